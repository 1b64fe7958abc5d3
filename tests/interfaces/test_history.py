"""Looking back: history lists, shows, does again and exports what was recorded."""

from __future__ import annotations

import dataclasses
import hashlib
import itertools
import json
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.agent.turn import Tools
from wirelessagent.deciding.core import time_limit
from wirelessagent.deciding.objectives.proportional_fairness import ProportionalFairness
from wirelessagent.interfaces.cli import run
from wirelessagent.store import replay as replaying
from wirelessagent.store.content import Content, observation_of
from wirelessagent.store.rebuilt import decision_of, outcome_of
from wirelessagent.store.store import Store
from wirelessagent.store.stored import sealed
from wirelessagent.testing.turns import decided_turn, random_turn

pytestmark = pytest.mark.machine_code

LOST = wa.loss.random(0.2)
PROBLEMS = {
    "rate": (wa.Problem("max_rate"), Tools()),
    "rate with weights, repaired as in the paper": (
        wa.Problem("max_rate", weights=(3.0, 1.0, 0.0, 2.0), users=("user 1", "user 3", "user 4")),
        Tools(repairer="nncf_paper", repairer_options={"frequency_weight": 0.7}),
    ),
    "power, groups, caps": (
        wa.Problem("min_power", min_rate_bps=(2e5, 1e5, 0.0, 1e5), resource_block_group_size=2,
                   subcarrier_max_power_w=np.inf, max_rate_bps=np.inf, max_power_w=15),
        Tools(method_options={"seed": 3}),
    ),
    "power, too much": (wa.Problem("min_power", min_rate_bps=1e9), Tools()),
    "power, with an outage": (wa.Problem("min_power", min_rate_bps=1e5, outage_probability=0.1), Tools()),
    "efficiency": (wa.Problem("max_energy_efficiency", min_rate_bps=1e5), Tools(method="greedy")),
    "fair after a past": (wa.Problem(ProportionalFairness(past_average_bps=(1e6, 0.0, 3e6, 1e5))), Tools()),
    "lowest, with a forbidden pair": (
        wa.Problem("max_min_rate", forbidden=np.arange(48).reshape(4, 12) % 7 == 0),
        Tools(method_options={"effort": "thorough"}),
    ),
    "the paper's": (wa.Problem("max_rate"), Tools(method="paper", repairer="nncf")),
}  # fmt: skip


@pytest.fixture(scope="module")
def scene() -> wa.Scene:
    return wa.simulate("rayleigh", num_users=4, num_subcarriers=12, seed=1)


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "audit.sqlite3"
    monkeypatch.setenv("WIRELESSAGENT_STORE_URL", str(path))
    return path


def answer(capsys: pytest.CaptureFixture[str], *arguments: object, code: int = 0) -> dict[str, Any]:
    assert run([str(argument) for argument in arguments] + ["--json"]) == code, capsys.readouterr().err
    return json.loads(capsys.readouterr().out)


def talked(capsys: pytest.CaptureFixture[str], *sentences: str, options: tuple[str, ...] = ()) -> list[dict[str, Any]]:
    """The turns of a conversation, each a line of JSON; what was said on stderr stays to be read."""
    said = [part for sentence in sentences for part in ("--say", sentence)]
    assert run(["chat", "--num-users", "4", *said, *options, "--json"]) == 0
    out, err = capsys.readouterr()
    sys.stderr.write(err)
    return [json.loads(line) for line in out.splitlines()]


def told(capsys: pytest.CaptureFixture[str], *arguments: object, code: int = 0) -> str:
    assert run([str(argument) for argument in arguments]) == code, capsys.readouterr().err
    return capsys.readouterr().out


@pytest.mark.parametrize(("problem", "tools"), PROBLEMS.values(), ids=PROBLEMS.keys())
def test_a_replay_is_identical(place: Path, scene: wa.Scene, problem: wa.Problem, tools: Tools) -> None:
    turn = decided_turn(scene, problem, LOST, tools=tools)
    assert turn.run is not None
    with Store.open(place, create=True) as store:
        replay = store.replay(store.append(turn))
    assert (replay.verdict, replay.same_setting, replay.differences) == ("identical", True, ())
    for name in ("owner", "power_w", "rate_bps"):
        np.testing.assert_array_equal(getattr(replay.decision, name), getattr(turn.run.decision, name))
    assert replay.decision.status == turn.run.decision.status


@pytest.mark.parametrize("problem", [
    wa.Problem("max_min_rate"), wa.Problem("min_power", min_rate_bps=2e5),
    wa.Problem("min_power", min_rate_bps=1e5, outage_probability=0.1),
], ids=["lowest", "power", "power, with an outage"])  # fmt: skip
def test_a_deadline_is_replayed_by_its_restarts(
    place: Path, scene: wa.Scene, problem: wa.Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    ticks = itertools.count()
    silent = SimpleNamespace(start=lambda: None, cancel=lambda: None)
    monkeypatch.setattr(time_limit.threading, "Timer", lambda *_: silent)
    monkeypatch.setattr(time_limit, "time", SimpleNamespace(perf_counter=lambda: next(ticks) / 1e3))
    turn = decided_turn(scene, problem, tools=Tools(method_options={"deadline_s": 0.06, "seed": 5}))
    monkeypatch.setattr(time_limit, "time", SimpleNamespace(perf_counter=lambda: 0.0))  # a machine of another speed
    assert turn.run is not None
    with Store.open(place, create=True) as store:
        assert store.replay(store.append(turn)).verdict == "identical"
    assert turn.run.decision.restarts > 10


def test_a_replay_says_how_it_differs(place: Path, scene: wa.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    turn = decided_turn(scene, wa.Problem("max_min_rate"), LOST)
    decide = wa.decide

    def shifted(share: float) -> None:
        def decided(*arguments: Any, **options: Any) -> wa.Decision:
            found = decide(*arguments, **options)
            other = dataclasses.replace(found, power_w=found.power_w * (1.0 + share))
            vars(other)["forecast"] = found.forecast
            return other

        monkeypatch.setattr("wirelessagent.chain.decide", decided)

    with Store.open(place, create=True) as store:
        number = store.append(turn)
        shifted(1e-12)
        replay = store.replay(number)
        assert (replay.verdict, len(replay.differences)) == ("close", 1)
        assert replay.differences[0].startswith("power_w differs by 1")
        shifted(1e-6)
        assert store.replay(number).verdict == "different"
        assert store.replay(number).differences == ("power_w differs by 1e-06",)
        monkeypatch.setattr(replaying, "this_platform", lambda: {"machine": "another"})
        assert store.replay(number).summary == "another decision, on another version or platform"


def test_another_owner_or_status_is_another_decision(
    place: Path, scene: wa.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    turn = decided_turn(scene, wa.Problem("max_rate"))
    decide = wa.decide
    with Store.open(place, create=True) as store:
        number = store.append(turn)
        for change in ({"owner": np.full(12, 3)}, {"status": "feasible"}):
            monkeypatch.setattr(
                "wirelessagent.chain.decide",
                lambda *given, change=change, **options: dataclasses.replace(decide(*given, **options), **change),
            )
            replay = store.replay(number)
            assert replay.verdict == "different"
            assert f"{next(iter(change))} differs" in replay.differences


def test_a_decision_comes_back_with_what_was_told_of_it(place: Path, scene: wa.Scene) -> None:
    turn = decided_turn(scene, wa.Problem("max_min_rate"), LOST)
    assert turn.run is not None
    with Store.open(place, create=True) as store:
        found = store.turn(store.append(turn))
    decision = decision_of(found, scene.sensed.user_names)
    np.testing.assert_array_equal(decision.committed_bps, turn.run.decision.committed_bps)
    assert turn.run.outcome is not None
    outcome = dataclasses.replace(turn.run.outcome, true_gain=None)  # what nobody can read back from a real cell
    assert str(wa.report(decision, outcome_of(found))) == str(wa.report(turn.run.decision, outcome))


def test_history_lists_what_was_recorded(place: Path, scene: wa.Scene, capsys: pytest.CaptureFixture[str]) -> None:
    assert f"nothing is recorded yet in {place}" in " ".join(told(capsys, "history").split())
    assert not place.exists()
    with Store.open(place, create=True) as store:
        store.append(decided_turn(scene, wa.Problem("min_power", min_rate_bps=1e9)))
        store.append(decided_turn(scene, wa.Problem("max_rate"), number=2))
        store.append(random_turn(4, session="other", seed=1))
    listed = answer(capsys, "history")
    assert listed["store"] == str(place)
    assert [line["number"] for line in listed["turns"]] == [1, 2, 3]
    assert [line["status"] for line in listed["turns"]] == ["infeasible", "optimal", None]
    assert [line["applied"] for line in listed["turns"]] == [None, "simulated", None]
    assert [line["number"] for line in answer(capsys, "history", "--last", 2)["turns"]] == [2, 3]
    assert [line["turn"] for line in answer(capsys, "history", "--session", "other")["turns"]] == [4]
    assert [line["turn"] for line in answer(capsys, "history", "--store", f"sqlite:///{place}")["turns"]] == [1, 2, 4]
    shown = told(capsys, "history")
    assert "max_rate" in shown
    assert "infeasible" in shown


def test_history_show_tells_a_turn_and_checks_it(
    place: Path, scene: wa.Scene, capsys: pytest.CaptureFixture[str]
) -> None:
    turn = decided_turn(scene, wa.Problem("max_min_rate"), LOST)
    assert turn.run is not None
    with Store.open(place, create=True) as store:
        store.append(turn)
        store.append(random_turn(4, seed=1))
    record = answer(capsys, "history", "show", 1)
    assert record["tampering"] == []
    assert record["turn"]["allocation"]["owner"] == turn.run.decision.owner.tolist()
    assert record["turn"]["applied"]["power_w"] == turn.run.decision.power_w.tolist()
    shown = told(capsys, "history", "show", 1)
    for text in (
        "Said: higher speed",
        "Understood by offline, 90% sure: allocate, max_min_rate\n",
        "feasible, by dual: ",
        "checked, as decided: 20 W",
        record["turn"]["hash"],
    ):
        assert text in shown
    assert "nothing in this session was changed" in shown
    assert "decided" not in told(capsys, "history", "show", 2)
    with closing(sqlite3.connect(place)) as connection:
        connection.execute("DROP TRIGGER audit_turn_no_update")
        connection.execute("UPDATE audit_turn SET text = 'save power' WHERE number = 1")
        connection.commit()
    assert answer(capsys, "history", "show", 1, code=1)["tampering"] == [
        "the trigger audit_turn_no_update is missing", "turn 1 was changed",
    ]  # fmt: skip
    assert "WARNING: the trigger audit_turn_no_update is missing; turn 1 was changed" in told(
        capsys, "history", "show", 1, code=1
    )


def test_a_turn_is_shown_and_replayed_in_the_language_it_was_said_in(
    place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    said = ("总速率最高，功率不超过 10 W", "jetzt mit 5 W und mindestens 100 kbit/s für jeden Nutzer")
    for sentence in said:
        talked(capsys, sentence)
    assert "记录" not in told(capsys, "history")
    shown = told(capsys, "history", "show", 1)
    for text in (
        f"原话：{said[0]}",
        "（已应用）",
        "用户3",
        "核对与决定一致：",
        "已检查：本会话没有任何内容被更改或删除。",
    ):
        assert text in shown
    assert "Decided" not in shown
    assert "第 1 条：决定逐位相同，版本和平台相同" in told(capsys, "history", "replay", 1)
    shown = told(capsys, "history", "show", 2)
    for text in ("Gesagt: ", "Nutzer 3", "Geprüft: In dieser Sitzung wurde nichts geändert oder gelöscht."):
        assert text in shown
    assert " the " not in shown


def test_history_replay_says_whether_it_is_the_same(
    place: Path, scene: wa.Scene, capsys: pytest.CaptureFixture[str]
) -> None:
    with Store.open(place, create=True) as store:
        store.append(decided_turn(scene, wa.Problem("max_rate"), LOST))
        store.append(random_turn(4, seed=1))
    assert answer(capsys, "history", "replay", 1)["verdict"] == "identical"
    assert "Turn 1: the same decision bit for bit, on the same version and platform" in told(
        capsys, "history", "replay", 1
    )
    assert run(["history", "replay", "2"]) == 2
    assert "turn 2 decided nothing (answered), so there is nothing to replay" in capsys.readouterr().err


def test_a_conversation_is_recorded_turn_by_turn(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = ("Highest total rate, at most 10 W", "how are you?", "Save power, 200 kbit/s each", "能效最高")
    turns = talked(capsys, *said)
    assert [turn["stored"] for turn in turns] == [1, 2, 3, 4]
    listed = answer(capsys, "history")["turns"]
    assert [line["text"] for line in listed] == list(said)
    assert {line["session"] for line in listed} == {turns[0]["session"]}
    for turn, line in zip(turns, listed, strict=True):
        assert line["stage"] == turn["stage"]
        if turn["decision"] is not None:
            assert line["value"] == turn["decision"]["value"]
            assert answer(capsys, "history", "replay", line["number"])["verdict"] == "identical"
    assert answer(capsys, "history", "show", 4)["tampering"] == []


def test_a_sentence_is_recorded(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = answer(capsys, "ask", "Highest total rate, at most 10 W", "--num-users", 4)
    assert asked["stored"] == 1
    assert answer(capsys, "ask", "Highest total rate", "--num-users", 4, "--no-store")["stored"] is None
    (line,) = answer(capsys, "history")["turns"]
    assert (line["stage"], line["value"]) == ("applied", asked["decision"]["value"])
    assert answer(capsys, "history", "replay", 1)["verdict"] == "identical"


@pytest.mark.parametrize("command", [["history"], ["history", "export", "{out}"]])
def test_a_session_that_is_not_there_is_told(
    command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place, out = tmp_path / "sessions.sqlite3", tmp_path / "out.jsonl"
    with Store.open(place, create=True) as store:
        store.append(random_turn(1, session="morning", seed=1))
    words = [word.format(out=out) for word in command]
    assert run([*words, "--store", str(place), "--session", "nope"]) != 0
    assert f"there is no session 'nope' in {place}: the latest are morning" in " ".join(capsys.readouterr().err.split())
    assert not out.exists()


@pytest.mark.parametrize("how", ["option", "setting"])
def test_nothing_is_recorded_where_it_is_not_wanted(
    place: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, how: str
) -> None:
    if how == "setting":
        monkeypatch.setenv("WIRELESSAGENT_STORE", "no")
    options = ("--no-store",) if how == "option" else ()
    assert talked(capsys, "Highest total rate", options=options)[0]["stored"] is None
    assert not place.exists()


@pytest.mark.parametrize("content", ["damaged", "no folder", "no setting"])
def test_a_store_that_fails_keeps_no_cell_from_being_served(
    place: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, content: str
) -> None:
    if content == "damaged":
        place.write_bytes(b"0123456789abcdef" * 512)
    elif content == "no folder":
        monkeypatch.setenv("WIRELESSAGENT_STORE_URL", str(place / "none" / "audit.sqlite3"))
    else:
        monkeypatch.setenv("WIRELESSAGENT_STORE", "perhaps")
    (turn,) = talked(capsys, "Highest total rate")
    err = capsys.readouterr().err
    assert (turn["stage"], turn["stored"]) == ("applied", None)
    assert err.startswith("wirelessagent: this turn is not recorded: ")
    assert err.count("\n") == 1


def test_a_replay_in_another_process_is_identical(place: Path, scene: wa.Scene) -> None:
    with Store.open(place, create=True) as store:
        store.append(decided_turn(scene, wa.Problem("min_power", min_rate_bps=2e5), LOST))
    command = [sys.executable, "-m", "wirelessagent", "history", "replay", "1", "--json"]
    found = subprocess.run(command, capture_output=True, text=True, timeout=300, check=True)
    assert json.loads(found.stdout)["verdict"] == "identical"


def test_an_export_holds_all_and_proves_itself(place: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with Store.open(place, create=True) as store:
        for number in range(1, 9):
            for session in ("one", "other"):
                store.append(random_turn(number, session=session, seed=len(session)))
        turns = list(store.turns())
        seen = {turn.number: store.content(turn.observation) for turn in turns if turn.observation}
    out = tmp_path / "turns.jsonl"
    assert answer(capsys, "history", "export", out)["turns"] == 16
    lines = [json.loads(line) for line in out.read_text(encoding="utf-8").splitlines()]
    contents: dict[str, Content] = {}
    exported: list[dict[str, Any]] = []
    for line in lines:
        kind = line.pop("kind")
        if kind == "turn":
            assert line["observation"] is None or {line["observation"], line["estimate"]} <= contents.keys()
            exported.append(line)
            continue
        arrays = {
            name: np.array(one["values"], dtype=one["dtype"]).reshape(one["shape"])
            for name, one in line["arrays"].items()
        }
        contents[line["hash"]] = Content.of(arrays)
        assert contents[line["hash"]].hash == line["hash"]
    assert [line["hash"] for line in exported] == [turn.hash for turn in turns]
    for line in exported:
        columns = {name: value for name, value in line.items() if name != "hash" and value is not None}
        text = json.dumps(columns, ensure_ascii=False, sort_keys=True, separators=(",", ":"))
        assert hashlib.sha256(text.encode()).hexdigest() == line["hash"] == sealed(line)
    for line in exported:
        if line["observation"]:
            gain = observation_of(contents[line["observation"]]).gain
            np.testing.assert_array_equal(gain, observation_of(seen[line["number"]]).gain)
    assert answer(capsys, "history", "export", out, "--session", "other")["turns"] == 8


def test_a_failed_export_leaves_the_file_as_it_was(
    place: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "turns.jsonl"
    out.write_text("before")
    assert run(["history", "export", str(out)]) == 2
    assert "nothing is recorded yet" in capsys.readouterr().err
    assert out.read_text() == "before"


@pytest.mark.parametrize(
    ("arguments", "code", "told"),
    [
        (["history", "show", "7"], 2, "there is no audit store at"),
        (["history", "show"], 2, "Missing argument"),
        (["history", "show", "first"], 2, "valid integer"),
        (["history", "--last", "0"], 2, "last must be 1 or more; got 0"),
        (["history", "--store", "nosuch://host"], 2, "name a file or a SQLAlchemy URL"),
        (["history", "--store", "/"], 1, "folder|unable to open"),
        (["history", "forget"], 2, "forget"),
    ],
)
def test_what_cannot_be_looked_back_at_is_told_in_a_line(
    place: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], code: int, told: str
) -> None:
    assert run(arguments) == code
    error = capsys.readouterr().err
    assert any(part in error for part in told.split("|")), error
    assert error.count("\n") == 1


def test_the_database_is_loaded_when_it_is_needed() -> None:
    program = (
        "import sys; from wirelessagent.interfaces.cli import run; run(['plugins', '--json']); "
        "sys.exit('sqlalchemy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", program], stdout=subprocess.DEVNULL, check=False).returncode == 0
