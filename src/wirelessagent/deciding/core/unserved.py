"""Users for whom no subcarrier is left, where the objective is worthless unless everybody gets something.

Proportional fairness and the lowest rate are 0 as soon as one user is left out. Where that cannot be avoided the
optimum is 0, whatever the others get; they are then served as well as they can be without those users.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import HIGHEST_LEVEL, LEAST_POWER, MOST_EFFICIENCY, Program
from wirelessagent.deciding.core.rate_proof import one_each, usable_groups
from wirelessagent.model.arrays import BoolArray, IntArray


def without_unservable(form: NormalForm, program: Program) -> tuple[NormalForm, IntArray]:
    """The problem with weight 0 for users who cannot get a subcarrier beside the others, and who they are."""
    from wirelessagent.deciding.core.batch_kernel import all_servable

    needy = needy_users(form, program)
    nobody, wanting = np.empty(0, dtype=np.int64), needy | (form.promised_nats > 0)
    if not needy.any() or all_servable(form.snr_per_w[np.newaxis], form.start, wanting)[0]:
        return form, nobody
    usable = usable_groups(form)
    if np.all(one_each(usable & wanting[:, np.newaxis])[wanting] >= 0):
        return form, nobody
    served = form.promised_nats > 0
    unserved: list[int] = []
    for user in np.flatnonzero(needy & ~served):
        served[user] = True
        if np.any(one_each(usable & served[:, np.newaxis])[served] < 0):
            served[user] = False
            unserved.append(int(user))
    left = np.array(unserved, dtype=np.int64)
    weight = form.weight.copy()
    weight[left] = 0.0
    return dataclasses.replace(form, weight=weight), left


def needy_users(form: NormalForm, program: Program) -> BoolArray:
    """Users whose rate of zero makes the objective worthless, shape (user,)."""
    counts = form.weight > 0
    if program.goal in (LEAST_POWER, MOST_EFFICIENCY):
        return np.zeros(counts.shape, dtype=bool)
    if program.goal == HIGHEST_LEVEL:
        return counts
    with np.errstate(divide="ignore"):
        return counts & np.isneginf(form.objective.utility(np.zeros(counts.shape)))
