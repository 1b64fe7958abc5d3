"""Problems that have an exact solution: the most rate, alone or per joule, where all users' bits are worth the same.

Each subcarrier then goes to its best user, whatever the price of power, and one water level does the rest.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.bounds import efficiency_bound_nats_per_j, rate_bound_nats
from wirelessagent.deciding.core.certificate import certified
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import MOST_EFFICIENCY, MOST_UTILITY, Program, Programs
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Decision

_ROUNDING = 1e-12
"""Share of the budget that a sum of powers may miss it by."""
_APPROACHED = (
    "without circuit power less power is always more efficient: the best efficiency is only approached "
    "as the power goes to 0, here to 1e-12 of it"
)


def is_closed(form: NormalForm, program: Program | Programs) -> bool:
    """Whether :func:`closed_decision` solves the problem."""
    if program.goal not in (MOST_UTILITY, MOST_EFFICIENCY) or form.start.size <= form.cap_w.size:
        return False
    if form.problem.min_rate_bps is not None and form.promised_nats.any():
        return False
    counts = form.weight > 0
    weight = form.weight[counts]
    return not (
        program.rows[..., counts, 4].any()
        or (weight != weight[0]).any()
        or (form.problem.max_rate_bps is not None and np.isfinite(form.most_nats[counts]).any())
        or not _is_straight(form, program)
    )


def _is_straight(form: NormalForm, program: Program | Programs) -> bool:
    """Whether the utility is a multiple of the rate, at the reference and at the highest rate."""
    _, high, reference, slope, _, _ = np.moveaxis(program.rows, -1, 0)
    rate = np.stack([reference, np.maximum(high, reference)]) * form.bps_per_nat
    worth = form.objective.utility(rate) * form.weight
    expected = rate * slope * (np.asarray(program.scale)[..., np.newaxis] / form.bps_per_nat)
    return bool(np.all(np.abs(worth - expected) <= 1e-9 * np.abs(expected)))


def closed_decision(form: NormalForm, program: Program) -> Decision:
    """The optimum, proven by the dual at its price."""
    found = closed_allocations(form, program)
    owner, power_w, price, bound = found.owner[0], found.power_w[0], float(found.price[0]), float(found.bound[0])
    if program.goal == MOST_UTILITY:
        return certified(form, owner, power_w, bound, price_of_power=price * found.worth)
    # Where the budget binds, a watt more brings μ nats and costs q of them, spread over P + C; elsewhere nothing.
    binds = float(power_w.sum()) >= form.budget_w * (1.0 - _ROUNDING)
    surplus = max(price * found.worth - bound, 0.0) / (form.budget_w + form.circuit_w) if binds else 0.0
    return certified(
        form,
        owner,
        power_w,
        bound,
        reason=_APPROACHED if form.circuit_w == 0.0 and power_w.any() else "",
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


def closed_allocations(form: NormalForm, program: Program | Programs) -> Closed:
    """The optima for the form's channels, (user, subcarrier) for a batch of one or (batch, user, subcarrier)."""
    from wirelessagent.deciding.core.fractional_kernel import max_efficiency
    from wirelessagent.deciding.core.water_filling_kernel import max_rate

    counts = form.weight > 0
    worth = float(np.ravel(program.scale)[0]) * float(program.rows[..., counts, 3].max())
    snr = np.where(counts[:, np.newaxis], form.snr_per_w, 0.0).reshape(-1, *form.snr_per_w.shape[-2:])
    budget = np.full(len(snr), form.budget_w)
    if program.goal == MOST_UTILITY:
        owner, power_w, price = max_rate(snr, form.cap_w, form.max_snr, budget)
        rate = rate_bound_nats(form, price.reshape(form.snr_per_w.shape[:-2]))
        bound = form.objective.figures(rate * worth, float(form.weight.sum()))
        return Closed(owner, power_w, price, bound.reshape(-1), np.zeros(len(snr), dtype=np.int64), worth)
    owner, power_w, price, steps = max_efficiency(snr, form.cap_w, form.max_snr, budget, form.circuit_w)
    worth *= form.cell.amplifier_efficiency
    bound = efficiency_bound_nats_per_j(form, price.reshape(form.snr_per_w.shape[:-2])) * worth
    return Closed(owner, power_w, price, bound.reshape(-1), steps, worth)
