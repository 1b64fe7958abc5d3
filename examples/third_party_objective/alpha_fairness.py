"""α-fairness: one number between the most rate for the cell and the most rate for its worst-off user.

J. Mo and J. Walrand, "Fair end-to-end window-based congestion control", IEEE/ACM Transactions on Networking 8(5),
2000, eq. (4):

    Σ u(r),   u(r) = r^(1−α)/(1−α),   and ln r for α = 1.

α → 0 is the largest sum rate, 1 proportional fairness, 2 the smallest total time for files of one size, and α → ∞ the
largest minimum rate.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import wirelessagent as wa


@dataclass(frozen=True, kw_only=True)
class AlphaFairness(wa.Objective):
    """Rates shared α-fairly; Mo and Walrand (2000).

    Attributes:
        alpha: how fair, more than 0; 1 is proportional fairness.
    """

    name = "alpha_fairness"
    unit = "bit/s"
    phrases = wa.phrases(en=["share alpha-fairly"], zh=["α公平"])
    figure_name = wa.phrases(en=["α-fair mean rate"], zh=["α公平平均速率"])

    alpha: float = 2.0

    def __post_init__(self) -> None:
        if not 0 < self.alpha < np.inf:
            raise wa.InputError(f"alpha must be more than zero and finite; got {self.alpha!r}: for 0 use max_rate")

    def utility(self, rate):
        """Each user's; −∞ for a rate of zero where α is 1 or more."""
        with np.errstate(divide="ignore"):
            if self.alpha == 1:
                return np.log(rate)
            return np.power(rate, 1 - self.alpha) / (1 - self.alpha)

    def conjugate(self, price, min_rate, max_rate):
        """u′(r) = r^(−α) is the price, at r = price^(−1/α) or at the limit that is nearer."""
        with np.errstate(divide="ignore", over="ignore"):
            rate = np.clip(np.power(price, -1.0 / self.alpha), min_rate, max_rate)
        payment = np.multiply(price, rate, where=price > 0, out=np.zeros_like(rate))  # what is free costs nothing
        return self.utility(rate) - payment, rate

    def power_law(self):
        """Its own α: with this declared, the method exact proves optima; without, bounds rest on the conjugate."""
        return float(self.alpha)

    def figure(self, utility, weight):
        """The rate that is worth as much if all get it, in bit/s: the weighted power mean of exponent 1 − α."""
        worth = np.float64(utility / weight)
        if self.alpha == 1:
            return float(np.exp(worth))
        with np.errstate(divide="ignore"):
            return float(np.power(np.maximum((1 - self.alpha) * worth, 0), 1 / (1 - self.alpha)))
