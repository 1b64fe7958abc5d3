"""The picture of a comparison shows each method's own figures, whatever they are."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.comparison import Comparison
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import human
from wirelessagent.pictures.canvas import Canvas
from wirelessagent.pictures.compare_picture import comparison_canvas, draw_comparison
from wirelessagent.pictures.method_names import readable
from wirelessagent.testing.channels import known, rayleigh_gain

pytestmark = pytest.mark.machine_code

CELL = wa.Cell(max_power_w=20)
SEVEN = ("dual", "exact", "greedy", "paper", "paper_inversion", "equal_power", "round_robin")


def compared(objective: str, methods=None, **limits) -> list[Comparison]:
    channel = known(rayleigh_gain(4, 12, seed=1)[0])
    return wa.compare(channel, wa.Problem(objective, **limits), CELL, methods)


def texts(panel) -> list[str]:
    return [text.get_text() for text in panel.axes.texts]


def marks(panel) -> dict[int, float]:
    """Where each row's mark is."""
    lines = [line for line in panel.axes.lines if line.get_markersize() == 8.0 and np.isfinite(line.get_xdata()[0])]
    return {int(line.get_ydata()[0]): float(line.get_xdata()[0]) for line in lines}


def legend(canvas: Canvas) -> list[str]:
    return [text.get_text() for one in canvas.figure.legends for text in one.get_texts()]


def test_marks_are_at_value_gap_and_time() -> None:
    found = compared("min_power", SEVEN, min_rate_bps=4e5)
    canvas = comparison_canvas(found)
    value, gap, time = (marks(panel) for panel in canvas.panels)
    usable = [row for row, one in enumerate(found) if one.decision.is_usable]
    bounds = [one.decision.bound for one in found]
    scale = found[0].decision.value / value[0]

    assert np.log10(scale) == pytest.approx(round(np.log10(scale)), abs=1e-9)
    assert sorted(value) == sorted(gap) == usable
    assert sorted(time) == list(range(7))
    for row in usable:
        assert value[row] * scale == pytest.approx(found[row].decision.value, rel=1e-12)
        if found[row].decision.gap > 1e-9:
            assert gap[row] == pytest.approx(100 * found[row].decision.gap, rel=1e-12)
    for row, one in enumerate(found):
        assert time[row] == pytest.approx(1e3 * one.time_s, rel=1e-12)
    assert any(label.startswith(f"no allocation is below {max(bounds) / scale:.4g} ") for label in legend(canvas))
    names = [label.get_text() for label in canvas.panels[0].axes.get_yticklabels()]
    assert names == [readable(name) for name in SEVEN]
    assert not any("_" in name for name in names)


def test_who_has_no_allocation_or_no_bound_is_said_to() -> None:
    canvas = comparison_canvas(compared("min_power", ["dual", "round_robin", "paper_scan"], min_rate_bps=1.5e6))
    assert texts(canvas.panels[0])[-2:] == ["undecided", "refused"]
    assert "no allocation" in legend(canvas)
    fair = comparison_canvas(compared("proportional_fairness", ["dual", "equal_power"]))
    assert texts(fair.panels[1])[-1] == "no bound"


def test_where_nothing_is_feasible_the_picture_says_why_and_what_it_would_take() -> None:
    found = compared("min_power", ["dual", "greedy", "paper_scan"], min_rate_bps=9e6)
    canvas = comparison_canvas(found)
    (said,) = (" ".join(text.split()) for text in texts(canvas.panels[0]))
    decision = found[0].decision
    assert decision.reason in said
    assert f"need at least {human(decision.needed_power_w.at_least, 'W')}" in said
    assert "times these rates" in said
    assert "dual: infeasible; greedy: infeasible; the paper's power scan: refused" in said


@pytest.mark.parametrize("objective", ["max_rate", "min_power", "max_energy_efficiency", "max_min_rate"])
def test_nothing_overlaps_and_nothing_is_outside(objective: str) -> None:
    limits = {"min_rate_bps": 3e5} if objective == "min_power" else {}
    canvas = comparison_canvas(compared(objective, **limits))
    canvas.figure.canvas.draw()
    for panel in canvas.panels:
        shown = [text for text in [*panel.axes.texts, panel.axes.title, panel.axes.xaxis.label] if text.get_text()]
        boxes = [text.get_window_extent() for text in shown]
        ticks = [one.get_window_extent() for one in panel.axes.get_xticklabels() if one.get_text()]
        for same in (boxes, ticks):
            for number, box in enumerate(same):
                assert not any(box.overlaps(other) for other in same[number + 1 :]), objective
        frame = canvas.figure.bbox
        assert all(frame.x0 <= box.x0 and box.x1 <= frame.x1 for box in boxes)


def test_values_far_apart_are_drawn_on_a_logarithmic_axis() -> None:
    found = compared("max_min_rate", ["dual", "greedy"])
    far = dataclasses.replace(found[1].decision, value=found[1].decision.value / 1e3)
    canvas = comparison_canvas([found[0], dataclasses.replace(found[1], decision=far)])
    assert canvas.panels[0].axes.get_xscale() == "log"
    assert comparison_canvas(found).panels[0].axes.get_xscale() == "linear"


def test_a_method_that_sends_nothing_is_drawn() -> None:
    found = compared("max_rate", ["dual"])
    nothing: Decision = dataclasses.replace(found[0].decision, value=0.0, bound=0.0, gap=0.0)
    assert marks(comparison_canvas([dataclasses.replace(found[0], decision=nothing)]).panels[0]) == {0: 0.0}


def test_where_all_refuse_there_is_nothing_to_draw(tmp_path: Path) -> None:
    with pytest.raises(wa.InputError, match="no decision to draw"):
        draw_comparison(compared("min_power", ["paper_scan"]), tmp_path / "compared.png")
