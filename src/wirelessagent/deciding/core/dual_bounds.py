"""The bound that prices prove, for every goal, worked out from the channel and the objective's own conjugate.

With λ = w/μ and Φ(λ) = Σ_g max_k t_kg (:mod:`.terms_kernel`), any prices w, μ ≥ 0 prove

    least power         P ≥ λ·R − Φ(λ)
    most utility        U ≤ u*(w) + μ (Φ(λ) + P_max)
    most per joule      U/(P + C) ≤ the smallest q ≥ … for which u*(w) + μ Φ(λ) + (μ − q) P − q C ≤ 0 for all P
    highest level       t with λ·r(t) ≤ Φ(λ) + P_max

so it does not matter how they were found. Nothing here looks at an allocation.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import HIGHEST_LEVEL, LEAST_POWER, MOST_EFFICIENCY, Program
from wirelessagent.model.arrays import FloatArray


def bound_of(form: NormalForm, program: Program, log_price: FloatArray, log_mu: float) -> float:
    """The bound in the objective's unit, from ln λ (user,) and ln μ in the program's utility per W."""
    with np.errstate(over="ignore"):
        price = np.exp(log_price)
    worth_w = groups_worth_w(form, price)
    if program.goal == LEAST_POWER:
        return max(float(price @ form.promised_nats) - worth_w, 0.0)
    weight = float(form.weight.sum())
    if program.goal == HIGHEST_LEVEL:
        level = highest_level(program, log_price, worth_w + form.budget_w) * form.bps_per_nat
        return form.objective.figure(float(form.objective.utility(np.array([level]))[0]), weight)
    mu = float(np.exp(log_mu)) * program.scale
    joint = conjugate(form, program, price * mu / form.bps_per_nat)
    full = conjugate(form, program, np.zeros(price.shape))  # what the highest rates are worth, whatever they take
    if program.goal == MOST_EFFICIENCY:
        return min(_efficiency(form, joint + mu * worth_w, mu), _efficiency(form, full, 0.0))
    return form.objective.figure(min(joint + mu * (worth_w + form.budget_w), full), weight)


def conjugate(form: NormalForm, program: Program, price: FloatArray) -> float:
    """u*(w) = Σ ω_k u_k*(w_k/ω_k) for prices w (user,) per bit/s, over the rates that are allowed.

    A user of weight 0 takes what it is promised.
    """
    low, high = program.share[:, 1] * form.bps_per_nat, program.share[:, 2] * form.bps_per_nat
    counts = form.weight > 0
    weight = np.where(counts, form.weight, 1.0)
    value, _ = form.objective.conjugate(price / weight, low, high)
    return float(np.where(counts, weight * value, -price * low).sum())


def groups_worth_w(form: NormalForm, price: FloatArray) -> float:
    """Φ(λ) in W, for λ (user,) in W per nat."""
    from wirelessagent.deciding.core.terms_kernel import worth_of_groups

    return float(worth_of_groups(form.snr_per_w, form.cap_w, form.max_snr, form.start, price))


def highest_level(program: Program, log_price: FloatArray, worth_w: float) -> float:
    """The largest t whose rates cost no more than ``worth_w`` at the prices, in nats."""
    from wirelessagent.deciding.core.dual_kernel import level_bound

    return float(level_bound(program.share, log_price, worth_w, program.most_level))


def _efficiency(form: NormalForm, worth: float, mu: float) -> float:
    """U ≤ worth + μ P, so U/(P + C) ≤ μ + (worth − μ C)/(P + C): largest at one end of 0 ≤ P ≤ P_max."""
    circuit = form.circuit_w
    surplus = worth - mu * circuit
    drawn = circuit if surplus > 0 else form.budget_w + circuit
    bound = mu + surplus / drawn if drawn > 0 else np.inf
    return bound * form.cell.amplifier_efficiency
