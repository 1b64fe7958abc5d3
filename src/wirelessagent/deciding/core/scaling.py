"""The largest common factor on the promised rates that the budget carries: from two sides, at once or by a search."""

from __future__ import annotations

import dataclasses

import numpy as np

from wirelessagent.deciding.core.dual_bounds import groups_worth_w
from wirelessagent.deciding.core.dual_search import Effort, Search, rates_of, search
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import Program
from wirelessagent.deciding.objectives.max_min_rate import MaxMinRate
from wirelessagent.model.decision import Bracket


def scaling_at_hand(form: NormalForm, least: Search) -> Bracket:
    """What the sets of the least power carry, and what its prices prove: s λ·R ≤ P_max + Φ(λ).

    Both are tight where the factor is near 1, and loose where the budget is far more than what is needed.
    """
    from wirelessagent.deciding.core.scaling_kernel import carried_scaling

    with np.errstate(over="ignore"):
        price = np.exp(least.prices.log_rate)
    paid = float(price @ form.promised_nats)
    most = max((form.budget_w + groups_worth_w(form, price)) / paid, 1.0) if paid > 0 else np.inf
    carried = carried_scaling(
        form.snr_per_w, form.cap_w, form.max_nats, form.promised_nats, least.owner, form.budget_w, least.spent_w, most
    )  # fmt: skip
    return Bracket(at_least=carried, at_most=most)


def searched_scaling(form: NormalForm, least: Search, effort: Effort) -> Bracket:
    """The same by a search of its own: the highest level of the rates, each in units of what is promised."""
    if form.limit.is_over():
        return Bracket(at_least=0.0, at_most=np.inf)
    users = form.promised_nats.size
    levelled = dataclasses.replace(
        form,
        objective=MaxMinRate(),
        weight=form.promised_nats,
        promised_nats=np.zeros(users),
        most_nats=np.full(users, np.inf),
    )
    found = search(levelled, Program.of(levelled), effort, owner=least.owner if least.kept else None)
    if not found.kept:
        return Bracket(at_least=0.0, at_most=np.inf)
    promised = form.promised_nats > 0
    carried = float(np.min(rates_of(form, found)[promised] / form.promised_nats[promised]))
    most = max(found.bound / form.bps_per_nat, carried)
    return Bracket(at_least=carried, at_most=most)
