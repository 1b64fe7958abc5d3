"""A decision and its report as tables, in the operator's language."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.forecast import Forecast
from wirelessagent.model.units import human, percent, prefixed, probability, reliability
from wirelessagent.telling.catalogue import called, message
from wirelessagent.telling.reasons import power_in_words
from wirelessagent.telling.report import Report
from wirelessagent.telling.text_table import Table

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
    columns = ["user", "subcarriers", "power", firm, *([] if report.achieved is None else ["achieved_rate"])]
    given = decision.rate_bps if judged else decision.committed_bps
    rows: list[tuple[str, ...]] = []
    for user in np.flatnonzero((decision.rate_bps > 0) | (given > 0)).tolist():
        own = (decision.owner == user) & (decision.power_w > 0)
        row = [called(language, decision.user_names[user]), str(int(own.sum()))]
        row += [human(float(decision.power_w[own].sum()), "W"), human(float(given[user]), "bit/s")]
        rows.append((*row, *([] if report.achieved is None else [_achieved(report, language, user)])))
    sure = reliability(decision.problem.outage_probability or 0.0)
    return _table(language, "served_title", columns, rows, sure=sure)


def _achieved(report: Report, language: str, user: int) -> str:
    """A user's true rate, and by how much it falls short where it does."""
    assert report.achieved is not None
    achieved = human(report.achieved.user_rate_bps[user], "bit/s")
    if user not in report.missed_users:
        return achieved
    return message(language, "label.short", value=achieved, short=percent(_shortfall(report, user)))


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


def user_table(report: Report, estimate: ChannelEstimate | None = None, language: str = "en") -> Table:
    """Each user's subcarriers, power and rates: predicted, how sure, committed and achieved."""
    decision, forecast = report.decision, report.decision.forecast
    unsure, judged = forecast is not None, decision.expected_rate_bps.size > 0
    band = forecast is not None and any(
        "(" in _banded(forecast, user, rate) for user, rate in enumerate(report.predicted.user_rate_bps)
    )
    kind = "asked_for" if decision.problem.promises_rates else "committed"
    columns = [
        "user",
        "subcarriers",
        *([] if estimate is None else ["of_them_repaired"]),
        "power",
        *(["promised_at"] * judged),
        "predicted_band" if band else "predicted_rate",
        *([kind] * (unsure and not judged)),
        *([] if report.achieved is None else ["achieved_rate"]),
    ]
    rows = [_user(report, estimate, language, user) for user in range(len(decision.user_names))]
    sure = reliability(decision.problem.outage_probability or 0.0)
    return _table(language, "users_title", columns, rows, sure=sure)


def _user(report: Report, estimate: ChannelEstimate | None, language: str, user: int) -> tuple[str, ...]:
    """The row of one user in the columns of :func:`user_table`."""
    decision, forecast = report.decision, report.decision.forecast
    own = (decision.owner == user) & (decision.power_w > 0)
    judged = decision.expected_rate_bps.size > 0
    row = [called(language, decision.user_names[user]), str(int(own.sum()))]
    if estimate is not None:
        row.append(str(int((own & estimate.repaired[user]).sum())))
    row.append(human(float(decision.power_w[own].sum()), "W"))
    if judged:
        row.append(human(decision.rate_bps[user], "bit/s"))
    predicted = report.predicted.user_rate_bps[user]
    row.append(human(predicted, "bit/s") if forecast is None else _banded(forecast, user, predicted))
    if forecast is not None and not judged:
        rate, sure = decision.committed_bps[user], probability(float(forecast.carried[user]))
        row.append(
            message(language, "label.with", value=human(rate, "bit/s"), beside=sure)
            if rate > 0
            else human(rate, "bit/s")
        )
    if report.achieved is not None:
        row.append(_achieved(report, language, user))
    return tuple(row)


def _shortfall(report: Report, user: int) -> float:
    """By how much a user's true rate falls short of the committed one, as a share."""
    assert report.achieved is not None
    return float(1 - report.achieved.user_rate_bps[user] / report.decision.committed_bps[user])


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
