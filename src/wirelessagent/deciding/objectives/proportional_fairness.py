"""Proportional fairness: nobody's rate can rise by some per cent without others' falling by more per cent in total."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray, float_array
from wirelessagent.model.errors import InputError
from wirelessagent.model.objective import Objective
from wirelessagent.model.phrases import phrases

_FREE = 1e-300
"""Per bit/s: a price below this is taken for none, so that its inverse stays a number."""


@dataclass(frozen=True, kw_only=True)
class ProportionalFairness(Objective):
    """The largest product of the users' rates, Σ ln r; Kelly, Maulloo and Tan (1998).

    The value is the users' geometric mean rate, exp(Σ ω ln r / Σ ω), in bit/s; 0 if a user gets nothing.

    Over many slots it is the average rates that are to be shared fairly. With r̄ the average that a user has had, and T
    the window of an NR or LTE scheduler, the average after this slot is r̄ (1 − 1/T) + r/T, and the best sum of its
    logarithms that of Σ ln((T − 1) r̄ + r). So the past average to give is s = (T − 1) r̄, and the value is the
    geometric mean of s + r. For a long window this is the scheduler's rule, the largest Σ r/r̄: Viswanath, Tse and
    Laroia (2002). F. P. Kelly, A. K. Maulloo and D. K. H. Tan, "Rate control for communication networks", J. Oper.
    Res. Soc. 49, 1998; P. Viswanath, D. N. C. Tse and R. Laroia, "Opportunistic beamforming using dumb antennas", IEEE
    Trans. Inf. Theory 48(6), 2002.

    Attributes:
        past_average_bps: what users have had already, s in bit/s, one value or one per user. From an average over T
            slots it is T − 1 times that.
    """

    name = "proportional_fairness"
    aliases = ("PF",)
    unit = "bit/s"
    figure_name = phrases(
        en=["geometric mean rate"],
        zh=["几何平均速率"],
        es=["media geométrica de las tasas"],
        fr=["moyenne géométrique des débits"],
        de=["geometrisches Mittel der Raten"],
    )
    phrases = phrases(
        en=["proportional fairness", "share fairly", "a fair share for everyone"],
        zh=["比例公平", "公平分配", "公平地共享"],
    )

    past_average_bps: float | tuple[float, ...] = 0.0

    def __post_init__(self) -> None:
        past = float_array("past_average_bps", self.past_average_bps)
        if past.ndim > 1 or not past.size or not np.all((past >= 0) & np.isfinite(past)):
            raise InputError(
                "past_average_bps must be one rate or one per user, zero or more and finite; "
                f"got {self.past_average_bps!r:.80}"
            )
        plain = float(past) if past.ndim == 0 else tuple(float(rate) for rate in past)
        object.__setattr__(self, "past_average_bps", plain)

    def utility(self, rate: FloatArray) -> FloatArray:
        """ln(s + r)."""
        past = self._past(rate.shape)
        with np.errstate(divide="ignore"):
            return np.log(past + rate)

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """u′(r) = 1/(s + r) is the price, at r = 1/price − s or at the limit that is nearer."""
        shape = np.broadcast_shapes(price.shape, min_rate.shape, max_rate.shape)
        past, free = self._past(shape), price < _FREE
        wanted = np.where(free, np.inf, 1.0 / np.where(free, 1.0, price)) - past
        rate = np.clip(wanted, min_rate, max_rate)
        payment = np.where(free, 0.0, price) * np.where(free, 0.0, rate)
        return self.utility(rate) - payment, rate

    def power_law(self) -> float | None:
        """1, the logarithm, where nobody has had anything."""
        return None if np.any(self.past_average_bps) else 1.0

    def figure(self, utility: float, weight: float) -> float:
        """The weighted geometric mean, exp(U / Σ ω)."""
        with np.errstate(over="ignore"):
            return float(np.exp(utility / weight))

    def _past(self, shape: tuple[int, ...]) -> FloatArray:
        """s for arrays of this shape, whose last axis is the users."""
        past = np.asarray(self.past_average_bps)
        if past.ndim and past.size not in (1, shape[-1]):
            raise InputError(
                f"past_average_bps has {past.size} values for {shape[-1]} users: give one value or one per user"
            )
        return past
