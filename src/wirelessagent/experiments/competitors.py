"""What others would fill missing gains with: competitors of the repairers, for evaluations only.

They are repairers, so that they run in the same code on the same draws, but are not registered: nobody should decide on
them, since none of them says how sure it is. Each works on gains relative to the user's own mean, without which the
strongest user would rule all of those that look at users jointly.

| name | what it is |
|---|---|
| ``cubic`` | a cubic spline over frequency (SciPy), the nearest value beyond its ends, nothing below zero |
| ``knn`` | scikit-learn's ``KNNImputer``: subcarriers are samples, users features |
| ``iterative`` | scikit-learn's ``IterativeImputer``: subcarriers are samples, users features |
| ``soft_impute`` | :mod:`wirelessagent.experiments.soft_impute` on the deviations from the user's mean |
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from wirelessagent.experiments.sklearn_adapter import iterative_filled, knn_filled
from wirelessagent.experiments.soft_impute import soft_impute
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.repairer import Repairer


@dataclass(frozen=True, kw_only=True)
class Competitor(Repairer):
    """A filler of matrices that says nothing of its errors; the variances are zero and mean nothing."""

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        gain = observation.current
        level = observed_levels(gain)
        frequency = observation.subcarrier_frequencies_hz
        where = np.arange(gain.shape[1], dtype=np.float64) if frequency is None else frequency
        filled = self.filled(gain / level[:, np.newaxis], where)
        return ChannelEstimate.completing(
            observation,
            gain=np.maximum(filled, 0.0) * level[:, np.newaxis],
            gain_variance=np.zeros(gain.shape),
            method=self.name,
        )

    @abstractmethod
    def filled(self, relative: FloatArray, frequency: FloatArray) -> FloatArray:
        """Gains relative to each user's mean, (user, subcarrier), with finite values in place of the NaN."""


def observed_levels(gain: FloatArray) -> FloatArray:
    """Each user's mean observed gain, shape (user,); the others' geometric mean for users never observed."""
    seen = ~np.isnan(gain)
    mean = np.where(seen, gain, 0.0).sum(axis=1) / np.maximum(seen.sum(axis=1), 1)
    known = mean > 0
    logarithms: FloatArray = np.log(mean[known])
    return np.where(known, mean, np.exp(logarithms.mean()) if logarithms.size else 1.0)


@dataclass(frozen=True, kw_only=True)
class Cubic(Competitor):
    """A cubic spline through each user's observed gains, its outermost values beyond them."""

    name = "cubic"

    def filled(self, relative: FloatArray, frequency: FloatArray) -> FloatArray:
        return np.stack([_spline(row, frequency) for row in relative])


def _spline(row: FloatArray, frequency: FloatArray) -> FloatArray:
    from scipy.interpolate import CubicSpline

    seen = np.flatnonzero(~np.isnan(row))
    if seen.size < 2:
        return np.full(row.shape, row[seen[0]] if seen.size else 1.0)
    x = (frequency - frequency[0]) / (frequency[-1] - frequency[0])
    within = np.clip(x, x[seen[0]], x[seen[-1]])
    return np.asarray(CubicSpline(x[seen], row[seen])(within), dtype=np.float64)


@dataclass(frozen=True, kw_only=True)
class Knn(Competitor):
    """The weighted mean over the subcarriers on which the other users' gains are most alike.

    Attributes:
        num_neighbours: how many subcarriers.
    """

    name = "knn"

    num_neighbours: int = 5

    def filled(self, relative: FloatArray, frequency: FloatArray) -> FloatArray:
        filled = knn_filled(relative.T, num_neighbours=self.num_neighbours).T
        return _with_means(filled, relative)


@dataclass(frozen=True, kw_only=True)
class Iterative(Competitor):
    """Each user's gains regressed on the other users' over the subcarriers, in turn until it settles.

    Attributes:
        num_nearest: the most users regressed on, or a matrix of many would take minutes.
        seed: of its choice of users.
    """

    name = "iterative"

    num_nearest: int = 20
    seed: int = 0

    def filled(self, relative: FloatArray, frequency: FloatArray) -> FloatArray:
        filled = iterative_filled(relative.T, num_nearest=self.num_nearest, seed=self.seed).T
        return _with_means(filled, relative)


def _with_means(filled: FloatArray, relative: FloatArray) -> FloatArray:
    """Users never observed at their mean; scikit-learn would leave them at zero."""
    unseen = np.isnan(relative).all(axis=1, keepdims=True)
    return np.where(unseen, 1.0, filled)


@dataclass(frozen=True, kw_only=True)
class SoftImpute(Competitor):
    """The matrix of deviations from the users' means completed by one of small nuclear norm.

    Attributes:
        seed: of the entries held out to choose the penalty.
    """

    name = "soft_impute"

    seed: int = 0

    def filled(self, relative: FloatArray, frequency: FloatArray) -> FloatArray:
        return 1.0 + soft_impute(relative - 1.0, seed=self.seed)


COMPETITORS: Mapping[str, Competitor] = MappingProxyType(
    {one.name: one for one in (Cubic(), Knn(), Iterative(), SoftImpute())}
)
"""The competitors by name."""

NEED_SKLEARN = frozenset({"knn", "iterative"})
