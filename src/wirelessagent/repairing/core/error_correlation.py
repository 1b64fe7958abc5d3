"""How the errors of repaired gains are correlated over frequency: two holes side by side are wrong together."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.repairing.core.fit import Learnt, Relative, mean_hypothesis

BLOCK = 320
"""Subcarriers whose errors are treated together; blocks of longer bands count as independent."""
JITTER = 1e-10


@dataclass(frozen=True)
class ErrorRoots:
    """Roots of the correlation matrices of the errors, worked out when asked for.

    Given the observed gains, Gaussian ones with the user's mean hypothesis would have the covariance
    S = R_mm − R_mo (R_oo + η)⁻¹ R_om; the correlation is that of S. Errors of observed gains are independent.
    """

    slot: Relative = field(repr=False)
    learnt: Learnt = field(repr=False)

    def __call__(self) -> FloatArray:
        """L with L Lᵀ the correlation, shape (user, subcarrier, subcarrier)."""
        table, noise, _ = mean_hypothesis(self.slot, self.learnt)
        place = self.learnt.candidates.place
        users, subcarriers = self.slot.known.shape
        root = np.broadcast_to(np.eye(subcarriers), (users, subcarriers, subcarriers)).copy()
        for k in range(users):
            for start in range(0, subcarriers, BLOCK):
                block = slice(start, start + BLOCK)
                distance = np.abs(place[block, np.newaxis] - place[block])
                known = self.slot.known[k, block]
                if not known.all():
                    missing = start + np.flatnonzero(~known)
                    root[k, missing[:, np.newaxis], missing] = _root(table[k][distance], known, float(noise[k]))
        return root


def _root(correlation: FloatArray, known: BoolArray, noise: float) -> FloatArray:
    """Of the errors of the missing entries, shape (missing, missing)."""
    from scipy.linalg import cho_factor, cho_solve, cholesky

    missing = ~known
    left = correlation[np.ix_(missing, missing)]
    if known.any():
        across = correlation[np.ix_(known, missing)]
        seen = correlation[np.ix_(known, known)] + (noise + JITTER) * np.eye(int(known.sum()))
        left = left - across.T @ cho_solve(cho_factor(seen, lower=True), across)
    scale = np.sqrt(np.maximum(np.diagonal(left), JITTER))
    normal = left / scale / scale[:, np.newaxis]
    size = len(normal)
    np.fill_diagonal(normal, 1.0)
    for jitter in (1e-9, 1e-6, 1e-3, 1e-1):
        try:
            return cholesky((normal + jitter * np.eye(size)) / (1.0 + jitter), lower=True)
        except np.linalg.LinAlgError:
            continue
    return np.eye(size)
