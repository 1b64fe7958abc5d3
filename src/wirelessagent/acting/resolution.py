"""Power in the steps that a base station can set: rounded up as it is written, and no more than is allowed.

A decision has the power that it was proven with. Rounded to the nearest step, a promised rate would be short by a part
in some thousands, which is no fault of anybody; so power is rounded up, to the next step. Where that would exceed the
budget or the cap of a subcarrier, the limit holds: a cap lies on the step below, and of the budget as many steps are
set as fit, for those first who would lose the largest part of a step. Whoever is rounded down loses less than a step on
each subcarrier, and reading back allows as much.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.rates import user_rate_bps

_ROUNDING = 1e-9
"""Part of a step by which a power may be off one and be on it."""


def settable_power_w(decision: Decision, step_w: float) -> FloatArray:
    """The decision's power (subcarrier,) in whole steps of ``step_w``, within its budget and caps."""
    if step_w <= 0.0:
        return decision.power_w
    problem, steps = decision.problem, decision.power_w / step_w
    caps = np.inf if problem.subcarrier_max_power_w is None else np.asarray(problem.subcarrier_max_power_w)
    down = np.floor(steps + _ROUNDING)
    up = np.minimum(np.ceil(steps - _ROUNDING), np.floor(caps / step_w + _ROUNDING))
    wanting = np.flatnonzero(up > down)
    spare = np.floor(problem.budget_w(decision.cell) / step_w + _ROUNDING) - np.minimum(up, down).sum()
    first = wanting[np.argsort(down[wanting] - steps[wanting], kind="stable")][: max(int(spare), 0)]
    found = np.minimum(up, down)
    found[first] += 1.0
    return found * step_w


def worth_of_a_step_bps(decision: Decision, step_w: float) -> FloatArray:
    """What a step less on each of its subcarriers takes from each user's rate, shape (user,), on the estimate.

    Zero where the decision does not tell what channel it was made for.
    """
    if step_w <= 0.0 or decision.estimate is None:
        return np.zeros(decision.rate_bps.shape)
    gain, less = decision.estimate.gain, np.maximum(decision.power_w - step_w, 0.0)
    full, reduced = (user_rate_bps(gain, decision.owner, power, decision.cell) for power in (decision.power_w, less))
    return full - reduced
