"""What the dual's prices tell an operator: what a watt more, or a promise more, changes, and what promises need."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.certificate import Figures
from wirelessagent.deciding.core.dual_bounds import groups_worth_w
from wirelessagent.deciding.core.dual_search import Search
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import HIGHEST_LEVEL, LEAST_POWER, MOST_EFFICIENCY
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Bracket

_ROUNDING = 1e-9
_STEPS = 12
_ACCURACY = 1e-6


def figures_of(form: NormalForm, found: Search, least: Search | None) -> Figures:
    """Prices and brackets of a decision; ``least`` is the search for the least power of the promised rates, if any."""
    figures = Figures(
        price_of_power=_price_of_power(form, found), prices=found.prices, iterations=found.iterations
    )  # fmt: skip
    if least is None:
        return figures
    figures["price_of_rate"] = _price_of_rate(form, found)
    figures["needed_power_w"] = Bracket(at_least=least.bound, at_most=least.spent_w)
    figures["rate_scaling"] = _scaling(form, least)
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
        return worth / (found.spent_w + form.circuit_w) * form.cell.amplifier_efficiency
    return worth * _figure_slope(form, found)


def _figure_slope(form: NormalForm, found: Search) -> float:
    """dfigure/dU at the bound that the search found, by central difference."""
    from wirelessagent.model.rates import user_rate_bps

    rate = user_rate_bps(form.estimate.gain, found.owner, found.power_w, form.cell)
    counts = form.weight > 0
    joint = float((form.weight[counts] * form.objective.utility(rate)[counts]).sum())
    if not np.isfinite(joint):
        return 0.0
    magnitude = float((form.weight[counts] * np.abs(form.objective.utility(rate)[counts])).sum())
    total, step = float(form.weight.sum()), 1e-6 * (magnitude if magnitude > 0 else 1e-9)
    rise = form.objective.figure(joint + step, total) - form.objective.figure(joint - step, total)
    return rise / (2.0 * step)


def _scaling(form: NormalForm, least: Search) -> Bracket:
    """The largest common factor on the promised rates: found on the sets at hand, proven at most by the prices."""
    with np.errstate(over="ignore"):
        price = np.exp(least.prices.log_rate)
    paid = float(price @ form.promised_nats)
    most = (form.budget_w + groups_worth_w(form, price)) / paid if paid > 0 else np.inf
    return Bracket(at_least=carried_scaling(form, least.owner, least.spent_w, max(most, 1.0)), at_most=max(most, 1.0))


def carried_scaling(form: NormalForm, owner: IntArray, spent_w: float, most: float) -> float:
    """The largest factor that given sets carry within the budget: ln P over ln s by false position.

    ``spent_w`` is what they need for the factor 1. Where that is above the budget the search goes downwards, from the
    share that the budget has of it: the power is convex in the factor, so that much is carried for certain.
    """
    from wirelessagent.deciding.core.least_power_kernel import owned_power
    from wirelessagent.deciding.core.rate_proof import ceilings

    snr = np.where(owner >= 0, form.snr_per_w[owner, np.arange(owner.size)], 0.0)
    ceiling, power_w, price = ceilings(form, snr), np.empty(owner.size), np.empty(form.weight.size)
    low, high, low_excess, high_excess = 1.0, most, np.log(max(spent_w, 1e-300) / form.budget_w), np.nan
    if low_excess > _ACCURACY:
        low, high, high_excess = form.budget_w / spent_w, 1.0, low_excess
        low_w = float(owned_power(snr, ceiling, low * form.promised_nats, owner, power_w, price))
        low_excess = min(np.log(max(low_w, 1e-300) / form.budget_w), 0.0)
    for step in range(_STEPS):
        if high - low <= _ACCURACY * high or low_excess >= -_ACCURACY:
            break
        if not np.isfinite(high_excess):
            factor = high if step == 0 else np.sqrt(low * high)
        else:
            factor = low + (high - low) * low_excess / (low_excess - high_excess)
            factor = min(max(factor, low + 0.02 * (high - low)), high - 0.02 * (high - low))
        needed = float(owned_power(snr, ceiling, factor * form.promised_nats, owner, power_w, price))
        if needed <= form.budget_w:
            low, low_excess = factor, np.log(needed / form.budget_w)
        else:
            high, high_excess = factor, np.log(needed / form.budget_w)
    return float(low)
