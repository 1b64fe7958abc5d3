"""Decisions whose rates are promised with an accepted outage probability, by any method for known channels.

With ``outage_probability`` ε a decision promises each user a rate that its true one stays below with the probability ε
at most, given all that was observed. The method decides on the channel to count on (:mod:`.core.outage_channel`); joint
draws say what may be promised on the allocation (:mod:`.core.outage_rates`) and how careful it has to be with each
user; it decides again, until little changes, and the best of these decisions is kept. For the least power the powers
are then the least that the promises take on the sets found (:mod:`.core.outage_power`), unless the method has a rule of
its own for them.

The bound is the optimum's on the hoped-for channel of :mod:`.core.outage_channel`, by the dual: whatever is promised at
this outage probability, under this posterior, no allocation does better. It holds for the problem with its uncertainty,
not for the channel to count on, so the gap also holds what the uncertainty may cost. Draws have their error: what may
be promised is exceeded by a fresh draw as often as asked for on average over the draws, not for each of them.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from wirelessagent.deciding.core.certificate import relative_gap
from wirelessagent.deciding.core.dual_search import owners_with_power
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.outage_channel import UncertainChannel
from wirelessagent.deciding.core.outage_power import fill, least_power
from wirelessagent.deciding.core.outage_rates import Rates, judge_afresh
from wirelessagent.deciding.method import Method
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import OPTIMAL_GAP, Bracket, Decision, Status
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.metrics import kept
from wirelessagent.model.problem import Problem
from wirelessagent.model.units import human, reliability

_ROUNDS, _MOST_ROUNDS = 3, 8
"""From each start, and where nothing kept its promises before."""
_SETTLED = 0.02
"""Places of q that move by less are settled."""
_BOLD = 0.3
"""The q of the second start, for users that rest on several uncertain entries: the first alone would avoid them."""
_AMPLE = 10.0
"""Budget of the search for the least power, in budgets: the powers are worked out anew, and judged then."""
_BACK_OFF = 0.05
"""Places by which a user who was promised too much gets more careful, the more the more often."""
_BUDGET_ROUNDING = 1e-9
_FILLED = 1e-6


def decide_with_outage(
    method: Method, estimate: ChannelEstimate, problem: Problem, cell: Cell, after: Decision | None = None
) -> Decision:
    """The decision of ``method`` for a problem with an outage probability; see the module's docstring.

    Where every gain is certain it is the decision for the problem without one.
    """
    assert problem.outage_probability is not None
    plain = dataclasses.replace(problem, outage_probability=None)
    if (estimate.gain_variance > 0).any():
        with method.limited():
            return _Search.of(method, estimate, problem, plain, cell).decision(after)
    decision = _solve(method, estimate, plain, cell, after)
    return dataclasses.replace(
        decision, problem=problem, expected_rate_bps=decision.rate_bps, outage=np.zeros(decision.rate_bps.size)
    )


def _solve(method: Method, estimate: ChannelEstimate, problem: Problem, cell: Cell, after: Decision | None) -> Decision:
    if after is None or not method.warm_starts:
        return method.solve(estimate, problem, cell)
    return cast(Decision, cast(Any, method).solve(estimate, problem, cell, after=after))


def _drafting(method: Method) -> Method:
    """The method as it decides in the rounds: without options that make it spend time, which the last one has.

    A method that does not restart spends none for its own sake.
    """
    known = {one.name for one in dataclasses.fields(method)}
    if "restarts" not in known:
        return method
    spending = {"effort": "fast", "deadline_s": None, "deadline_ms": None, "steps": None, "restarts": None}
    return dataclasses.replace(method, **{name: value for name, value in spending.items() if name in known})


@dataclass(frozen=True, kw_only=True, eq=False)
class _Found:
    """An allocation and what may be promised on it.

    Attributes:
        decision: the method's, on the channel that was counted on.
        owner, power_w: the allocation, shape (subcarrier,); a power is infinite where a promise cannot be kept.
        promised_bps: shape (user,).
        place: of each user's q, by what may be promised, shape (user,).
        short: users who may be promised less than they must get, shape (user,).
        value: the objective's at the promised rates; NaN where limits are not kept.
    """

    decision: Decision
    owner: IntArray
    power_w: FloatArray
    promised_bps: FloatArray
    place: FloatArray
    short: BoolArray
    value: float


@dataclass(frozen=True, kw_only=True, eq=False)
class _Search:
    """A problem on an uncertain channel; ``plain`` is the problem without its outage probability."""

    method: Method
    problem: Problem
    plain: Problem
    cell: Cell
    form: NormalForm
    channel: UncertainChannel
    rates: Rates

    @classmethod
    def of(cls, method: Method, estimate: ChannelEstimate, problem: Problem, plain: Problem, cell: Cell) -> _Search:
        assert problem.outage_probability is not None
        form = NormalForm.of(method, estimate, plain, cell)
        channel = UncertainChannel.of(estimate, problem.outage_probability)
        rates = Rates(form=form, channel=channel)
        return cls(method=method, problem=problem, plain=plain, cell=cell, form=form, channel=channel, rates=rates)

    def decision(self, after: Decision | None) -> Decision:
        from wirelessagent.deciding.methods.dual import Dual

        hoped = Dual(restarts=0).solve(self.channel.hoped_for(), self.plain, self.cell)
        if hoped.status == "infeasible":
            even = "even where every uncertain gain turns out as high as it may"
            return self._nothing(hoped, "infeasible", f"{hoped.reason}, {even}")
        tried: list[_Found] = []
        for q in (self.channel.outage, max(self.channel.outage, _BOLD)):
            if tried and self.form.limit.is_over():
                break
            start = np.full(self.channel.uncertain.shape[0], self.channel.place_of(q))
            tried += self._rounds(start, after, any(not np.isnan(found.value) for found in tried))
        best = self._best(tried)
        if best is None:
            return self._nothing(hoped, "undecided", self._reason(tried))
        if _drafting(self.method) == self.method:
            return self._made(best, hoped, best.decision.restarts)
        last = self._decided(self.method, best.place, best.decision)
        chosen = self._best([best, self._judged(last, best.place)]) if last.is_usable else best
        return self._made(chosen or best, hoped, last.restarts)

    def _rounds(self, place: FloatArray, after: Decision | None, is_kept: bool) -> list[_Found]:
        """Decisions from the places (user,) of first q: as many as it takes until promises are kept, and settle."""
        found: list[_Found] = []
        for done in range(1, _MOST_ROUNDS + 1):
            decision = self._decided(_drafting(self.method), place, after)
            if not decision.is_usable:
                break
            now = self._judged(decision, place)
            found.append(now)
            is_kept |= not np.isnan(now.value)
            settled = done >= _ROUNDS or np.abs(now.place - place).max() < _SETTLED
            if (is_kept and settled) or self.form.limit.is_over():
                break
            after, place = decision, np.maximum(now.place - _BACK_OFF * (done - 1) * now.short, 0.0)
        return found

    def _decided(self, method: Method, place: FloatArray, after: Decision | None) -> Decision:
        """The method's decision on the channel to count on."""
        problem, cell = self.plain, self.cell
        if self.form.objective.measure == "power":
            cell = dataclasses.replace(cell, max_power_w=_AMPLE * self.form.budget_w)
            problem = dataclasses.replace(problem, max_power_w=None)
        return _solve(method, self.channel.at(place), problem, cell, after)

    def _judged(self, decision: Decision, place: FloatArray) -> _Found:
        """What may be promised on an allocation; for the least power, on the powers that this takes."""
        form, place = self.form, place.copy()
        promised, power_w = np.zeros(place.size), decision.power_w.copy()
        refill = form.objective.measure == "power" and self._is_filled(decision, place)
        for held in self.rates.owned(decision.owner):
            own, user = held.subcarriers, held.user
            if refill:
                power_w[own], place[user] = least_power(form, held, float(form.promised_nats[user]), place[user])
                if not np.isfinite(power_w[own]).all():
                    continue
            promised[user] = held.promised_nats(power_w[own])
            if held.uncertain.size and not refill:
                place[user] = held.place(power_w[own], promised[user])
        bps, spent = np.minimum(promised, form.most_nats) * form.bps_per_nat, float(power_w.sum())
        short = ~kept(bps, form.promised_nats * form.bps_per_nat)
        good = spent <= form.budget_w * (1.0 + _BUDGET_ROUNDING) and not short.any()
        return _Found(
            decision=decision,
            owner=owners_with_power(form, decision.owner, power_w),
            power_w=power_w,
            promised_bps=bps,
            place=place,
            short=short,
            value=form.objective.value(bps, spent, self.cell, form.weight) if good else np.nan,
        )

    def _is_filled(self, decision: Decision, place: FloatArray) -> bool:
        """Whether the method gives its sets the least power: a rule of its own is kept."""
        filled = 0.0
        for held in self.rates.owned(decision.owner):
            nats = float(self.form.promised_nats[held.user])
            filled += float(fill(self.form, held, held.counted_on(place[held.user]), nats).sum())
        return decision.total_power_w <= filled * (1.0 + _FILLED)

    def _best(self, tried: list[_Found]) -> _Found | None:
        """The first of the best that keep every limit."""
        sign = 1.0 if self.form.objective.direction == "max" else -1.0
        usable = [found for found in tried if not np.isnan(found.value)]
        return max(usable, key=lambda found: sign * found.value, default=None)

    def _made(self, found: _Found, hoped: Decision, restarts: int) -> Decision:
        gap = relative_gap(found.value, hoped.bound)
        expected, outage = judge_afresh(self.rates, found.owner, found.power_w, found.promised_bps)
        spent = float(found.power_w.sum())
        return dataclasses.replace(
            found.decision,
            owner=found.owner,
            power_w=found.power_w,
            rate_bps=found.promised_bps,
            status="optimal" if gap <= OPTIMAL_GAP else "feasible",
            value=found.value,
            bound=hoped.bound,
            gap=gap,
            needed_power_w=_needed(hoped, spent if self.form.objective.measure == "power" else np.nan),
            rate_scaling=_scaled(hoped, 1.0),
            restarts=restarts,
            steps=self.form.limit.steps,
            problem=self.problem,
            cell=self.cell,
            expected_rate_bps=expected,
            outage=outage,
        )

    def _nothing(self, hoped: Decision, status: Status, reason: str) -> Decision:
        """The decision where no promises were found that are kept, from that on the hoped-for channel."""
        nobody = np.full(hoped.owner.size, -1, dtype=np.int64)
        return dataclasses.replace(
            hoped,
            owner=nobody,
            power_w=np.zeros(nobody.size),
            rate_bps=np.zeros(hoped.rate_bps.size),
            status=status,
            value=np.nan,
            gap=np.nan,
            reason=reason,
            price_of_power=np.nan,
            price_of_rate=np.empty(0),
            prices=None,
            needed_power_w=_needed(hoped, np.nan),
            rate_scaling=_scaled(hoped, 0.0),
            steps=self.form.limit.steps,
            method=self.method.name,
            problem=self.problem,
        )

    def _reason(self, tried: list[_Found]) -> str:
        """Why nothing was found, with the power of the least that kept its promises beyond the budget."""
        budget, sure = human(self.form.budget_w, "W"), reliability(self.channel.outage)
        needed = [float(found.power_w.sum()) for found in tried if not found.short.any()]
        told = f"what was found needs {human(min(needed), 'W')}" if needed else "no allocation was found that does"
        return (
            f"the promised rates were not reached with a probability of {sure} within {budget}: {told}, "
            "and whether they can be is not known"
        )


def _needed(hoped: Decision, found_w: float) -> Bracket | None:
    """The power of the promises: at least that on the hoped-for channel."""
    known = hoped.needed_power_w
    return None if known is None else Bracket(at_least=known.at_least, at_most=found_w)


def _scaled(hoped: Decision, found: float) -> Bracket | None:
    """The common factor on the promises: at most that on the hoped-for channel."""
    known = hoped.rate_scaling
    return None if known is None else Bracket(at_least=min(found, known.at_most), at_most=known.at_most)
