"""Decisions about promised rates: kept, proven impossible, or neither."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from wirelessagent.deciding.core.certificate import Figures, certified, nothing
from wirelessagent.deciding.core.exact_powers import BUDGET_ROUNDING
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.rate_proof import RateProof, prove, shortage
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Bracket, Decision
from wirelessagent.model.metrics import kept
from wirelessagent.model.rates import user_rate_bps
from wirelessagent.model.units import human

Allocate = Callable[[FloatArray], tuple[IntArray, FloatArray]]
"""From rates in nats (user,) to an owner and a power in W per subcarrier; the power is infinite where it cannot."""

_PROOF_ROUNDING = 1e-9
_MOST_TOLD_W = 1e12
_SCALING_ACCURACY = 1e-6
_BISECTIONS = 40


def least_power_decision(form: NormalForm, allocate: Allocate) -> Decision:
    """P2 by a method that finds an allocation for given rates, judged by the dual bound."""
    proof = prove(form)
    owner, power_w = allocate(form.promised_nats)
    found = float(power_w.sum())
    figures = _figures(form, proof)
    figures["price_of_power"] = 0.0  # more budget changes nothing once the rates are carried
    if not form.promised_nats.any():
        return certified(form, owner, power_w, 0.0, **figures)
    reason, most = ("", np.inf) if np.isfinite(found) else shortage(form)
    fits = found <= form.budget_w * (1.0 + BUDGET_ROUNDING)
    at_most = min(proof.max_scaling, most)
    figures["needed_power_w"] = _needed(proof, reason, found)
    figures["rate_scaling"] = Bracket(
        at_least=_largest_scaling(form, allocate, 1.0 if fits else 0.0, at_most), at_most=at_most
    )
    if fits:
        return certified(form, owner, power_w, proof.needed_w, **figures)
    tried = f"what was found needs {_told(found)}" if np.isfinite(found) else "no sets that carry them were found"
    return _not_kept(form, proof, reason, tried, figures)


def broken_decision(form: NormalForm, found_w: float, needed_w: float, price: FloatArray, scaling: float) -> Decision:
    """Where no allocation was found that keeps the promised rates: infeasible with a proof, or undecided.

    ``found_w`` is the power of one that keeps them beyond the budget, infinite for none; ``needed_w`` is the least by
    the dual at the ``price`` λ (user,) of each rate; ``scaling`` is the common factor that is known to fit the budget.
    """
    proof = prove(form)
    if needed_w > proof.needed_w:
        proof = dataclasses.replace(proof, needed_w=needed_w, price=price)
    reason, most = shortage(form) if np.isinf(found_w) else ("", np.inf)
    figures = _figures(form, proof)
    figures["needed_power_w"] = _needed(proof, reason, found_w)
    at_most = min(proof.max_scaling, most)
    if proof.needed_w > form.budget_w * (1.0 + _PROOF_ROUNDING):
        at_most = min(at_most, 1.0)
    figures["rate_scaling"] = Bracket(at_least=min(scaling, at_most), at_most=at_most)
    tried = f"what was found needs {_told(found_w)}" if np.isfinite(found_w) else "no sets that carry them were found"
    return _not_kept(form, proof, reason, tried, figures)


def fixed_power_decision(form: NormalForm, owner: IntArray, power_w: FloatArray, bound: float) -> Decision:
    """A decision for an allocation that does not look at the promised rates, if it happens to keep them.

    ``bound`` holds for the objective without promises, so with them it holds all the more; for the least power they
    give a better one.
    """
    if not form.promised_nats.any():
        return certified(form, owner, power_w, bound)
    rate = user_rate_bps(form.estimate.gain, owner, power_w, form.cell)
    promised = form.promised_nats * form.bps_per_nat
    bearing = promised > 0
    met = bool(kept(rate, promised).all())
    found = float(power_w.sum())
    proof = prove(form)
    reason, most = ("", np.inf) if met else shortage(form)
    figures = _figures(form, proof)
    figures["needed_power_w"] = _needed(proof, reason, found if met else np.inf)
    share = float(np.min(rate[bearing] / promised[bearing]))
    figures["rate_scaling"] = Bracket(at_least=share, at_most=min(proof.max_scaling, most))
    if form.objective.name == "min_power":
        bound = proof.needed_w
    if met:
        return certified(form, owner, power_w, bound, **figures)
    return _not_kept(form, proof, reason, f"this allocation carries {100 * share:.3g} % of them", figures, bound)


def _figures(form: NormalForm, proof: RateProof) -> Figures:
    if form.objective.name != "min_power":  # the prices are those of power, whatever the objective
        return Figures(iterations=proof.iterations)
    return Figures(price_of_rate=proof.price / form.bps_per_nat, iterations=proof.iterations)


def _not_kept(
    form: NormalForm, proof: RateProof, shortage: str, tried: str, figures: Figures, bound: float = np.nan
) -> Decision:
    """Infeasible where that is proven, else undecided; ``tried`` says how far the allocation came."""
    least = np.inf if shortage else proof.needed_w
    bound = least if form.objective.name == "min_power" else bound
    budget = human(form.budget_w, "W")
    figures["price_of_power"] = np.nan
    if shortage:
        figures["reason"] = shortage
        return nothing(form, "infeasible", bound, **figures)
    if np.isinf(least):
        figures["reason"] = "no assignment of the subcarriers carries the rates asked for at any power"
        return nothing(form, "infeasible", bound, **figures)
    if least > form.budget_w * (1.0 + _PROOF_ROUNDING):
        needed = _told(least) if least > _MOST_TOLD_W else f"at least {_told(least)}"
        figures["reason"] = f"the rates asked for need {needed} on this channel, more than the budget of {budget}"
        return nothing(form, "infeasible", bound, **figures)
    figures["reason"] = (
        f"the rates asked for were not reached within {budget}: {tried}, at least {_told(least)} is needed, "
        "and whether they can be reached is not known; another method may tell"
    )
    return nothing(form, "undecided", bound, **figures)


def _needed(proof: RateProof, shortage: str, found: float) -> Bracket:
    """The power that the promised rates need; ``found`` is infinite where no allocation was found that carries them."""
    at_least = np.inf if shortage else proof.needed_w
    return Bracket(at_least=at_least, at_most=found if np.isfinite(found) or np.isinf(at_least) else np.nan)


def _told(power_w: float) -> str:
    """A power for a sentence; beyond what all the world radiates its digits tell nothing."""
    return human(power_w, "W") if power_w <= _MOST_TOLD_W else "more than 1e12 W"


def _largest_scaling(form: NormalForm, allocate: Allocate, low: float, high: float) -> float:
    """The largest common factor on the promised rates that ``allocate`` carries within the budget, by bisection."""
    for _ in range(_BISECTIONS):
        if high - low <= _SCALING_ACCURACY * high:
            break
        middle = 0.5 * (low + high)
        if float(allocate(middle * form.promised_nats)[1].sum()) <= form.budget_w:
            low = middle
        else:
            high = middle
    return low
