"""A problem in the terms that the methods share: SNR per watt, rates in nats, powers in W.

With a = g/(Γ N0 B) a subcarrier carries min(ln(1 + p a), c ln 2) nats at the power p, and B (1 − o)/ln 2 bit/s per nat.
Pairs that cannot be used (users not served, forbidden pairs, subcarriers without power, no gain) have a = 0, so that
no algorithm needs to know of them.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.time_limit import TimeLimit
from wirelessagent.deciding.method import Method
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import normalised_gain

_MOST_SNR = 1e60
"""In 1/W; a gain of 1 over the thermal noise in 1 Hz has less than 1e21."""
_LEAST_SNR = 1e-200
"""In 1/W; a pair with less counts as unusable: no budget reaches it, and its figures leave the range of numbers."""

_LARGEST_EXPONENT = 700.0


@dataclass(frozen=True, kw_only=True, eq=False)
class NormalForm:
    """What a method solves, and what its decision must carry.

    Attributes:
        method: registered name of the method.
        objective: the objective, resolved.
        problem: the problem.
        cell: the cell.
        estimate: the estimated channel.
        snr_per_w: a, shape (user, subcarrier), in 1/W; 0 where a pair may not be used.
        budget_w: power budget.
        cap_w: power cap of each subcarrier, shape (subcarrier,); infinite where there is none.
        max_nats: the largest rate of a subcarrier in nats; infinite where there is none.
        promised_nats, promised_bps: the rate each served user must get, shape (user,).
        most_nats: the rate beyond which a user has nothing to send, shape (user,); infinite where there is none.
        weight: each user's weight, shape (user,); 0 for users who are not served.
        start: first subcarrier of each resource-block group, and the number of subcarriers, shape (group + 1,).
        bps_per_nat: bit/s that one nat on a subcarrier is worth.
        limit: when the search has to end.
    """

    method: str
    objective: Objective
    problem: Problem
    cell: Cell
    estimate: ChannelEstimate
    snr_per_w: FloatArray
    budget_w: float
    cap_w: FloatArray
    max_nats: float
    promised_nats: FloatArray
    promised_bps: FloatArray
    most_nats: FloatArray
    weight: FloatArray
    start: IntArray
    bps_per_nat: float
    limit: TimeLimit

    @classmethod
    def of(cls, method: Method, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> NormalForm:
        """The normal form of a problem that ``method`` solves.

        Raises:
            UnsupportedProblemError: it does not.
            InputError: a constraint does not fit the estimate's shape, or the gains leave the range of numbers.
        """
        objective, problem = method.objective_of(problem), problem.for_users(estimate.user_names)
        users, subcarriers = estimate.num_users, estimate.num_subcarriers
        cap_w = _caps_w(problem, subcarriers)
        bps_per_nat = cell.data_bandwidth_hz / math.log(2.0)
        promised, most = problem.min_rates_bps(users), problem.max_rates_bps(users)
        if problem.users is not None:
            served = problem.serves(users)
            promised, most = np.where(served, promised, 0.0), np.where(served, most, 0.0)
        group = problem.resource_block_group_size
        return cls(
            method=method.name,
            objective=objective,
            problem=problem,
            cell=cell,
            estimate=estimate,
            snr_per_w=_snr_per_w(estimate.gain, problem, cell, cap_w),
            budget_w=problem.budget_w(cell),
            cap_w=cap_w,
            max_nats=cell.max_spectral_efficiency * math.log(2.0),
            promised_nats=promised / bps_per_nat,
            promised_bps=promised,
            most_nats=most / bps_per_nat,
            weight=problem.weights_of(users),
            start=_starts(subcarriers, group),
            bps_per_nat=bps_per_nat,
            limit=TimeLimit.in_force(),
        )

    def on(self, gain: FloatArray) -> NormalForm:
        """The same problem on many channels, ``gain`` (…, user, subcarrier); ``snr_per_w`` then has that shape."""
        snr_per_w = _snr_per_w(gain, self.problem, self.cell, self.cap_w)
        return dataclasses.replace(self, snr_per_w=snr_per_w)

    @property
    def max_snr(self) -> float:
        """The SNR at which a subcarrier reaches its largest rate, infinite where there is none."""
        return math.expm1(self.max_nats) if self.max_nats < _LARGEST_EXPONENT else math.inf

    @property
    def circuit_w(self) -> float:
        """Circuit power as the amplifier sees it, ξ P_c: then efficiency is ξ R/(P + ξ P_c)."""
        return self.cell.amplifier_efficiency * self.cell.circuit_power_w

    @property
    def best_snr_per_w(self) -> FloatArray:
        """a of the best user on each subcarrier, shape (…, subcarrier)."""
        return self.snr_per_w.max(axis=-2)

    def caps_w(self, snr_per_w: FloatArray) -> FloatArray:
        """The most useful power for ``snr_per_w`` (…, subcarrier): the cap, or less where the rate is full before."""
        with np.errstate(divide="ignore", over="ignore"):
            return np.where(snr_per_w > 0, np.minimum(self.cap_w, self.max_snr / snr_per_w), 0.0)


def _snr_per_w(gain: FloatArray, problem: Problem, cell: Cell, cap_w: FloatArray) -> FloatArray:
    """a for ``gain`` (…, user, subcarrier), 0 where a pair may not be used."""
    if gain.size and gain.max() / _MOST_SNR > cell.snr_gap * cell.noise_power_w:
        raise InputError(
            f"gains up to {gain.max():g} over a noise of {cell.noise_power_w:g} W are out of range: "
            "a power gain is about 1 at most; check its unit"
        )
    snr_per_w = normalised_gain(gain, cell)
    unlimited = problem.subcarrier_max_power_w is None and problem.users is None and problem.forbidden is None
    if unlimited and snr_per_w.size and snr_per_w.min() > _LEAST_SNR:
        return snr_per_w
    users, subcarriers = gain.shape[-2:]
    usable = snr_per_w > _LEAST_SNR
    if problem.subcarrier_max_power_w is not None:
        usable &= cap_w > 0
    if problem.users is not None:
        usable &= problem.serves(users)[:, np.newaxis]
    if problem.forbidden is not None:
        usable &= problem.allows((users, subcarriers))
    return snr_per_w if usable.all() else np.where(usable, snr_per_w, 0.0)


def _starts(num_subcarriers: int, group: int) -> IntArray:
    if group == 1:
        return np.arange(num_subcarriers + 1)
    return np.minimum(np.arange(0, num_subcarriers + group, group), num_subcarriers)


def _caps_w(problem: Problem, num_subcarriers: int) -> FloatArray:
    if problem.subcarrier_max_power_w is None:
        return np.full(num_subcarriers, np.inf)
    cap = np.asarray(problem.subcarrier_max_power_w, dtype=np.float64)
    if cap.ndim > 1 or cap.size not in (1, num_subcarriers):
        raise InputError(
            f"subcarrier_max_power_w must be one value or one per subcarrier ({num_subcarriers}); got shape {cap.shape}"
        )
    return np.broadcast_to(cap, (num_subcarriers,)).copy()
