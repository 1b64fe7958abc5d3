"""What is known of the true gains after observation: a distribution, not a number.

The base class is what decisions may ask of it. :class:`GammaPosterior` is the simplest honest one: independent
entries, each a gamma distribution with the estimate's mean and variance (exact for the exponential gain of Rayleigh
fading with a known mean, and a point mass where the variance is zero).
"""

from __future__ import annotations

import functools
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.mean_log import MeanLogs
from wirelessagent.model.shown import Plain


class Posterior(ABC):
    """The distribution of the true (user, subcarrier) gains given all observations.

    Attributes:
        mean: of each gain, shape (user, subcarrier). Where a noisy measurement is not all that tells of a gain it is
            not the estimate's, which is the measurement.
    """

    mean: FloatArray

    @abstractmethod
    def quantile(self, probability: float) -> FloatArray:
        """The gain that each entry stays below with ``probability``, shape (user, subcarrier)."""

    @abstractmethod
    def samples(self, num_samples: int, *, seed: int) -> FloatArray:
        """Joint draws of the true gains, shape (sample, user, subcarrier)."""

    def samples_of(self, user: int, subcarriers: IntArray, num_samples: int, *, seed: int) -> FloatArray:
        """Joint draws of one user's gains on a few ``subcarriers``, shape (sample, subcarrier).

        Other draws than :meth:`samples` makes, of the same distribution; they may be spread more evenly than
        independent ones. A posterior overrides this where it can draw a few entries without drawing all.
        """
        return self.samples(num_samples, seed=seed)[:, user, subcarriers]

    @abstractmethod
    def expected_log1p(self, scale: FloatArray) -> FloatArray:
        """E[ln(1 + s·g)] per entry for a scale s (broadcast), shape (user, subcarrier), in nats."""


@dataclass(frozen=True, repr=False)
class GammaPosterior(Plain, Posterior):
    """Independent gamma distributions with given means and variances, both of shape (user, subcarrier)."""

    mean: FloatArray
    variance: FloatArray

    def quantile(self, probability: float) -> FloatArray:
        from scipy.special import gammaincinv

        shape = self._shape()
        spread = gammaincinv(shape, probability) / shape
        return np.where(self.variance > 0, self.mean * spread, self.mean)

    def samples(self, num_samples: int, *, seed: int) -> FloatArray:
        shape = self._shape()
        drawn = np.random.default_rng(seed).gamma(shape, size=(num_samples, *shape.shape)) / shape
        return self.mean * np.where(self.variance > 0, drawn, 1.0)

    def samples_of(self, user: int, subcarriers: IntArray, num_samples: int, *, seed: int) -> FloatArray:
        few = GammaPosterior(self.mean[user, subcarriers], self.variance[user, subcarriers])
        shape = few._shape()
        drawn = np.random.default_rng((seed, user)).gamma(shape, size=(num_samples, shape.size)) / shape
        return few.mean * np.where(few.variance > 0, drawn, 1.0)

    def expected_log1p(self, scale: FloatArray) -> FloatArray:
        spread = np.where(self.variance > 0, 1.0 / self._shape(), 0.0)
        return _mean_logs().mean(spread, self.mean * scale)

    def _shape(self) -> FloatArray:
        """The gamma shape parameter mean²/variance; 1 where it is not used."""
        certain = (self.variance <= 0) | (self.mean <= 0)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            return np.where(certain, 1.0, np.clip(self.mean**2 / self.variance, 1e-3, 1e12))


@functools.lru_cache(maxsize=1)
def _mean_logs() -> MeanLogs:
    return MeanLogs.of(lambda probability, spread: GammaPosterior(np.ones(spread.shape), spread).quantile(probability))
