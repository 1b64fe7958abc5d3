"""Experiments: files that can be reproduced, pictures that are their tables, statistics that are what they claim."""

from __future__ import annotations

import csv
import functools
import io
import itertools
import json
import multiprocessing
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
from matplotlib.text import Text

from wirelessagent.experiments import catalogue
from wirelessagent.experiments.catalogue import EXPERIMENTS, reproduce
from wirelessagent.experiments.draws import Seeds, run_draws, seeds_of
from wirelessagent.experiments.error_sweep import (
    ErrorVersusDelaySpread,
    ErrorVersusLoss,
    ErrorVersusUserCorrelation,
    SweepDraw,
)
from wirelessagent.experiments.experiment import Experiment, Result
from wirelessagent.experiments.intervals import (
    Measure,
    exponent,
    last_crossing,
    resampled_means,
    resampled_medians,
    with_interval,
)
from wirelessagent.experiments.modes import Modes
from wirelessagent.experiments.rate_versus_power import RateVersusPower
from wirelessagent.experiments.repair_error import squared_errors
from wirelessagent.experiments.run_time import RunTime
from wirelessagent.experiments.scenario import Scenario
from wirelessagent.experiments.table import Table, table_of
from wirelessagent.model.errors import InputError, UnknownNameError
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.scene import Scene
from wirelessagent.pictures.canvas import Canvas
from wirelessagent.sensing.rayleigh import Rayleigh

pytestmark = pytest.mark.machine_code

SMALL = {
    "run_time": RunTime(
        num_subcarriers=(8, 16, 32, 64), num_users=(2, 4), num_levels=(10, 20, 40), users_held=2, subcarriers_held=16,
        most_repeats=3,
    ),
    "error_versus_loss": ErrorVersusLoss(loss_percents=(20.0, 50.0)),
    "error_versus_delay_spread": ErrorVersusDelaySpread(rms_delay_spreads_ns=(30.0, 100.0, 1000.0)),
    "error_versus_user_correlation": ErrorVersusUserCorrelation(user_correlations=(0.0, 0.9, 0.99)),
}  # fmt: skip
"""Experiments that are too long for a test as they stand."""


@functools.cache
def drawn(name: str) -> tuple[Experiment, Result, Canvas]:
    """An experiment of few draws with its picture, for all tests that only look."""
    experiment = SMALL.get(name, EXPERIMENTS[name])
    result = experiment.run(draws=3, seed=1)
    return experiment, result, experiment.picture(result)


@pytest.fixture(autouse=True)
def small(monkeypatch):
    monkeypatch.setattr(catalogue, "EXPERIMENTS", {**EXPERIMENTS, **SMALL})


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_each_writes_a_picture_a_table_and_a_record_the_same_ones_for_a_seed(tmp_path, name):
    reported = []
    folder = tmp_path / "new" / "folder"
    paths = reproduce([name], out=folder, draws=3, seed=1, progress=lambda *at: reported.append(at)).files

    assert [path.name for path in paths[name]] == [f"{name}.png", f"{name}.csv", f"{name}.json"]
    assert sorted(folder.iterdir()) == sorted(path for some in paths.values() for path in some)
    picture, table, record_path = paths[name]
    assert picture.read_bytes().startswith(b"\x89PNG")
    record = json.loads(record_path.read_text())
    assert (record["experiment"], record["seed"]) == (name, 1)
    assert {"version", "configuration", "measures", "draws", "summary"} <= record.keys()
    assert "date" not in record_path.read_text()
    assert reported[-1] == (name, reported[-1][1], reported[-1][1])
    if name == "run_time":
        return
    again = reproduce([name], out=tmp_path / "again", draws=3, seed=1).files
    other = reproduce([name], out=tmp_path / "other", draws=3, seed=3).files
    assert [path.read_bytes() for path in paths[name]] == [path.read_bytes() for path in again[name]]
    assert table.read_bytes() != other[name][1].read_bytes()


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_what_is_plotted_is_what_the_table_holds(name):
    _, result, canvas = drawn(name)
    table = result.table

    columns = [
        table.numbers(column) for column in table.columns if not isinstance(table.rows[0][_at(table, column)], str)
    ]
    held = np.unique(np.concatenate(columns))
    plotted = np.concatenate([_plotted(panel.axes) for panel in canvas.panels])
    assert plotted.size >= len(table.rows)
    assert np.isin(plotted, held).all()


def _at(table: Table, column: str) -> int:
    return table.columns.index(column)


def _plotted(axes) -> np.ndarray:
    """The y values of every curve and bar of a panel but for guides, which have no marker."""
    lines = [container.lines[0] for container in axes.containers if hasattr(container, "lines")]
    curves = [line.get_ydata() for line in lines if line is not None]  # the error bars of bars have none
    bars = [bar.get_height() for bar in axes.patches]
    return np.concatenate([*curves, bars])


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_axis_is_labelled(name):
    for panel in drawn(name)[2].panels:
        assert "(" in panel.axes.get_ylabel(), "a quantity names its unit"
        assert panel.axes.get_xlabel() or panel.axes.get_xticklabels()


@pytest.mark.parametrize(
    ("name", "facts"),
    [
        ("channel_recovery", ["K × N = 8 × 20", "20 % random loss", "100 ns RMS delay spread", "1 draw"]),
        ("rate_versus_power", ["K × N = 8 × 20", "30 % random loss", "100 ns RMS delay spread", "3 draws"]),
        ("error_versus_loss", ["K × N = 8 × 20", "100 ns RMS delay spread", "3 draws"]),
        ("error_versus_delay_spread", ["K × N = 8 × 20", "20 % random loss", "3 draws"]),
        ("error_versus_user_correlation", ["K × N = 8 × 20", "20 % random loss", "100 ns RMS delay spread", "3 draws"]),
        ("modes", ["K × N = 8 × 20", "20 % random loss", "100 ns RMS delay spread", "3 draws"]),
        ("run_time", ["20 % random loss", "100 ns RMS delay spread", "up to 3 calls a point"]),
    ],
)
def test_every_figure_says_what_it_rests_on(name, facts):
    title = drawn(name)[2].figure.get_suptitle()

    assert [fact for fact in facts if fact not in title] == []
    assert ("delay spread" in title) == (name != "error_versus_delay_spread"), "what is swept has no one value"
    assert ("random loss" in title) == (name != "error_versus_loss"), "what is swept has no one value"


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_neither_legends_nor_labels_cover_data_or_each_other(name):
    figure = drawn(name)[2].figure
    figure.draw_without_rendering()
    panels = [axes.get_window_extent() for axes in figure.axes]
    labels = [Text.get_window_extent(text) for axes in figure.axes for text in axes.texts]
    legends = [legend.get_window_extent() for legend in figure.legends]

    assert not any(axes.get_legend() for axes in figure.axes)
    assert legends or labels
    for place, box in enumerate([*labels, *legends]):
        shrunk = box.shrunk(0.98, 0.9)  # lines of text may touch
        assert not any(shrunk.overlaps(other) for other in [*panels, *labels[:place]])
        assert figure.bbox.padded(1.0).containsx(box.x1)
        assert figure.bbox.padded(1.0).containsy(box.y1)


@pytest.mark.parametrize("name", [name for name in EXPERIMENTS if name not in ("modes", "run_time")])
def test_curves_that_coincide_are_told_apart(name):
    """But for measured times, which may come close to each other by chance."""
    canvas = drawn(name)[2]
    canvas.figure.draw_without_rendering()
    for panel in canvas.panels:
        curves = [one.lines[0] for one in panel.axes.containers]
        looks = [(line.get_color(), line.get_marker()) for line in curves]
        assert len(set(looks)) == len(looks)
        for one, other in itertools.combinations(curves, 2):
            shown = [line.get_transform().transform(line.get_xydata()) for line in (one, other)]
            if shown[0].shape == shown[1].shape and np.abs(shown[0][:, 1] - shown[1][:, 1]).max() < 3.0:
                assert np.abs(shown[0][:, 0] - shown[1][:, 0]).min() > 2.0, "in pixels"


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_methods_go_by_readable_names(name):
    figure = drawn(name)[2].figure
    texts = [text.get_text() for text in figure.findobj(Text)]

    assert [text for text in texts if "_" in text] == []


def test_the_recovered_channel_is_that_of_the_user_in_the_record():
    _, result, canvas = drawn("channel_recovery")
    title = canvas.panels[0].axes.get_title(loc="left")

    assert title.startswith(f"The channel of user {result.table.values('user')[0]},")


@pytest.mark.parametrize("name", ["rate_versus_power", "error_versus_loss", "modes"])
def test_neither_the_executor_nor_its_size_matters(name):
    experiment = catalogue.EXPERIMENTS[name]
    alone = experiment.run(draws=41, seed=1)
    with ThreadPoolExecutor(3) as threads:
        assert experiment.run(draws=41, seed=1, executor=threads).table == alone.table


def test_draws_run_in_other_processes():
    draw = SweepDraw((Scenario(channel=Rayleigh(num_users=2, num_subcarriers=4)),), ("user_mean",))
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as processes:
        spread = run_draws(draw, draws=25, seed=9, executor=processes)

    assert np.array_equal(spread, run_draws(draw, draws=25, seed=9))


def test_a_longer_run_starts_with_the_shorter_one_and_no_seed_repeats():
    long, short = (run_draws(_seed_pair, draws=draws, seed=4) for draws in (50, 7))

    assert np.array_equal(long[:7], short)
    assert np.unique(long).size == long.size
    assert seeds_of(4, 0) != seeds_of(5, 0)


def _seed_pair(seeds: Seeds) -> np.ndarray:
    return np.array([seeds.channel, seeds.loss], dtype=float)


def _widths(table: Table, column: str) -> np.ndarray:
    return table.numbers(f"{column}_high") - table.numbers(f"{column}_low")


def test_more_draws_narrow_the_intervals():
    at_full_power = RateVersusPower(max_powers_w=(20.0,))
    few, many = (at_full_power.run(draws=draws, seed=1).table for draws in (8, 128))

    assert (_widths(many, "goodput_mbps") < _widths(few, "goodput_mbps"))[1:].all()


def test_the_error_bars_drawn_are_those_of_the_share_of_perfect_knowledge():
    experiment = EXPERIMENTS["rate_versus_power"]
    result = experiment.run(draws=16, seed=1)
    canvas = experiment.picture(result)
    perfect, repaired = (result.table.where(csi=csi) for csi in ("perfect", "nncf"))

    assert (_widths(repaired, "sum_rate_share") < 0.1 * _widths(repaired, "sum_rate_mbps") / 40.0).all()
    assert "interval of that share" in canvas.figure.get_suptitle()
    panels = zip(canvas.panels, ("sum_rate", None, "goodput", "goodput_by_subcarrier"), strict=True)
    for panel, quantity in panels:
        drawn = {one.get_label().partition(":")[0]: one for one in panel.axes.containers}
        assert not drawn["perfect CSI"].has_yerr
        if quantity is not None:
            ends = np.array([segment[:, 1] for segment in drawn["NNCF with relative gains"].lines[2][0].get_segments()])
            low, high = (repaired.numbers(f"{quantity}_share_{end}") for end in ("low", "high"))
            assert ends == pytest.approx(np.stack([low, high], axis=1) * perfect.numbers(f"{quantity}_mbps")[:, None])


def test_a_single_draw_has_no_interval_and_an_empty_cell(tmp_path):
    _, table, _ = reproduce(["rate_versus_power"], out=tmp_path, draws=1).files["rate_versus_power"]

    rows = list(csv.DictReader(io.StringIO(table.read_text())))
    assert {row["sum_rate_mbps_low"] for row in rows} == {""}
    assert {row["goodput_share_high"] for row in rows} == {""}
    assert all(float(row["sum_rate_mbps"]) > 0 for row in rows)


def test_perfect_knowledge_keeps_every_promise_and_is_never_beaten():
    table = RateVersusPower(max_powers_w=(1.0, 20.0)).run(draws=20, seed=3).table
    perfect = table.where(csi="perfect")

    assert np.allclose(perfect.numbers("goodput_mbps"), perfect.numbers("sum_rate_mbps"), rtol=1e-12)
    assert (perfect.numbers("sum_rate_share") == 1).all()
    for csi in ("kriging", "nncf", "nncf_paper", "user_mean"):
        rows = table.where(csi=csi)
        assert (rows.numbers("sum_rate_share") <= 1 + 1e-9).all()
        assert (rows.numbers("goodput_mbps") < rows.numbers("sum_rate_mbps")).all()


def test_each_mode_is_best_at_what_it_is_for():
    everything_known = Modes(scenario=Scenario(loss_rate=0.0))
    table = everything_known.run(draws=30, seed=1).table.where(who="default")

    def figures(column: str) -> dict[str, float]:
        return dict(zip(table.values("strategy"), table.numbers(column).tolist(), strict=True))

    sum_rate, efficiency, power_w = (
        figures(column) for column in ("sum_rate_mbps", "energy_efficiency_mbit_per_j", "power_w")
    )
    assert max(sum_rate, key=lambda strategy: sum_rate[strategy]) == "max rate"
    assert max(efficiency, key=lambda strategy: efficiency[strategy]) == "max energy efficiency"
    assert power_w["min power"] < 0.5 * power_w["fixed power"]
    assert sum_rate["min power"] == pytest.approx(8.0, rel=1e-6), "eight users at 1 Mbit/s each"
    shares = [table.numbers(f"{status}_share") for status in ("optimal", "feasible", "infeasible", "undecided")]
    assert np.allclose(np.sum(shares, axis=0), 1.0, rtol=1e-12)
    assert np.allclose(table.numbers("served_share"), shares[0] + shares[1], rtol=1e-12)


def test_draws_that_minimum_power_cannot_serve_are_counted_and_leave_its_means_alone():
    asking_much = Modes(min_rate_bps=2.5e6)
    served = asking_much.run(draws=20, seed=1).table.where(strategy="min power", who="default")

    assert 0 < served.numbers("served_share")[0] < 1
    assert served.numbers("infeasible_share")[0] > 0
    assert 0 < served.numbers("power_w")[0] < asking_much.scenario.cell.max_power_w


def test_the_title_tells_allocations_found_from_rates_kept():
    modes = Modes(min_rate_bps=2e6)
    result = modes.run(draws=20, seed=1)
    least = result.table.where(strategy="min power", who="default")
    found, got = least.numbers("served_share")[0], least.numbers("users_at_min_rate_share")[0]
    title = modes.picture(result).figure.get_suptitle()

    assert got < 1, "the rates are promised on the estimate"
    assert f"found in {100 * found:.0f} % of the draws" in title
    assert f"{100 * got:.0f} % of its users got the rate" in title


def test_a_rate_that_no_draw_can_serve_is_said():
    hopeless = Modes(min_rate_bps=1e9)
    result = hopeless.run(draws=2, seed=1)

    assert "no allocation was found in any draw" in hopeless.picture(result).figure.get_suptitle()
    assert np.isnan(result.measures["drawn_saving_as_printed"].value)


def test_repair_by_nncf_cuts_the_error_at_the_nominal_delay_spread_and_the_literal_one_does_not():
    result = SMALL["error_versus_delay_spread"].run(draws=40, seed=1)
    at_100_ns = result.table.where(rms_delay_spread_ns=100.0)
    cut = dict(zip(at_100_ns.values("repairer"), at_100_ns.numbers("cut"), strict=True))

    assert cut["user_mean"] == 0
    assert result.measures["cut_by_nncf"].low > 67
    assert cut["nncf_paper"] < 0
    assert 100 < result.measures["reach_of_nncf"].value < 1000
    assert result.measures["best_cut_as_printed"].value < 67


def test_the_literal_rule_needs_users_that_are_alike():
    result = SMALL["error_versus_user_correlation"].run(draws=20, seed=1)
    cut = result.table.where(repairer="nncf_paper").numbers("cut_absolute")

    assert cut[0] < 0.5 < 0.67 < cut[-1]
    assert 0 < result.measures["correlation_needed_as_printed"].value < 0.99


def test_errors_are_relative_to_the_users_mean_and_floored_in_db():
    truth = np.array([[1.0, 3.0, 2.0], [2e-9, 2e-9, 2e-9]])
    observed = np.array([[1.0, 3.0, np.nan], [2e-9, 2e-9, 2e-9]])
    scene = Scene(cell=Scenario().cell, sensed=ChannelObservation(gain=truth), truth=truth)

    sums = squared_errors(scene, ChannelObservation(gain=observed), ["user_mean"])

    assert sums[0].tolist() == pytest.approx([0.0, 0.0, 0.0, 1.0], abs=1e-15)
    nulled = Scene(cell=scene.cell, sensed=scene.sensed, truth=np.array([[1.0, 3.0, 0.0], [2e-9, 2e-9, 2e-9]]))
    sums = squared_errors(nulled, ChannelObservation(gain=observed), ["user_mean"])
    level = 4.0 / 3.0
    floored_db = 10 * np.log10(2.0 / level) + 30.0
    assert sums[0].tolist() == pytest.approx([(2.0 / level) ** 2, floored_db**2, 4.0, 1.0], rel=1e-12)


def test_intervals_cover_what_they_say():
    rng = np.random.default_rng(0)
    samples = rng.exponential(size=(60, 2000))
    samples[rng.random(samples.shape) < 0.1] = np.nan
    sizes = np.geomspace(1.0, 16.0, 9)
    times = sizes * np.exp(rng.normal(scale=0.2, size=(2000, 9)))

    _, low, high = np.moveaxis(with_interval(resampled_means(samples, seed=1)), -1, 0)
    assert np.mean((low <= 1.0) & (high >= 1.0)) == pytest.approx(0.93, abs=0.02)
    medians = np.array([with_interval(resampled_medians(one, seed=1))[1:] for one in samples.T[:100]])
    assert np.mean((medians[:, 0] <= np.log(2.0)) & (medians[:, 1] >= np.log(2.0))) == pytest.approx(0.94, abs=0.05)
    slopes = [exponent(sizes, one) for one in times]
    assert np.mean([one.low <= 1.0 <= one.high for one in slopes]) == pytest.approx(0.95, abs=0.02)


def test_intervals_in_closed_form():
    assert resampled_means(np.array([1.0, np.nan, 3.0]), seed=1)[0] == 2.0
    assert resampled_medians(np.array([1.0, np.nan, 3.0, 8.0]), seed=1)[0] == 3.0
    fit = exponent(np.array([1.0, 10.0, 100.0]), np.array([5.0, 0.5, 0.05]))
    assert (fit.value, fit.low, fit.high) == pytest.approx((-1.0, -1.0, -1.0), rel=1e-9)
    bent = exponent(np.array([1.0, np.e, np.e**2]), np.exp([0.0, 2.0, 2.0]))
    assert bent.high - bent.value == pytest.approx(12.706204736 * np.sqrt(2.0 / 3.0 / 2.0), rel=1e-9)
    assert np.isnan(exponent(np.array([1.0, 10.0]), np.array([1.0, 2.0])).low), "two points leave nothing to scatter"
    spread = np.array([10.0, 100.0, 1000.0])
    assert last_crossing(spread, np.array([0.9, 0.7, 0.5]), 0.6) == pytest.approx(10**2.5, rel=1e-12)
    assert np.isnan(last_crossing(spread, np.array([0.5, 0.7, 0.5]), 0.6))
    assert last_crossing(spread, np.array([0.9, 0.8, 0.7]), 0.6) == 1000.0


@pytest.mark.parametrize(
    ("figures", "text"),
    [
        ((-1357.4, -1800.0, -900.0, "%"), "−1,357 % (−1,800 to −900)"),
        ((99.99977, 99.99925, 100.0, "%"), "100.0 %"),
        ((0.0142, 0.0093, 0.02, "%"), "0.0142 % (0.0093 to 0.0200)"),
        ((0.0, 0.0, 0.0, "dB"), "0 dB"),
        ((float("nan"), float("nan"), float("nan"), "ns"), "–"),
        ((1.5, float("nan"), float("nan"), ""), "1.5"),
    ],
)
def test_figures_are_told_with_the_digits_that_are_sure(figures, text):
    value, low, high, unit = figures
    assert str(Measure(value=value, low=low, high=high, unit=unit)) == text


def test_a_table_survives_its_csv():
    table = table_of(("name", "x_w"), [("a", np.float64(0.1) + 0.2), ("b", np.nan), ("c, d", 3)])

    assert table.to_csv() == 'name,x_w\na,0.30000000000000004\nb,\n"c, d",3\n'


@pytest.mark.parametrize("wrong", [{"draws": 0}, {"seed": -1}])
def test_impossible_settings_are_refused_before_anything_is_written(tmp_path, wrong):
    with pytest.raises(InputError, match=r"draws must be 1 or more and seed 0 or more"):
        reproduce(["channel_recovery"], out=tmp_path / "new", **wrong)

    assert not (tmp_path / "new").exists()


def test_an_unknown_experiment_names_the_known_ones(tmp_path):
    with pytest.raises(UnknownNameError, match="did you mean 'run_time'"):
        reproduce(["runtime"], out=tmp_path)


def test_a_folder_that_cannot_be_made_is_an_input_error(tmp_path):
    (tmp_path / "file").write_text("")

    with pytest.raises(InputError, match="cannot be made"):
        reproduce(["channel_recovery"], out=tmp_path / "file" / "folder")
