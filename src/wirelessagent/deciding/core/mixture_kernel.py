"""The step of column generation: better prices from the sets that are known, near the best prices so far.

What users would pay at other prices is at least what they would for the sets known by now, so

    m(π, μ) = Σ_j π_j + (μ − q) P + Σ_k max over known s of [U_s − μ P_s − π(S_s)]

is at most D, and equal to it wherever a set was found. Far from there it is wild; the proximal step minimises
m + |π − π̂|²/2t + (μ − μ̂)²/2t_μ around the best prices π̂, μ̂ (Kiwiel, 1990). In its dual each user has a mixture x of
known sets, and the prices follow from how much of each column and of power the mixtures take:

    π_j = max(π̂_j + t (Σ_s x_s [j ∈ S_s] − 1), 0),    μ = max(μ̂ + t_μ (Σ_s x_s P_s − P), q).

It is solved by moving weight, user by user, from the worst set with some to the best one, each time just as much as
makes the two equally good; the cost is a few hundred microseconds for thousands of sets.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.work_kernel import is_over
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

MOVES = 3
"""Of one user's weight before it is the next one's turn."""
NEGLIGIBLE = 1e-15
"""A weight below which a set has none."""


@kernel
def best_and_worst(
    first_set: int,
    last_set: int,
    first: IntArray,
    member: IntArray,
    utility: FloatArray,
    power: FloatArray,
    weight: FloatArray,
    price: FloatArray,
    mu: float,
) -> tuple[int, int, float, float, float]:
    """The best of a user's sets, the worst with some weight, what both are worth, and what the mixture is."""
    best, worst = first_set, first_set
    most, least, mean = -np.inf, np.inf, 0.0
    for s in range(first_set, last_set):
        net = utility[s] - mu * power[s]
        for i in range(first[s], first[s + 1]):
            net -= price[member[i]]
        if net > most:
            most, best = net, s
        if weight[s] > 0.0:
            mean += weight[s] * net
            if net < least:
                least, worst = net, s
    return best, worst, most, least, mean


@kernel
def load_of(first: IntArray, member: IntArray, power: FloatArray, weight: FloatArray, load: FloatArray) -> float:
    """Write how much of each column the mixtures take, (column,); returns the power that they take."""
    load[:] = 0.0
    taken_w = 0.0
    for s in range(weight.size):
        if weight[s] > 0.0:
            taken_w += weight[s] * power[s]
            for i in range(first[s], first[s + 1]):
                load[member[i]] += weight[s]
    return taken_w


@kernel
def differing(first: IntArray, member: IntArray, one: int, other: int, mark: IntArray) -> int:
    """How many columns are in just one of two sets; ``mark`` (column,) is 0 before and after."""
    for i in range(first[one], first[one + 1]):
        mark[member[i]] = 1
    count = first[one + 1] - first[one]
    for i in range(first[other], first[other + 1]):
        count += 1 - 2 * mark[member[i]]
    for i in range(first[one], first[one + 1]):
        mark[member[i]] = 0
    return int(count)


@kernel
def move_weight(
    first: IntArray,
    member: IntArray,
    center: FloatArray,
    step: float,
    worst: int,
    best: int,
    moved: float,
    weight: FloatArray,
    load: FloatArray,
    price: FloatArray,
) -> None:
    """Move weight from one set to another, with the load and the prices that follow."""
    weight[best] += moved
    weight[worst] = weight[worst] - moved if weight[worst] - moved > NEGLIGIBLE else 0.0
    for m in range(first[worst], first[worst + 1]):
        load[member[m]] -= moved
    for m in range(first[best], first[best + 1]):
        load[member[m]] += moved
    for s in (worst, best):
        for m in range(first[s], first[s + 1]):
            j = member[m]
            price[j] = max(center[j] + step * (load[j] - 1.0), 0.0)


@kernel
def mix(
    begin: IntArray,
    first: IntArray,
    member: IntArray,
    utility: FloatArray,
    power: FloatArray,
    center: FloatArray,
    center_mu: float,
    step: float,
    step_mu: float,
    least_mu: float,
    budget_w: float,
    tolerance: float,
    sweeps: int,
    weight: FloatArray,
    price: FloatArray,
    work: IntArray,
) -> tuple[float, float, float]:
    """The proximal step of the module's docstring, to within ``tolerance``; returns μ, m there, and how exact that is.

    Args:
        begin: where each user's sets begin, shape (user + 1,).
        first, member: where each set begins in the list of columns, shape (set + 1,), and that list.
        utility, power: U and P in W of each set, shape (set,).
        center, center_mu: π̂, shape (column,), and μ̂.
        step, step_mu: t and t_μ; the latter 0 without a budget.
        least_mu, budget_w: q and P.
        tolerance, sweeps: where to stop.
        weight: x to start from, shape (set,), each user's adding up to 1; overwritten.
        price: written, π, shape (column,).
        work: steps done and to do; see :mod:`.work_kernel`.
    """  # fmt: skip
    load = np.empty(center.size)
    mark = np.zeros(center.size, dtype=np.int64)
    taken_w = load_of(first, member, power, weight, load)
    price[:] = np.maximum(center + step * (load - 1.0), 0.0)
    mu = max(center_mu + step_mu * (taken_w - budget_w), least_mu) if step_mu > 0.0 else center_mu
    gap, worth = np.inf, 0.0
    for sweep in range(sweeps):
        gap, worth = 0.0, 0.0
        for k in range(begin.size - 1):
            _, _, most, _, mean = best_and_worst(
                begin[k], begin[k + 1], first, member, utility, power, weight, price, mu
            )  # fmt: skip
            gap += most - mean
            worth += most
        if gap <= tolerance or sweep == sweeps - 1 or is_over(work):
            break
        for k in range(begin.size - 1):
            for _ in range(MOVES):
                best, worst, most, least, _ = best_and_worst(
                    begin[k], begin[k + 1], first, member, utility, power, weight, price, mu
                )  # fmt: skip
                if best == worst or not most > least:
                    break
                extra_w = power[best] - power[worst]
                bend = step * differing(first, member, best, worst, mark) + step_mu * extra_w * extra_w
                moved = min(weight[worst], (most - least) / bend) if bend > 0.0 else weight[worst]
                move_weight(first, member, center, step, worst, best, moved, weight, load, price)
                if step_mu > 0.0:
                    taken_w += moved * extra_w
                    mu = max(center_mu + step_mu * (taken_w - budget_w), least_mu)
    value = worth + price.sum()
    if step_mu > 0.0:
        value += (mu - least_mu) * budget_w
    return mu, value, gap
