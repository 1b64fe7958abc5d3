"""Prices of the users' rates and of power: the dual of every problem, by Newton's method on a smoothed maximum.

With w_k the price of user k's rate, μ that of power and λ = w/μ in W per nat, no allocation is worth more than

    F(w, μ) = Σ_k u_k*(w_k) + μ [Φ(λ) + P],    u*(w) = max over low ≤ r ≤ high of U(r) − w r,    Φ(λ) = Σ_g max_k t_kg,

where g runs over the groups of subcarriers that have one owner. F is convex in (w, μ) but kinked wherever two users tie
for a group, and at its minimum many do, so that subgradients and coordinate steps stall. So Φ is smoothed
(:mod:`.supply_kernel`) at a temperature that falls step by step, and Newton's method in (ln w, ln μ) makes supply meet
demand (:mod:`.demand_kernel`) in a few steps per temperature. Where a straight utility's demand jumps, at w = U′, F is
kinked as well, but in that price alone: no step passes the kink without stopping there, and a price stays while the
supply is within the jump (Bertsekas 1982, projected Newton).

The goals differ in what moves. For promises alone (low = high, U = 0) μ is 1, P is 0, and −F = λ·R − Φ is the dual of
P2. The highest common level t is what λ·r(t) ≤ Φ(λ) + P allows, and the promises are those of that level. Efficiency q
is the sum of utilities in which a watt costs at least q, so that μ ≥ q; q is moved by Dinkelbach's method.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.ask_kernel import EFFICIENCY, LEVEL
from wirelessagent.deciding.core.climb_point_kernel import (
    DEAREST,
    EFFICIENT,
    EXACT,
    FARTHEST,
    FLATNESS,
    LEAST,
    MEAN,
    PAID,
    RELATIVE,
    SAME,
    SHARED,
    SMOOTH,
    VALUE,
    Ask,
    Path,
    State,
    budget_of,
    evaluate,
    least_price,
    new_path,
    new_state,
    value_at,
    worth_of_group,
)
from wirelessagent.deciding.core.demand_kernel import level_bound
from wirelessagent.deciding.core.newton_kernel import newton_step
from wirelessagent.deciding.core.supply_kernel import Groups, worth_w
from wirelessagent.deciding.core.work_kernel import is_over
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray

STEPS = 24
TRIALS = 12
CAREFUL = 6
"""Trials of a step until all of its parts are shortened alike."""
SHRINK = 0.25
SHORT, LONG = 1.0, 8.0
"""Longest step of a logarithm at first, and after many that were too short."""
FLAT = 1e-2
"""What a step must promise, in units of the temperature and of the value of all groups."""
LEAST_SHARE, NEARLY, SHARED_AT = 1e-2, 0.999, 5e-3
"""Supply in units of demand between which it is taken to grow exponentially, and the least temperature at which it is:
below, few users share a group."""
ENOUGH = 40.0
"""For the level ln λ next to that of the budget in W, beyond which a common factor changes nothing."""
LAST, EXACTLY = 10, 1e-9
"""Moves of an efficiency after the climb, at a temperature of next to nothing."""
ROUGH = 0.1
"""Share of its surplus to which an efficiency's prices must be settled before it moves."""


@kernel
def write_slope(path: Path, at: State, logarithmic: bool) -> None:
    """Write the gradient, or what leads to a better step from it for users who are new to the groups that they want.

    Supply s of theirs grows exponentially with the price rather than linearly, as long as other users own nearly all of
    those groups. The step that makes up for a demand d that is fixed is then (ln d − ln s) s/s′ instead of (d − s)/s′.
    """
    users = at.supplied.size
    path.slope[:] = at.gradient
    for k in range(users):
        if logarithmic and at.gradient[k] < 0.0 and at.falling[k] == 0.0:
            share = at.supplied[k] / (at.supplied[k] - at.gradient[k] * np.exp(-at.log_price[k]))
            if LEAST_SHARE < share < NEARLY:
                path.slope[k] *= share * np.log(share) / (share - 1.0)


@kernel
def solve_step(path: Path, at: State, logarithmic: bool) -> float:
    """Write Newton's step; returns the fall of F that it promises, twice."""
    size = 0
    for k in range(at.free.size):
        if at.free[k]:
            path.free[size] = k
            size += 1
    write_slope(path, at, logarithmic)
    newton_step(at.hessian, path.slope, path.free, size, path.factor, path.step)
    promised = -(path.step * at.gradient).sum()
    if promised > 0.0 or not logarithmic:
        return promised
    return newton_step(at.hessian, at.gradient, path.free, size, path.factor, path.step)


@kernel
def shortened(path: Path, user: int, longest: float, apart: bool) -> float:
    """A part of the step, none longer than ``longest``; where ``apart`` those of ln μ and of ln λ = ln w − ln μ."""
    if not apart or user == path.kink.size or path.step[user] == 0.0:
        return min(max(path.step[user], -longest), longest)
    common = min(max(path.step[-1], -longest), longest)
    return common + min(max(path.step[user] - path.step[-1], -longest), longest)


@kernel
def walk(path: Path, here: State, there: State, longest: float, apart: bool, scale: float) -> None:
    """Write the prices a step away, shortened to ``longest``; kinks are not passed."""
    users = path.kink.size
    for k in range(users + 1):
        old = here.log_price[k]
        new = old + scale * shortened(path, k, longest, apart)
        if not np.isfinite(new):
            new = old
        if k == users:
            new = max(new, path.figures[LEAST])
        elif old == path.kink[k]:
            if (new - old) * here.gradient[k] > 0.0:
                new = old
        elif (old - path.kink[k]) * (new - path.kink[k]) < 0.0 or abs(new - path.kink[k]) < SAME:
            new = path.kink[k]
        there.log_price[k] = new
    beyond = max((there.log_price[:users] - there.log_price[users]).max() - path.figures[DEAREST], 0.0)
    for k in range(users):
        if there.log_price[k] != path.kink[k]:
            log_lambda = there.log_price[k] - there.log_price[users] - beyond
            there.log_price[k] = max(log_lambda, -FARTHEST) + there.log_price[users]


@kernel
def first_kink(path: Path, here: State, longest: float, apart: bool) -> float:
    """The share of a step at which the first kink is met; 1 if none is."""
    share = 1.0
    for k in range(path.kink.size):
        part = shortened(path, k, longest, apart)
        ahead = path.kink[k] - here.log_price[k]
        if ahead * part > 0.0 and abs(part) * share > abs(ahead):
            share = ahead / part
    return share


@kernel
def descend(groups: Groups, ask: Ask, rows: FloatArray, path: Path, here: State, there: State, longest: float) -> float:
    """Fill in ``there``, a step away, where F is less; returns the share of the step, 0 if F is nowhere less."""
    scale = 1.0
    for trial in range(TRIALS):
        if trial > 0 and is_over(ask.work):
            break
        apart = trial == 1
        if apart and np.abs(path.step).max() <= 0.5 * longest:  # nothing was shortened
            continue
        if trial == CAREFUL and (ask.goal == LEVEL or np.abs(path.step).max() > longest):
            path.step[:] *= min(1.0, longest / np.abs(path.step).max())
            scale = first_kink(path, here, longest, apart)
        walk(path, here, there, longest, apart, 1.0 if apart else scale)
        evaluate(groups, ask, rows, path, there)
        if there.figures[VALUE] < here.figures[VALUE]:
            return scale
        if not apart:
            share = first_kink(path, here, longest, apart) if trial == 0 else 1.0
            scale *= share if share < 1.0 else SHRINK
    return 0.0


@kernel
def settle_at(groups: Groups, ask: Ask, rows: FloatArray, path: Path, here: State, there: State) -> tuple[int, bool]:
    """Newton's method at one temperature; returns the steps, and whether the prices are now those of ``there``."""
    longest = SHORT
    swapped = False
    steps = 0
    while steps < STEPS and not is_over(ask.work):
        promised = solve_step(path, here, path.figures[RELATIVE] >= SHARED_AT)
        mu = np.exp(here.log_price[-1])
        enough = path.figures[FLATNESS] * path.figures[RELATIVE] * mu * abs(here.figures[SMOOTH] + budget_of(ask))
        surplus = surplus_of(ask, path, here, SHARED)
        if promised <= max(enough, ROUGH * abs(surplus)):
            if abs(surplus) <= enough:
                break
            move_efficiency(ask, path, here, surplus)
            evaluate(groups, ask, rows, path, here)
            steps += 1
            continue
        steps += 1
        scale = descend(groups, ask, rows, path, here, there, longest)
        if scale == 0.0:
            break
        clipped = np.abs(path.step).max() > longest
        longest = SHORT if scale < 1.0 else min(2.0 * longest, LONG) if clipped else longest
        here, there, swapped = there, here, not swapped
    return steps, swapped


@kernel
def cool(path: Path, here: State, relative: float, worth: float) -> None:
    """Move the prices to where they are expected to settle at the next temperature, at which shares keep as they are.

    The gradient changes by (T/T′ − 1)·cooling, and the part of the Hessian that is due to the shares is T/T′ times as
    much.
    """
    users = path.kink.size
    ratio = path.figures[RELATIVE] * path.figures[MEAN] / (relative * worth)
    path.figures[RELATIVE], path.figures[MEAN] = relative, worth
    here.hessian[:] *= ratio
    for k in range(users):
        here.hessian[k, k] -= (ratio - 1.0) * (here.rising[k] + here.falling[k])
        here.hessian[users, k] += (ratio - 1.0) * here.rising[k]
        here.hessian[users, users] -= (ratio - 1.0) * here.rising[k]
    here.gradient[:] += (ratio - 1.0) * here.cooling
    solve_step(path, here, False)  # the gradient is not that of today's supply
    walk(path, here, here, SHORT, False, 1.0)


@kernel
def climb(
    groups: Groups, ask: Ask, rows: FloatArray, temperatures: FloatArray, flat: float, log_price: FloatArray
) -> tuple[float, int]:
    """Minimise F from ``log_price``, ln w of each user and ln μ, shape (user + 1,), overwritten with the best found.

    Returns F there (for the level its bound, for the efficiency q) and the Newton steps. Temperatures are in units of
    the mean price of a group, and ``flat`` is what a step must promise at each, next to that (:data:`FLAT`). ``rows``
    is overwritten for the level.
    """
    users = rows.shape[0]
    here, there, path = new_state(users), new_state(users), new_path(rows, log_price)
    here.log_price[:] = log_price
    path.figures[FLATNESS], path.figures[LEAST] = flat, least_price(ask, rows)
    path.figures[DEAREST] = float(np.log(ask.budget_w)) + ENOUGH if ask.goal == LEVEL else FARTHEST
    here.log_price[users] = max(here.log_price[users], path.figures[LEAST])
    here.figures[EXACT] = worth_w(groups, log_price[:users] - log_price[users])
    path.figures[RELATIVE], path.figures[MEAN] = temperatures[0], worth_of_group(groups, here)
    evaluate(groups, ask, rows, path, here)
    if ask.goal == EFFICIENCY:
        start_efficiency(ask, path, here)
        evaluate(groups, ask, rows, path, here)
    best, iterations = np.inf, 0
    for i in range(temperatures.size + (LAST if ask.goal == EFFICIENCY else 0)):
        if i < temperatures.size:
            if i > 0:
                cool(path, here, temperatures[i], worth_of_group(groups, here))
                evaluate(groups, ask, rows, path, here)
            steps, swapped = settle_at(groups, ask, rows, path, here, there)
            iterations += steps
            if swapped:
                here, there = there, here
        else:
            path.figures[RELATIVE] = EXACTLY
            move_efficiency(ask, path, here, surplus_of(ask, path, here, EXACT))
            evaluate(groups, ask, rows, path, here)
        found = proven(ask, here)
        if found < best:
            best = found
            log_price[:] = here.log_price
        if is_over(ask.work):
            break
    return best, iterations


@kernel
def proven(ask: Ask, at: State) -> float:
    """What the prices prove with the exact maximum."""
    users = at.supplied.size
    log_mu = at.log_price[users]
    mu = np.exp(log_mu)
    if ask.goal == LEVEL:
        return level_bound(ask.share, at.log_price[:users] - log_mu, at.figures[EXACT] + ask.budget_w, ask.most_level)
    value = value_at(at, EXACT)
    if ask.goal != EFFICIENCY:
        return value
    surplus = value - mu * (ask.budget_w + ask.circuit_w)
    drawn = ask.circuit_w if surplus > 0.0 else ask.budget_w + ask.circuit_w
    return float(mu + surplus / max(drawn, 1e-300))


@kernel
def surplus_of(ask: Ask, path: Path, at: State, which: int) -> float:
    """F − q (P + C), which is 0 at the best efficiency; 0 for other goals."""
    if ask.goal != EFFICIENCY:
        return 0.0
    return value_at(at, which) - path.figures[EFFICIENT] * (ask.budget_w + ask.circuit_w)


@kernel
def start_efficiency(ask: Ask, path: Path, at: State) -> None:
    """An efficiency to start from, with the least price of power that goes with it."""
    least = path.figures[LEAST]
    efficiency = min(np.exp(at.log_price[-1]), at.figures[VALUE] / (ask.budget_w + ask.circuit_w))
    path.figures[EFFICIENT] = efficiency
    path.figures[LEAST] = max(np.log(efficiency) if efficiency > 0.0 else -FARTHEST, least)


@kernel
def move_efficiency(ask: Ask, path: Path, at: State, surplus: float) -> None:
    """The next efficiency by Dinkelbach's method; prices that were at the old one move along."""
    users = path.kink.size
    log_mu, least = at.log_price[users], path.figures[LEAST]
    spent_w = min(at.figures[PAID] - at.figures[SHARED], ask.budget_w) if log_mu <= least + SAME else ask.budget_w
    old = path.figures[EFFICIENT]
    efficiency = max(old + surplus / max(spent_w + ask.circuit_w, 1e-300), SHRINK * old)
    following = np.log(efficiency) if efficiency > 0.0 else -FARTHEST
    new = max(following, log_mu) if log_mu > least + SAME else following
    for k in range(users):
        if at.log_price[k] != path.kink[k]:
            at.log_price[k] += new - log_mu
    at.log_price[users] = new
    path.figures[EFFICIENT], path.figures[LEAST] = efficiency, following
