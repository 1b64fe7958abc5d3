"""A problem as the exact search reads it, and whether its promised rates can be carried at all."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.goals import Goal, HighestLevel, Most, MostPerJoule
from wirelessagent.deciding.core.market import Market, Sets
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import HIGHEST_LEVEL, LEAST_POWER, MOST_UTILITY, Program, promises
from wirelessagent.deciding.core.rate_proof import ceilings
from wirelessagent.deciding.core.set_packing import LONGEST_S
from wirelessagent.model.arrays import FloatArray


def goal_of(form: NormalForm, program: Program) -> Goal:
    """What ``program`` wants to be largest."""
    if program.goal == LEAST_POWER:
        return least_power(form)
    if program.goal == HIGHEST_LEVEL:
        market = _market(form, program.rows, budgeted=False)
        return HighestLevel(
            market=market, share=program.share, most_level=program.most_level, power_w=form.budget_w
        )  # fmt: skip
    market = _market(form, program.rows, budgeted=True)
    return (
        Most(market=market) if program.goal == MOST_UTILITY else MostPerJoule(market=market, circuit_w=form.circuit_w)
    )


def least_power(form: NormalForm) -> Goal:
    """The least power that carries the promised rates."""
    return Most(market=_market(form, promises(form.promised_nats), budgeted=False))


def shown(form: NormalForm, program: Program, x: float) -> float:
    """The objective's value at the level x of the program's goal."""
    weight = float(form.weight.sum())
    if program.goal == LEAST_POWER:
        return -x
    if program.goal == HIGHEST_LEVEL:
        return form.objective.figure(float(form.objective.utility(np.array([x * form.bps_per_nat]))[0]), weight)
    if program.goal == MOST_UTILITY:
        return form.objective.figure(x * program.scale, weight)
    return x * program.scale * form.cell.amplifier_efficiency


def carried_at_any_power(market: Market, nats: FloatArray) -> tuple[bool, Sets | None]:
    """Whether ceilings may carry ``nats`` (user,), and sets that do: a covering problem, by integer programming."""
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import block_diag, hstack, identity, vstack

    users, columns = np.flatnonzero(nats > 0), market.columns
    most = np.add.reduceat(market.ceiling, market.start[:-1], axis=1)
    share = np.minimum(most[users] / nats[users, np.newaxis], 1.0)
    cover = block_diag([row[np.newaxis] for row in share], format="csc")
    packing = hstack([identity(columns)] * users.size, format="csc")
    result = milp(
        np.zeros(users.size * columns),
        constraints=LinearConstraint(
            vstack([cover, packing], format="csc"),
            np.concatenate([np.ones(users.size), np.full(columns, -np.inf)]),
            np.concatenate([np.full(users.size, np.inf), np.ones(columns)]),
        ),
        integrality=np.ones(users.size * columns, dtype=np.int64),
        bounds=Bounds(0.0, 1.0),
        options={"time_limit": max(min(market.limit.left_s, LONGEST_S), 0.01)},
    )
    if result.x is None:
        return result.status != 2, None
    taken = np.asarray(result.x).reshape(users.size, columns) > 0.5
    owner = np.where(taken.any(axis=0), users[taken.argmax(axis=0)], -1)
    sets = Sets.of_owner(owner, nats.size)
    return True, sets if market.value(sets)[0] > -np.inf else None


def _market(form: NormalForm, rows: FloatArray, *, budgeted: bool) -> Market:
    return Market.of(
        rows,
        form.snr_per_w,
        ceilings(form, form.snr_per_w),
        form.start,
        cost_per_w=0.0 if budgeted else 1.0,
        budget_w=form.budget_w if budgeted else np.inf,
        limit=form.limit,
    )
