"""What prices of subcarriers add to what prices of rates have found: a tighter bound, and often better sets.

Prices of rates let users share every single subcarrier, which few or heavily loaded ones do not allow. Prices of the
subcarriers (:mod:`.column_prices`) do not, and their search ends at the optimum if it is given the time.
"""

from __future__ import annotations

import dataclasses
import functools

import numpy as np

from wirelessagent.deciding.core.column_prices import column_prices, start_prices
from wirelessagent.deciding.core.dual_search import Search, owners_with_power, tighter
from wirelessagent.deciding.core.exact_powers import exact_powers
from wirelessagent.deciding.core.exact_search import Optimum, search
from wirelessagent.deciding.core.exact_start import carried_at_any_power, goal_of, least_power, shown
from wirelessagent.deciding.core.goals import Goal, Most
from wirelessagent.deciding.core.market import Market, Sets
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import HIGHEST_LEVEL, LEAST_POWER, MOST_EFFICIENCY, Program, promises
from wirelessagent.deciding.core.time_limit import TimeLimit
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import OPTIMAL_GAP
from wirelessagent.model.rates import user_rate_bps

_FARTHEST = 80.0
"""Of ln μ at the start; a price beyond is that of power to spare."""
_TINY = 1e-9
"""SNR at full power, or nats, below which the rounding of levels (1e-16) is more than the slack of a bound covers."""
_ROUNDING = 1e-12
"""Share of a bound by which it is widened, beside what levels, which are logarithms, are off by."""
MOST_SETS = 2000
"""Sets listed for one user before a problem is divided."""
OUT_OF_TIME = "the time allowed ended before this was proven to be the best"
_ROUNDED = "what is better, if anything, is less than rounding: rates or gains lie too far apart"
_NO_POWER_LAW = (
    "the objective declares no power law of the rate, so that the bound is that of prices of rates, and sets were "
    "searched for with the power law that is nearest at the rates found"
)
_APPROACHED = "without circuit power the best efficiency is only approached, and the bound is that of prices of rates"
"""Why it is not known that nothing is better."""


@functools.cache
def make_ready() -> None:
    """Have all that a search needs compiled, once in a process, so that its time is spent on searching."""
    from wirelessagent.deciding.core.ask_kernel import Ask
    from wirelessagent.deciding.core.dual_kernel import solve

    rows, owner = promises(np.ones(2)), np.array([0, 1])
    ask = Ask(
        LEAST_POWER, np.full(2, np.inf), np.inf, np.arange(3), rows, np.zeros((2, 3)), 0.0, 1.0, 0.0, TimeLimit().work
    )  # fmt: skip
    solve(np.ones((2, 2)), ask, 2, 0, 0, False, np.zeros(2), 0.0, False, owner.copy(), np.empty(2))
    market = Market.of(rows, np.ones((2, 2)), np.ones((2, 2)), np.arange(3), cost_per_w=1.0, budget_w=np.inf)
    known = Sets.of_owner(owner, 2)
    priced = column_prices(market, start_prices(market, np.zeros(2), 0.0), 0.0, known, rounds=2)
    goal = Most(market=market)
    search(goal, known, priced.price, 0.0, most_sets=2).allocation(goal)


def tightened(form: NormalForm, found: Search, most_sets: int = MOST_SETS, enough: float = np.inf) -> Search:
    """``found``, or better sets, with the better bound; nothing better than a score of ``enough`` is looked for."""
    program = found.program
    if not found.kept:
        return found
    if program.goal == MOST_EFFICIENCY and form.circuit_w <= 0.0:
        return dataclasses.replace(found, open=_APPROACHED)
    sign = -1.0 if program.goal == LEAST_POWER or form.objective.direction == "min" else 1.0
    known = _worth(form, program, found.owner, found.power_w)
    if sign * found.bound - known <= _ROUNDING * abs(known):  # nothing is better
        return found
    if form.limit.is_over():
        return dataclasses.replace(found, open=OUT_OF_TIME)
    if not _is_resolved(form):
        return dataclasses.replace(found, open=_ROUNDED)
    goal = goal_of(form, program)
    optimum = _search_from(form, goal, found, most_sets, enough)
    if optimum.x == -np.inf:
        return dataclasses.replace(found, open=OUT_OF_TIME if form.limit.is_over() else _ROUNDED)
    own, power_w = optimum.allocation(goal)
    power_w = exact_powers(form, goal.reaching(optimum.x).users, own, power_w)
    own, worth = owners_with_power(form, own, power_w), _worth(form, program, own, power_w)
    why = OUT_OF_TIME if form.limit.is_over() else _ROUNDED
    if program.exact:
        # Levels are off by as much as they are for the allocation whose powers are known to the last bit.
        reached = shown(form, program, optimum.x)
        slack = 0.0 if reached == sign * worth else abs(reached - sign * worth) + _ROUNDING * abs(reached)
        bound = shown(form, program, optimum.bound) + sign * slack
        if sign * bound >= known - OPTIMAL_GAP * abs(known):  # else levels are too small to be told apart
            found = dataclasses.replace(found, bound=tighter(form, program, found.bound, bound))
    else:
        why = _NO_POWER_LAW
    found = dataclasses.replace(found, open=why)
    if not worth > known:
        return found
    return dataclasses.replace(found, owner=own, power_w=power_w, score=float(optimum.x))


def _is_resolved(form: NormalForm) -> bool:
    """Whether levels, which are logarithms, tell the powers apart: not where all SNRs or promised rates are tiny."""
    limits = np.concatenate([form.promised_nats, form.most_nats])
    return form.budget_w * float(form.snr_per_w.max()) > _TINY and bool(np.all(limits[limits > 0] > _TINY))


def carried(form: NormalForm, least: Search, most_sets: int = MOST_SETS, *, enough: float) -> Search:
    """The search for the least power of the promised rates, gone on with where it found nothing within the budget.

    Where it found no sets at all, integer programming does; the bound is infinite if there are none. It ends with a
    power of at most −``enough``.
    """
    if form.limit.is_over():
        return least
    goal = least_power(form)
    if not least.kept:
        possible, sets = carried_at_any_power(goal.market, form.promised_nats)
        if sets is None:
            return least if possible else dataclasses.replace(least, bound=np.inf)
        columns = sets.owner(goal.market.columns)
        owner, power_w = np.repeat(columns, np.diff(form.start)), np.full(form.cap_w.size, np.inf)
        least = dataclasses.replace(least, kept=True, owner=owner, power_w=power_w, score=-np.inf)
    return tightened(form, least, most_sets, enough)


def sets_of(form: NormalForm, owner: IntArray) -> Sets:
    """The users' sets of groups; a subcarrier without power may have no owner though its group has one."""
    return Sets.of_owner(np.maximum.reduceat(owner, form.start[:-1]), form.weight.size)


def _search_from(form: NormalForm, goal: Goal, found: Search, most_sets: int, enough: float) -> Optimum:
    """The exact search from the owners and the prices of rates that the dual has found."""
    fixed = found.program.goal in (LEAST_POWER, HIGHEST_LEVEL)
    log_mu = 0.0 if fixed else min(max(float(found.prices.log_power), -_FARTHEST), _FARTHEST)
    price = start_prices(goal.market, found.prices.log_rate, log_mu)
    return search(goal, sets_of(form, found.owner), price, log_mu, most_sets=most_sets, enough=enough)


def _worth(form: NormalForm, program: Program, owner: IntArray, power_w: FloatArray) -> float:
    """What ``program`` makes of an allocation; more is better."""
    spent_w = float(power_w.sum())
    if program.goal == LEAST_POWER or not np.isfinite(spent_w):
        return -spent_w
    rate = user_rate_bps(form.estimate.gain, owner, power_w, form.cell)
    value = form.objective.value(rate, spent_w, form.cell, form.weight)
    return value if form.objective.direction == "max" else -value
