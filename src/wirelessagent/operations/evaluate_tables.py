"""The tables of evaluations as people read them: a table for each channel and loss, a row for each method."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from wirelessagent.experiments.evaluate_decision import OBJECTIVES
from wirelessagent.experiments.evaluation import rows_of
from wirelessagent.experiments.table import Table as Figures
from wirelessagent.operations.record import Table


def repair_tables(table: Figures) -> list[Table]:
    columns = ("method", "RMSE / level", "in dB", "to the best", "to the oracle", "90 % holds, %", "below 5 %, %", "ms")

    def cells(row: dict[str, Any]) -> tuple[str, ...]:
        best, oracle, rmse = (_figure(row, name) for name in ("ratio_to_best", "ratio_to_oracle", "rmse"))
        holds = _figure(row, "coverage_90", percent=True)
        return (
            row["method"], rmse, _short(row["rmse_db"]), best, oracle, holds, _share(row, "below_5"),
            _short(row["time_ms"]),
        )  # fmt: skip

    return _by_case(table, columns, cells)


def decision_tables(table: Figures) -> list[Table]:
    reached = ("method", "goodput, %", "choice", "not carried", "caution", "prop. fair, %", "smallest, %")
    promised = ("method", "missed, %", "of repaired, %", "power", "refused, %")

    def reaches(row: dict[str, Any]) -> tuple[str, ...]:
        goodput, *fair = (_figure(row, f"{name}_share", percent=True) for name in OBJECTIVES)
        caution = 1.0 - row["goodput_share"] - row["choice_share"] - row["not_carried_share"]
        lost = *(f"−{_share(row, name)}" for name in ("choice_share", "not_carried_share")), f"−{100.0 * caution:.1f}"
        return (row["method"], goodput, *lost, *fair)

    def promises(row: dict[str, Any]) -> tuple[str, ...]:
        missed = (_figure(row, name, percent=True) for name in ("missed_share", "missed_of_resting_share"))
        return (row["method"], *missed, _figure(row, "power_ratio"), _share(row, "refused_share"))

    pairs = zip(
        _by_case(table, reached, reaches, ": reached"), _by_case(table, promised, promises, ": promises"), strict=True
    )
    return [one for pair in pairs for one in pair]


def _figure(row: dict[str, Any], column: str, *, percent: bool = False) -> str:
    """A figure with its interval: "0.238 (0.231–0.245)"; of what a method is compared to itself, the figure alone."""
    values = [row[f"{column}{end}"] for end in ("", "_low", "_high")]
    if values[0] is None:
        return "–"
    shown = [f"{100.0 * value:.1f}" if percent else _short(value) for value in values if value is not None]
    return f"{shown[0]} ({shown[1]}–{shown[2]})" if len(shown) == 3 and len(set(shown)) > 1 else shown[0]


def _short(value: float) -> str:
    """About three digits, without exponents.

    >>> _short(0.05678), _short(1.0423), _short(1234.5)
    ('0.0568', '1.04', '1,234')
    """
    decimals = 0 if value >= 100 else 1 if value >= 10 else 2 if value >= 1 else 3 if value >= 0.1 else 4
    return f"{value:,.{decimals}f}"


def _share(row: dict[str, Any], column: str) -> str:
    return "–" if row[column] is None else f"{100.0 * row[column]:.1f}"


def _by_case(
    table: Figures, columns: tuple[str, ...], cells: Callable[[dict[str, Any]], tuple[str, ...]], what: str = ""
) -> list[Table]:
    """A table of ``what`` for each channel and loss, a row for each method."""
    made: list[Table] = []
    for channel in table.values("channel"):
        for loss in table.where(channel=channel).values("loss"):
            rows = rows_of(table.where(channel=channel, loss=loss))
            title = f"{channel}, {loss}: {100.0 * rows[0]['missing_share']:.0f} % missing{what}"
            made.append(Table(title=title, columns=columns, rows=tuple(cells(row) for row in rows)))
    return made
