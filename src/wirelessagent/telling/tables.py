"""A decision and its report as tables, in the operator's language."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TypeAlias

import numpy as np

from wirelessagent.model.arrays import BoolArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.forecast import Forecast
from wirelessagent.model.units import human, percent, prefixed, probability, reliability
from wirelessagent.telling.catalogue import called, message
from wirelessagent.telling.reasons import power_in_words
from wirelessagent.telling.report import Report
from wirelessagent.telling.text_table import Table

Cells: TypeAlias = dict[str, Callable[[int], str]]
"""What a table says of a user, by the head of the column."""

_ROUNDED_UP = 1.0005
"""So that what rounds to 1000 of a unit is 1 of the next."""


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
    cells: Cells = {
        **_cells(report, language),
        firm: lambda user: human(float(given[user]), "bit/s"),
        **_achieved(report, language),
    }
    served = np.flatnonzero((decision.rate_bps > 0) | (given > 0))
    return _of_users(language, "served_title", cells, served.tolist(), decision)


def user_table(report: Report, estimate: ChannelEstimate | None = None, language: str = "en") -> Table:
    """Each user's subcarriers, power and rates: predicted, how sure, committed and achieved."""
    decision, forecast = report.decision, report.decision.forecast
    predicted, judged = report.predicted.user_rate_bps, decision.expected_rate_bps.size > 0
    cells = _cells(report, language, estimate)
    if judged:
        cells["promised_at"] = lambda user: human(decision.rate_bps[user], "bit/s")
    if forecast is None:
        cells["predicted_rate"] = lambda user: human(predicted[user], "bit/s")
    else:
        banded = [_banded(forecast, user, rate) for user, rate in enumerate(predicted)]
        cells["predicted_band" if any("(" in rate for rate in banded) else "predicted_rate"] = banded.__getitem__
        if not judged:
            kind = "asked_for" if decision.problem.promises_rates else "committed"
            cells[kind] = lambda user: _committed(decision, forecast, language, user)
    cells |= _achieved(report, language)
    return _of_users(language, "users_title", cells, range(len(decision.user_names)), decision)


def _cells(report: Report, language: str, estimate: ChannelEstimate | None = None) -> Cells:
    """What each table of users begins with."""
    decision = report.decision
    cells: Cells = {
        "user": lambda user: called(language, decision.user_names[user]),
        "subcarriers": lambda user: str(int(_own(decision, user).sum())),
    }
    if estimate is not None:
        cells["of_them_repaired"] = lambda user: str(int((_own(decision, user) & estimate.repaired[user]).sum()))
    return {**cells, "power": lambda user: human(float(decision.power_w[_own(decision, user)].sum()), "W")}


def _committed(decision: Decision, forecast: Forecast, language: str, user: int) -> str:
    """A user's committed rate and, where there is one, how surely it is kept."""
    rate, sure = human(decision.committed_bps[user], "bit/s"), probability(float(forecast.carried[user]))
    return message(language, "label.with", value=rate, beside=sure) if decision.committed_bps[user] > 0 else rate


def _achieved(report: Report, language: str) -> Cells:
    """A user's true rate, and by how much it falls short where it does; nothing where the truth is not known."""
    achieved, committed = report.achieved, report.decision.committed_bps
    if achieved is None:
        return {}

    def cell(user: int) -> str:
        rate = human(achieved.user_rate_bps[user], "bit/s")
        if user not in report.missed_users:
            return rate
        short = percent(float(1 - achieved.user_rate_bps[user] / committed[user]))
        return message(language, "label.short", value=rate, short=short)

    return {"achieved_rate": cell}


def _own(decision: Decision, user: int) -> BoolArray:
    return (decision.owner == user) & (decision.power_w > 0)


def _of_users(language: str, title: str, cells: Cells, users: Iterable[int], decision: Decision) -> Table:
    """A table with a row for each of these users, a column for each kind of cell."""
    rows = [tuple(cell(user) for cell in cells.values()) for user in users]
    return _table(language, title, tuple(cells), rows, sure=reliability(decision.problem.outage_probability or 0.0))


def figures_of_infeasibility(decision: Decision, language: str = "en") -> Table:
    """What the request would need and what could be had, each from both sides."""
    rows: list[tuple[str, ...]] = []
    if decision.needed_power_w is not None:
        need, label = decision.needed_power_w, message(language, "label.power_of_rates")
        rows.append((label, *(power_in_words(one, language) for one in (need.at_least, need.at_most))))
    if decision.rate_scaling is not None:
        scale, label = decision.rate_scaling, message(language, "label.scaling_of_rates")
        rows.append((label, *(f"{one:.3g}" if one else "–" for one in (scale.at_least, scale.at_most))))
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
