"""What the command line takes in several ways, and what it says of limits, noise and rates."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wirelessagent.interfaces.cli import run

RNG = np.random.default_rng(3)


@pytest.fixture
def matrix(tmp_path: Path) -> Path:
    """Complete gains of 4 users on 12 subcarriers."""
    path = tmp_path / "gain.csv"
    np.savetxt(path, np.random.default_rng(3).exponential(1e-10, (4, 12)), delimiter=",")
    return path


@pytest.fixture
def described(tmp_path: Path) -> Path:
    """The same with noise and bandwidth stated."""
    path = tmp_path / "gain.npz"
    meta = json.dumps({"noise_psd_w_per_hz": 1e-17, "rb_bandwidth_hz": 180e3})
    np.savez(path, gain=np.random.default_rng(3).exponential(1e-10, (4, 12)), meta=np.array(meta))
    return path


def answer(capsys: pytest.CaptureFixture[str], *arguments: object) -> dict[str, Any]:
    assert run([*map(str, arguments), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def shown(capsys: pytest.CaptureFixture[str], *arguments: object, code: int = 0) -> str:
    """All that is printed, in one line."""
    assert run([*map(str, arguments)]) == code
    streams = capsys.readouterr()
    return " ".join((streams.out + streams.err).split())


def test_given_noise_and_bandwidth_win_over_the_file_and_are_said_to(
    described: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = answer(capsys, "solve", described, "--noise-psd-w-per-hz", 1e-20, "--subcarrier-bandwidth-hz", 15e3)
    stated = answer(capsys, "solve", described)
    assert given["facts"]["noise"] == "1e-20 W/Hz (given; the file says 1e-17 W/Hz)"
    assert given["facts"]["bandwidth"] == "15 kHz (given; the file says 180 kHz)"
    assert stated["facts"]["noise"] == "1e-17 W/Hz (from the file)"
    assert given["value"] / 15e3 > stated["value"] / 180e3


def test_a_given_noise_of_which_the_file_says_nothing(matrix: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert answer(capsys, "solve", matrix, "--noise-psd-w-per-hz", 1e-20)["facts"]["noise"] == "1e-20 W/Hz (given)"


def test_a_budget_is_the_cells_limit_unless_that_is_given(matrix: Path, capsys: pytest.CaptureFixture[str]) -> None:
    more = answer(capsys, "solve", matrix, "--max-power-w", 50)
    assert more["max_power_w"] == 50
    assert more["facts"]["power limit"] == "50 W (the budget; --cell-max-power-w sets another)"
    assert "power limit" not in answer(capsys, "solve", matrix, "--max-power-w", 5)["facts"]
    told = shown(capsys, "solve", matrix, "--max-power-w", 50, "--cell-max-power-w", 30, code=2)
    assert "above the cell's limit of 30 W" in told


def test_a_sentence_beyond_the_cells_limit_is_answered_at_once(capsys: pytest.CaptureFixture[str]) -> None:
    told = shown(capsys, "ask", "Highest total rate, at most 50 W", "--num-users", 3)
    places = [told.index(part) for part in ("understand", "note 50 W is above the cell's limit of 20 W", "sense")]
    assert places == sorted(places)


def test_a_file_is_read_and_then_sensed_once(matrix: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["ask", "Highest total rate", "--csi", str(matrix)]) == 0
    stages = [line.split()[0] for line in capsys.readouterr().out.splitlines()[:8] if line.split()]
    assert stages.count("sense") == stages.count("read") == 1


def test_rates_are_promised_only_where_some_were_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    told = shown(capsys, "ask", "Highest total rate", "--num-users", 3, "--loss", "users:1")
    assert "planned rates kept" in told
    assert "promised rate" not in told
    promised = shown(capsys, "ask", "Least power, 100 kbit/s each", "--num-users", 3, "--loss", "users:1")
    assert "promises kept" in promised
    assert "committed" not in promised


@pytest.mark.parametrize("methods", [["dual,greedy"], ["dual, greedy"], ["dual", "greedy"]])
def test_methods_are_listed_or_repeated(methods: list[str], matrix: Path, capsys: pytest.CaptureFixture[str]) -> None:
    flags = [flag for name in methods for flag in ("--methods", name)]
    found = answer(capsys, "compare", matrix, "--objective", "PF", *flags)["answers"]
    assert {one["method"] for one in found} == {"dual", "greedy"}


def test_options_go_to_the_compared_methods_that_have_them(matrix: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ("compare", matrix, "--objective", "PF", "--methods", "dual,greedy", "--restarts", 3)
    restarts = {one["method"]: one["decision"]["restarts"] for one in answer(capsys, *arguments)["answers"]}
    assert restarts == {"dual": 3, "greedy": 0}
    told = shown(capsys, "compare", matrix, "--methods", "greedy", "--effort", "fast", code=2)
    assert "unknown option 'effort' of the methods greedy" in told


def test_users_and_forbidden_pairs(matrix: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for forbidden in (["--forbidden", "user 2:5-9,user 3:0"], ["--forbidden", "user 2:5-9", "--forbidden", "user 3:0"]):
        found = answer(capsys, "solve", matrix, "--objective", "PF", "--users", "user 2,user 3", *forbidden)
        assert set(found["owner"]) == {1, 2}
        assert 1 not in found["owner"][5:10]
        assert found["owner"][0] != 2
    for wrong, why in (
        ("user 9:1", "no user is called 'user 9'"),
        ("user 2", "of the form 'user 2:5-9'"),
        ("user 2:5-12", "subcarriers go from 0 to 11"),
    ):
        assert why in shown(capsys, "solve", matrix, "--forbidden", wrong, code=2)


def test_the_fairness_is_that_of_the_users_to_serve(matrix: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = answer(capsys, "solve", matrix, "--objective", "max_min_rate", "--users", "user 1,user 2")
    assert found["report"]["predicted"]["jain_index"] > 0.9


def test_who_cannot_be_served_is_counted(capsys: pytest.CaptureFixture[str]) -> None:
    told = shown(capsys, "ask", "Share fairly", "--num-users", 8, "--num-subcarriers", 5, "--loss", "random:0.0001")
    assert "3 of 8 users cannot be served: there are only 5 subcarriers" in told


def test_gains_are_not_repaired_for_a_file_that_cannot_be_written(
    matrix: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    told = shown(capsys, "repair", matrix, "--out", tmp_path / "o.mat", code=2)
    assert told == "wirelessagent: gains are written as NPZ or CSV; end the name in .npz or .csv instead of 'o.mat'"


def test_nothing_is_the_best_where_nothing_is_feasible(matrix: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ("--objective", "min_power", "--min-rate-bps", 1e9, "--methods", "dual,greedy")
    told = shown(capsys, "compare", matrix, *arguments, code=3)
    assert "none has an allocation" in told
    assert "best first" not in told


def test_numbers_in_brackets_are_read_and_wrong_ones_shown_as_written(
    matrix: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = answer(capsys, "solve", matrix, "--objective", "min_power", "--min-rate-bps", "[1e5, 0, 0, 0]")
    assert np.count_nonzero(found["rate_bps"]) == 1
    told = shown(capsys, "solve", matrix, "--min-rate-bps", "1e5,lots", code=2)
    assert "got '1e5,lots'" in told


def test_help_shows_long_names_whole(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    assert run(["solve", "--help"]) == 0
    assert not [line for line in capsys.readouterr().out.splitlines() if "--" in line and "…  " in line[:60]]
