"""The dual core on one problem: what the kernels found, with the bound that its prices prove."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wirelessagent.deciding.core.dual_bounds import bound_of
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import LEAST_POWER, Program
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Prices
from wirelessagent.model.rates import user_rate_bps

if TYPE_CHECKING:
    from wirelessagent.deciding.core.ask_kernel import Ask

SMALL = 12
"""Up to so many users every one is a candidate for every group, beyond it the best few."""
CANDIDATES = 6
REFITS = 6
WORST = -1e90
"""Scores below this belong to allocations that do not keep every limit."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Effort:
    """How hard to search.

    Attributes:
        restarts: of the local search.
        seed: of the restarts.
    """

    restarts: int
    seed: int


@dataclass(frozen=True, kw_only=True, eq=False)
class Search:
    """What was found.

    Attributes:
        program: what was asked.
        owner, power_w: the allocation, shape (subcarrier,).
        score: of the allocation by the program's rows; more is better.
        kept: whether it keeps every limit.
        bound: in the objective's unit.
        prices: of the dual; ln μ is in the program's utility per W.
        iterations: Newton steps.
        restarts: of the local search.
        open: why it is not known that nothing is better, for people; empty where it is, or nobody has looked.
    """

    program: Program
    owner: IntArray
    power_w: FloatArray
    score: float
    kept: bool
    bound: float
    prices: Prices
    iterations: int
    restarts: int = 0
    open: str = ""

    @property
    def spent_w(self) -> float:
        return float(self.power_w.sum())


def search(
    form: NormalForm,
    program: Program,
    effort: Effort,
    after: Prices | None = None,
    owner: IntArray | None = None,
) -> Search:
    """Prices, sets and powers for one program, from the prices and the sets of an earlier search, if any."""
    from wirelessagent.deciding.core.dual_kernel import solve

    users, subcarriers = form.snr_per_w.shape
    warm = after is not None and after.log_rate.shape == (users,) and bool(np.isfinite(after.log_rate).all())
    log_price = after.log_rate.copy() if after is not None and warm else np.zeros(users)
    log_mu = float(after.log_power) if after is not None and warm else 0.0
    given = owner is not None
    sets, power_w = np.empty(subcarriers, dtype=np.int64), np.empty(subcarriers)
    sets[:] = -1 if owner is None else owner
    found = solve(
        form.snr_per_w, ask_of(form, program), users if users <= SMALL else CANDIDATES, effort.restarts, effort.seed,
        warm, log_price, log_mu, given, sets, power_w,
    )  # fmt: skip
    return Search(
        program=program,
        owner=owners_with_power(form, sets, power_w),
        power_w=power_w,
        score=float(found.score),
        kept=found.score > WORST and math.isfinite(power_w.sum()),
        bound=bound_of(form, program, log_price, found.log_mu),
        prices=Prices(log_rate=log_price, log_power=found.log_mu),
        iterations=int(found.iterations),
        restarts=effort.restarts,
    )


def search_objective(
    form: NormalForm, program: Program, effort: Effort, after: Prices | None = None, owner: IntArray | None = None
) -> Search:
    """:func:`search` for the problem's objective, asked again for its utility around the rates found until it fits."""
    best = search(form, program, effort, after, owner)
    for _ in range(REFITS):
        nats = rates_of(form, best)
        if not best.kept or best.program.meets(form, nats) or form.limit.is_over():
            break
        again = search(form, Program.of(form, nats), effort, best.prices, best.owner)
        if not again.kept or form.limit.is_over():
            break
        best = dataclasses.replace(again, bound=tighter(form, program, best.bound, again.bound))
    return best


def search_promises(form: NormalForm, effort: Effort, after: Prices | None = None) -> Search:
    """:func:`search` for the least power that carries the promised rates, whatever the objective is."""
    return search(form, Program.of_promises(form), effort, after)


def ask_of(form: NormalForm, program: Program) -> Ask:
    """The program as the kernels read it."""
    from wirelessagent.deciding.core.ask_kernel import Ask

    return Ask(
        program.goal, form.cap_w, float(form.max_nats), form.start, program.rows, program.share,
        float(program.most_level), float(form.budget_w), float(form.circuit_w), form.limit.work,
    )  # fmt: skip


def rates_of(form: NormalForm, found: Search) -> FloatArray:
    """The users' rates in nats, shape (user,)."""
    return user_rate_bps(form.estimate.gain, found.owner, found.power_w, form.cell) / form.bps_per_nat


def owners_with_power(form: NormalForm, owner: IntArray, power_w: FloatArray) -> IntArray:
    """The owners (…, subcarrier) of groups that carry power, −1 elsewhere: a group is owned as a whole."""
    if form.start.size > power_w.shape[-1]:  # each group is a subcarrier
        return np.where(power_w > 0, owner, -1)
    used = np.add.reduceat(power_w, form.start[:-1], axis=-1) > 0
    return np.where(np.repeat(used, np.diff(form.start), axis=-1), owner, -1)


def tighter(form: NormalForm, program: Program, one: float, other: float) -> float:
    """The better of two bounds on what ``program`` asks for, which may be the least power under any objective."""
    is_lower = program.goal == LEAST_POWER or form.objective.direction == "min"
    return max(one, other) if is_lower else min(one, other)
