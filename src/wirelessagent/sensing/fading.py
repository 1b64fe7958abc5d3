"""Small-scale Rayleigh fading with an exponential power-delay profile and Clarke's Doppler spectrum.

Every coefficient is complex Gaussian of unit power. The correlation of two of them is the product

    E[h(f, t) h*(f', t')] = 1 / (1 + j2π(f − f')τ) · J0(2π f_d (t − t'))

for the rms delay spread τ and the largest Doppler shift f_d, so the gains |h|² are correlated by
1/(1 + (2πΔfτ)²) over frequency and by J0(2π f_d Δt)² over time. Both hold to about 1e-12, not only on average over a
tapped-delay-line's grid:

- over frequency, h is a sum of taps at the nodes of a Gauss–Legendre quadrature of the profile, one independent
  complex Gaussian per node; enough nodes are taken that the quadrature is exact to rounding over the whole band, so no
  N×N matrix is needed and 3,276 subcarriers cost little;
- over time, the slots are mixed by the symmetric square root of their exact covariance matrix.

Sources: Jakes, *Microwave Mobile Communications* (1974), section 1.5 (the two correlations); Clarke (1968) for J0.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.arrays import FloatArray

ComplexArray: TypeAlias = NDArray[np.complex128]

_PROFILE_END = 40.0
"""Delay, in rms delay spreads, at which the profile is cut: e^−40 is below rounding."""
_NODES = 32
"""Quadrature nodes per panel of delays."""
_PANEL_EXPONENT = 28.0
"""Largest |z| for which 32 nodes integrate exp(zx) over [−1, 1] to rounding."""
_SMALLEST_EIGENVALUE = 1e-13
"""Share of the slots' power below which a direction is rounding, and is left out."""
_BLOCK = 1 << 22
"""Largest number of coefficients in an intermediate array (64 MiB)."""


def rayleigh_fading(
    rng: np.random.Generator,
    *,
    num_users: int,
    num_slots: int,
    num_subcarriers: int,
    subcarrier_spacing_hz: float,
    rms_delay_spread_s: float,
    doppler_hz: float,
    slot_s: float,
) -> ComplexArray:
    """Independent users' fading coefficients of unit mean power, shape (user, slot, subcarrier).

    A channel that does not move is the same in every slot. The first users' coefficients do not depend on how many
    users follow.
    """
    moving = doppler_hz > 0 and num_slots > 1
    taps = delay_taps(num_subcarriers, subcarrier_spacing_hz * rms_delay_spread_s)
    drawn = taps.draw(rng, num_users * (num_slots if moving else 1)).reshape(num_users, -1, num_subcarriers)
    if moving:
        return time_root(num_slots, doppler_hz * slot_s) @ drawn
    return np.repeat(drawn, num_slots, axis=1)


@dataclass(frozen=True)
class DelayTaps:
    """An exponential power-delay profile as taps on panels of equal length, ``_NODES`` of them on each.

    The delay of a tap is its panel's start plus its node's offset, so its phases are a product of two small tables.

    Attributes:
        amplitude: root of each tap's power, shape (node, panel); the powers sum to 1.
        panel_phase: exp(−j2πf·start) on every subcarrier, shape (panel, subcarrier).
        node_phase: exp(−j2πf·offset) on every subcarrier, shape (node, subcarrier).
    """

    amplitude: FloatArray
    panel_phase: ComplexArray
    node_phase: ComplexArray

    def draw(self, rng: np.random.Generator, count: int) -> ComplexArray:
        """Independent frequency responses, shape (count, subcarrier)."""
        nodes, panels = self.amplitude.shape
        num_subcarriers = self.node_phase.shape[1]
        response = np.empty((count, num_subcarriers), dtype=np.complex128)
        rows = max(1, _BLOCK // (nodes * max(panels, num_subcarriers)))
        for start in range(0, count, rows):
            size = min(rows, count - start)
            tap = complex_normal(rng, (size, nodes, panels)) * self.amplitude
            response[start : start + size] = np.einsum("rin,in->rn", tap @ self.panel_phase, self.node_phase)
        return response


@functools.lru_cache(maxsize=8)
def delay_taps(num_subcarriers: int, spread: float) -> DelayTaps:
    """The taps for a band of ``num_subcarriers``; ``spread`` is the rms delay spread times the subcarrier spacing.

    On a grid of frequencies, delays that differ by one over the spacing cannot be told apart, so a profile that is
    longer than that is folded into one period, where it is exponential again.
    """
    from numpy.polynomial.legendre import leggauss

    end = min(_PROFILE_END, 1.0 / spread) if spread > 0 else _PROFILE_END  # in rms delay spreads
    exponent = abs(1.0 + 2j * np.pi * (num_subcarriers - 1) * spread)
    panels = int(np.ceil(end * exponent / (2 * _PANEL_EXPONENT)))
    length = end / panels
    points, weights = leggauss(_NODES)
    offset = length * (points + 1.0) / 2.0
    start = length * np.arange(panels)
    power = weights[:, np.newaxis] * np.exp(-(offset[:, np.newaxis] + start))
    turn = -2j * np.pi * spread * np.arange(num_subcarriers)
    return DelayTaps(
        amplitude=np.sqrt(power / power.sum()),
        panel_phase=np.exp(np.multiply.outer(start, turn)),
        node_phase=np.exp(np.multiply.outer(offset, turn)),
    )


@functools.lru_cache(maxsize=8)
def time_root(num_slots: int, turns_per_slot: float) -> FloatArray:
    """The symmetric square root of the slots' covariance J0(2π f_d Δt), shape (slot, slot).

    ``turns_per_slot`` is f_d times the slot's length. The symmetric root, unlike one made of eigenvectors, does not
    depend on the signs that a linear-algebra library happens to choose.
    """
    from scipy.linalg import eigh, toeplitz
    from scipy.special import j0

    covariance = toeplitz(j0(2.0 * np.pi * turns_per_slot * np.arange(num_slots)))
    value, vector = eigh(covariance)
    value = np.where(value > _SMALLEST_EIGENVALUE * num_slots, value, 0.0)
    return np.ascontiguousarray((vector * np.sqrt(value)) @ vector.T)


def complex_normal(rng: np.random.Generator, shape: tuple[int, ...]) -> ComplexArray:
    """Circular complex Gaussian numbers of unit mean power."""
    pairs = rng.standard_normal((*shape, 2)) * np.sqrt(0.5)
    return pairs.view(np.complex128)[..., 0]
