"""Rates on subcarriers: the paper's eq. (1), with a practical link.

With the coding gap Γ, the overhead o and the spectral-efficiency cap c,

    r = B (1 − o) min(c, log2(1 + p a)),    a = g / (Γ N0 B),

which is the paper's eq. (1) for Γ = 1, o = 0 and c = ∞. The cap makes power beyond (2^c − 1)/a useless.
"""

from __future__ import annotations

import math

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell


def normalised_gain(gain: FloatArray, cell: Cell) -> FloatArray:
    """SNR per watt after the coding gap, a = g/(Γ N0 B), in 1/W; same shape as ``gain``."""
    return gain / (cell.snr_gap * cell.noise_power_w)


def useful_power_w(gain: FloatArray, cell: Cell) -> FloatArray:
    """The power at which the spectral-efficiency cap is reached, (2^c − 1)/a, in W; infinite without a cap."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        power = np.expm1(np.log(2.0) * cell.max_spectral_efficiency) / normalised_gain(gain, cell)
    return np.where(np.isnan(power), np.inf, power)


def subcarrier_rate_bps(gain: FloatArray, power_w: FloatArray, cell: Cell) -> FloatArray:
    """Rate in bit/s for power ``power_w`` on gain ``gain`` (broadcast together); eq. (1).

    >>> cell = Cell(subcarrier_bandwidth_hz=1.0, noise_psd_w_per_hz=1.0)
    >>> float(subcarrier_rate_bps(np.array(3.0), np.array(1.0), cell))
    2.0
    """
    bits = np.log1p(power_w * normalised_gain(gain, cell)) / math.log(2.0)
    return cell.data_bandwidth_hz * np.minimum(bits, cell.max_spectral_efficiency)


def owned_gain(gain: FloatArray, owner: IntArray) -> FloatArray:
    """The gain of each subcarrier to its owner, shape (…, subcarrier); 0 where nobody owns it."""
    if gain.ndim == 2:
        return np.where(owner >= 0, gain[owner, np.arange(owner.size)], 0.0)
    users, size = int(gain.shape[-2]), int(gain.shape[-1])
    rows: IntArray = np.maximum(owner, 0)
    index = (rows + _numbered(owner.shape[:-1]) * users) * size + np.arange(size)
    return np.where(owner >= 0, gain.reshape(-1)[index], 0.0)


def user_rate_bps(gain: FloatArray, owner: IntArray, power_w: FloatArray, cell: Cell) -> FloatArray:
    """Each user's rate in bit/s, shape (…, user), for a gain (…, user, subcarrier) and one owner per subcarrier."""
    rate = subcarrier_rate_bps(owned_gain(gain, owner), power_w, cell)
    leading, users = gain.shape[:-2], int(gain.shape[-2])
    if not leading:
        return np.bincount(owner + 1, weights=rate, minlength=users + 1).astype(np.float64, copy=False)[1:]
    place = owner + 1 + _numbered(owner.shape[:-1]) * (users + 1)  # the first place of each problem is nobody's
    places = math.prod(leading) * (users + 1)
    total = np.bincount(place.reshape(-1), weights=rate.reshape(-1), minlength=places)
    return total.astype(np.float64, copy=False).reshape(*leading, users + 1)[..., 1:]


def _numbered(leading: tuple[int, ...]) -> IntArray:
    """The number of each problem of a batch, shape (…, 1)."""
    return np.arange(math.prod(leading)).reshape(*leading, 1)
