"""What a turn says: what was decided and how sure, what changed, and what it needs; and what of it is recorded."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wirelessagent as wa
from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn
from wirelessagent.interfaces.cli import run
from wirelessagent.store.record_of import understood
from wirelessagent.telling.catalogue import message
from wirelessagent.telling.report import decision_tables

pytestmark = pytest.mark.machine_code

SCENE = wa.simulate("rayleigh", wa.Cell(max_power_w=20), num_users=4, num_subcarriers=12, seed=3)


def said(*lines: str, confirm: bool = False) -> list[Turn]:
    session = Session(SCENE, wa.loss.random(0.2), seed=1, confirm=confirm)
    return [session.say(line) for line in lines]


def flat(capsys: pytest.CaptureFixture[str]) -> str:
    """What was printed, on one line."""
    return " ".join(capsys.readouterr().out.split())


def test_a_first_request_says_what_was_understood_decided_and_done() -> None:
    (turn,) = said("Highest total rate, at most 10 W")
    assert turn.run is not None
    assert turn.lines.decided.startswith("The highest total rate: at most 10 W of radiated power. Total rate ")
    assert turn.lines.changed.startswith("Set on the simulated base station and checked")
    assert turn.lines.needs == ""
    assert turn.shift is None
    assert turn.reply == f"{turn.lines.decided}\n{turn.lines.changed}"


def test_a_change_says_what_was_before_and_what_became_of_the_allocation() -> None:
    first, second = said("Highest total rate, at most 10 W", "at most 5 W, user 2 at least 500 kbit/s")
    assert first.run is not None
    assert second.run is not None
    changed = second.lines.changed
    assert "at most 5 W of radiated power (before: 10 W)" in changed
    assert "at least 500 kbit/s for user 2" in changed
    shift = second.shift
    assert shift is not None
    before, after = first.run.decision, second.run.decision
    assert shift.power_w == (before.total_power_w, after.total_power_w)
    assert shift.sum_rate_bps == (before.rate_bps.sum(), after.rate_bps.sum())
    owners = [np.where(one.power_w > 0, one.owner, -1) for one in (before, after)]
    assert shift.subcarriers == np.count_nonzero(owners[0] != owners[1])
    assert all(shift.rate_bps[name] == (before.rate_bps[k], after.rate_bps[k])
               for k, name in enumerate(before.user_names) if name in shift.rate_bps)  # fmt: skip
    assert "Radiated power 10 W → 5 W" in changed or "radiated power 10 W → 5 W" in changed


def test_a_way_back_to_what_is_in_effect_moves_nothing() -> None:
    turns = said("Highest total rate, at most 10 W", "yes", "at most 5 W", "at most 10 W", confirm=True)
    assert "→" in turns[2].lines.changed
    assert "Nothing to change" in turns[3].lines.changed
    assert "→" not in turns[3].lines.changed  # 5 W was never in effect


def test_what_is_dropped_is_named() -> None:
    turns = said("Highest total rate, at most 10 W, 200 kbit/s each", "without the power limit")
    assert "No longer: at most 10 W of radiated power." in turns[-1].lines.changed
    turns = said("Highest total rate, at most 10 W", "new request: least power with 200 kbit/s each")
    assert "No longer: at most 10 W of radiated power." in turns[-1].lines.changed


def test_a_plan_that_waits_needs_a_yes_and_says_so_after_other_answers() -> None:
    turns = said("Highest total rate, at most 10 W", "how sure is this?", "what if we had 5 W?", "yes", confirm=True)
    assert [turn.stage for turn in turns] == ["planned", "answered", "answered", "applied"]
    assert turns[0].lines.needs == "Apply it?"
    assert turns[1].lines.needs.startswith("The plan still waits")
    assert turns[2].lines.changed == "Nothing was changed."
    assert "'do that' takes the what-if" in turns[2].lines.needs
    assert turns[3].lines.needs == ""


SAME = {
    "en": ("highest total rate, at most 10 W", "at most 5 W"),
    "zh": ("最高总速率，功率不超过10 W", "功率不超过5 W"),
    "es": ("máxima tasa total, como máximo 10 W", "como máximo 5 W"),
    "fr": ("débit total maximal, au plus 10 W", "au plus 5 W"),
    "de": ("höchste Gesamtrate, höchstens 10 W", "höchstens 5 W"),
}


@pytest.mark.parametrize("language", SAME)
def test_a_line_says_neither_its_own_name_nor_how_it_is_answered(language: str) -> None:
    """The console shows each line beside its name, and a plan beside its buttons."""
    for turn in said(*SAME[language], confirm=True):
        assert turn.intent.language == language
        assert turn.lines.needs == message(language, "ask_back.apply_it")
        assert turn.lines.needs[-1] in "?？"
        for line in ("decided", "changed", "needs"):
            name = str(message(language, f"console.{line}"))
            assert not getattr(turn.lines, line).casefold().startswith(name.casefold())
    assert "5 W" in turn.lines.changed


def test_a_question_back_is_a_need_alone() -> None:
    turns = said("Highest total rate", "leave user 9 out")
    assert turns[-1].lines.needs.startswith("There is no user 9 here")
    assert turns[-1].lines.decided == turns[-1].lines.changed == ""


def test_the_efficiency_of_now_is_a_figure_and_the_word_is_explained() -> None:
    turns = said("Highest total rate, at most 10 W", "what is the energy efficiency now?", "what is energy efficiency?")
    assert turns[0].run is not None
    figures = {row[0]: row[1] for row in turns[0].run.report.figures()}
    assert figures["Energy efficiency"] in turns[1].reply
    assert "bits per joule drawn" in turns[2].reply


def test_the_record_holds_lines_and_the_key_and_places_of_each_message() -> None:
    for turn in said("Highest total rate, at most 10 W", "now with 5 W", "最多8瓦", "10 Mbit/s each", "why not?"):
        record = understood(turn)
        assert record["schema"] == 4
        assert record["lines"] == {name: str(getattr(turn.lines, name)) for name in ("decided", "changed", "needs")}
        assert json.loads(json.dumps(record)) == record
        for name, line in record["lines"].items():
            told = record["messages"][name]
            assert bool(told) == bool(line)
            for one in told:
                if not any(isinstance(place, list) for place in one["places"].values()):
                    assert message(turn.intent.language, one["key"], **one["places"]) in line


def test_ask_shows_three_lines_and_the_users_served_and_the_rest_when_asked(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    asked = ["ask", "Highest total rate, at most 5 W, 200 kbit/s each", "--num-users", "3", "--num-subcarriers", "8"]
    shown: dict[str, str] = {}
    for more in ((), ("--full",), ("--json",)):
        assert run([*asked, *more]) == 0
        shown["".join(more)] = capsys.readouterr().out if more == ("--json",) else flat(capsys)
    record: dict[str, Any] = json.loads(shown["--json"])
    for text in ("", "--full"):
        assert record["lines"]["decided"] in shown[text]
        assert record["lines"]["changed"] in shown[text]
    assert "Users served" in shown[""]
    assert record["explanation"][0] not in shown[""]
    assert all(line in shown["--full"] for line in record["explanation"])
    assert "not measured" in shown["--full"]
    assert "not measured" not in shown[""]


LINES = ("Highest total rate, at most 10 W", "now with 5 W", "least power, 200 kbit/s each", "leave user 2 out",
         "what if we had 2 W?", "how sure is this?", "undo", "no", "without the power limit")  # fmt: skip


@settings(max_examples=15, deadline=None)
@given(st.lists(st.sampled_from(LINES), min_size=2, max_size=5))
def test_a_plan_that_waits_is_for_what_holds(lines: list[str]) -> None:
    session = Session(SCENE, wa.loss.random(0.2), seed=1, confirm=True)
    for line in lines:
        before = session.state
        session.say(line)
        state = session.state
        if state.planned is None:
            continue
        assert state.planned is state.run
        assert state.request is not None
        problem = state.planned.decision.problem
        assert getattr(problem.objective, "name", None) == state.request.objective
        assert problem.max_power_w == state.request.constraints.get("max_power_w")
        if state.request != before.request:
            assert state.planned is not before.planned
    assert dataclasses.replace(session.state, noted=False).on_air is None


def test_a_stored_turn_tells_the_lines(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    store = str(tmp_path / "turns.db")
    assert run(["ask", "Highest total rate", "--num-users", "3", "--num-subcarriers", "8", "--store", store]) == 0
    capsys.readouterr()
    assert run(["history", "show", "1", "--store", store, "--json"]) == 0
    turn = json.loads(capsys.readouterr().out)["turn"]
    assert turn["intent"]["lines"]["decided"] in turn["reply"]


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("show the allocation", "Of 12 subcarriers, counted from 1:"),
        ("show me the current allocation", "Of 12 subcarriers, counted from 1:"),
        ("显示子载波分配", "12 个子载波"),
        ("zeige die Zuteilung", "12"),
        ("montre l'allocation", "12"),
        ("muestra la asignación", "12"),
    ],
)
def test_the_allocation_and_the_powers_come_when_they_are_asked_for(line: str, told: str) -> None:
    turn = said("Highest total rate, at most 10 W", line)[-1]
    assert turn.lines.decided.startswith(told) or told in turn.lines.decided.split("\n")[0]
    assert len(turn.lines.decided.split("\n")) > 1
    assert turn.stage == "answered"


@pytest.mark.parametrize("line", ["show the powers", "list the rates", "显示功率", "zeige die Leistungen"])
def test_what_each_user_gets_comes_when_it_is_asked_for(line: str) -> None:
    turn = said("Highest total rate, at most 10 W", line)[-1]
    assert turn.run is None
    assert [table.columns[2] for table in turn.tables][:1] in (["power"], ["功率"], ["Leistung"])


@pytest.mark.parametrize(
    "line",
    [
        "what's the total rate", "what is the least power here", "how high is the energy efficiency",
        "whats the sum rate",
        "and what's the radiated power now", "is the total rate highest now", "wie hoch ist die Gesamtrate",
        "wie hoch ist die Energieeffizienz", "quelle est l'efficacité énergétique", "combien de débit total",
        "cuál es la tasa total", "总速率是多少",
    ],
)  # fmt: skip
def test_a_question_without_its_mark_changes_nothing(line: str) -> None:
    session = Session(SCENE, wa.loss.random(0.2), seed=1)
    session.say("Proportional fairness, at most 10 W")
    before = session.request
    turn = session.say(line)
    assert session.request == before
    assert turn.stage in ("answered", "asked")


def test_the_tables_of_a_turn_are_those_of_the_run_that_it_speaks_of() -> None:
    wish, other = "Highest total rate, at most 10 W", "now with 5 W"
    turns = [*said(wish, wish, other, "undo"), *said(wish, "yes", other, "yes", "undo", confirm=True)]
    assert [turn.stage for turn in turns[-2:]] == ["applied", "planned"]
    for turn in turns:
        assert turn.run is not None
        assert list(turn.tables) == decision_tables(turn.run.report, turn.run.estimate)
