"""Promises with an outage probability, from words and options to what is said of them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.interfaces.cli import run
from wirelessagent.telling.explanation import explain
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.report import decision_tables
from wirelessagent.telling.roster import Accounts


@pytest.fixture(autouse=True)
def _wide(monkeypatch: pytest.MonkeyPatch) -> None:
    """Room for each heading on one line."""
    monkeypatch.setenv("COLUMNS", "240")


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
    assert "each promise is kept with 99.9 %" in told
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
    assert "joint posterior" not in told
    assert "romise" not in told.replace("makes promises of them", "")
    assert "asked for (kept with)" in told
    assert re.search(r"the least sure one, 500 kbit/s for user \d, is kept with [\d.]+ %", told)


@pytest.mark.parametrize(
    ("language", "kept", "asked", "promised"),
    [("en", "asked for (kept with)", "asked for", "romise"), ("zh", "要求的速率（兑现概率）", "要求", "承诺")],
)
def test_what_was_asked_for_without_a_probability_is_not_called_promised(
    language: str, kept: str, asked: str, promised: str
) -> None:
    """Nowhere: in tables, explanations, what the base station did, accounts of users, and why something can't be."""
    scene = wa.simulate("rayleigh", num_users=4, num_subcarriers=8, seed=3)
    estimate = wa.repair(scene.observe(wa.loss.random(0.3), seed=1))
    for rate, usable in ((1e6, True), (1e8, False)):
        decision = wa.decide(estimate, wa.Problem("min_power", min_rate_bps=rate), scene.cell)
        outcome = wa.SimulatedBaseStation(scene).apply(decision) if usable else None
        made = wa.report(decision, outcome)
        told = [*explain(estimate, made, language=language)]
        for table in decision_tables(made, estimate, language):
            told += [table.title, *table.columns, *(cell for row in table.rows for cell in row)]
        assert decision.problem.firmness == "asked"
        assert any(asked in each for each in told)
        offered = ("makes promises of them", "即成为承诺")
        assert not [each for each in told if promised in each and not any(offer in each for offer in offered)]
        if usable:
            assert kept in told
            case = Case(estimate=estimate, decision=decision)
            said = [Accounts(case, language).share(user) for user in range(4)]
            assert not [each for each in said if promised in each]


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
    told = shown(capsys, "ask", words, "--loss", "random:0.3", "--seed", "3", "--full")
    assert promised in told
    assert all(part in told for part in table)


def test_compare_promises_by_every_method(capsys: pytest.CaptureFixture[str], holed: Path) -> None:
    told = shown(
        capsys, "compare", holed, "--objective", "min_power", "--min-rate-bps", "5e5", "--outage-probability", "0.05"
    )
    assert all(name in told for name in ("dual", "greedy", "paper", "exact"))
    assert "does not honour" not in told
