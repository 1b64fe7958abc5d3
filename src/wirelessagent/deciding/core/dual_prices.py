"""What the dual's prices tell an operator: what a watt more, or a promise more, changes, and what promises need."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from wirelessagent.deciding.core.certificate import Figures
from wirelessagent.deciding.core.dual_search import Effort, Search, search
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import HIGHEST_LEVEL, LEAST_POWER, MOST_EFFICIENCY
from wirelessagent.deciding.core.scaling import scaling_at_hand
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Bracket
from wirelessagent.model.rates import user_rate_bps

_ROUNDING = 1e-9
_NEWTON_STEPS = 30
_STEP = 1e-3
"""Of the circuit power, next to all that is drawn, from which the power at the bound is worked out."""


def figures_of(form: NormalForm, found: Search, least: Search | None, searched: Bracket | None = None) -> Figures:
    """Prices and brackets of a decision.

    Args:
        form: the problem.
        found: what was found for it.
        least: the search for the least power of the promised rates, if there are any.
        searched: what a search for the largest factor on them has found; None takes what is at hand.
    """
    figures = Figures(
        price_of_power=_price_of_power(form, found),
        prices=found.prices,
        iterations=found.iterations,
        restarts=found.restarts,
    )
    if least is None:
        return figures
    figures["price_of_rate"] = _price_of_rate(form, found)
    figures["needed_power_w"] = Bracket(at_least=least.bound, at_most=least.spent_w)
    scaling = scaling_at_hand(form, least)
    if searched is not None:
        scaling = Bracket(
            at_least=max(scaling.at_least, searched.at_least), at_most=min(scaling.at_most, searched.at_most)
        )  # fmt: skip
    figures["rate_scaling"] = scaling
    return figures


def _price_of_power(form: NormalForm, found: Search) -> float:
    """Change of the best value per watt more."""
    program = found.program
    if program.goal == LEAST_POWER:
        return 0.0  # more budget changes nothing once the rates are carried
    with np.errstate(over="ignore"):
        price, mu = np.exp(found.prices.log_rate), float(np.exp(found.prices.log_power)) * program.scale
    if program.goal == HIGHEST_LEVEL:
        paid = float(price @ form.weight)
        binding = found.spent_w >= form.budget_w * (1.0 - _ROUNDING)
        return form.bps_per_nat / paid if binding and paid > 0 else 0.0
    if program.goal == MOST_EFFICIENCY:
        efficiency = found.bound / form.cell.amplifier_efficiency
        if found.spent_w < form.budget_w * (1.0 - _ROUNDING):
            return 0.0
        return max(mu - efficiency, 0.0) / (form.budget_w + form.circuit_w) * form.cell.amplifier_efficiency
    return mu * _figure_slope(form, found)


def _price_of_rate(form: NormalForm, found: Search) -> FloatArray:
    """Change of the best value per bit/s more promised to each user, shape (user,)."""
    program = found.program
    promised = form.promised_nats > 0
    with np.errstate(over="ignore"):
        price = np.exp(found.prices.log_rate)
    if program.goal == LEAST_POWER:
        return np.where(promised, price, 0.0) / form.bps_per_nat
    if program.goal == HIGHEST_LEVEL:
        level = np.exp(found.prices.log_power)
        binding = promised & (form.promised_nats >= form.weight * level * (1.0 - _ROUNDING))
        paid = float(price @ (form.weight * ~binding))
        return np.where(binding, -price / paid if paid > 0 else 0.0, 0.0)
    _, _, reference, slope, curvature, _ = program.rows.T
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        marginal = slope * (form.promised_nats / reference) ** -curvature
        worth = np.where(promised, np.minimum(marginal - price * np.exp(found.prices.log_power), 0.0), 0.0)
    worth = np.nan_to_num(worth, nan=0.0, posinf=0.0) * program.scale / form.bps_per_nat
    if program.goal == MOST_EFFICIENCY:
        return worth / _drawn_w(form, found)
    return worth * _figure_slope(form, found)


def _drawn_w(form: NormalForm, found: Search) -> float:
    """What the cell draws where the bound is reached, P/ξ + P_c; the allocation that was found draws something else.

    1/q is the least (P/ξ + P_c)/U, so its slope over P_c is 1/U, and P/ξ + P_c is U/q there.
    """
    cell, spent_w = form.cell, (found.spent_w + form.circuit_w) / form.cell.amplifier_efficiency
    if form.limit.is_over():
        return spent_w
    circuit_w = np.maximum(cell.circuit_power_w + spent_w * _STEP * np.array([-1.0, 1.0]), 0.0)
    cells = (replace(cell, circuit_power_w=float(circuit)) for circuit in circuit_w)
    forms = (replace(form, cell=other) for other in cells)
    effort = Effort(restarts=0, seed=0)
    bounds = np.array([search(other, found.program, effort, found.prices, found.owner).bound for other in forms])
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / bounds
        drawn_w = float(inverse.mean() * np.diff(circuit_w)[0] / np.diff(inverse)[0])
    return drawn_w if 0.0 < drawn_w < np.inf else spent_w


def _figure_slope(form: NormalForm, found: Search) -> float:
    """dfigure/dU at the bound that the search found, by central difference; Newton's steps find its U."""
    rate = user_rate_bps(form.estimate.gain, found.owner, found.power_w, form.cell)
    counts = form.weight > 0
    worth = form.weight[counts] * form.objective.utility(rate)[counts]
    joint, magnitude = float(worth.sum()), float(np.abs(worth).sum())
    if not np.isfinite(joint):
        return 0.0
    total, step = float(form.weight.sum()), 1e-6 * (magnitude if magnitude > 0 else 1e-9)
    slope = 0.0
    for _ in range(_NEWTON_STEPS):
        rise = form.objective.figure(joint + step, total) - form.objective.figure(joint - step, total)
        slope, short = rise / (2.0 * step), found.bound - form.objective.figure(joint, total)
        if not np.isfinite(short) or slope <= 0.0 or abs(short) <= _ROUNDING * abs(found.bound):
            break
        joint += short / slope
    return slope
