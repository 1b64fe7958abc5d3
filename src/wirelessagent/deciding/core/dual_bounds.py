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
from wirelessagent.deciding.core.program import HIGHEST_LEVEL, LEAST_POWER, MOST_EFFICIENCY, Program, Programs
from wirelessagent.model.arrays import FloatArray

_COARSE = np.append(0.0, np.arange(-8.0, 8.25, 0.5))
_FINE = np.arange(-0.5, 0.51, 0.05)
"""Steps in ln μ at which the bound is worked out; the first is the price that was found."""
_ROUNDING = 4e-16
"""Share of its terms, for each of them, that a sum may be off by; every bound is on the safe side of it."""
_DEAREST = 1e130
"""No price is higher, so that products stay within the range of numbers."""


def bound_of(form: NormalForm, program: Program, log_price: FloatArray, log_mu: float) -> float:
    """The bound in the objective's unit, from ln λ (user,) and ln μ in the program's utility per W."""
    return float(bounds_of(form, program, log_price, np.asarray(log_mu)))


def bounds_of(form: NormalForm, program: Program | Programs, log_price: FloatArray, log_mu: FloatArray) -> FloatArray:
    """:func:`bound_of` for the form's channels, shape (…), from ln λ (…, user) and ln μ (…)."""
    log_price = np.minimum(log_price, np.log(_DEAREST))
    price = np.exp(log_price)
    worth_w = _groups_worth_w(form, price)
    rounding = _ROUNDING * sum(form.snr_per_w.shape[-2:])
    if program.goal == LEAST_POWER:
        paid_w = price @ form.promised_nats
        with np.errstate(invalid="ignore"):  # ∞ − ∞ proves nothing
            proven_w = paid_w - worth_w - rounding * (paid_w + worth_w)
        return np.fmax(proven_w, _first_nats_w(form) * (1.0 - rounding))
    weight = float(form.weight.sum())
    if program.goal == HIGHEST_LEVEL:
        worth_w = (worth_w + form.budget_w) * (1.0 + rounding)
        with np.errstate(over="ignore"):  # where no power is needed the level has no limit
            level = _highest_level(program, log_price, worth_w) * (1.0 + rounding) * form.bps_per_nat
        return form.objective.figures(form.objective.utility(level[..., np.newaxis])[..., 0], weight)
    full = _conjugate(form, program, np.zeros(price.shape), rounding)  # the highest rates, whatever they take
    best = full
    if program.goal == MOST_EFFICIENCY:
        best = np.minimum(_efficiency(form, full, np.zeros(full.shape)), _first_nats_per_j(form, program))
    center = np.asarray(log_mu, dtype=np.float64)
    for steps in (_COARSE, _FINE):  # λ and Φ(λ) are the costly part: with them given the best μ is soon found
        tried = center[..., np.newaxis] + steps
        with np.errstate(over="ignore"):
            mu = np.minimum(np.exp(tried), _DEAREST) * np.asarray(program.scale)[..., np.newaxis]
        rate_price = price[..., np.newaxis, :] * mu[..., np.newaxis] / form.bps_per_nat
        joint = _conjugate(form, program, rate_price, rounding)
        paid = mu * worth_w[..., np.newaxis] * (1.0 + rounding)
        if program.goal == MOST_EFFICIENCY:
            bounds = _efficiency(form, joint + paid + rounding * mu * form.circuit_w, mu) * (1.0 + rounding)
        else:
            bounds = joint + paid + mu * form.budget_w * (1.0 + rounding)
        at = bounds.argmin(axis=-1)[..., np.newaxis]
        center = np.take_along_axis(tried, at, axis=-1)[..., 0]
        best = np.minimum(best, np.take_along_axis(bounds, at, axis=-1)[..., 0])
    return best if program.goal == MOST_EFFICIENCY else form.objective.figures(best, weight)


def groups_worth_w(form: NormalForm, price: FloatArray) -> float:
    """Φ(λ) in W, for λ (user,) in W per nat."""
    return float(_groups_worth_w(form, price))


def _first_nats_w(form: NormalForm) -> FloatArray:
    """Σ R_k/max a_k, shape (…): what the promised rates cost if all nats cost as little as the first.

    That is the bound at λ = 1/max a. The climb of the prices loses its digits where rates are so small that they need
    hardly more.
    """
    best = form.snr_per_w.max(axis=-1)
    return np.where(best > 0, form.promised_nats / np.where(best > 0, best, 1.0), 0.0).sum(axis=-1)


def _first_nats_per_j(form: NormalForm, program: Program | Programs) -> FloatArray:
    """The most utility per joule radiated, shape (…): that of the first nats, r ≤ p a, where utilities are straight.

    No other bound holds without circuit power, when less power is always more efficient.
    """
    if form.objective.power_law() != 0.0:
        return np.asarray(np.inf)
    slope = program.rows[..., 3]
    best = (slope * form.snr_per_w.max(axis=-1)).max(axis=-1)
    return best * program.scale * form.cell.amplifier_efficiency


def _conjugate(form: NormalForm, program: Program | Programs, price: FloatArray, rounding: float) -> FloatArray:
    """u*(w) = Σ ω_k u_k*(w_k/ω_k) for prices w (…, user) per bit/s, over the rates that are allowed, shape (…).

    A user of weight 0 takes what it is promised. ``rounding`` is the share of its terms by which the sum is raised.
    """
    share = program.share if program.share.ndim == price.ndim + 1 else program.share[..., np.newaxis, :, :]
    low, high = share[..., 1] * form.bps_per_nat, share[..., 2] * form.bps_per_nat
    counts = form.weight > 0
    weight = np.where(counts, form.weight, 1.0)
    value, rate = form.objective.conjugate(price / weight, low, high)
    value = np.where(counts, weight * value, -price * low)
    paid = price * np.where(counts, np.where(np.isfinite(rate), rate, 0.0), low)
    size = np.where(np.isfinite(value), np.abs(value) + paid, 0.0)
    return np.asarray(value.sum(axis=-1) + rounding * size.sum(axis=-1))


def _groups_worth_w(form: NormalForm, price: FloatArray) -> FloatArray:
    from wirelessagent.deciding.core.batch_kernel import worth_of_all

    snr_per_w, flat = form.snr_per_w.reshape(-1, *form.snr_per_w.shape[-2:]), price.reshape(-1, price.shape[-1])
    return worth_of_all(snr_per_w, form.cap_w, form.max_snr, form.start, flat).reshape(price.shape[:-1])


def _highest_level(program: Program | Programs, log_price: FloatArray, worth_w: FloatArray) -> FloatArray:
    """The largest t whose rates cost no more than ``worth_w`` (…) at the prices (…, user), in nats, shape (…)."""
    from wirelessagent.deciding.core.batch_kernel import level_bounds

    share, flat = program.share.reshape(-1, *program.share.shape[-2:]), log_price.reshape(-1, log_price.shape[-1])
    level = level_bounds(share, flat, np.ravel(worth_w), np.ravel(program.most_level))
    return level.reshape(np.shape(worth_w))


def _efficiency(form: NormalForm, worth: FloatArray, mu: FloatArray) -> FloatArray:
    """U ≤ worth + μ P, so U/(P + C) ≤ μ + (worth − μ C)/(P + C): largest at one end of 0 ≤ P ≤ P_max."""
    circuit = form.circuit_w
    surplus = worth - mu * circuit
    drawn = np.where(surplus > 0, circuit, form.budget_w + circuit)
    bound = mu + np.where(drawn > 0, surplus / np.where(drawn > 0, drawn, 1.0), np.inf)
    return bound * form.cell.amplifier_efficiency
