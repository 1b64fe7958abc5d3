"""The picture of a run shows what the run's objects say, for any shape, and is written whole or not at all."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from wirelessagent.deciding.objectives.max_rate import MaxRate
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Bracket, Decision
from wirelessagent.model.errors import InputError, MissingDependencyError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.metrics import link_metrics
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import normalised_gain, user_rate_bps
from wirelessagent.pictures.canvas import Canvas
from wirelessagent.pictures.chain_picture import chain_canvas, draw_chain

pytestmark = pytest.mark.machine_code

CELL = Cell()
WATER_LEVEL_W = 1.5


def a_run(
    num_users=8, num_subcarriers=20, *, loss=0.2, status="optimal", applied=True, min_rate_bps=None, user_names=(),
    cell=CELL, water_level_w=WATER_LEVEL_W,
):  # fmt: skip
    """The objects of a run with a true water level on random gains, by hand: pictures need no solver."""
    rng = np.random.default_rng(num_users * 1000 + num_subcarriers)
    truth = 1e-10 * rng.exponential(size=(num_users, num_subcarriers)) * 10.0 ** rng.uniform(-1, 1, (num_users, 1))
    holes = rng.random(truth.shape) < loss
    observation = ChannelObservation(gain=np.where(holes, np.nan, truth), user_names=user_names)
    estimate = ChannelEstimate.completing(observation, gain=1.3 * truth, gain_variance=np.square(truth), method="nncf")
    owner = estimate.gain.argmax(axis=0)
    power_w = np.maximum(water_level_w - 1.0 / normalised_gain(estimate.gain.max(axis=0), cell), 0.0)
    if status not in ("optimal", "feasible"):
        owner, power_w = np.full_like(owner, -1), np.zeros_like(power_w)
    rate = user_rate_bps(estimate.gain, owner, power_w, cell)
    decision = Decision(
        owner=owner, power_w=power_w, rate_bps=rate, status=status, value=1.0, bound=1.0, gap=0.0, unit="bit/s",
        method="dual", problem=Problem(MaxRate(), min_rate_bps=min_rate_bps), cell=cell,
        user_names=observation.user_names, reason="" if status in ("optimal", "feasible") else "needs at least 43.2 W",
    )  # fmt: skip
    outcome = None
    if applied and decision.is_usable:
        achieved = link_metrics(truth, owner, power_w, cell, committed_bps=rate)
        outcome = Outcome(base_station="simulated", owner=owner, power_w=power_w, promised_bps=rate, achieved=achieved)
    return {"observation": observation, "estimate": estimate, "decision": decision, "outcome": outcome}


def texts(canvas: Canvas) -> list[str]:
    """Every text in the picture, the legends' included."""
    from matplotlib.text import Text

    return [text.get_text() for text in canvas.figure.findobj(Text)]


def heights(axes, count: int) -> np.ndarray:
    """Heights of the first ``count`` bars of a panel."""
    return np.array([bar.get_height() for bar in axes.patches[:count]])


@pytest.mark.parametrize(
    ("num_users", "num_subcarriers", "options"),
    [
        (1, 1, {"loss": 0.0}),
        (1, 273, {"applied": False}),
        (9, 20, {"status": "infeasible", "min_rate_bps": 1e6}),
        (64, 5, {"min_rate_bps": 1e5}),
        (64, 273, {"loss": 0.3}),
    ],
)
def test_any_shape_is_drawn_without_a_warning(tmp_path, num_users, num_subcarriers, options):
    draw_chain(**a_run(num_users, num_subcarriers, **options), path=tmp_path / "run.png")

    assert (tmp_path / "run.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(("suffix", "start"), [(".png", b"\x89PNG"), (".SVG", b"<?xml"), (".pdf", b"%PDF")])
def test_the_suffix_names_the_format(tmp_path, suffix, start):
    draw_chain(**a_run(2, 6), path=tmp_path / f"run{suffix}")

    assert (tmp_path / f"run{suffix}").read_bytes().startswith(start)
    assert [path.name for path in tmp_path.iterdir()] == [f"run{suffix}"]


def test_an_unknown_suffix_lists_the_known_ones_and_writes_nothing(tmp_path):
    with pytest.raises(InputError, match=r"\.png, \.svg, \.pdf; got 'run\.gif'"):
        draw_chain(**a_run(2, 6), path=tmp_path / "run.gif")

    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_there_is_an_input_error(tmp_path):
    with pytest.raises(InputError, match="does not exist"):
        draw_chain(**a_run(2, 6), path=tmp_path / "nowhere" / "run.png")


def test_the_same_run_gives_the_same_bytes(tmp_path):
    for name in ("one.png", "two.png"):
        draw_chain(**a_run(2, 6), path=tmp_path / name)

    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()


def test_the_matrices_show_holes_and_their_repair():
    run = a_run()
    sensed, repaired = (panel.axes for panel in chain_canvas(**run).panels[:2])
    missing = run["observation"].missing

    image = sensed.images[0].get_array()
    assert np.array_equal(np.ma.getmaskarray(image), missing)
    assert np.allclose(image.compressed(), 10 * np.log10(run["observation"].current[~missing]), rtol=1e-12)
    assert not np.ma.getmaskarray(repaired.images[0].get_array()).any()
    dots = repaired.lines[0].get_xydata().astype(int)
    assert {(user, subcarrier) for subcarrier, user in dots} == set(map(tuple, np.argwhere(missing)))


def test_bars_are_the_powers_and_the_line_is_the_water_level():
    run = a_run()
    canvas = chain_canvas(**run)
    panel = canvas.panels[2].axes

    assert np.array_equal(heights(panel, 20), run["decision"].power_w)
    assert panel.lines[0].get_ydata()[0] == pytest.approx(WATER_LEVEL_W, rel=1e-9)
    assert "water level 1.5 W" in texts(canvas)


@pytest.mark.parametrize(("water_level_w", "unit", "scale"), [(1.5e-3, "mW", 1e-3), (4e-5, "µW", 1e-6)])
def test_small_powers_take_a_prefix(water_level_w, unit, scale):
    quiet = Cell(noise_psd_w_per_hz=CELL.noise_psd_w_per_hz / 1e6)
    run = a_run(cell=quiet, water_level_w=water_level_w)
    canvas = chain_canvas(**run)
    panel = canvas.panels[2].axes

    assert panel.get_ylabel() == f"Power ({unit})"
    assert heights(panel, 20) == pytest.approx(run["decision"].power_w / scale, rel=1e-12)
    assert panel.lines[0].get_ydata()[0] == pytest.approx(water_level_w / scale, rel=1e-9)
    assert f"water level {water_level_w / scale:.3g} {unit}" in texts(canvas)
    assert f"Decided by dual: {run['decision'].total_power_w / scale:.3g} {unit}" in texts(canvas)


def test_the_strip_shows_the_owner_of_every_subcarrier():
    run = a_run()
    panel = chain_canvas(**run).panels[2].axes
    strip = [bar for bar in panel.patches if bar.get_y() < 0]

    colour_of = dict(zip(run["decision"].owner.tolist(), (bar.get_facecolor() for bar in strip), strict=True))
    assert len(strip) == 20
    assert len(set(colour_of.values())) == len(colour_of) > 1
    assert [bar.get_facecolor() for bar in strip] == [colour_of[owner] for owner in run["decision"].owner.tolist()]


def test_powers_without_a_common_level_get_no_line():
    run = a_run()
    uneven = dict(vars(run["decision"]), power_w=run["decision"].power_w * np.linspace(0.5, 1.0, 20))
    run["decision"] = Decision(**uneven)

    assert not any("water level" in text for text in texts(chain_canvas(**run)))


def test_rates_stand_beside_each_other_and_misses_are_marked():
    run = a_run(min_rate_bps=1e6)
    canvas = chain_canvas(**run)
    panel = canvas.panels[3].axes
    decision, outcome = run["decision"], run["outcome"]

    assert panel.get_ylabel() == "Rate (Mbit/s)"
    assert np.allclose(heights(panel, 8), decision.rate_bps / 1e6, rtol=1e-12)
    assert np.allclose(heights(panel, 16)[8:], outcome.achieved.user_rate_bps / 1e6, rtol=1e-12)
    assert outcome.missed.any()
    assert panel.lines[0].get_xdata().tolist() == np.flatnonzero(outcome.missed).tolist()
    assert "minimum" in texts(canvas)


def test_without_an_outcome_nothing_is_called_achieved():
    shown = texts(chain_canvas(**a_run(applied=False)))

    assert "predicted" in shown
    assert not any("achieved" in text for text in shown)


@pytest.mark.parametrize("status", ["infeasible", "undecided"])
def test_without_an_allocation_the_reason_stands_where_the_powers_would(status):
    canvas = chain_canvas(**a_run(status=status, min_rate_bps=3e6))
    allocation, rates = (panel.axes for panel in canvas.panels[2:])
    shown = texts(canvas)

    assert f"{status}: needs at least 43.2 W" in shown
    assert f"Decided by dual: {status}" in shown
    assert not allocation.axison, "an axis without data says nothing"
    assert "minimum" in shown
    assert "predicted" not in shown
    assert not rates.patches


def test_without_an_allocation_the_picture_says_what_it_would_take():
    run = a_run(status="infeasible", min_rate_bps=3e6)
    needed, scaling = Bracket(at_least=43.2, at_most=np.nan), Bracket(at_least=0.4, at_most=0.5)
    decision = dataclasses.replace(run["decision"], needed_power_w=needed, rate_scaling=scaling)
    said = " ".join(" ".join(texts(chain_canvas(**{**run, "decision": decision}))).split())

    assert "need at least 43.2 W. The budget carries 0.4 to 0.5 times these rates" in said


def test_without_an_allocation_or_a_wanted_rate_no_axis_is_drawn():
    canvas = chain_canvas(**a_run(status="undecided"))

    assert not any(panel.axes.axison for panel in canvas.panels[2:])
    assert "No rate was asked for" in texts(canvas)


@pytest.mark.parametrize(("num_users", "step"), [(17, 2), (20, 2), (40, 5), (64, 10)])
def test_many_users_are_counted_evenly(num_users, step):
    canvas = chain_canvas(**a_run(num_users, 5, user_names=tuple(f"device {k}" for k in range(num_users))))
    numbers = list(range(step, num_users + 1, step))

    for axis in (canvas.panels[0].axes.yaxis, canvas.panels[1].axes.yaxis, canvas.panels[3].axes.xaxis):
        assert [text.get_text() for text in axis.get_ticklabels()] == [str(number) for number in numbers]
        assert axis.get_ticklocs().tolist() == [number - 1 for number in numbers]
        assert axis.get_label_text() == "User (number)"
    assert not any("device" in text for text in texts(canvas)), "a name that no axis shows"


def test_up_to_sixteen_users_are_named_without_touching():
    canvas = chain_canvas(**a_run(16, 5))
    canvas.figure.draw_without_rendering()
    axes = canvas.panels[3].axes
    labels = axes.get_xticklabels()
    apart = np.diff([label.get_window_extent().x1 for label in labels]).min()
    line_height = axes.yaxis.get_ticklabels()[0].get_window_extent().height

    assert [label.get_text() for label in labels] == [f"user {k}" for k in range(1, 17)]
    assert apart * np.sin(np.deg2rad(labels[0].get_rotation())) > line_height


def test_names_that_the_font_cannot_show_become_numbers():
    shown = texts(chain_canvas(**a_run(3, 6, user_names=("camera", "相机", "$x$"))))

    assert {"camera", "user 2", "user 3"} <= set(shown)
    assert not {"相机", "$x$"} & set(shown)


def test_every_axis_of_a_quantity_names_its_unit():
    panels = chain_canvas(**a_run()).panels

    assert [panel.axes.get_xlabel() for panel in panels[:3]] == [
        "Subcarrier",
        "Subcarrier",
        "Subcarrier (strip: its owner)",
    ]
    assert panels[2].axes.get_ylabel() == "Power (W)"


def test_without_matplotlib_the_error_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)

    with pytest.raises(MissingDependencyError, match=r"pip install 'wirelessagent\[plot\]'"):
        draw_chain(**a_run(2, 6), path=tmp_path / "run.png")


def test_pyplot_and_its_global_state_stay_out(tmp_path: Path):
    code = (
        "import sys; from wirelessagent.pictures import chain_picture, canvas;"
        "assert 'matplotlib' not in sys.modules;"
        "canvas.Canvas(width_in=2, height_in=2).save(__import__('pathlib').Path(sys.argv[1]));"
        "assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code, str(tmp_path / "empty.png")], check=True, timeout=60)
