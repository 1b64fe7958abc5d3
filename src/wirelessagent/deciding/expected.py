"""The channel to count on where nothing is promised: uncertain gains by the mean rate that they carry.

A rate is concave in the gain, so that a gain of mean m carries less on average than a certain gain m would, the less
the more uncertain it is; whoever takes estimates at their face value prefers those that are unsure. With p the power
of each subcarrier if all get the same, an uncertain gain g counts as g̃ with

    ln(1 + p g̃/(Γ N0 B)) = E[ln(1 + p g/(Γ N0 B))],

and a decision made on g̃, with its value and its bound, speaks of mean rates under the posterior. That is exact at the
power p; where a subcarrier gets more, g̃ is a little too high for it, and a little too low where it gets less.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from wirelessagent.model.cell import Cell
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import normalised_gain


def counted_on(estimate: ChannelEstimate, problem: Problem, cell: Cell) -> ChannelEstimate:
    """The channel to decide on, as if it were certain: the estimate itself where it is, or where rates are promised."""
    objective = problem.objective
    is_power = isinstance(objective, Objective) and objective.measure == "power"
    if is_power or problem.promises_rates:
        return estimate
    uncertain = estimate.gain_variance > 0
    if not uncertain.any():
        return estimate
    power_w = problem.budget_w(cell) / estimate.num_subcarriers
    snr_per_gain = power_w * normalised_gain(np.ones(estimate.gain.shape), cell)
    gain = np.expm1(estimate.posterior.expected_log1p(snr_per_gain)) / snr_per_gain
    return dataclasses.replace(
        estimate,
        gain=np.where(uncertain, gain, estimate.gain),
        gain_variance=np.zeros(gain.shape),
        joint_posterior=None,
    )
