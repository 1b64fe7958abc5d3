"""From what a search found to a decision: kept or not, with the dual's prices, and a word on whoever is left out."""

from __future__ import annotations

import dataclasses

import numpy as np

from wirelessagent.deciding.core.certificate import Figures, certified
from wirelessagent.deciding.core.closed_form import APPROACHED
from wirelessagent.deciding.core.dual_bounds import bound_of
from wirelessagent.deciding.core.dual_prices import figures_of
from wirelessagent.deciding.core.dual_search import Search
from wirelessagent.deciding.core.exact_powers import BUDGET_ROUNDING
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import MOST_EFFICIENCY, Program
from wirelessagent.deciding.core.promises import broken_decision
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Bracket, Decision
from wirelessagent.model.rates import user_rate_bps

PROOF_ROUNDING = 1e-9
_FIRST_NATS = 1e-12
"""So few that they cost as little as the first."""


def fits(form: NormalForm, found: Search) -> bool:
    """Whether what was found keeps every limit, the budget too."""
    return found.kept and found.spent_w <= form.budget_w * (1.0 + BUDGET_ROUNDING)


def is_proven_too_much(form: NormalForm, least: Search) -> bool:
    """Whether the promised rates are proven to need more than the budget."""
    return least.bound > form.budget_w * (1.0 + PROOF_ROUNDING)


def unpowered_decision(form: NormalForm) -> Decision:
    """The least power where nothing is promised: none, for nobody."""
    nobody = np.full(form.cap_w.size, -1, dtype=np.int64)
    return certified(form, nobody, np.zeros(form.cap_w.size), 0.0, price_of_power=0.0)


def is_approached(form: NormalForm, program: Program) -> bool:
    """Whether less power is always more efficient, so that the best efficiency is only approached."""
    straight = form.objective.power_law() == 0.0
    return program.goal == MOST_EFFICIENCY and form.circuit_w <= 0.0 and straight and not form.promised_nats.any()


def approached_decision(form: NormalForm, program: Program) -> Decision:
    """Next to no power, for the pair whose first nats are worth the most per joule."""
    owner, power_w = np.full(form.cap_w.size, -1, dtype=np.int64), np.zeros(form.cap_w.size)
    worth = form.weight[:, np.newaxis] * form.snr_per_w
    user, subcarrier = np.unravel_index(int(worth.argmax()), worth.shape)
    if worth[user, subcarrier] > 0.0:
        group = int(np.searchsorted(form.start, subcarrier, side="right")) - 1
        owner[form.start[group] : form.start[group + 1]] = user
        first_w = min(_FIRST_NATS, float(form.most_nats[user])) / float(form.snr_per_w[user, subcarrier])
        power_w[subcarrier] = min(first_w, form.budget_w, float(form.cap_w[subcarrier]))
    bound = bound_of(form, program, np.zeros(form.weight.size), 0.0)
    return certified(form, owner, power_w, bound, reason=APPROACHED, price_of_power=0.0)


def unkept_decision(form: NormalForm, least: Search, scaling: Bracket) -> Decision:
    """The decision where the search for the least power of the promised rates found none within the budget.

    What part of them it carries is what there is to ask for instead: ``scaling`` as searched for.
    """
    price = np.where(form.promised_nats > 0, np.exp(least.prices.log_rate), 0.0)
    found_w = least.spent_w if least.kept else np.inf
    decision = broken_decision(form, found_w, least.bound, price, scaling.at_least)
    return dataclasses.replace(decision, restarts=least.restarts)


def decision_of(
    form: NormalForm, found: Search, least: Search | None, unserved: IntArray, scaling: Bracket | None = None
) -> Decision:
    """The decision for what was found; ``least`` is the search for the least power of the promised rates, if any.

    ``unserved`` are the users without whom the others are served (:mod:`.unserved`); ``scaling`` is what a search for
    the largest factor on the promised rates has found.
    """
    figures = figures_of(form, found, least, scaling)
    if unserved.size == 0:
        decision = certified(form, found.owner, found.power_w, found.bound, **figures)
        return dataclasses.replace(decision, reason=found.open) if decision.status != "optimal" else decision
    return worthless_decision(form, found.owner, found.power_w, unserved, figures)


def unservable_decision(form: NormalForm, least: Search | None, unserved: IntArray) -> Decision:
    """Where nobody whose rate counts can be served: the promised rates are kept, and that is all."""
    if least is None:
        nobody = np.full(form.cap_w.size, -1, dtype=np.int64)
        return worthless_decision(form, nobody, np.zeros(nobody.size), unserved, Figures())
    return worthless_decision(form, least.owner, least.power_w, unserved, figures_of(form, least, least))


def worthless_decision(
    form: NormalForm, owner: IntArray, power_w: FloatArray, unserved: IntArray, figures: Figures
) -> Decision:
    """The optimum of an objective that is at its lowest because of users who cannot be served."""
    names = ", ".join(form.estimate.user_names[user] for user in map(int, unserved[:3]))
    more = f" and {unserved.size - 3} more" if unserved.size > 3 else ""
    figures["reason"] = (
        f"no subcarrier is left for {names}{more}, so {form.objective.name} is at its lowest whatever the others get: "
        "they are served without them"
    )
    figures["price_of_power"] = 0.0
    rate = user_rate_bps(form.estimate.gain, owner, power_w, form.cell)
    value = form.objective.value(rate, float(power_w.sum()), form.cell, form.weight)
    return certified(form, owner, power_w, value, **figures)
