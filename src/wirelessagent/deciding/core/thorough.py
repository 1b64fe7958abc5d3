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
from wirelessagent.deciding.core.exact_search import Optimum, search
from wirelessagent.deciding.core.exact_start import carried_at_any_power, goal_of, is_met_everywhere, least_power, shown
from wirelessagent.deciding.core.goals import Goal, Most
from wirelessagent.deciding.core.market import Market, Sets
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import HIGHEST_LEVEL, LEAST_POWER, MOST_EFFICIENCY, Program, promises
from wirelessagent.model.arrays import IntArray
from wirelessagent.model.decision import Prices

_FARTHEST = 80.0
"""Of ln μ at the start; a price beyond is that of power to spare."""
MOST_SETS = 2000
"""Sets listed for one user before a problem is divided."""


@functools.cache
def make_ready() -> None:
    """Have all that the search needs compiled, once in a process, so that its time is spent on searching."""
    rows, owner = promises(np.ones(2)), np.array([0, 1])
    market = Market.of(rows, np.ones((2, 2)), np.ones((2, 2)), np.arange(3), cost_per_w=1.0, budget_w=np.inf)
    known = Sets.of_owner(owner, 2)
    priced = column_prices(market, start_prices(market, np.zeros(2), 0.0), 0.0, known, rounds=2)
    goal = Most(market=market)
    search(goal, known, priced.price, 0.0, deadline=np.inf, most_sets=2).allocation(goal)


def tightened(form: NormalForm, found: Search, deadline: float, most_sets: int = MOST_SETS) -> Search:
    """``found``, or better sets, with the better bound; ``deadline`` in seconds on ``time.perf_counter``."""
    program = found.program
    if not found.kept or (program.goal == MOST_EFFICIENCY and form.circuit_w <= 0.0):
        return found
    goal = goal_of(form, program)
    optimum = search_from(form, program, goal, found.owner, found.prices, deadline=deadline, most_sets=most_sets)
    if is_met_everywhere(form, program):
        found = dataclasses.replace(found, bound=tighter(form, found.bound, shown(form, program, optimum.bound)))
    if optimum.x <= found.score:
        return found
    own, power_w = optimum.allocation(goal)
    return dataclasses.replace(
        found, owner=owners_with_power(form, own, power_w), power_w=power_w, score=float(optimum.x)
    )  # fmt: skip


def carried(form: NormalForm, least: Search, deadline: float, most_sets: int = MOST_SETS) -> Search:
    """The search for the least power of the promised rates, gone on with where it found nothing within the budget.

    Where it found no sets at all, integer programming does; the bound is infinite if there are none.
    """
    goal = least_power(form)
    if not least.kept:
        possible, sets = carried_at_any_power(goal.market, form.promised_nats, deadline)
        if sets is None:
            return least if possible else dataclasses.replace(least, bound=np.inf)
        columns = sets.owner(goal.market.columns)
        least = dataclasses.replace(least, kept=True, owner=np.repeat(columns, np.diff(form.start)), score=-np.inf)
    return tightened(form, least, deadline, most_sets)


def search_from(
    form: NormalForm,
    program: Program,
    goal: Goal,
    owner: IntArray,
    prices: Prices,
    *,
    deadline: float,
    most_sets: int,
) -> Optimum:
    """The exact search from the owners (subcarrier,) and the prices of rates that the dual has found."""
    fixed = program.goal in (LEAST_POWER, HIGHEST_LEVEL)
    log_mu = 0.0 if fixed else min(max(float(prices.log_power), -_FARTHEST), _FARTHEST)
    price = start_prices(goal.market, prices.log_rate, log_mu)
    return search(goal, sets_of(form, owner), price, log_mu, deadline=deadline, most_sets=most_sets)


def sets_of(form: NormalForm, owner: IntArray) -> Sets:
    """The users' sets of groups; a subcarrier without power may have no owner though its group has one."""
    return Sets.of_owner(np.maximum.reduceat(owner, form.start[:-1]), form.weight.size)
