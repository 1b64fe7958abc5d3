"""Problems that have an exact solution: the most rate, alone or per joule, where all users' bits are worth the same.

Each subcarrier then goes to its best user, whatever the price of power, and one water level does the rest.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.bounds import efficiency_bound_nats_per_j, rate_bound_nats
from wirelessagent.deciding.core.certificate import certified
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import MOST_EFFICIENCY, MOST_UTILITY, Program
from wirelessagent.model.decision import Decision

_ROUNDING = 1e-12
"""Share of the budget that a sum of powers may miss it by."""
_APPROACHED = (
    "without circuit power less power is always more efficient: the best efficiency is only approached "
    "as the power goes to 0, here to 1e-12 of it"
)


def is_closed(form: NormalForm, program: Program) -> bool:
    """Whether :func:`closed_decision` solves the problem."""
    counts = form.weight > 0
    return (
        program.goal in (MOST_UTILITY, MOST_EFFICIENCY)
        and bool(np.all(program.rows[counts, 4] == 0.0))
        and bool(np.ptp(form.weight[counts]) == 0.0)
        and not form.promised_nats.any()
        and bool(np.isinf(form.most_nats[counts]).all())
        and form.start.size - 1 == form.snr_per_w.shape[1]
    )


def closed_decision(form: NormalForm, program: Program) -> Decision:
    """The optimum, proven by the dual at its price."""
    from wirelessagent.deciding.core.fractional_kernel import max_efficiency
    from wirelessagent.deciding.core.water_filling_kernel import max_rate

    worth = program.scale * float(program.rows[form.weight > 0, 3].max())  # of a nat, in the objective's unit
    snr = np.where((form.weight > 0)[:, np.newaxis], form.snr_per_w, 0.0)[np.newaxis]
    budget = np.array([form.budget_w])
    if program.goal == MOST_UTILITY:
        owner, power_w, price = max_rate(snr, form.cap_w, form.max_snr, budget)
        mu = float(price[0])
        bound = form.objective.figure(rate_bound_nats(form, mu) * worth, float(form.weight.sum()))
        return certified(form, owner[0], power_w[0], bound, price_of_power=mu * worth)
    owner, power_w, price, iterations = max_efficiency(snr, form.cap_w, form.max_snr, budget, form.circuit_w)
    bound = efficiency_bound_nats_per_j(form, float(price[0]))
    worth *= form.cell.amplifier_efficiency
    # Where the budget binds, a watt more brings μ nats and costs q of them, spread over P + C; elsewhere nothing.
    binds = float(power_w[0].sum()) >= form.budget_w * (1.0 - _ROUNDING)
    surplus = max(float(price[0]) - bound, 0.0) / (form.budget_w + form.circuit_w) if binds else 0.0
    return certified(
        form,
        owner[0],
        power_w[0],
        bound * worth,
        reason=_APPROACHED if form.circuit_w == 0.0 and power_w[0].any() else "",
        price_of_power=surplus * worth,
        iterations=int(iterations[0]),
    )
