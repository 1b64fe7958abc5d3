"""Problems that have an exact solution: the most rate, alone or per joule, where all users' bits are worth the same.

Each subcarrier then goes to its best user, whatever the price of power, and one water level does the rest.
"""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.bounds import efficiency_bound_nats_per_j, rate_bound_nats
from wirelessagent.deciding.core.certificate import certified
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Decision

_ROUNDING = 1e-12
"""Share of the budget that a sum of powers may miss it by."""
APPROACHED = (
    "without circuit power less power is always more efficient: the best efficiency is only approached "
    "as the power goes to 0, here to 1e-12 of it"
)


def nats_worth(form: NormalForm) -> float | None:
    """What a nat is worth to every user alike, in the objective's utility, where :func:`closed_decision` solves it.

    None elsewhere; that a utility is the rate itself is the objective's word (:meth:`.Objective.power_law`).
    """
    if form.objective.power_law() != 0.0 or form.objective.measure == "power" or form.objective.joined == "min":
        return None
    if form.start.size <= form.cap_w.size:
        return None
    counts = form.weight > 0
    weight = form.weight[counts]
    if (weight != weight[0]).any() or form.promised_nats.any():
        return None
    if form.problem.max_rate_bps is not None and np.isfinite(form.most_nats[counts]).any():
        return None
    return form.bps_per_nat * float(weight[0])


def closed_decision(form: NormalForm, worth: float) -> Decision:
    """The optimum, proven by the dual at its price; ``worth`` by :func:`nats_worth`."""
    found = closed_allocations(form, worth)
    owner, power_w, price, bound = found.owner[0], found.power_w[0], float(found.price[0]), float(found.bound[0])
    if form.objective.measure != "efficiency":
        return certified(form, owner, power_w, bound, price_of_power=price * found.worth)
    # Where the budget binds, a watt more brings μ nats and costs q of them, spread over P + C; elsewhere nothing.
    binds = float(power_w.sum()) >= form.budget_w * (1.0 - _ROUNDING)
    surplus = max(price * found.worth - bound, 0.0) / (form.budget_w + form.circuit_w) if binds else 0.0
    return certified(
        form,
        owner,
        power_w,
        bound,
        reason=APPROACHED if form.circuit_w == 0.0 and power_w.any() else "",
        price_of_power=surplus,
        iterations=int(found.steps[0]),
    )


class Closed(NamedTuple):
    """Optima of a batch.

    Attributes:
        owner, power_w: shape (batch, subcarrier).
        price: of power in nats per W, shape (batch,).
        bound: in the objective's unit, shape (batch,).
        steps: of the search, shape (batch,).
        worth: of a nat, in the objective's unit.
    """

    owner: IntArray
    power_w: FloatArray
    price: FloatArray
    bound: FloatArray
    steps: IntArray
    worth: float


def closed_allocations(form: NormalForm, worth: float) -> Closed:
    """The optima for the form's channels, (user, subcarrier) for a batch of one or (batch, user, subcarrier)."""
    from wirelessagent.deciding.core.fractional_kernel import max_efficiency
    from wirelessagent.deciding.core.water_filling_kernel import max_rate

    if not form.weight.all():
        counted = np.where(form.weight[:, np.newaxis] > 0, form.snr_per_w, 0.0)
        form = dataclasses.replace(form, snr_per_w=counted)
    leading = form.snr_per_w.shape[:-2]
    snr = form.snr_per_w.reshape(-1, *form.snr_per_w.shape[-2:])
    budget = np.full(len(snr), form.budget_w)
    if form.objective.measure != "efficiency":
        owner, power_w, price = max_rate(snr, form.cap_w, form.max_snr, budget)
        rate = rate_bound_nats(form, price.reshape(leading))
        bound = form.objective.figures(rate * worth, float(form.weight.sum()))
        return Closed(owner, power_w, price, bound.reshape(-1), np.zeros(len(snr), dtype=np.int64), worth)
    owner, power_w, price, steps = max_efficiency(snr, form.cap_w, form.max_snr, budget, form.circuit_w)
    worth *= form.cell.amplifier_efficiency
    bound = efficiency_bound_nats_per_j(form, price.reshape(leading)) * worth
    return Closed(owner, power_w, price, bound.reshape(-1), steps, worth)
