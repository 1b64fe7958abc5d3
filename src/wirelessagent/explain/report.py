"""Predicted beside achieved: what a decision promised and what the true channel gave."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.decision import Decision
from wirelessagent.model.metrics import LinkMetrics, jain_index, metrics_of_rates
from wirelessagent.model.objective import Objective
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.phrases import phrases
from wirelessagent.model.units import human, reliability

_FIGURES = (
    ("Sum rate", "sum_rate_bps", "bit/s"),
    ("Goodput", "goodput_bps", "bit/s"),
    ("Radiated power", "power_w", "W"),
    ("Energy efficiency", "energy_efficiency_bit_per_j", "bit/J"),
    ("Spectral efficiency", "spectral_efficiency_bps_per_hz", "bit/s/Hz"),
    ("Jain's fairness index", "jain_index", ""),
)


@dataclass(frozen=True, kw_only=True)
class Report:
    """A decision's metrics on the estimated channel and, where the truth is known, on the true one.

    Attributes:
        decision: what was decided.
        predicted: metrics on the estimated channel. Its rates are the promised ones; with an outage probability they
            are the mean ones, and its goodput is what is expected of the promises that are kept.
        achieved: metrics on the true channel; None where it is not known.
        missed_users: numbers of the users whose true rate fell short of the promise, counted from 0.
    """

    decision: Decision
    predicted: LinkMetrics
    achieved: LinkMetrics | None
    missed_users: tuple[int, ...]

    def figures(self) -> list[tuple[str, str, str]]:
        """(figure, predicted, achieved) as text, "–" where the truth is not known; the objective's own figure first."""
        rows = [
            (
                label,
                human(getattr(self.predicted, name), unit),
                "–" if self.achieved is None else human(getattr(self.achieved, name), unit),
            )
            for label, name, unit in _FIGURES
        ]
        rows = [*self._promises(), *rows]
        name = name_of_figure(self.decision)
        if not name:
            return rows
        achieved = "–" if self.achieved is None else self._worth(self.achieved)
        label = name[:1].upper() + name[1:] if name.isascii() else name  # a capital α reads as an A
        return [(label, self._worth(self.predicted), achieved), *rows]

    def _promises(self) -> list[tuple[str, str, str]]:
        """What is promised with which probability, beside how many promises were kept; nothing without an outage."""
        decision = self.decision
        if decision.problem.outage_probability is None:
            return []
        served = decision.rate_bps > 0
        kept = f"{int(served.sum()) - len(self.missed_users)} of {int(served.sum())} kept"
        label = f"Promised at {reliability(decision.problem.outage_probability)}"
        return [(label, human(float(decision.rate_bps.sum()), "bit/s"), "–" if self.achieved is None else kept)]

    def _worth(self, metrics: LinkMetrics) -> str:
        """The objective's value for these rates and power."""
        decision = self.decision
        assert isinstance(decision.problem.objective, Objective)
        weight = decision.problem.weights_of(decision.rate_bps.size)
        value = decision.problem.objective.value(metrics.user_rate_bps, metrics.power_w, decision.cell, weight)
        return human(value, decision.unit)

    def __str__(self) -> str:
        rows = [("", "predicted", "achieved"), *self.figures()]
        lines = [f"{label:22} {before:>16} {after:>16}" for label, before, after in rows]
        if self.achieved is not None:
            served = int(np.count_nonzero(self.decision.rate_bps > 0))
            rate = "promised" if self.decision.problem.promises_rates else "committed"
            lines.append(f"{len(self.missed_users)} of {served} served users missed their {rate} rate")
        return "\n".join(lines)


def report(decision: Decision, outcome: Outcome | None = None) -> Report:
    """The report of a decision and, if it was applied, of what the base station read back."""
    return Report(
        decision=decision,
        predicted=predicted_metrics(decision),
        achieved=None if outcome is None else _among_served(outcome.achieved, decision),
        missed_users=() if outcome is None else tuple(int(user) for user in np.flatnonzero(outcome.missed)),
    )


def cannot_be_served(decision: Decision) -> str:
    """One sentence on users without any rate, where that makes the decision worthless; empty where it does not."""
    objective = decision.problem.objective
    if decision.value != 0 or not isinstance(objective, Objective) or objective.measure == "power":
        return ""
    counts = decision.problem.weights_of(decision.rate_bps.size) > 0
    starved = np.flatnonzero(counts & (decision.rate_bps <= 0))
    if not starved.size:
        return ""
    left = f"{starved.size} user{'s' if starved.size > 1 else ''} cannot be served"
    served, size = int(np.count_nonzero(counts)), decision.problem.resource_block_group_size
    places, kind = -(-decision.owner.size // size), "subcarriers" if size == 1 else "resource-block groups"
    return f"{left}: there are {places} {kind} for {served} users" if places < served else left


def name_of_figure(decision: Decision, language: str = "en") -> str:
    """What the decision's value is called, as in "lowest rate"; empty where its unit says it all."""
    objective = decision.problem.objective
    names = objective.figure_name if isinstance(objective, Objective) else phrases()
    return (names.get(language) or names.get("en") or next(iter(names.values()), ("",)))[0]


def predicted_metrics(decision: Decision) -> LinkMetrics:
    """The decision's metrics on the channel that it was made for."""
    judged = decision.expected_rate_bps.size > 0
    rate = decision.expected_rate_bps if judged else decision.rate_bps
    kept = 1.0 - decision.outage if judged else 1.0
    metrics = metrics_of_rates(
        rate,
        goodput_bps=float((kept * decision.rate_bps).sum()),
        power_w=decision.total_power_w,
        num_subcarriers=decision.owner.size,
        cell=decision.cell,
    )
    served = _among_served(metrics, decision)
    assert served is not None
    return served


def _among_served(metrics: LinkMetrics | None, decision: Decision) -> LinkMetrics | None:
    """The metrics with the fairness of those users that are to be served: who is left out on purpose is not starved."""
    if metrics is None or decision.problem.users is None:
        return metrics
    rate = metrics.user_rate_bps
    return dataclasses.replace(metrics, jain_index=jain_index(rate[decision.problem.serves(rate.size)]))
