"""Normal draws that are spread evenly: quantiles of what depends on a few of them are twice or thrice as accurate."""

from __future__ import annotations

import functools
import math

import numpy as np

from wirelessagent.model.arrays import FloatArray

_MOST = 16
"""Dimensions beyond which draws are independent: so few points cannot be even in so many."""
_END = 7.0


def normal_draws(num_draws: int, dimensions: int, rng: np.random.Generator) -> FloatArray:
    """Standard normal draws, shape (draw, dimension), independent over dimensions but spread evenly over draws.

    A Kronecker sequence with a random shift, u_i = shift + i (φ⁻¹, φ⁻², …) mod 1 with φ^(d+1) = φ + 1, through the
    inverse of the normal distribution. M. Roberts, *The unreasonable effectiveness of quasirandom sequences* (2018),
    proposes these multipliers; Niederreiter, *Random Number Generation and Quasi-Monte Carlo Methods* (1992), section
    3.1, has the theory.

    >>> float(abs(normal_draws(4000, 2, np.random.default_rng(1)).mean().round(3)))
    0.0
    """
    if dimensions > _MOST:
        return rng.standard_normal((num_draws, dimensions))
    root = 2.0
    for _ in range(64):
        root = (1.0 + root) ** (1.0 / (dimensions + 1))
    step = root ** -np.arange(1.0, dimensions + 1)
    even = (rng.random(dimensions) + np.arange(num_draws)[:, np.newaxis] * step) % 1.0
    return np.interp(even, *_normal_distribution())


@functools.cache
def _normal_distribution() -> tuple[FloatArray, FloatArray]:
    """The normal distribution function and where it is taken: its inverse, read from here, is exact to 1e-7."""
    place = np.linspace(-_END, _END, 16_385)
    return np.array([math.erfc(-z / math.sqrt(2.0)) / 2.0 for z in place.tolist()]), place
