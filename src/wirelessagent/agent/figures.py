"""Decisions in one line, and runs side by side, in the operator's language."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from wirelessagent.agent.restating import goal_words
from wirelessagent.model.units import human, percent
from wirelessagent.telling.catalogue import called, message
from wirelessagent.telling.parts import name_of_figure
from wirelessagent.telling.reasons import power_in_words
from wirelessagent.telling.text_table import Table

if TYPE_CHECKING:
    from wirelessagent.agent.turn import Run


def side_by_side(runs: Sequence[tuple[str, Run]], language: str = "en") -> Table:
    """Runs beside each other: what each is worth, takes and keeps."""
    columns = [message(language, "label.figure"), *(called(language, name) for name, _ in runs)]
    cells = [_cells(run, language) for _, run in runs]
    known = [label for label in cells[0] if any(cell[label] != "–" for cell in cells)]
    rows = [(message(language, f"label.{label}"), *(cell[label] for cell in cells)) for label in known]
    return Table(title=message(language, "label.side_by_side"), columns=tuple(columns), rows=tuple(rows))


def _cells(run: Run, language: str) -> dict[str, str]:
    """The figures of one run by their labels; "–" for what there is not."""
    decision, objective = run.decision, run.decision.problem.objective
    assert not isinstance(objective, str)
    usable, need = decision.is_usable, decision.needed_power_w
    figure = name_of_figure(decision, language)
    served = decision.problem.serves(decision.rate_bps.size)
    value = human(decision.value, decision.unit)
    value = message(language, "label.with", value=value, beside=figure) if figure else value
    missed = "–" if run.outcome is None or run.outcome.achieved is None else str(int(run.outcome.missed.sum()))
    return {
        "objective": goal_words(objective.name, language),
        "status": message(language, f"status.{decision.status}"),
        "value": value if usable else "–",
        "bound": human(decision.bound, decision.unit),
        "gap": percent(decision.gap),
        "power": human(decision.total_power_w, "W") if usable else "–",
        "power_needed": "–" if need is None else power_in_words(need.at_least, language),
        "sum_rate_bps": human(float(decision.rate_bps.sum()), "bit/s") if usable else "–",
        "lowest_rate": human(float(decision.rate_bps[served].min()), "bit/s") if usable else "–",
        "users_served": str(int(np.count_nonzero(decision.rate_bps > 0))) if usable else "–",
        "promises_missed": missed,
    }
