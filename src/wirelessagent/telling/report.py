"""Predicted beside achieved: what a decision promised, what the true channel gave, and what not knowing it cost.

And the tables that people want to see of both, in the operator's language.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, ClassVar, TypeAlias

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.forecast import Forecast
from wirelessagent.model.metrics import LinkMetrics
from wirelessagent.model.objective import Objective
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.shown import Picture, Shown, Summary
from wirelessagent.model.units import human, percent, prefixed, probability, reliability
from wirelessagent.telling.catalogue import Table, called, capital, message
from wirelessagent.telling.facts.case import (
    among_served,
    in_use,
    objective_of,
    predicted_metrics,
    ungrouped_bound,
    with_perfect_knowledge,
)
from wirelessagent.telling.parts import goal_words, name_of_figure, power_in_words

Columns: TypeAlias = dict[str, list[str]]
"""What a table says of each user, by the head of the column."""

_FIGURES = (
    ("sum_rate_bps", "bit/s"),
    ("goodput_bps", "bit/s"),
    ("power_w", "W"),
    ("energy_efficiency_bit_per_j", "bit/J"),
    ("spectral_efficiency_bps_per_hz", "bit/s/Hz"),
    ("jain_index", ""),
)
_ROUNDED_UP = 1.0005
"""So that what rounds to 1000 of a unit is 1 of the next."""


@dataclass(frozen=True, kw_only=True, repr=False)
class Report(Shown):
    """A decision's metrics on the estimated channel and, where the truth is known, on the true one.

    Attributes:
        decision: what was decided.
        predicted: what is expected: the mean rates under the estimate's posterior, and of the committed ones what is
            expected to arrive. Where nothing is uncertain these are the decision's rates.
        achieved: metrics on the true channel; None where it is not known.
        missed_users: numbers of the users whose true rate fell short of the commitment, counted from 0.
        perfect: what would have been decided, and achieved, with every gain known; None where the truth is not known,
            or was.
        ungrouped_bound: what nothing does better than where subcarriers are assigned one by one; NaN where they are.
    """

    decision: Decision
    predicted: LinkMetrics
    achieved: LinkMetrics | None
    missed_users: tuple[int, ...]
    perfect: Decision | None = None
    ungrouped_bound: float = np.nan

    @property
    def regret(self) -> float:
        """What not knowing cost, as a share of the objective's value with perfect knowledge; NaN where that is unknown.

        Of a maximum it is the share that the achieved value lies below it, of the least power the share above it. It is
        negative where power was saved at the price of promises. Commitments that the channel did not carry are not in
        it, since the value counts true rates; see :attr:`goodput_regret`.
        """
        if self.perfect is None or self.achieved is None or not self.perfect.value:
            return np.nan
        ratio = self._value(self.achieved) / self.perfect.value
        return ratio - 1.0 if self.objective.direction == "min" else 1.0 - ratio

    @property
    def goodput_regret(self) -> float:
        """The share by which what arrives of the committed rates lies below the sum rate with perfect knowledge."""
        if self.perfect is None or self.achieved is None or not self.perfect.rate_bps.any():
            return np.nan
        return 1.0 - self.achieved.goodput_bps / float(self.perfect.rate_bps.sum())

    def figures(self, language: str = "en") -> list[tuple[str, ...]]:
        """(figure, predicted, achieved) as text, "–" where the truth is not known; the objective's own figure first.

        Where perfect knowledge would have decided otherwise, what it would have achieved comes last.
        """
        known = [self.predicted, self.achieved, *([] if self.perfect is None else [predicted_metrics(self.perfect)])]

        def row(label: str, figure: Callable[[LinkMetrics], float], unit: str) -> tuple[str, ...]:
            return label, *("–" if one is None else human(figure(one), unit) for one in known)

        named = bool(name_of_figure(self.decision, language))
        return [
            *([row(self._own_label(language), self._value, self.decision.unit)] if named else []),
            *self._decided(language),
            *self._promises(language),
            *(row(message(language, f"label.{name}"), attrgetter(name), unit) for name, unit in _FIGURES),
        ]

    def _own_label(self, language: str) -> str:
        """What the objective's own figure is called in a table."""
        figures = {"power": "power_w", "efficiency": "energy_efficiency_bit_per_j"}
        plain = figures.get(self.objective.measure, "sum_rate_bps")
        name = name_of_figure(self.decision, language) or message(language, f"label.{plain}")
        return capital(name) if name.isascii() else name  # a capital α reads as an A

    def _decided(self, language: str) -> list[tuple[str, ...]]:
        """The value that the decision was made for, where what is expected of the true channel shows another one."""
        decision, promised = self.decision, self.decision.expected_rate_bps.size > 0
        value = human(decision.value, decision.unit)
        told_by_promises = promised and not name_of_figure(decision, language) and decision.unit == "bit/s"
        if not decision.is_usable or told_by_promises or value == human(self._value(self.predicted), decision.unit):
            return []
        key = "label.at_promised" if promised else "label.as_decided"
        perfect = () if self.perfect is None else (human(self.perfect.value, self.perfect.unit),)
        return [(message(language, key, figure=self._own_label(language)), value, "–", *perfect)]

    def _promises(self, language: str) -> list[tuple[str, ...]]:
        """What is promised with which probability, beside how many promises were kept; nothing without an outage."""
        decision = self.decision
        if decision.problem.outage_probability is None:
            return []
        count, kept = int((decision.rate_bps > 0).sum()), "–"
        if self.achieved is not None:
            kept = message(language, "label.kept_of", kept=count - len(self.missed_users), served=count)
        label = message(language, "label.promised_at_head", sure=reliability(decision.problem.outage_probability))
        made = [decision] if self.perfect is None else [decision, self.perfect]
        promised, *perfect = (human(float(one.rate_bps.sum()), "bit/s") for one in made)
        return [(label, promised, kept, *perfect)]

    def _value(self, metrics: LinkMetrics) -> float:
        """The objective's value for these rates and power."""
        weight = self.decision.problem.weights_of(self.decision.rate_bps.size)
        return self.objective.value(metrics.user_rate_bps, metrics.power_w, self.decision.cell, weight)

    @property
    def objective(self) -> Objective:
        """What was decided for."""
        return objective_of(self.decision)

    _derived: ClassVar[tuple[str, ...]] = ("regret", "goodput_regret")

    @property
    def _head(self) -> tuple[str, ...]:
        return ("", "predicted", "achieved", *([] if self.perfect is None else ["all gains known"]))

    def summary(self) -> Summary:
        title = f"Report: {self._missed() or f'a decision that is {self.decision.status}'}"
        return Summary(title=title, header=self._head, rows=tuple(self.figures()))

    def picture(self) -> Picture:
        parts = {"decision": self.decision, "achieved": self.achieved, "missed_users": self.missed_users}
        return Picture(kind="rates", parts=parts)

    def columns(self) -> Mapping[str, Any]:
        """One row for each user; no rate achieved where that is not known."""
        decision, users = self.decision, np.arange(self.decision.rate_bps.size)
        columns = {
            "user": list(decision.user_names),
            "min_rate_bps": decision.problem.min_rates_bps(users.size),
            "predicted_bps": self.predicted.user_rate_bps,
            "committed_bps": decision.committed_bps,
        }
        if self.achieved is None:
            return columns
        missed = np.isin(users, self.missed_users)
        return {**columns, "achieved_bps": self.achieved.user_rate_bps, "missed": missed}

    def _missed(self) -> str:
        """How many users missed their rates; empty where that is not known."""
        if self.achieved is None:
            return ""
        served = int(np.count_nonzero(self.decision.committed_bps > 0))
        firmness = self.decision.problem.firmness
        rate = "the rate asked for" if firmness == "asked" else f"their {firmness} rate"
        return f"{len(self.missed_users)} of {served} served users missed {rate}"

    def __str__(self) -> str:
        rows = (self._head, *self.figures())
        lines = [f"{label:22}" + "".join(f" {one:>16}" for one in rest) for label, *rest in rows]
        return "\n".join([*lines, *filter(None, [self._missed()])])


def report(decision: Decision, outcome: Outcome | None = None) -> Report:
    """The report of a decision and, if it was applied, of what the base station read back.

    Where the base station knows the true channel and the decision did not, the report also has what the method, with
    its default options, would have decided with every gain known.
    """
    achieved = None if outcome is None else outcome.achieved
    return Report(
        decision=decision,
        predicted=predicted_metrics(decision),
        achieved=None if achieved is None else among_served(achieved, decision),
        missed_users=() if outcome is None else tuple(int(user) for user in np.flatnonzero(outcome.missed)),
        perfect=None if outcome is None else with_perfect_knowledge(decision, outcome),
        ungrouped_bound=ungrouped_bound(decision),
    )


def decision_tables(report: Report, estimate: ChannelEstimate | None, language: str = "en") -> list[Table]:
    """What people want to see of a decision: users and figures, or what it would take where it cannot be done."""
    if report.decision.is_usable:
        return [user_table(report, estimate, language), report_table(report, language)]
    return [figures_of_infeasibility(report.decision, language)]


def served_table(report: Report, language: str = "en") -> Table:
    """What the users get who are served, in few columns."""
    decision, judged = report.decision, report.decision.expected_rate_bps.size > 0
    firm = "promised_at" if judged else "committed_rate" if decision.forecast is not None else "predicted_rate"
    given = decision.rate_bps if judged else decision.committed_bps
    served = np.flatnonzero((decision.rate_bps > 0) | (given > 0))
    columns = {**_holdings(report, language), firm: _rates(given)}
    return _of_users(report, language, "served_title", columns, served.tolist())


def user_table(report: Report, estimate: ChannelEstimate | None = None, language: str = "en") -> Table:
    """Each user's subcarriers, power and rates: predicted, how sure, committed and achieved."""
    decision, forecast = report.decision, report.decision.forecast
    predicted, judged = report.predicted.user_rate_bps, decision.expected_rate_bps.size > 0
    columns = _holdings(report, language, estimate)
    if judged:
        columns["promised_at"] = _rates(decision.rate_bps)
    if forecast is None:
        columns["predicted_rate"] = _rates(predicted)
    else:
        banded = [_banded(forecast, user, rate) for user, rate in enumerate(predicted)]
        columns["predicted_band" if any("(" in rate for rate in banded) else "predicted_rate"] = banded
        if not judged:
            kind = "asked_for" if decision.problem.promises_rates else "committed"
            columns[kind] = told = _rates(decision.committed_bps)
            for user in np.flatnonzero(decision.committed_bps > 0).tolist():
                sure = probability(float(forecast.carried[user]))
                told[user] = message(language, "label.with", value=told[user], beside=sure)
    return _of_users(report, language, "users_title", columns, range(len(decision.user_names)))


def _holdings(report: Report, language: str, estimate: ChannelEstimate | None = None) -> Columns:
    """What each table of users begins with."""
    decision, users = report.decision, report.decision.user_names
    own = [np.flatnonzero(in_use(decision) == user) for user in range(len(users))]
    columns = {"user": [called(language, name) for name in users], "subcarriers": [str(some.size) for some in own]}
    if estimate is not None:
        repaired = [int(estimate.repaired[user, some].sum()) for user, some in enumerate(own)]
        columns["of_them_repaired"] = [str(count) for count in repaired]
    return {**columns, "power": [human(float(decision.power_w[some].sum()), "W") for some in own]}


def _rates(rate_bps: FloatArray) -> list[str]:
    return [human(rate, "bit/s") for rate in rate_bps.tolist()]


def _of_users(report: Report, language: str, title: str, columns: Columns, users: Iterable[int]) -> Table:
    """A table with a row for each of these users, and each one's true rate and what it lacks, where that is known."""
    if report.achieved is not None:
        rate_bps, told = report.achieved.user_rate_bps, _rates(report.achieved.user_rate_bps)
        for user in report.missed_users:
            short = percent(float(1 - rate_bps[user] / report.decision.committed_bps[user]))
            told[user] = message(language, "label.short", value=told[user], short=short)
        columns = {**columns, "achieved_rate": told}
    rows = [tuple(column[user] for column in columns.values()) for user in users]
    sure = reliability(report.decision.problem.outage_probability or 0.0)
    return _table(language, title, tuple(columns), rows, sure=sure)


def figures_of_infeasibility(decision: Decision, language: str = "en") -> Table:
    """What the request would need and what could be had, each from both sides."""
    rows, need, scale = list[tuple[str, ...]](), decision.needed_power_w, decision.rate_scaling
    if need is not None:
        powers = (power_in_words(one, language) for one in (need.at_least, need.at_most))
        rows.append((message(language, "label.power_of_rates"), *powers))
    if scale is not None:
        factors = (f"{one:.3g}" if one else "–" for one in (scale.at_least, scale.at_most))
        rows.append((message(language, "label.scaling_of_rates"), *factors))
    return _table(language, "needed_title", ("figure", "at_least", "at_most"), rows)


def report_table(report: Report, language: str = "en") -> Table:
    """Figures of merit: predicted, achieved, and what knowing every gain would have achieved."""
    rows = report.figures(language)
    if report.achieved is None:
        certain = report.decision.forecast is None
        rows = [row[:2] for row in rows if not (certain and row[0] == message(language, "label.goodput_bps"))]
        return _table(language, "predicted_title", ("figure", "predicted"), rows)
    columns = ("figure", "predicted", "achieved", *([] if report.perfect is None else ["all_gains_known"]))
    return _table(language, "achieved_title", columns, rows)


def side_by_side(reports: Sequence[tuple[str, Report]], language: str = "en") -> Table:
    """Decisions by their names beside each other: what each is worth, takes and keeps."""
    columns = [message(language, "label.figure"), *(called(language, name) for name, _ in reports)]
    cells = [_comparable(one, language) for _, one in reports]
    known = [label for label in cells[0] if any(cell[label] != "–" for cell in cells)]
    rows = [(message(language, f"label.{label}"), *(cell[label] for cell in cells)) for label in known]
    return Table(title=message(language, "label.side_by_side"), columns=tuple(columns), rows=tuple(rows))


def _comparable(report: Report, language: str) -> dict[str, str]:
    """The figures of one decision by their labels; "–" for what there is not."""
    decision, need = report.decision, report.decision.needed_power_w
    figure, value = name_of_figure(decision, language), human(decision.value, decision.unit)
    value = message(language, "label.with", value=value, beside=figure) if figure else value

    def met(cell: str) -> str:
        return cell if decision.is_usable else "–"

    return {
        "objective": goal_words(report.objective.name, language),
        "status": message(language, f"status.{decision.status}"),
        "value": met(value),
        "bound": human(decision.bound, decision.unit),
        "gap": percent(decision.gap),
        "power": met(human(decision.total_power_w, "W")),
        "power_needed": "–" if need is None else power_in_words(need.at_least, language),
        "sum_rate_bps": met(human(float(decision.rate_bps.sum()), "bit/s")),
        "lowest_rate": met(human(float(decision.rate_bps[decision.served].min()), "bit/s")),
        "users_served": met(str(int(np.count_nonzero(decision.rate_bps > 0)))),
        "promises_missed": "–" if report.achieved is None else str(len(report.missed_users)),
    }


def _banded(forecast: Forecast, user: int, rate_bps: float) -> str:
    """A rate with its band, as in "1.21 (1.1–1.3) Mbit/s"; the rate alone where the band does not show."""
    scale, unit = prefixed(rate_bps * _ROUNDED_UP, "bit/s")
    low, rate, high = (f"{one / scale:.3g}" for one in (forecast.low_bps[user], rate_bps, forecast.high_bps[user]))
    return f"{rate} {unit}" if low == high else f"{rate} ({low}–{high}) {unit}"


def _table(
    language: str, title: str, columns: Sequence[str], rows: Sequence[tuple[str, ...]], **places: object
) -> Table:
    heads = tuple(message(language, f"label.{column}", **places) for column in columns)
    return Table(title=message(language, f"label.{title}"), columns=heads, rows=tuple(rows))
