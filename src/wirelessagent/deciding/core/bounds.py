"""Bounds that prove how good a decision is; each holds for any price, the right one makes it tight.

They are worked out from the gains and the price alone, not from the allocation that they judge, and are rounded up.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.model.arrays import FloatArray

_STEP = 4e-16
"""Least change of a number, and the share of its terms, for each of them, that a sum may be off by."""


def rate_bound_nats(form: NormalForm, price: float | FloatArray) -> FloatArray:
    """The most nats that the budget can carry: Φ(μ) + μ P_max, the Lagrangian dual of P1; elementwise, (…)."""
    return (_best_surplus(form, price) + price * form.budget_w) * (1.0 + _STEP * form.cap_w.size)


def efficiency_bound_nats_per_j(form: NormalForm, price: float | FloatArray) -> FloatArray:
    """The most nats per joule, R/(P + ξ P_c), from a price of power near the right one; elementwise, (…).

    An efficiency q cannot be reached if R − q (P + C) < 0 for all allocations, which a price μ ≥ q proves where
    Φ(μ) + μ P_max − q (P_max + C) < 0. That holds above q = (Φ(μ) + μ P_max)/(P_max + C), and this q is at most μ
    just where Φ(μ) ≤ μ C. So the price is raised by as little as makes that true.
    """
    step = _STEP
    value = _best_surplus(form, price)
    while np.any(low := value > price * form.circuit_w):
        price = np.where(low, price * (1.0 + step), price)
        step *= 2.0
        value = _best_surplus(form, price)
    bound = np.minimum(price, (value + price * form.budget_w) / (form.budget_w + form.circuit_w))
    return bound * (1.0 + _STEP * form.cap_w.size)


def best_efficiency_nats_per_j(form: NormalForm) -> float:
    """:func:`efficiency_bound_nats_per_j` at the price of the exact method, for methods that do not know it."""
    from wirelessagent.deciding.core.fractional_kernel import max_efficiency

    price = max_efficiency(
        form.snr_per_w[np.newaxis], form.cap_w, form.max_snr, np.array([form.budget_w]), form.circuit_w
    )[2]
    return float(efficiency_bound_nats_per_j(form, price[0]))


def best_rate_nats(form: NormalForm) -> float:
    """:func:`rate_bound_nats` at the price of the exact method, for methods that do not know it."""
    from wirelessagent.deciding.core.water_filling_kernel import max_rate

    price = max_rate(form.snr_per_w[np.newaxis], form.cap_w, form.max_snr, np.array([form.budget_w]))[2]
    return float(rate_bound_nats(form, price[0]))


def known_bound(form: NormalForm) -> float:
    """The bound without promised rates, in the objective's unit; NaN for objectives that none is known for here."""
    if form.objective.name == "max_rate":
        return best_rate_nats(form) * form.bps_per_nat
    if form.objective.name == "max_energy_efficiency":
        return best_efficiency_nats_per_j(form) * form.bps_per_nat * form.cell.amplifier_efficiency
    return 0.0 if form.objective.name == "min_power" else np.nan


def _best_surplus(form: NormalForm, price: float | FloatArray) -> FloatArray:
    """Φ(μ), shape (…): the user with the best gain is worth most, whatever the price."""
    from wirelessagent.deciding.core.surplus_kernel import surplus

    leading = form.snr_per_w.shape[:-2]
    each = np.ascontiguousarray(np.broadcast_to(price, leading)).reshape(-1)
    snr_per_w = form.snr_per_w.reshape(-1, *form.snr_per_w.shape[-2:])
    return surplus(snr_per_w, form.cap_w, form.max_snr, each).reshape(leading)
