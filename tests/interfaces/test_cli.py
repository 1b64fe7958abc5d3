"""The command line as a user meets it: exit codes, streams, JSON, files."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wirelessagent.interfaces.cli import run
from wirelessagent.operations.catalogue import OPERATIONS

EXAMPLE = Path(__file__).parents[2] / "examples" / "data" / "measured_wifi.npz"


@pytest.fixture
def matrix(tmp_path: Path) -> Path:
    """A small gain matrix with holes, as CSV."""
    gain = np.random.default_rng(3).exponential(1e-10, (4, 12))
    gain[1, 3] = gain[2, 7] = np.nan
    path = tmp_path / "gain.csv"
    np.savetxt(path, gain, delimiter=",")
    return path


def answer(capsys: pytest.CaptureFixture[str], *arguments: object, code: int = 0) -> dict[str, Any]:
    """The JSON record of a command that must exit with ``code``."""
    assert run([str(argument) for argument in arguments] + ["--json"]) == code
    out, err = capsys.readouterr()
    assert err == ""
    return json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))


def refusal(capsys: pytest.CaptureFixture[str], *arguments: object, code: int = 2) -> str:
    """The one line on stderr of a command that must fail; with --json there is nothing on stdout."""
    assert run([str(argument) for argument in arguments] + ["--json"]) == code
    out, err = capsys.readouterr()
    assert out == ""
    assert "Traceback" not in err
    assert err.count("\n") == 1
    return err


@pytest.mark.parametrize("name", OPERATIONS)
def test_every_operation_is_a_command_with_help_and_json(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run([*name.split(), "--help"]) == 0
    shown = capsys.readouterr().out
    assert "--json" in shown
    assert OPERATIONS[name].split()[0] in shown


def test_every_operation_is_documented() -> None:
    page = (Path(__file__).parents[2] / "docs" / "cli.md").read_text(encoding="utf-8")
    for name in OPERATIONS:
        assert f"| `{name}" in page


def test_help_lists_the_options_of_the_plugins(capsys: pytest.CaptureFixture[str]) -> None:
    run(["simulate", "--help-all"])
    assert "--rms-delay-spread-s" in capsys.readouterr().out
    run(["compare", "--help-all"])
    assert "--frequency-weight" not in capsys.readouterr().err


def test_simulate_repair_solve_compare_pass_files_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    seen, repaired, allocation = tmp_path / "seen.npz", tmp_path / "repaired.npz", tmp_path / "allocation.json"
    simulated = answer(capsys, "simulate", "--num-users", 5, "--loss", "random:0.3", "--seed", 4, "--out", seen)
    assert (simulated["num_users"], simulated["num_subcarriers"]) == (5, 20)
    assert 0 < simulated["missing"] == sum(value is None for row in simulated["gain"] for value in row)

    filled = answer(capsys, "repair", seen, "--method", "linear", "--out", repaired)
    assert filled["missing"] == simulated["missing"]
    assert 0 < filled["normalised_rmse"] < 1
    with np.load(repaired) as stored, np.load(seen) as raw:
        observed = ~np.isnan(raw["gain"])
        np.testing.assert_array_equal(stored["gain"][observed], raw["gain"][observed])
        np.testing.assert_array_equal(stored["repaired"], ~observed)
        assert np.all(stored["gain_variance"][~observed] > 0)

    decided = answer(capsys, "solve", repaired, "--objective", "P1", "--max-power-w", 10, "--out", allocation)
    assert decided["status"] == "optimal"
    assert decided["total_power_w"] == pytest.approx(10, rel=1e-9)
    assert json.loads(allocation.read_text())["owner"] == decided["owner"]

    picture = tmp_path / "compared.png"
    compared = answer(
        capsys,
        "compare",
        repaired,
        "--objective",
        "max_rate",
        *("--methods=dual", "--methods=paper"),
        "--plot",
        picture,
    )
    assert [one["method"] for one in compared["answers"]] == ["dual", "paper"]
    assert compared["plot"] == str(picture)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert all(one["decision"]["gap"] < 1e-3 for one in compared["answers"])
    against = answer(
        capsys, "compare", repaired, "--objective", "PF", *("--methods=round_robin", "--methods=paper_scan")
    )
    assert [one["method"] for one in against["answers"]] == ["round_robin", "paper_scan"]
    assert "does not solve" in against["answers"][1]["refusal"]
    every = answer(capsys, "compare", repaired, "--objective", "proportional_fairness")["answers"]
    values = [one["decision"]["value"] for one in every]
    assert values == sorted(values, reverse=True)


def test_a_simulation_is_the_same_for_the_same_seed(capsys: pytest.CaptureFixture[str]) -> None:
    first = answer(capsys, "simulate", "--seed", 9, "--loss", "bursts:0.2")
    assert answer(capsys, "simulate", "--seed", 9, "--loss", "bursts:0.2") == first
    assert answer(capsys, "simulate", "--seed", 10, "--loss", "bursts:0.2") != first


def test_a_budget_of_any_size_is_solved_on_a_matrix_of_ones_own(
    matrix: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for budget in (1e-9, 1e6):
        decided = answer(capsys, "solve", matrix, "--max-power-w", budget)
        assert decided["status"] == "optimal"
        assert decided["max_power_w"] == budget
    assert "above the cell's limit" in refusal(capsys, "solve", matrix, "--max-power-w", 30, "--cell-max-power-w", 20)


def test_an_infeasible_promise_is_said_to_be_so_with_figures(matrix: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ("--objective", "min_power", "--min-rate-bps", 50e6, "--max-power-w", 0.01)
    decided = answer(capsys, "solve", matrix, *asked, code=3)
    assert decided["status"] == "infeasible"
    assert decided["needed_power_w"]["at_least"] > 0.01
    assert decided["rate_scaling"]["at_most"] < 1
    assert set(decided["owner"]) == {-1}
    assert sum(decided["power_w"]) == 0


def test_per_user_rates_are_read_from_a_list(matrix: Path, capsys: pytest.CaptureFixture[str]) -> None:
    decided = answer(
        capsys, "solve", matrix, "--objective", "min_power", "--min-rate-bps", "1e5,2e5,3e5,0", "--max-power-w", 1e3
    )
    assert np.all(np.array(decided["rate_bps"]) >= np.array([1e5, 2e5, 3e5, 0]) * (1 - 1e-9))


@pytest.mark.parametrize(
    ("words", "objective"),
    [
        ("Higher speed for video streaming", "max_rate"),
        ("Save power for sensors, 200 kbit/s each", "min_power"),
        ("能效最高", "max_energy_efficiency"),
    ],
)
def test_ask_runs_the_whole_chain(words: str, objective: str, capsys: pytest.CaptureFixture[str]) -> None:
    record = answer(capsys, "ask", words, "--seed", 3)
    assert record["decision"]["objective"] == objective
    assert record["decision"]["status"] in ("optimal", "feasible")
    assert record["outcome"]["base_station"] == "simulated"
    assert record["report"]["achieved"]["power_w"] == pytest.approx(record["decision"]["total_power_w"])
    missing = sum(value is None for row in record["observed_gain"] for value in row)
    assert missing == sum(map(sum, record["estimate"]["repaired"])) > 0
    assert record["explanation"]


def test_ask_shows_each_stage_and_writes_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "run.png"
    assert (
        run(
            [
                "ask",
                "Higher speed for video streaming",
                "--csi",
                str(EXAMPLE),
                "--loss",
                "random:0.2",
                "--plot",
                str(picture),
            ]
        )
        == 0
    )
    shown = capsys.readouterr().out
    for stage in ("understand", "sense", "repair", "decide", "act"):
        assert f"{stage}  " in shown
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_ask_repairs_only_where_something_is_missing(capsys: pytest.CaptureFixture[str]) -> None:
    record = answer(capsys, "ask", "maximum rate", "--csi", EXAMPLE)
    assert record["estimate"]["method"] == "none"


def test_ask_without_a_known_truth_applies_nothing_but_can_write(
    matrix: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "allocation.csv"
    record = answer(capsys, "ask", "maximum rate", "--csi", matrix, "--out", out)
    assert record["outcome"] is None
    assert record["report"]["achieved"] is None
    assert len(out.read_text().splitlines()) == 13


def test_an_unclear_sentence_gets_a_question_back(capsys: pytest.CaptureFixture[str]) -> None:
    record = answer(capsys, "ask", "make it nice", code=2)
    assert record["decision"] is None
    assert record["intent"]["kind"] == "clarify"
    assert "?" in record["intent"]["reply"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["solve", "nowhere.csv"], "nowhere.csv"),
        (["solve"], "PATH"),
        (["solve", EXAMPLE, "--objective", "max_rat"], "did you mean 'max_rate'"),
        (["solve", EXAMPLE, "--method", "nothing"], "unknown method 'nothing'"),
        (["solve", EXAMPLE, "--max-power-w", "-3"], "-3"),
        (["solve", EXAMPLE, "--max-power-w", "much"], "much"),
        (["solve", EXAMPLE, "--min-rate-bps", "1,x"], "--min-rate-bps"),
        (["solve", EXAMPLE, "--users", "nobody"], "nobody"),
        (["solve", EXAMPLE, "--overhead", "1.5"], "overhead"),
        (["solve", EXAMPLE, "--method", "paper_scan", "--objective", "min_power"], "does not solve"),
        (["repair", EXAMPLE, "--out", "no/such/folder/x.npz", "--drop", "0"], "no/such/folder"),
        (["simulate", "--loss", "rain:0.1"], "rain"),
        (["simulate", "--num-users", "0"], "num_users"),
        (["simulate", "--cell-preset", "lte"], "lte"),
        (["ask", "maximum rate", "--plot", "run.gif"], "run.gif"),
        (["compare", EXAMPLE, "--objective", "max_rate", "--plot", "run.gif"], "run.gif"),
        (["reproduce", "everything"], "everything"),
        (["reproduce", "--draws", "0"], "draws"),
        (["plugins", "--kind", "solver"], "solver"),
        (["solve", EXAMPLE, "--objective", "P3", "--method", "paper_scan", "--num-levels", "1000000000"], "num_levels"),
        (["dance"], "dance"),
        (["ask", "max rate \udcff"], "text: this is not text in UTF-8"),
        (
            ["solve", EXAMPLE, "--method", "paper_bisection", "--objective", "P1", "--min-rate-bps", "1e6"],
            "min_rate_bps: leave it out or name another method (dual, equal_power, exact, greedy, ",
        ),
        (["ask", "maximum rate", "--no-such-option"], "--no-such-option"),
    ],
    ids=lambda value: " ".join(map(str, value))[:60] if isinstance(value, list) else None,
)
def test_bad_input_gets_one_clear_line(
    arguments: list[object],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert said in refusal(capsys, *arguments)
    assert list(tmp_path.iterdir()) == []


def test_the_program_runs_as_a_module_and_says_its_version() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "wirelessagent", "--version"], capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stdout.startswith("wirelessagent 0.")


def test_without_a_command_the_help_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert run([]) == 2
    out, err = capsys.readouterr()
    assert "solve" in out
    assert err == ""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no device that is always full")
def test_a_full_disk_is_one_line(tmp_path: Path) -> None:
    with open("/dev/full", "w") as full:  # noqa: PTH123
        done = subprocess.run(
            [sys.executable, "-m", "wirelessagent", "intent", "save power"],
            stdout=full, stderr=subprocess.PIPE, text=True, timeout=60, check=False,
        )  # fmt: skip
    assert done.returncode == 1
    assert "No space left on device" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_terminal_without_chinese_does_not_stop_the_work() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "wirelessagent", "intent", "能效最高"],
        capture_output=True, text=True, timeout=60, check=True, env={**os.environ, "PYTHONIOENCODING": "latin-1"},
    )  # fmt: skip
    assert "max_energy_efficiency" in done.stdout


def test_a_solved_file_can_be_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    record = answer(capsys, "solve", EXAMPLE, "--plot", tmp_path / "solved.svg")
    assert record["plot"] == str(tmp_path / "solved.svg")
    assert b"<svg" in (tmp_path / "solved.svg").read_bytes()


def test_a_guess_is_called_a_guess(capsys: pytest.CaptureFixture[str]) -> None:
    record = answer(capsys, "ask", "max rate", "--loss", "users:1")
    assert len(record["estimate"]["unobserved_users"]) == 1
    assert any("is a guess" in sentence for sentence in record["explanation"])


def test_an_interruption_while_loading_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from wirelessagent.__main__ import main

    def interrupted(arguments: list[str]) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr("wirelessagent.interfaces.cli.run", interrupted)
    with pytest.raises(SystemExit) as stopped:
        main()
    assert stopped.value.code == 130
    assert capsys.readouterr().err == "wirelessagent: interrupted\n"


def test_an_interruption_of_a_compiler_exits_with_130() -> None:
    """Compilers run what they write with ``exec``, after which Python would end by the signal instead."""
    interrupted = (
        "import os, signal, sys, types; from wirelessagent.__main__ import main; "
        "signal.signal(signal.SIGINT, signal.default_int_handler); "
        "run = lambda _: exec('import os, signal; os.kill(os.getpid(), signal.SIGINT)'); "
        "sys.modules['wirelessagent.interfaces.cli'] = types.SimpleNamespace(run=run); main()"
    )
    done = subprocess.run([sys.executable, "-c", interrupted], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (130, "wirelessagent: interrupted\n")
