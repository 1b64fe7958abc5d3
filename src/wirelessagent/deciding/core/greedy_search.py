"""Greedy sets on one problem, with the bound that the dual's prices prove."""

from __future__ import annotations

import dataclasses

import numpy as np

from wirelessagent.deciding.core.dual_bounds import bound_of
from wirelessagent.deciding.core.dual_search import WORST, Search, ask_of, owners_with_power, rates_of, tighter
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import HIGHEST_LEVEL, Program
from wirelessagent.deciding.core.rate_proof import one_each, usable_groups
from wirelessagent.model.arrays import BoolArray, IntArray
from wirelessagent.model.decision import Prices

_REFITS = 3
_FARTHEST = 300.0
"""Without a channel prices run away. Any prices prove a bound, those within e^±300 without an overflow."""


def search_greedily(form: NormalForm, program: Program, owner: IntArray | None = None) -> Search:
    """Sets and powers for one program; ``owner`` (subcarrier,) has their groups already.

    Turns may leave a user without what it must have where another could have had a different group. Then it is tried
    again with one group for each such user, by a matching.
    """
    nobody = np.full(form.cap_w.size, -1, dtype=np.int64)
    found, missing = _search(form, program, nobody if owner is None else owner)
    if missing and owner is None and not form.limit.is_over():
        again, _ = _search(form, program, _seeds(form, _must_have(form, program)))
        if again.score > found.score:
            return again
    return found


def search_objective_greedily(form: NormalForm, program: Program, owner: IntArray | None = None) -> Search:
    """:func:`search_greedily`, asked again for the objective's utility around the rates found until it fits."""
    best = search_greedily(form, program, owner)
    for _ in range(_REFITS):
        nats = rates_of(form, best)
        if not best.kept or best.program.meets(form, nats) or form.limit.is_over():
            break
        again = search_greedily(form, Program.of(form, nats), owner)
        if not again.kept or form.limit.is_over():
            break
        best = dataclasses.replace(again, bound=tighter(form, program, best.bound, again.bound))
    return best


def _search(form: NormalForm, program: Program, owner: IntArray) -> tuple[Search, int]:
    """What greedy gains find from ``owner`` (subcarrier,), and how many users still lack what they must have."""
    from wirelessagent.deciding.core.greedy_kernel import solve_greedily

    users, subcarriers = form.snr_per_w.shape
    owner, power_w, log_price = owner.copy(), np.empty(subcarriers), np.zeros(users)
    found = solve_greedily(form.snr_per_w, ask_of(form, program), log_price, owner, power_w)
    log_price = np.clip(np.where(np.isfinite(log_price), log_price, -_FARTHEST), -_FARTHEST, _FARTHEST)
    log_mu = float(np.clip(np.nan_to_num(found.log_mu), -_FARTHEST, _FARTHEST))
    search = Search(
        program=program,
        owner=owners_with_power(form, owner, power_w),
        power_w=power_w,
        score=float(found.score),
        kept=found.score > WORST and bool(np.isfinite(power_w).all()),
        bound=bound_of(form, program, log_price, log_mu),
        prices=Prices(log_rate=log_price, log_power=log_mu),
        iterations=int(found.iterations),
    )
    return search, int(found.missing)


def _must_have(form: NormalForm, program: Program) -> BoolArray:
    """Users to whom nothing at all is not enough, shape (user,)."""
    low, _, _, slope, curvature, _ = program.rows.T
    if program.goal == HIGHEST_LEVEL:
        return (form.promised_nats > 0) | (form.weight > 0)
    return (low > 0) | ((slope > 0) & (curvature >= 1.0))


def _seeds(form: NormalForm, users: BoolArray) -> IntArray:
    """Owners (subcarrier,) that give each of ``users`` (user,) one usable group, as far as there are any."""
    seed = one_each(usable_groups(form) & users[:, np.newaxis])
    owner = np.full(form.start.size - 1, -1, dtype=np.int64)
    served = np.flatnonzero(seed >= 0)
    owner[seed[served]] = served
    return np.repeat(owner, np.diff(form.start))
