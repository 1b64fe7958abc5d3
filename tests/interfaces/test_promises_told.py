"""Promises with an outage probability, from words and options to what is said of them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.interfaces.cli import run


@pytest.fixture
def holed(tmp_path: Path) -> Path:
    """Gains of 8 users on 20 subcarriers, a third of them missing."""
    scene = wa.simulate("rayleigh", num_users=8, num_subcarriers=20, seed=3)
    path = tmp_path / "gain.npy"
    np.save(path, scene.observe(wa.loss.random(0.3), seed=1).current)
    return path


def shown(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    """All that is printed, in one line."""
    assert run([*map(str, arguments)]) == 0
    return " ".join(capsys.readouterr().out.split())


def test_solve_says_what_is_promised_at_which_probability(capsys: pytest.CaptureFixture[str], holed: Path) -> None:
    asked = "solve", holed, "--objective", "min_power", "--min-rate-bps", "5e5", "--outage-probability"
    told = shown(capsys, *asked, "0.001")
    assert "no promises kept at 99.9 % do better than" in told
    assert "promised at 99.9 %" in told
    assert "4 Mbit/s are promised in all" in told
    run([*map(str, asked), "0.001", "--json"])
    answer = json.loads(capsys.readouterr().out)
    assert answer["outage_probability"] == 0.001
    assert len(answer["outage"]) == len(answer["expected_rate_bps"]) == 8
    assert min(answer["rate_bps"]) >= 5e5 * (1 - 1e-9)
    assert max(answer["outage"]) < 0.003
    report = answer["report"]["predicted"]
    assert report["user_rate_bps"] == answer["expected_rate_bps"]
    assert report["goodput_bps"] <= sum(answer["rate_bps"])


def test_without_an_outage_probability_nothing_is_said_of_one(capsys: pytest.CaptureFixture[str], holed: Path) -> None:
    told = shown(capsys, "solve", holed, "--objective", "min_power", "--min-rate-bps", "5e5")
    assert "promised at" not in told
    assert "joint posterior" not in told


@pytest.mark.parametrize(
    ("words", "promised", "table"),
    [
        (
            "Save power, 500 kbit/s each, 95% reliability",
            "Each promised rate is kept with a probability of 95 %",
            ("Promised at 95 %", "of 8 kept", "Users"),
        ),
        (
            "最节能，每用户至少500kbps，可靠性95%",
            "每个承诺速率以 95 % 的概率兑现",
            ("以 95 % 承诺", "/8 兑现", "用户"),
        ),
    ],
)
def test_ask_promises(capsys: pytest.CaptureFixture[str], words: str, promised: str, table: tuple[str, ...]) -> None:
    told = shown(capsys, "ask", words, "--loss", "random:0.3", "--seed", "3")
    assert promised in told
    assert all(part in told for part in table)


def test_compare_promises_by_every_method(capsys: pytest.CaptureFixture[str], holed: Path) -> None:
    told = shown(
        capsys, "compare", holed, "--objective", "min_power", "--min-rate-bps", "5e5", "--outage-probability", "0.05"
    )
    assert all(name in told for name in ("dual", "greedy", "paper", "exact"))
    assert "does not honour" not in told
