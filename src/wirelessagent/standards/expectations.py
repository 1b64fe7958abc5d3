"""A run as expectations with targets, which every standard writes in its own way.

A request becomes up to three kinds of expectation: the objective ("better than the current value", for no standard
knows a "maximise"), the power budget as a ceiling of energy, and the users' rates, one for all users who are promised
the same.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from wirelessagent.model.arrays import BoolArray
from wirelessagent.model.metrics import READ_BACK_TOLERANCE
from wirelessagent.model.units import percent
from wirelessagent.standards.baseline import baseline
from wirelessagent.standards.subject import (
    ENERGY_CONSUMPTION,
    USER_THROUGHPUT,
    Metric,
    State,
    Subject,
    objective_metric,
)

FLOOR = "throughput-floor-"
"""How the names of expectations of promised rates begin."""

Progress: TypeAlias = Literal["kept", "missed", "pending", "taken back", "impossible", "undecided"]
"""What became of a target: pending before anything is read back; taken back where it was applied and is not in effect
any more; impossible and undecided as the decision is."""


@dataclass(frozen=True, kw_only=True)
class Expectation:
    """One requirement and what became of it; figures in the metric's unit.

    Attributes:
        name: identifier within the intent.
        metric: what is measured.
        users: names of the users meant; empty where it is the cell as a whole.
        more_is_better: whether the metric is to be above ``wanted`` or below it.
        strict: whether ``wanted`` itself does not do.
        wanted: the figure to beat or to keep.
        baseline: what ``wanted`` is where it stands for the current value: "current value", or what stands for it.
        promised: the decision's figure; None where nothing was decided.
        achieved: what was read back; None where that is not known.
        progress: what became of it.
        reasons: why it is not kept, one sentence each.
        recommended: a figure that could be kept instead; None where none is known or needed.
    """

    name: str
    metric: Metric
    users: tuple[str, ...]
    more_is_better: bool
    strict: bool
    wanted: float
    progress: Progress
    baseline: str = ""
    promised: float | None = None
    achieved: float | None = None
    reasons: tuple[str, ...] = ()
    recommended: float | None = None


def expectations(subject: Subject) -> list[Expectation]:
    """What was asked for and what became of it, the objective first."""
    return [_objective(subject), *_ceiling(subject), *_floors(subject)]


def is_kept(found: Iterable[Expectation]) -> bool:
    """Whether all of them are."""
    return all(one.progress == "kept" for one in found)


def _objective(subject: Subject) -> Expectation:
    """Better than what was there before, or what stands for it."""
    metric = objective_metric(subject)
    than = baseline(subject, metric)
    users = _names(subject, subject.served) if metric.per_user else ()
    return _judged(
        subject, "objective", metric, subject.served, than.wanted,
        users=users, more=metric is not ENERGY_CONSUMPTION, strict=than.strict, baseline=than.called,
    )  # fmt: skip


def _ceiling(subject: Subject) -> list[Expectation]:
    """The power budget, where the request has one, as the energy that it allows to draw."""
    budget_w, needed = subject.decision.problem.max_power_w, subject.needed_power_w
    if budget_w is None:
        return []
    enough = None if needed is None or not np.isfinite(needed.at_most) else subject.energy_kwh(needed.at_most)
    return [
        _judged(
            subject, "energy-ceiling", ENERGY_CONSUMPTION, subject.served, subject.energy_kwh(budget_w),
            users=(), more=False, recommended=enough,
        )
    ]  # fmt: skip


def _floors(subject: Subject) -> list[Expectation]:
    """The rates that users were promised, one expectation for all who are promised the same."""
    problem, scaling = subject.decision.problem, subject.rate_scaling
    least = np.where(subject.served, problem.min_rates_bps(subject.served.size), 0.0)
    factor = scaling.at_least if scaling is not None and scaling.at_least > 0 else None  # no rate at all helps nobody
    found: list[Expectation] = []
    for number, rate in enumerate(np.unique(least[least > 0]), start=1):
        users, wanted = least == rate, float(rate) / 1e3
        recommended = None if factor is None else wanted * factor
        found.append(
            _judged(
                subject, f"{FLOOR}{number}", USER_THROUGHPUT, users, wanted,
                users=_names(subject, users), more=True, recommended=recommended,
            )
        )  # fmt: skip
    return found


def _judged(
    subject: Subject,
    name: str,
    metric: Metric,
    meant: BoolArray,
    wanted: float,
    *,
    users: tuple[str, ...],
    more: bool,
    strict: bool = False,
    baseline: str = "",
    recommended: float | None = None,
) -> Expectation:
    promised, achieved = subject.promised(), subject.achieved()
    value = None if achieved is None else metric.of(subject, achieved, meant)
    progress, reasons = _progress(subject, value, wanted, more=more, strict=strict)
    if progress == "missed" and achieved is not None and name.startswith(FLOOR):
        reasons = _missed(subject, achieved, meant, wanted)
    return Expectation(
        name=name,
        metric=metric,
        users=users,
        more_is_better=more,
        strict=strict,
        wanted=wanted,
        baseline=baseline,
        promised=None if promised is None else _finite(metric.of(subject, promised, meant)),
        achieved=_finite(value),
        progress=progress,
        reasons=reasons,
        recommended=recommended if progress == "impossible" else None,
    )


def _progress(
    subject: Subject, achieved: float | None, wanted: float, *, more: bool, strict: bool
) -> tuple[Progress, tuple[str, ...]]:
    decision = subject.decision
    if not decision.is_usable:
        return "impossible" if decision.status == "infeasible" else "undecided", (decision.reason,)
    if subject.taken_back:
        return "taken back", ("the allocation was applied, and taken back: it is not in effect",)
    if achieved is None:
        applied = "applied, but not measured" if subject.outcome is not None else "decided, but not applied"
        return "pending", (f"the allocation is {applied}",)
    sign = 1.0 if more else -1.0
    margin = sign * (achieved - wanted)
    if margin > 0 or (not strict and margin >= -READ_BACK_TOLERANCE * abs(wanted)):
        return "kept", ()
    kept = "not better than" if strict else ("below" if more else "above")
    return "missed", (f"{achieved:.6g} is {kept} {wanted:.6g}",)


def _missed(subject: Subject, achieved: State, meant: BoolArray, wanted: float) -> tuple[str, ...]:
    """Who fell short of a promised rate, in kbit/s, and by how much."""
    rate = achieved.rate_bps / 1e3
    short = np.flatnonzero(meant & (rate < wanted * (1 - READ_BACK_TOLERANCE)))
    names = subject.decision.user_names
    return tuple(
        f"{names[user]} gets {rate[user]:.6g} kbit/s, {percent(1 - rate[user] / wanted)} less than {wanted:.6g} kbit/s"
        for user in short
    )


def _finite(value: float | None) -> float | None:
    """None for what no document can hold, such as the utility −∞ of a user without any rate."""
    return value if value is not None and np.isfinite(value) else None


def _names(subject: Subject, users: BoolArray) -> tuple[str, ...]:
    return tuple(subject.decision.user_names[user] for user in np.flatnonzero(users))
