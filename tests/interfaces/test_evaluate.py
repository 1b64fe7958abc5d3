"""Evaluations: figures that are right, files that can be read back, pictures that are drawn, errors that help."""

from __future__ import annotations

import csv
import json
import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.experiments import evaluated_methods
from wirelessagent.experiments.competitors import COMPETITORS, Competitor
from wirelessagent.experiments.evaluate_decision import AVOID, PERFECT, EvaluateDecision
from wirelessagent.experiments.evaluate_repair import EvaluateRepair
from wirelessagent.experiments.evaluated_channels import EvaluatedChannel, FileChannel, parse_channel
from wirelessagent.experiments.evaluated_methods import all_methods, check_methods
from wirelessagent.experiments.evaluation import Evaluated, write
from wirelessagent.experiments.intervals import resampled_sums, with_interval
from wirelessagent.experiments.oracle import Oracle
from wirelessagent.experiments.soft_impute import soft_impute
from wirelessagent.experiments.table import Table
from wirelessagent.interfaces.cli import run
from wirelessagent.model.errors import InputError, MissingDependencyError, UnknownNameError
from wirelessagent.pictures.method_names import readable
from wirelessagent.sensing.rayleigh import Rayleigh

pytestmark = pytest.mark.machine_code

QUICK = tuple(name for name in all_methods() if name != "iterative")
"""All methods but the one that takes a fifth of a second."""


def simulated(text: str = "rayleigh:100", **options: Any) -> EvaluatedChannel:
    source = Rayleigh(**{"num_users": 6, "num_subcarriers": 20, "snr_db": 30.0, **options})
    return parse_channel(text, source=source, cell=wa.Cell(), options={})


@pytest.fixture(scope="module")
def result() -> Evaluated:
    return evaluation().run(draws=60, seed=11)


def evaluation(methods: tuple[str, ...] = QUICK, *channels: EvaluatedChannel) -> EvaluateRepair:
    return EvaluateRepair(
        channels=channels or (simulated(), simulated("rayleigh:mixed")),
        losses=("random:0.2", "random:0.5", "bursts:0.2"),
        methods=methods,
    )


@pytest.fixture
def drops(tmp_path: Path) -> Path:
    """Three complete drops of a cell as a file."""
    gain = np.stack(
        [Rayleigh(num_users=3, num_subcarriers=16).observe(wa.Cell(), seed=seed).truth for seed in (1, 2, 3)]
    )
    path = tmp_path / "cells.npz"
    np.savez(path, gain=gain, meta=json.dumps({"axes": "drop,user,subcarrier"}))
    return path


def by_method(table: Table, column: str, **case: str) -> dict[str, float]:
    rows = table.where(**case)
    return dict(zip(rows.values("method"), rows.numbers(column).tolist(), strict=True))


@pytest.mark.parametrize("channel", ["rayleigh:100", "rayleigh:mixed"])
@pytest.mark.parametrize("loss", ["random:0.2", "random:0.5", "bursts:0.2"])
def test_the_oracle_is_best_and_kriging_beats_the_user_mean(result: Evaluated, channel: str, loss: str) -> None:
    error = by_method(result.table, "rmse", channel=channel, loss=loss)
    assert error["oracle"] <= 1.02 * min(error.values())
    assert error["kriging"] < 0.9 * error["user_mean"]
    assert all(error[name] > error["kriging"] for name in ("cubic", "knn", "soft_impute"))


def test_ratios_and_intervals_belong_to_the_errors(result: Evaluated) -> None:
    case = {"channel": "rayleigh:100", "loss": "random:0.2"}
    error = by_method(result.table, "rmse", **case)
    best = min(error[name] for name in error if name != "oracle")
    assert by_method(result.table, "ratio_to_best", **case) == pytest.approx({k: e / best for k, e in error.items()})
    to_oracle = by_method(result.table, "ratio_to_oracle", **case)
    assert to_oracle == pytest.approx({k: e / error["oracle"] for k, e in error.items()})
    low, high = (by_method(result.table, f"rmse{end}", **case) for end in ("_low", "_high"))
    assert all(low[name] < error[name] < high[name] for name in error)


def test_the_ratio_of_paired_methods_is_known_better_than_either_error(result: Evaluated) -> None:
    row = result.table.where(channel="rayleigh:100", loss="random:0.2", method="kriging")
    width = {
        name: float(row.numbers(f"{name}_high")[0] - row.numbers(f"{name}_low")[0]) / float(row.numbers(name)[0])
        for name in ("rmse", "ratio_to_oracle")
    }
    assert width["ratio_to_oracle"] < 0.7 * width["rmse"]


def test_only_methods_that_say_how_sure_they_are_have_a_calibration(result: Evaluated) -> None:
    holds = by_method(result.table, "coverage_90", channel="rayleigh:100", loss="random:0.2")
    assert {name for name, share in holds.items() if np.isnan(share)} == set(COMPETITORS) - {"iterative"}
    assert 0.85 < holds["kriging"] < 0.97
    assert 0.85 < holds["oracle"] < 0.97


def test_the_share_missing_is_what_was_lost(result: Evaluated) -> None:
    rows = result.table.where(loss="random:0.5")
    assert rows.numbers("missing_share") == pytest.approx(np.full(len(rows.rows), 0.5))
    assert set(rows.numbers("missing_entries")) == {60 * 60}


def test_csv_json_and_pictures_are_written_and_read_back(result: Evaluated, tmp_path: Path) -> None:
    paths = {path.name: path for path in write(evaluation(), result, tmp_path / "new" / "folder")}
    assert set(paths) == {
        "evaluate_repair.csv", "recovery.csv", "evaluate_repair.json",
        "recovery.png", "error_versus_loss.png", "calibration.png",
    }  # fmt: skip
    with paths["evaluate_repair.csv"].open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    record = json.loads(paths["evaluate_repair.json"].read_text(), parse_constant=lambda name: pytest.fail(name))
    assert len(rows) == len(record["tables"]["evaluate_repair"]) == len(result.table.rows)
    for text, stated, held in zip(rows, record["tables"]["evaluate_repair"], result.table.rows, strict=True):
        for column, value in zip(result.table.columns, held, strict=True):
            known = isinstance(value, str) or np.isfinite(value)
            assert stated[column] == (value if known else None)
            assert text[column] == ("" if not known else value if isinstance(value, str) else repr(value))
    assert (record["seed"], record["draws"]) == (11, 60)
    assert record["findings"]["rayleigh:100, random:0.2"]["best"] == "kriging"
    for name, path in paths.items():
        assert not name.endswith(".png") or path.read_bytes().startswith(b"\x89PNG")


def test_the_pictures_show_what_the_tables_hold(result: Evaluated) -> None:
    canvas = evaluation().pictures(result)["error_versus_loss"]
    for panel, channel in zip(canvas.panels, ("rayleigh:100", "rayleigh:mixed"), strict=False):
        drawn = {c.get_label(): c.lines[0].get_ydata() for c in panel.axes.containers if hasattr(c, "lines")}
        for method in QUICK:
            rows = [result.table.where(channel=channel, loss=f"random:{rate}", method=method) for rate in (0.2, 0.5)]
            assert drawn[readable(method)].tolist() == [row.numbers("rmse")[0] for row in rows]
    recovery = result.tables["recovery"]
    assert recovery.columns[5] == "kriging_db"
    heard = recovery.where(missing=0)
    assert np.all(recovery.numbers("low_db") <= recovery.numbers("high_db"))
    assert np.array_equal(heard.numbers("observed_db"), heard.numbers("kriging_db")), "what was observed stays"
    assert np.isnan(recovery.where(missing=1).numbers("observed_db")).all()
    assert not np.array_equal(heard.numbers("observed_db"), heard.numbers("truth_db")), "it was measured with noise"


def test_neither_the_executor_nor_a_second_run_changes_a_figure() -> None:
    methods = ("user_mean", "linear", "cubic", "oracle")
    channel = simulated(num_users=3, num_subcarriers=8)
    one = EvaluateRepair(channels=(channel,), losses=("random:0.3",), methods=methods)
    alone = one.run(draws=45, seed=3)
    with ThreadPoolExecutor(2) as threads:
        assert figures(one.run(draws=45, seed=3, executor=threads)) == figures(alone)
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as processes:
        assert figures(one.run(draws=45, seed=3, executor=processes)) == figures(alone)
    assert figures(one.run(draws=45, seed=4)) != figures(alone)


def figures(result: Evaluated) -> list[str]:
    """The rows without the times; as text, so that NaN equals NaN."""
    at = result.table.columns.index("time_ms")
    return [repr(row[:at] + row[at + 1 :]) for row in result.table.rows]


def test_a_file_is_drawn_from_all_its_drops_and_has_no_oracle(drops: Path) -> None:
    channel = parse_channel(str(drops), source=Rayleigh(), cell=wa.Cell(), options={})
    drawn = [channel.drawn(seed) for seed in range(30)]
    assert len({one.truth.tobytes() for one in drawn}) == 3
    assert all(np.array_equal(one.level, one.truth.mean(axis=1)) for one in drawn)
    table = evaluation(("user_mean", "kriging", "oracle"), channel).run(draws=10, seed=1).table
    assert set(table.values("method")) == {"user_mean", "kriging"}
    assert np.isnan(table.numbers("ratio_to_oracle")).all()


def test_slots_of_a_file_are_history(tmp_path: Path) -> None:
    gain = Rayleigh(num_users=2, num_subcarriers=5, num_slots=9, speed_km_per_h=30).observe(wa.Cell()).truth
    assert gain is not None
    np.save(tmp_path / "slots.npy", gain)
    channel = FileChannel(path=tmp_path / "slots.npy", num_slots=4)
    drawn = [channel.drawn(seed) for seed in range(40)]
    assert {one.scene.sensed.num_slots for one in drawn} == {4}
    assert {one.truth.tobytes() for one in drawn} == {gain[t].tobytes() for t in range(3, 9)}
    assert FileChannel(path=tmp_path / "slots.npy").drawn(0).scene.sensed.gain.ndim == 2
    with pytest.raises(InputError, match=r"holds 9 slot\(s\), fewer than the 10"):
        FileChannel(path=tmp_path / "slots.npy", num_slots=10).drawn(0)


def test_noise_added_to_a_file_is_stated(drops: Path) -> None:
    noisy = [FileChannel(path=drops, snr_db=20.0).drawn(seed) for seed in range(300)]
    error = np.concatenate([(one.scene.sensed.gain - one.truth) / one.level[:, np.newaxis] for one in noisy])
    stated = np.concatenate(
        [one.scene.sensed.current_noise_variance / np.square(one.level)[:, np.newaxis] for one in noisy]
    )
    assert np.mean(error) == pytest.approx(0.0, abs=0.01)
    assert np.mean(np.square(error)) == pytest.approx(np.mean(stated), rel=0.1)


def test_mixed_users_have_the_same_levels_and_their_own_delay_spread() -> None:
    drawn = [simulated("rayleigh:mixed", num_users=8).drawn(seed) for seed in range(20)]
    alone = [simulated("rayleigh:300", num_users=8).drawn(seed) for seed in range(20)]
    for mixed, single in zip(drawn, alone, strict=True):
        assert mixed.oracle is not None
        assert np.array_equal(mixed.level, single.level)
        same = mixed.oracle.rms_delay_spread_s == 300e-9
        assert np.array_equal(mixed.truth[same], single.truth[same])
    spreads = np.concatenate([one.oracle.rms_delay_spread_s for one in drawn if one.oracle])
    assert set(spreads.tolist()) == {30e-9, 100e-9, 300e-9, 1e-6}


def test_the_oracle_knows_time_and_other_users() -> None:
    """At 3 km/h earlier slots, and with correlated users others' gains, say more than one's own slot alone."""

    def error(**options: Any) -> float:
        channel = simulated("rayleigh:1000", num_subcarriers=12, **options)
        one = EvaluateRepair(channels=(channel,), losses=("random:0.3",), methods=("oracle",))
        return float(one.run(draws=40, seed=2).table.numbers("rmse")[0])

    alone = error()
    assert error(num_slots=4, speed_km_per_h=3.0) < 0.6 * alone
    assert error(user_correlation=0.95) < 0.8 * alone


def test_the_oracles_estimate_is_the_conditional_mean_of_jointly_normal_gains() -> None:
    """One user, two subcarriers, exact: g_2 = 1 + c (g_1 − 1) with c = 1/(1 + (2πΔfτ)²)."""
    spread, spacing = 400e-9, 180e3
    oracle = Oracle(mean_gain=np.array([2.0]), rms_delay_spread_s=np.array([spread]))
    seen = wa.ChannelObservation(gain=np.array([[5.0, np.nan]]), subcarrier_frequencies_hz=np.array([0.0, spacing]))
    correlation = 1.0 / (1.0 + (2.0 * np.pi * spacing * spread) ** 2)
    estimate = oracle.repair(seen)
    assert estimate.gain[0].tolist() == pytest.approx([5.0, 2.0 * (1.0 + 1.5 * correlation)], rel=1e-9)
    assert estimate.gain_variance[0, 1] == pytest.approx(4.0 * (1.0 - correlation**2), rel=1e-9)


@pytest.mark.parametrize("competitor", COMPETITORS.values(), ids=lambda one: one.name)
def test_competitors_survive_holes_of_every_kind(competitor: Competitor) -> None:
    gain = Rayleigh(num_users=4, num_subcarriers=12).observe(wa.Cell(), seed=1).sensed.gain.copy()
    gain[0], gain[:, 5], gain[2, 1:] = np.nan, np.nan, np.nan
    seen = wa.ChannelObservation(gain=gain)
    estimate = competitor.repair(seen)
    assert np.isfinite(estimate.gain).all()
    assert (estimate.gain >= 0).all()
    assert np.array_equal(estimate.gain[~np.isnan(gain)], gain[~np.isnan(gain)])
    assert np.isfinite(competitor.repair(wa.ChannelObservation(gain=np.full((3, 4), np.nan))).gain).all()
    scaled = competitor.repair(wa.ChannelObservation(gain=gain * np.array([[1e-3], [1.0], [1e5], [1e2]])))
    wanted = estimate.gain * np.array([[np.nan], [1.0], [1e5], [1e2]])  # the first user's level is a guess from others
    assert scaled.gain[1:] == pytest.approx(wanted[1:], rel=1e-6)


def test_soft_impute_finds_a_matrix_of_rank_one() -> None:
    rng = np.random.default_rng(5)
    truth = np.outer(rng.standard_normal(30), rng.standard_normal(20))
    holes = rng.random(truth.shape) < 0.3
    filled = soft_impute(np.where(holes, np.nan, truth))
    assert np.sqrt(np.mean(np.square(filled - truth)[holes])) < 0.1 * truth.std()


def test_bootstrap_intervals_cover_a_mean() -> None:
    rng = np.random.default_rng(1)
    hits = 0
    for trial in range(200):
        samples = rng.exponential(size=(80, 1))
        _, low, high = with_interval(resampled_sums(samples, seed=trial, resamples=400) / 80)[0]
        hits += low <= 1.0 <= high
    assert 0.89 < hits / 200 < 0.98


def test_a_single_draw_has_no_interval(tmp_path: Path) -> None:
    one = evaluation(("user_mean", "linear"), simulated())
    result = one.run(draws=1, seed=1)
    assert np.isnan(result.table.numbers("rmse_low")).all()
    assert write(one, result, tmp_path), "neither JSON nor pictures mind"


@pytest.fixture(scope="module")
def decided() -> tuple[EvaluateDecision, Evaluated]:
    one = EvaluateDecision(
        channels=(simulated("rayleigh:100", snr_db=None),),
        losses=("random:0.2", "random:0.5"),
        methods=("user_mean", "kriging"),
        min_rate_bps=0.3e6,
    )
    return one, one.run(draws=12, seed=5)


def test_perfect_knowledge_is_the_yardstick(decided: tuple[EvaluateDecision, Evaluated]) -> None:
    table = decided[1].table
    for name in ("goodput_share", "proportional_fairness_share", "max_min_rate_share", "power_ratio"):
        assert (table.where(method=PERFECT).numbers(name) == 1.0).all()
    assert (table.where(method=PERFECT).numbers("missed_share") == 0.0).all()
    for name in ("user_mean", "kriging", AVOID):
        assert (table.where(method=name).numbers("goodput_share") < 1.0 + 1e-9).all()
    for name in ("goodput", "proportional_fairness", "max_min_rate"):
        shares = by_method(table, f"{name}_share", loss="random:0.5")
        assert shares["kriging"] > shares["user_mean"]


def test_what_goodput_loses_has_three_parts(decided: tuple[EvaluateDecision, Evaluated]) -> None:
    table = decided[1].table
    goodput, choice, not_carried = (table.numbers(f"{name}_share") for name in ("goodput", "choice", "not_carried"))
    caution = 1.0 - goodput - choice - not_carried
    perfect = np.array([row[table.columns.index("method")] == PERFECT for row in table.rows])
    for part in (choice, not_carried, caution):
        assert (part[perfect] == 0.0).all()
        assert (part[~perfect] >= -1e-12).all()
    assert (choice[~perfect] > 0.0).all()
    half = by_method(table, "choice_share", loss="random:0.5")
    assert half["user_mean"] > 2.0 * half["kriging"]


def test_who_avoids_repaired_entries_keeps_promises_and_pays(decided: tuple[EvaluateDecision, Evaluated]) -> None:
    table = decided[1].table
    avoiding = table.where(method=AVOID)
    assert (avoiding.numbers("missed_share") == 0.0).all(), "observations are exact"
    assert (avoiding.numbers("resting_share") == 0.0).all()
    assert np.isnan(avoiding.numbers("missed_of_resting_share")).all()
    assert (avoiding.numbers("power_ratio") > 1.0).all()
    assert by_method(table, "missed_of_resting_share", loss="random:0.5")["kriging"] > 0.2


def test_decisions_are_written_and_drawn(decided: tuple[EvaluateDecision, Evaluated], tmp_path: Path) -> None:
    names = [path.name for path in write(*decided, tmp_path)]
    assert names == ["evaluate_decision.csv", "evaluate_decision.json", "regret.png", "promises.png"]
    assert all((tmp_path / name).stat().st_size > 0 for name in names)


def test_the_commands_answer_and_write(drops: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    methods = ("--methods", "user_mean", "--methods", "kriging", "--methods", "oracle")
    common = ("--loss", "random:0.3", "--draws", "4", "--num-users", "3", "--snr-db", "inf", "--json")
    out = tmp_path / "out"
    assert run(["evaluate", "repair", "rayleigh:30", str(drops), *methods, *common, "--out", str(out)]) == 0
    record = json.loads(capsys.readouterr().out)
    assert [(row["channel"], row["method"]) for row in record["rows"]] == [
        ("rayleigh:30", "user_mean"), ("rayleigh:30", "kriging"), ("rayleigh:30", "oracle"),
        ("cells", "user_mean"), ("cells", "kriging"),
    ]  # fmt: skip
    assert record["rows"][-1]["ratio_to_oracle"] is None
    assert record["configuration"]["channels"] == {"rayleigh:30": "3 × 20, exact", "cells": "3 × 16, as it is"}
    assert sorted(map(str, out.iterdir())) == sorted(record["files"])
    assert run(["evaluate", "decision", "rayleigh:300", "--methods", "linear", *common[:-1]]) == 0
    said = capsys.readouterr()
    assert "rayleigh:300, random:0.3: 30 % missing" in said.out
    assert "evaluate decision" in said.err


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["rayleigh:soon"], "rayleigh:NANOSECONDS or rayleigh:mixed; got 'rayleigh:soon'"),
        (["rayleigh:1e9"], "check its unit"),
        (["nowhere.npz"], "nowhere.npz: there is no such file"),
        (["rayleigh:100", "rayleigh:100"], "two channels have the same name"),
        (["--loss", "rain:0.2"], "unknown loss pattern 'rain'"),
        (["--loss", "stale:1"], "leaves nothing"),
        (["--methods", "krigin"], "did you mean 'kriging'"),
        (["--draws", "0"], "draws must be 1 or more"),
        (["--history", "0"], "history must be 1 or more"),
        (["rayleigh:mixed", "--user-correlation", "0.5"], "name one delay spread"),
    ],
)
def test_what_cannot_be_evaluated_is_refused(
    arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["evaluate", "repair", *arguments, "--json"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert told in err
    assert err.count("\n") == 1


def test_a_file_with_holes_is_refused(tmp_path: Path) -> None:
    np.save(tmp_path / "holes.npy", np.array([[1.0, np.nan], [2.0, 3.0]]))
    with pytest.raises(InputError, match="gains are missing"):
        FileChannel(path=tmp_path / "holes.npy").drawn(0)


def test_without_sklearn_the_extra_is_named_and_the_rest_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sklearn", None)
    with pytest.raises(
        MissingDependencyError, match=r"'knn' needs the package 'scikit-learn'.*wirelessagent\[evaluate\]"
    ):
        check_methods(["knn"])
    installed = evaluated_methods.installed_methods()
    assert set(all_methods()) - set(installed) == {"knn", "iterative"}
    with pytest.raises(UnknownNameError, match="soft_impute"):
        check_methods(["soft_input"])
    with pytest.raises(InputError, match="at least one method"):
        check_methods([])
