"""Entries that are missing because they are weak: what their absence says of them.

Where a measurement fails the more often the weaker the gain, P(missing | g) = p e^(−s g) for a gain in units of its
user's level, absence is evidence. A coefficient h = ν + e with e ~ CN(0, c) keeps its family: times e^(−s|h|²) its
density is that of ν/(1 + sc) and c/(1 + sc). How strong the selection is, the pattern itself says: a missing entry has
the likelihood p E[e^(−s g)] = p/(1 + sc) · e^(−sν²/(1 + sc)), an observed one 1 − p e^(−s g), both with the likeliest
p. Losses have nothing to do with gains unless that is far likelier (``INNOCENT``), and strengths are averaged.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray

WEAKEST, STRENGTHS = 0.5, 4
"""The smallest strength s of a selection, and how many there are, each twice the one before."""
INNOCENT = 0.9
"""Chance that losses have nothing to do with gains, before anything is seen; the strengths share the rest."""
NEGLIGIBLE = 1e-3
"""Chance of a selection below which nothing is changed."""
ENTRIES = 512
"""How many entries are asked for the strength, at most, evenly over the matrix."""
STEPS, SETTLED = 30, 1e-4
"""Most Newton steps for p, each kept within (0, 1), and the step that ends them."""
TOGETHER = 16
"""Factors multiplied before the logarithm is taken."""


@kernel
def likeliest_share(hazard: FloatArray, gone: int) -> float:
    """The p that maximises gone · ln p + Σ ln(1 − p hazard), for hazards in (0, 1]."""
    low, high = 0.0, 1.0
    p = gone / (gone + hazard.sum())
    for _ in range(STEPS):
        slope, curve = gone / p, -gone / p**2
        for h in hazard:
            odds = h / (1.0 - p * h)
            slope -= odds
            curve -= odds * odds
        if slope > 0.0:
            low = p
        else:
            high = p
        following = p - slope / curve
        following = following if low < following < high else 0.5 * (low + high)
        step, p = abs(following - p), following
        if step < SETTLED * p:
            break
    return p


@kernel
def log_kept(hazard: FloatArray, p: float) -> float:
    """Σ ln(1 − p hazard)."""
    total, product = 0.0, 1.0
    for i in range(hazard.size):
        product *= 1.0 - p * hazard[i]
        if i % TOGETHER == TOGETHER - 1:
            total += np.log(product)
            product = 1.0
    return total + np.log(product)


@kernel
def weigh_strengths(
    gain: FloatArray, variance: FloatArray, level: FloatArray, missing: BoolArray, chance: FloatArray
) -> None:
    """Write how likely no selection and each strength are into ``chance`` (1 + STRENGTHS,)."""
    width, size = gain.shape[1], gain.size
    stride = -(-size // ENTRIES)
    stride += stride > 1 and width % stride == 0  # else it would be the same subcarriers of every user
    hazard, known, unknown = np.empty((3, -(-size // stride)))
    count, gone = 0, 0
    for at in range(0, size, stride):
        k, n = at // width, at % width
        if level[k] <= 0.0:
            continue
        g, v = gain[k, n] / level[k], variance[k, n] / level[k] / level[k]
        if not missing[k, n]:
            hazard[count] = np.exp(-WEAKEST * g)
            count += 1
        elif 0.0 < v < g * g:
            unknown[gone] = g - np.sqrt(g * g - v)
            known[gone] = g - unknown[gone]
            gone += 1
    if count == 0 or gone == 0:
        chance[:] = 0.0
        chance[0] = 1.0
        return
    chance[0] = gone * np.log(gone / (gone + count)) + count * np.log(count / (gone + count))
    s = WEAKEST
    for i in range(1, chance.size):
        p = likeliest_share(hazard[:count], gone)
        chance[i] = gone * np.log(p) + log_kept(hazard[:count], p)
        for m in range(gone):
            grown = 1.0 + s * unknown[m]
            chance[i] -= np.log(grown) + s * known[m] / grown
        hazard[:count] *= hazard[:count]
        s *= 2.0
    chance[:] = np.exp(chance - chance.max())
    chance[0] *= INNOCENT
    chance[1:] *= (1.0 - INNOCENT) / STRENGTHS
    chance /= chance.sum()


@kernel
def allow_for_absence(gain: FloatArray, variance: FloatArray, level: FloatArray, missing: BoolArray) -> None:
    """Overwrite mean and variance (user, subcarrier) of missing entries with those given that they are missing.

    ``level`` (user,) is in the unit of the gain. Entries that are certain, and those of users whose level is hardly
    known, stay as they are.
    """
    chance = np.empty(1 + STRENGTHS)
    weigh_strengths(gain, variance, level, missing, chance)
    if chance[0] > 1.0 - NEGLIGIBLE:
        return
    for k in range(gain.shape[0]):
        for n in range(gain.shape[1]):
            if not missing[k, n] or level[k] <= 0.0:
                continue
            g, v = gain[k, n] / level[k], variance[k, n] / level[k] / level[k]
            if not 0.0 < v < g * g:
                continue
            unknown = g - np.sqrt(g * g - v)
            known, first, second, s = g - unknown, 0.0, 0.0, 0.0
            for i in range(chance.size):
                grown = 1.0 + s * unknown
                c = unknown / grown
                m = known / grown**2 + c
                first += chance[i] * m
                second += chance[i] * (2.0 * m * c - c**2 + m**2)
                s = WEAKEST if i == 0 else 2.0 * s
            gain[k, n], variance[k, n] = level[k] * first, level[k] * (level[k] * (second - first**2))
