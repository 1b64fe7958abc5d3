"""export: what is in the audit store as documents of standards, on the command line."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.interfaces.cli import run
from wirelessagent.standards import tmf921, tmf921_models, ts28312_models
from wirelessagent.store.store import Store
from wirelessagent.testing.turns import decided_turn, random_turn, turn_of

CELL = wa.Cell()


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A store of two turns of a session, a question between them, and one of another session."""
    place = tmp_path / "audit.sqlite3"
    scene = wa.simulate("rayleigh", CELL, num_users=3, num_subcarriers=6, seed=2)
    with Store.open(place, create=True) as store:
        store.append(decided_turn(scene, wa.Problem("max_rate", max_power_w=5.0), number=1))
        store.append(turn_of(None, number=2))
        store.append(decided_turn(scene, wa.Problem("max_rate", max_power_w=10.0), number=3))
        store.append(random_turn(1, session="another one/2", seed=1))
    return place


def printed(place: Path, capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    assert run(["export", *arguments, "--store", str(place), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_a_turn_is_printed_as_a_standard_has_it(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sent = printed(place, capsys, "1")
    ts28312_models.Document.model_validate(sent)
    assert sent["Intent"][0]["id"] == "one-1"
    assert sent["Intent"][0]["userLabel"] == "higher speed"
    tmf921_models.Document.model_validate(printed(place, capsys, "1", "--format", "tmf921"))


def test_better_than_what_the_session_had_before(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first, third = printed(place, capsys, "1"), printed(place, capsys, "3")
    before, objective = (sent["Intent"][0]["intentExpectations"][0]["expectationTargets"][0] for sent in (first, third))
    assert before["targetValueRange"] == 0
    results = first["IntentReport"][0]["intentFulfilmentReport"]["expectationFulfilmentResult"]
    assert objective["targetValueRange"] == results[0]["targetFulfilmentResults"][0]["targetAchievedValue"]
    whole = third["IntentReport"][0]["intentFulfilmentReport"]["intentFulfilmentInfo"]
    assert whole == {"fulfilmentStatus": "FULFILLED"}


def test_what_was_put_back_is_what_there_was(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = wa.simulate("rayleigh", CELL, num_users=3, num_subcarriers=6, seed=2)
    with Store.open(place) as store:
        turn = decided_turn(scene, wa.Problem("max_rate", max_power_w=20.0), number=4)
        small = decided_turn(scene, wa.Problem("max_rate", max_power_w=1.0), number=4)
        assert small.run is not None
        store.append(dataclasses.replace(turn, stage="reverted", restored=small.run.outcome))
        number = store.append(decided_turn(scene, wa.Problem("max_rate", max_power_w=10.0), number=5))
    sent = printed(place, capsys, str(number))
    assert small.run.outcome is not None
    assert small.run.outcome.achieved is not None
    current = float(np.mean(small.run.outcome.achieved.user_rate_bps)) / 1e3
    wanted = sent["Intent"][0]["intentExpectations"][0]["expectationTargets"][0]["targetValueRange"]
    assert wanted == pytest.approx(current, rel=1e-12)


def info_of(sent: dict[str, Any]) -> dict[str, Any]:
    return sent["IntentReport"][0]["intentFulfilmentReport"]["intentFulfilmentInfo"]


class Halving(wa.BaseStation):
    """Does as told, but for one time, when it radiates half of it."""

    name = "halving"

    def __init__(self, scene: wa.Scene, fails_at: int) -> None:
        self._station, self._left = wa.SimulatedBaseStation(scene), fails_at

    def apply(self, decision: wa.Decision) -> wa.Outcome:
        self._left -= 1
        done = self._station.apply(decision)
        return dataclasses.replace(done, power_w=done.power_w * (0.5 if self._left == 0 else 1.0))


CONVERSATION = (
    "Highest total rate with at most 5 W",
    "now with 10 W",
    "Highest total rate with at most 5 W",
    "what if we had 20 W?",
    "undo",
)
"""Applied, reverted, changes nothing, supposes, goes back to a request that is not in effect."""


@pytest.fixture(scope="module")
def talked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("talk") / "audit.sqlite3"
    scene = wa.simulate("rayleigh", wa.Cell(max_power_w=20), num_users=3, num_subcarriers=6, seed=2)
    with Store.open(place, create=True) as store:
        session = wa.Session(scene, base_station=Halving(scene, 2), confirm=False, store=store)
        stages = [session.say(line).stage for line in CONVERSATION]
    assert stages[:4] == ["applied", "reverted", "nothing", "answered"]
    return place


def test_what_was_reverted_is_terminated_and_deactivated(talked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sent = printed(talked, capsys, "2")
    assert sent["Intent"][0]["intentAdminState"] == "DEACTIVATED"
    assert info_of(sent)["notFullfilledState"] == "TERMINATED"


def test_what_is_in_effect_already_is_fulfilled(talked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first, third = printed(talked, capsys, "1"), printed(talked, capsys, "3")
    for sent in (first, third):
        assert sent["Intent"][0]["intentAdminState"] == "ACTIVATED"
        assert info_of(sent) == {"fulfilmentStatus": "FULFILLED"}
    results = [
        sent["IntentReport"][0]["intentFulfilmentReport"]["expectationFulfilmentResult"][0]["targetFulfilmentResults"]
        for sent in (first, third)
    ]
    assert results[0][0]["targetAchievedValue"] == results[1][0]["targetAchievedValue"]


@pytest.mark.parametrize("number", ["4", "5"])
def test_what_ifs_and_undoing_are_no_requests(talked: Path, number: str, capsys: pytest.CaptureFixture[str]) -> None:
    if number == "5":
        with Store.open(talked) as store:
            assert store.turn(5).stage == "undone"
    assert run(["export", number, "--store", str(talked), "--json"]) != 0
    told = capsys.readouterr().err
    assert f"turn {number} " in told
    assert "is no request" in told
    assert "such as turn" in told


def test_what_is_in_effect_is_exported_if_no_turn_is_named(talked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sent = printed(talked, capsys)
    assert sent["Intent"][0]["userLabel"] == "Highest total rate with at most 5 W"
    assert info_of(sent) == {"fulfilmentStatus": "FULFILLED"}


def test_a_yes_is_told_in_the_words_of_the_request(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    place = tmp_path / "audit.sqlite3"
    scene = wa.simulate("rayleigh", CELL, num_users=3, num_subcarriers=6, seed=2)
    with Store.open(place, create=True) as store:
        session = wa.Session(scene, base_station=Halving(scene, 9), confirm=True, store=store)
        stages = [session.say(line).stage for line in ("Highest total rate with at most 5 W", "apply it")]
    assert stages == ["planned", "applied"]
    assert info_of(printed(place, capsys, "1"))["notFullfilledState"] == "RECEIVED"
    sent = printed(place, capsys)
    assert sent["Intent"][0]["userLabel"] == "Highest total rate with at most 5 W"
    assert info_of(sent) == {"fulfilmentStatus": "FULFILLED"}


def test_what_is_impossible_is_exported_where_nothing_is_in_effect(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "audit.sqlite3"
    scene = wa.simulate("rayleigh", CELL, num_users=3, num_subcarriers=6, seed=2)
    with Store.open(place, create=True) as store:
        refused = decided_turn(scene, wa.Problem("max_rate", max_power_w=5.0, min_rate_bps=1e9), number=1)
        store.append(dataclasses.replace(refused, stage="nothing"))
    report = printed(place, capsys)["IntentReport"][0]
    assert report["intentFeasibilityCheckReport"]["feasibilityCheckResult"] == "INFEASIBLE"


def test_the_latest_decision_is_meant_if_none_is_named(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert printed(place, capsys)["Intent"][0]["id"] == "another-one-2-1"


def test_a_file_holds_the_same(place: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "intent.json"
    assert run(["export", "3", "--store", str(place), "--format", "tmf921", "--out", str(out)]) == 0
    told = capsys.readouterr().out
    assert "TMF921 v5" in told
    assert "AveDLRANUEThpt" in told
    assert "kept" in told
    text = out.read_text(encoding="utf-8")
    assert tmf921.to_json(tmf921_models.Document.model_validate_json(text)) + "\n" == text
    assert json.loads(text) == printed(place, capsys, "3", "--format", "tmf921")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["2"], "decided nothing"),
        (["99"], "there is no turn 99"),
        (["1", "--format", "28312"], "should be 'ts28312' or 'tmf921'"),
        (["1", "--observation-period-s", "0"], "observation_period_s must be positive"),
        (["1", "--out", "/no/such/folder/x.json"], "does not exist"),
    ],
)
def test_what_cannot_be_exported_is_said(
    place: Path, arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["export", *arguments, "--store", str(place)]) in (1, 2)
    assert told in capsys.readouterr().err
