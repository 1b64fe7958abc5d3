"""How the errors of repaired gains are correlated over frequency: two holes side by side are wrong together."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.repairing.core.fit import Learnt, Relative, mean_hypothesis, unstated

BLOCK = 320
"""Subcarriers whose errors are treated together; blocks of longer bands count as independent."""
JITTER = 1e-10
NEAREST = 10
"""Observed entries on each side of a missing one beyond which others add next to nothing to what is known of it."""


@dataclass(frozen=True)
class ErrorRoots:
    """Roots of the correlation matrices of the errors, worked out when asked for.

    Given the observed gains, Gaussian ones with the user's mean hypothesis would have the covariance
    S = R_mm − R_mo (R_oo + η)⁻¹ R_om; the correlation is that of S. The same holds for observed ones of which the
    others tell as well (``smoothed``, shape (user, subcarrier)); errors of those that only their own measurement tells
    of are independent.
    """

    slot: Relative = field(repr=False)
    learnt: Learnt = field(repr=False)
    smoothed: BoolArray = field(repr=False)

    def __call__(self) -> FloatArray:
        """L with L Lᵀ the correlation, shape (user, subcarrier, subcarrier)."""
        table, noise, own = self._mean
        place = self.learnt.candidates.place
        users, subcarriers = self.slot.known.shape
        root = np.broadcast_to(np.eye(subcarriers), (users, subcarriers, subcarriers)).copy()
        for k in range(users):
            for start in range(0, subcarriers, BLOCK):
                block = slice(start, start + BLOCK)
                distance = np.abs(place[block, np.newaxis] - place[block])
                known = self.slot.known[k, block]
                wanted = ~known | self.smoothed[k, block]
                if wanted.any():
                    there = start + np.flatnonzero(wanted)
                    left = _left(table[k][distance], wanted, known, float(noise[k]), float(own[k]))
                    root[k, there[:, np.newaxis], there] = _root(left)
        return root

    def among(self, user: int, subcarriers: IntArray) -> FloatArray:
        """The correlation between the errors of a few of a user's entries, shape (entry, entry).

        Given the observed entries about them alone, as the others would add next to nothing.
        """
        table, noise, own = self._mean
        place, known = self.learnt.candidates.place, self.slot.known[user]
        correlation = np.eye(subcarriers.size)
        places = np.flatnonzero((~known | self.smoothed[user])[subcarriers])
        wanted, observed = subcarriers[places], np.flatnonzero(known)
        if wanted.size > 1:
            first = np.searchsorted(observed, wanted)
            near = np.clip(first[:, np.newaxis] + np.arange(-NEAREST, NEAREST), 0, max(observed.size - 1, 0))
            about = np.union1d(observed[np.unique(near)] if observed.size else observed, wanted)
            distance = np.abs(place[about, np.newaxis] - place[about])
            wanted_here = np.isin(about, wanted)
            left = _left(table[user][distance], wanted_here, known[about], float(noise[user]), float(own[user]))
            order = np.argsort(wanted, kind="stable")
            correlation[np.ix_(places[order], places[order])] = left
        return correlation

    @functools.cached_property
    def _mean(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Correlation at each distance (user, distance), η and its part that is no noise (user,), on average."""
        table, noise, _ = mean_hypothesis(self.slot, self.learnt)
        return table, noise, unstated(self.slot, self.learnt)


def _root(correlation: FloatArray) -> FloatArray:
    """The lower triangular root of a correlation matrix that may be singular, same shape."""
    from scipy.linalg import cholesky

    size = len(correlation)
    for jitter in (1e-9, 1e-6, 1e-3, 1e-1):
        try:
            return cholesky((correlation + jitter * np.eye(size)) / (1.0 + jitter), lower=True)
        except np.linalg.LinAlgError:
            continue
    return np.eye(size)


def _left(correlation: FloatArray, wanted: BoolArray, known: BoolArray, noise: float, own: float) -> FloatArray:
    """Correlation of the errors of the ``wanted`` entries given the ``known`` ones, shape (wanted, wanted).

    ``own`` is the variance that each entry has to itself.
    """
    from scipy.linalg import cho_factor, cho_solve

    left = correlation[np.ix_(wanted, wanted)]
    if known.any():
        across = correlation[np.ix_(known, wanted)]
        seen = correlation[np.ix_(known, known)] + (noise + JITTER) * np.eye(int(known.sum()))
        left = left - across.T @ cho_solve(cho_factor(seen, lower=True), across)
    scale = np.sqrt(np.maximum(np.diagonal(left) + own, JITTER))
    normal = left / scale / scale[:, np.newaxis]
    np.fill_diagonal(normal, 1.0)
    return normal
