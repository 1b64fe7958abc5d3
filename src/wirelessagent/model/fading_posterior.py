"""What is known of faded gains: Rician powers, whose errors may be correlated over frequency.

A coefficient h of which a part is known is complex Gaussian about it: h = ν + e with e ~ CN(0, c). Its power |h|² has
the mean m = ν² + c and the variance v = 2mc − c², so that mean and variance say all: c = m − √(m² − v). Certainty is
c = 0, Rayleigh fading of known level c = m. A variance above m² says that the level itself is uncertain: an
exponential gain whose level is inverse-gamma distributed is Lomax distributed, P(g > x) = (1 + x/(m(α − 1)))^−α with
α = 2v/(v − m²). The two meet at v = m².

Simon and Alouini, *Digital Communication over Fading Channels* (2005), section 2.2.1.3 (Rician power); Johnson, Kotz
and Balakrishnan, *Continuous Univariate Distributions* (1994), section 20.12 (Lomax).
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.even_draws import normal_draws
from wirelessagent.model.mean_log import MeanLogs
from wirelessagent.model.posterior import Posterior
from wirelessagent.model.shown import Plain

MEAN_LOGS = Path(__file__).with_name("fading_mean_logs.npy")
"""The table of :func:`tabulated`, written by ``numpy.save``; a test makes it anew and compares."""

_NODES = 513
"""Nodes of a quantile's table over √(c/m)."""
_SHARP = 1e-4
"""c/m below which the amplitude is normal to four digits and more."""


class ErrorCorrelation(Protocol):
    """How the errors e of one user's entries are correlated over frequency."""

    def __call__(self) -> FloatArray:
        """R with R Rᵀ the correlation, shape (user, subcarrier, subcarrier)."""
        ...

    def among(self, user: int, subcarriers: IntArray) -> FloatArray:
        """The correlation between a few of a user's entries, shape (entry, entry)."""
        ...


@dataclass(frozen=True, repr=False)
class FadingPosterior(Plain, Posterior):
    """Powers of partly known coefficients.

    Attributes:
        mean, variance: of the true gains, shape (user, subcarrier).
        error_root: the correlation of the errors e over frequency; None for independent errors. It is asked when
            samples are drawn.
    """

    mean: FloatArray
    variance: FloatArray
    error_root: ErrorCorrelation | None = field(default=None, repr=False, compare=False)

    def quantile(self, probability: float) -> FloatArray:
        mean = self.mean
        below = np.interp(np.sqrt(self._unknown), np.linspace(0.0, 1.0, _NODES), _rician_quantiles(probability))
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            alpha = self._alpha
            beyond = (alpha - 1.0) * np.expm1(-np.log1p(-probability) / alpha)
        return mean * np.where(self._spread > 1.0, beyond, below)

    def samples(self, num_samples: int, *, seed: int) -> FloatArray:
        rng = np.random.default_rng(seed)
        users, subcarriers = self.mean.shape
        error: FloatArray = rng.standard_normal((2, num_samples, users, subcarriers))
        if self._root is not None:
            error = np.matmul(self._root, error[..., np.newaxis])[..., 0]
        unknown = self.mean * self._unknown
        known = np.sqrt(np.maximum(self.mean - unknown, 0.0))
        root = np.sqrt(unknown / 2.0)
        drawn: FloatArray = (known + root * error[0]) ** 2 + (root * error[1]) ** 2
        wide = self._spread > 1.0
        if wide.any():
            every = np.arange(int(subcarriers))
            for user in np.flatnonzero(wide.any(axis=1)).tolist():
                drawn[:, user] *= self._levels(user, every, rng.random(num_samples))
        return np.where(self.variance > 0, drawn, self.mean)

    def samples_of(self, user: int, subcarriers: IntArray, num_samples: int, *, seed: int) -> FloatArray:
        rng = np.random.default_rng((seed, user))
        error = normal_draws(num_samples, 2 * subcarriers.size, rng).reshape(num_samples, 2, -1).transpose(1, 0, 2)
        if self.error_root is not None and subcarriers.size > 1:
            strength, direction = np.linalg.eigh(self.error_root.among(user, subcarriers))
            error = error @ (direction * np.sqrt(np.maximum(strength, 0.0))).T
        mean = self.mean[user, subcarriers]
        unknown = mean * self._unknown[user, subcarriers]
        root = np.sqrt(unknown / 2.0)
        drawn: FloatArray = (np.sqrt(np.maximum(mean - unknown, 0.0)) + root * error[0]) ** 2 + (root * error[1]) ** 2
        if (self._spread[user, subcarriers] > 1.0).any():
            drawn *= self._levels(user, subcarriers, rng.random(num_samples))
        return np.where(self.variance[user, subcarriers] > 0, drawn, mean)

    def _levels(self, user: int, subcarriers: IntArray, chance: FloatArray) -> FloatArray:
        """Draws of a user's level in units of the mean, shape (sample, subcarrier); 1 where it is known.

        It is one level that all the user's entries share, so it is drawn once: ``chance`` (sample,) says where among
        its possible values it lies, the more uncertain it is for an entry the further from the mean.
        """
        from scipy.special import gammaincinv

        wide, alpha = self._spread[user, subcarriers] > 1.0, self._alpha[user, subcarriers]
        level = np.ones((chance.size, subcarriers.size))
        for shape in np.unique(alpha[wide]):
            there = wide & (alpha == shape)
            level[:, there] = ((shape - 1.0) / gammaincinv(shape, chance))[:, np.newaxis]
        return level

    def expected_log1p(self, scale: FloatArray) -> FloatArray:
        return _mean_logs().mean(self._spread, self.mean * scale)

    @functools.cached_property
    def _spread(self) -> FloatArray:
        """v/m²; 0 where nothing is uncertain."""
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            ratio = self.variance / self.mean / self.mean
        return np.where((self.variance > 0) & (self.mean > 0), ratio, 0.0)

    @functools.cached_property
    def _unknown(self) -> FloatArray:
        """c/m, without cancellation where it is small."""
        spread = np.minimum(self._spread, 1.0)
        return spread / (1.0 + np.sqrt(1.0 - spread))

    @functools.cached_property
    def _alpha(self) -> FloatArray:
        """Lomax shape where the spread is above 1."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return 2.0 / (1.0 - 1.0 / np.maximum(self._spread, 1.0 + 1e-12))

    @functools.cached_property
    def _root(self) -> FloatArray | None:
        return None if self.error_root is None else self.error_root()


@functools.lru_cache(maxsize=256)
def _rician_quantiles(probability: float) -> FloatArray:
    """Quantile of the power of mean 1 for √(c/m) from 0 to 1, shape (node,)."""
    from scipy.special import chndtrix, ndtri

    unknown = np.linspace(0.0, 1.0, _NODES) ** 2
    known = 1.0 - unknown
    sharp = np.maximum(np.sqrt(known) + ndtri(probability) * np.sqrt(unknown / 2.0), 0.0) ** 2
    wide = unknown > _SHARP
    exact = np.where(wide, unknown, 1.0)
    return np.where(wide, exact / 2.0 * chndtrix(probability, 2.0, np.where(wide, 2.0 * known / exact, 0.0)), sharp)


def tabulated() -> MeanLogs:
    """The mean logarithms, made anew: what :data:`MEAN_LOGS` holds, where SciPy is not loaded for it."""
    return MeanLogs.of(lambda probability, spread: FadingPosterior(np.ones(spread.shape), spread).quantile(probability))


@functools.lru_cache(maxsize=1)
def _mean_logs() -> MeanLogs:
    return MeanLogs(np.load(MEAN_LOGS))
