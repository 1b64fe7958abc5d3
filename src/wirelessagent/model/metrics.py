"""The figures of merit of an allocation on a given channel, predicted or achieved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.rates import user_rate_bps
from wirelessagent.model.shown import Plain

RATE_TOLERANCE = 1e-9
"""Relative shortfall up to which a constraint on a rate is met: rounding."""

READ_BACK_TOLERANCE = 1e-4
"""Relative shortfall up to which a rate that was read back counts as kept, in reports, goodput and documents alike:
less than the three digits that people are shown."""


@dataclass(frozen=True, kw_only=True, repr=False)
class LinkMetrics(Plain):
    """What an allocation gives on one channel.

    Attributes:
        user_rate_bps: each user's rate, shape (user,).
        sum_rate_bps: total rate if the link adapts ideally to the channel.
        goodput_bps: total of the committed rates that the channel carries; a user whose rate falls short of its
            commitment counts nothing.
        power_w: radiated power.
        energy_efficiency_bit_per_j: sum rate over drawn power, P/ξ + P_c.
        spectral_efficiency_bps_per_hz: sum rate over the total bandwidth, N·B.
        jain_index: fairness of the rates, (Σ r)²/(K Σ r²), in [1/K, 1]; Jain, Chiu and Hawe (1984).
    """

    user_rate_bps: FloatArray
    sum_rate_bps: float
    goodput_bps: float
    power_w: float
    energy_efficiency_bit_per_j: float
    spectral_efficiency_bps_per_hz: float
    jain_index: float


def kept(
    rate_bps: FloatArray, promised_bps: FloatArray, tolerance: float = RATE_TOLERANCE
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """True where a rate reaches what was promised, within the tolerance."""
    return rate_bps >= promised_bps * (1.0 - tolerance)


def jain_index(rate_bps: FloatArray) -> float:
    """Jain's fairness index; 0 where nobody gets anything.

    >>> jain_index(np.array([1.0, 1.0])), jain_index(np.array([1.0, 0.0]))
    (1.0, 0.5)
    """
    largest = float(np.max(rate_bps, initial=0.0))
    if largest == 0.0:
        return 0.0
    share = rate_bps / largest
    return float(share.sum() ** 2 / (share.size * np.square(share).sum()))


def energy_efficiency_bit_per_j(sum_rate_bps: float, power_w: float, cell: Cell) -> float:
    """Sum rate over drawn power, P/ξ + P_c, in bit/J; 0 where nothing is drawn and nothing sent."""
    drawn = power_w / cell.amplifier_efficiency + cell.circuit_power_w
    return sum_rate_bps / drawn if drawn > 0 else 0.0


def link_metrics(
    gain: FloatArray,
    owner: IntArray,
    power_w: FloatArray,
    cell: Cell,
    *,
    committed_bps: FloatArray | None = None,
    slack_bps: FloatArray | None = None,
) -> LinkMetrics:
    """Metrics on ``gain`` (user, subcarrier) of an owner and a power per subcarrier.

    ``committed_bps`` (user,) are the rates that were promised; None takes the rates that ``gain`` carries. One that is
    short by ``slack_bps`` (user,) still arrives.
    """
    rate = user_rate_bps(gain, owner, power_w, cell)
    committed = rate if committed_bps is None else committed_bps
    least = committed if slack_bps is None else committed - slack_bps
    arrives = kept(rate, least, READ_BACK_TOLERANCE)
    return metrics_of_rates(
        rate,
        goodput_bps=float(np.where(arrives, committed, 0.0).sum()),
        power_w=float(power_w.sum()),
        num_subcarriers=gain.shape[-1],
        cell=cell,
    )


def metrics_of_rates(
    user_rate_bps: FloatArray, *, goodput_bps: float, power_w: float, num_subcarriers: int, cell: Cell
) -> LinkMetrics:
    """Metrics that follow from rates (user,), a goodput and a radiated power that are known already."""
    total = float(user_rate_bps.sum())
    return LinkMetrics(
        user_rate_bps=user_rate_bps,
        sum_rate_bps=total,
        goodput_bps=goodput_bps,
        power_w=power_w,
        energy_efficiency_bit_per_j=energy_efficiency_bit_per_j(total, power_w, cell),
        spectral_efficiency_bps_per_hz=total / (num_subcarriers * cell.subcarrier_bandwidth_hz),
        jain_index=jain_index(user_rate_bps),
    )
