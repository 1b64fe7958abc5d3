"""What is expected of a decision on the true channel; and what knowing every gain, or no groups, would have made."""

from __future__ import annotations

import dataclasses

import numpy as np

from wirelessagent import chain, plugins
from wirelessagent.model.decision import Decision
from wirelessagent.model.metrics import LinkMetrics, jain_index, metrics_of_rates
from wirelessagent.model.outcome import Outcome


def predicted_metrics(decision: Decision) -> LinkMetrics:
    """What is expected of the decision on the true channel, by what is known of it."""
    rate, carried = decision.rate_bps, np.ones(decision.rate_bps.size)
    if decision.expected_rate_bps.size:
        rate, carried = decision.expected_rate_bps, 1.0 - decision.outage
    elif decision.forecast is not None:
        rate, carried = decision.forecast.mean_bps, decision.forecast.carried
    metrics = metrics_of_rates(
        rate,
        goodput_bps=float((carried * decision.committed_bps).sum()),
        power_w=decision.total_power_w,
        num_subcarriers=decision.owner.size,
        cell=decision.cell,
    )
    served = among_served(metrics, decision)
    assert served is not None
    return served


def among_served(metrics: LinkMetrics | None, decision: Decision) -> LinkMetrics | None:
    """The metrics with the fairness of those users that are to be served: who is left out on purpose is not starved."""
    if metrics is None or decision.problem.users is None:
        return metrics
    return dataclasses.replace(metrics, jain_index=jain_index(metrics.user_rate_bps[decision.served]))


def with_perfect_knowledge(decision: Decision, outcome: Outcome) -> Decision | None:
    """The decision on the true channel; None where that is not known, was known, or carries no such decision."""
    estimate, truth = decision.estimate, outcome.true_gain
    if estimate is None or truth is None or np.array_equal(estimate.gain, truth):
        return None
    registered = {one.name for one in plugins.plugins("method")}
    made = chain.decide(
        chain.certain(truth, estimate.user_names),
        decision.problem,
        decision.cell,
        decision.method if decision.method in registered else None,
    )
    return made if made.is_usable else None


def ungrouped_bound(decision: Decision) -> float:
    """What nothing does better than if subcarriers were assigned one by one; NaN where they are, or it is not known."""
    if decision.problem.resource_block_group_size == 1 or decision.estimate is None or not decision.is_usable:
        return np.nan
    single = dataclasses.replace(decision.problem, resource_block_group_size=1)
    return chain.decide(decision.estimate, single, decision.cell, "dual", restarts=0).bound
