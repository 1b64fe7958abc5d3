"""The least power of promises on given sets of subcarriers of an uncertain channel.

A user's powers are water-filled for the rate R on the quantiles at its q, and q is moved until R is what may be
promised: less caution takes less power and keeps less. That finds the best powers of one family, not of all; on sets of
one uncertain entry, or none, the family holds the best.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.outage_rates import Held
from wirelessagent.model.arrays import FloatArray

_STEPS = 40
_ACCURACY = 1e-7
"""Relative, of the rate: what may be promised is at least R and at most this above it."""


class Spent(NamedTuple):
    """The powers (entry,) of a user that may be promised its rate, infinite where none do, and its q's place."""

    power_w: FloatArray
    place: float


def least_power(form: NormalForm, held: Held, nats: float, start: float) -> Spent:
    """The powers for the rate ``nats``, from the place ``start`` of a first q."""
    low, high = 0.0, len(held.levels) - 1.0  # R may be promised at low, and not at high
    power_low, excess_low = _filled(form, held, nats, low)
    if not np.isfinite(excess_low) or excess_low < 0.0:
        return _scaled(form, held, nats, power_low)
    if not held.uncertain.size:
        return Spent(power_low, start)
    excess_high, place = np.nan, min(max(start, low), high)
    stuck = 0
    for _ in range(_STEPS):
        power, excess = _filled(form, held, nats, place)
        if np.isfinite(excess) and excess >= 0.0:
            low, power_low, excess_low = place, power, excess
            stuck = stuck + 1 if stuck > 0 else 1
        else:
            high, excess_high = place, excess
            stuck = stuck - 1 if stuck < 0 else -1
        if 0.0 <= excess_low <= _ACCURACY * nats or high - low <= 1e-9:
            break
        middle = 0.5 * (low + high)
        if np.isfinite(excess_high) and abs(stuck) <= 2:  # aim at the lower half of what is accepted
            middle = low + (high - low) * (excess_low - 0.5 * _ACCURACY * nats) / (excess_low - excess_high)
            middle = min(max(middle, low + 1e-3 * (high - low)), high - 1e-3 * (high - low))
        place = middle
    return Spent(power_low, low)


def _filled(form: NormalForm, held: Held, nats: float, place: float) -> tuple[FloatArray, float]:
    """Powers that carry ``nats`` on the quantiles at ``place``, and by how much what may be promised exceeds it.

    NaN where the quantiles carry it at no power.
    """
    power_w = fill(form, held, held.counted_on(place), nats)
    if not np.isfinite(power_w).all():
        return power_w, np.nan
    return power_w, held.promised_nats(power_w) - nats * (1.0 - 1e-12)


def _scaled(form: NormalForm, held: Held, nats: float, power_w: FloatArray) -> Spent:
    """Where even the smallest q does not do, all powers times what does."""
    cap_w = form.cap_w[held.subcarriers]
    for _ in range(_STEPS):
        if not np.isfinite(power_w).all() or held.promised_nats(power_w) >= nats * (1.0 - 1e-12):
            return Spent(power_w, 0.0)
        power_w = np.where(1.25 * power_w <= cap_w, 1.25 * power_w, np.inf)
    return Spent(np.full(power_w.shape, np.inf), 0.0)


def fill(form: NormalForm, held: Held, snr_per_w: FloatArray, nats: float) -> FloatArray:
    """Water-filling for ``nats`` on gains that are known, shape (entry,); infinite where they cannot carry it."""
    from wirelessagent.deciding.core.least_power_kernel import owned_power

    cap_w = form.cap_w[held.subcarriers]
    with np.errstate(invalid="ignore"):
        ceiling = np.where(snr_per_w > 0, np.minimum(np.log1p(cap_w * snr_per_w), form.max_nats), 0.0)
    power_w = np.empty(snr_per_w.size)
    owner = np.zeros(snr_per_w.size, dtype=np.int64)
    total = owned_power(
        np.ascontiguousarray(snr_per_w), ceiling, np.array([nats]), owner, power_w, np.empty(1)
    )  # fmt: skip
    return power_w if np.isfinite(total) else np.full(power_w.shape, np.inf)
