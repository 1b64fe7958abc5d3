"""Conversations: each turn's state, what is restated and told, amendments, undo, questions, and users."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from conversations import CHINESE, ENGLISH, LOSS, SCENE, SEED, Line, Scripted, asks, means

import wirelessagent as wa
from wirelessagent.agent.posing import pose
from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn, restated
from wirelessagent.language.conversation import NAME as READ_HERE
from wirelessagent.language.intent import CONSTRAINTS, Intent
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.request import Request
from wirelessagent.model.errors import UnclearRequestError

NAMES = tuple(f"user {number}" for number in range(1, 6))


def plain(value: Any) -> Any:
    return {key: plain(inner) for key, inner in value.items()} if isinstance(value, Mapping) else value


def talk(*intents: Intent, **options: Any) -> tuple[Session, list[Turn]]:
    """A session after these turns."""
    session = Session(SCENE, LOSS, seed=SEED, recogniser=Scripted(intents), **options)
    return session, [session.say(f"line {number}") for number, _ in enumerate(intents)]


def posed(objective: str = "max_rate", names: tuple[str, ...] = NAMES, language: str = "en", **constraints: Any) -> Any:
    return pose(Request(objective=objective, constraints=constraints), wa.Cell(max_power_w=20), names, language)


def question(objective: str = "max_rate", names: tuple[str, ...] = NAMES, language: str = "en", **stated: Any) -> str:
    with pytest.raises(UnclearRequestError) as refusal:
        posed(objective, names, language, **stated)
    return str(refusal.value)


@pytest.mark.parametrize("name", ["scripted", "offline"])
@pytest.mark.parametrize("lines", [ENGLISH, CHINESE], ids=["en", "zh"])
def test_a_conversation_of_fifteen_turns(lines: tuple[Line, ...], name: str) -> None:
    recogniser = OfflineRecogniser() if name == "offline" else Scripted(line.intent for line in lines)
    session = Session(SCENE, LOSS, seed=SEED, recogniser=recogniser)
    for number, line in enumerate(lines, start=1):
        on_air = session.state.on_air
        turn = session.say(line.text)
        assert (turn.number, turn.text, turn.stage) == (number, line.text, line.stage), turn.reply
        assert turn.recogniser in (name, READ_HERE)
        assert session.request is not None
        assert session.request.objective == line.objective
        assert plain(session.request.constraints) == plain(line.constraints)
        assert all(words in turn.reply for words in line.told), turn.reply
        assert any("\u4e00" <= sign <= "\u9fff" for sign in turn.reply) == (line.intent.language == "zh")
        if line.stage in ("answered", "nothing"):
            assert session.state.on_air is on_air
        else:
            on_air = session.state.on_air
            assert on_air is not None
            assert on_air.outcome is not None
            assert np.array_equal(on_air.outcome.power_w, on_air.decision.power_w)
            assert on_air.decision.problem.objective.name == line.objective  # type: ignore[union-attr]
    assert [turn.number for turn in session.turns] == list(range(1, 16))


def test_undo_puts_the_earlier_allocation_back() -> None:
    lower = asks("max_rate", amends=True, max_power_w=5.0)
    session, turns = talk(asks("max_rate", max_power_w=10.0), lower, means("command", topic="undo"))
    assert turns[2].restored is not None
    assert turns[0].run is not None
    assert np.array_equal(turns[2].restored.power_w, turns[0].run.decision.power_w)
    assert session.state.on_air is not None
    assert session.state.on_air.decision is turns[0].run.decision
    assert session.request == Request(objective="max_rate", constraints={"max_power_w": 10.0})


def test_undo_goes_back_to_the_start_and_no_further() -> None:
    undo = means("command", topic="undo")
    session, turns = talk(asks("max_rate"), asks("min_power"), undo, undo, undo)
    assert [turn.stage for turn in turns] == ["applied", "applied", "undone", "undone", "nothing"]
    assert session.request is None
    assert session.state.on_air is not None  # there was no allocation before the first, so that one stays
    assert "stays" in turns[3].reply


def test_what_was_forgotten_can_be_had_back() -> None:
    session, turns = talk(asks("max_rate"), means("command", topic="reset"), means("command", topic="undo"))
    assert turns[1].stage == "undone"
    assert session.request == Request(objective="max_rate")


def test_the_same_allocation_is_not_applied_again() -> None:
    session, turns = talk(asks("max_rate", max_power_w=10.0), asks("max_rate", max_power_w=10.0))
    assert [turn.stage for turn in turns] == ["applied", "nothing"]
    assert "Nothing to change" in turns[1].reply
    assert session.state.on_air is session.state.run


def test_an_amendment_joins_and_so_does_a_request_that_does_not_start_over() -> None:
    session, _ = talk(
        asks("max_rate", max_power_w=10.0, min_rate_bps=1e5),
        asks("max_rate", amends=True, min_rate_bps={"2": 2e5}),
        means("allocate", "max_rate", amends=True, dropped=("max_power_w",), constraints={"leave_out": ("1",)}),
        asks("max_rate", amends=True, leave_out=("3",)),
    )
    assert session.request is not None
    assert plain(session.request.constraints) == {"min_rate_bps": {"all": 1e5, "2": 2e5}, "leave_out": ("1", "3")}
    session, _ = talk(asks("max_rate", max_power_w=10.0), asks("max_rate", min_rate_bps=1e5))
    assert session.request == Request(objective="max_rate", constraints={"max_power_w": 10.0, "min_rate_bps": 1e5})


def test_what_if_shows_both_and_changes_nothing() -> None:
    session, turns = talk(
        asks("max_rate", max_power_w=10.0),
        means("question", topic="what_if", details={"constraints": {"max_power_w": 2.0}}),
        means("question", topic="what_if", details={"objective": "min_power"}),
        means("question", topic="what_if", details={"missing_share": 0.5}),
        means("question", topic="what_if", details={"missing_share": 1.0}),
        means("question", topic="what_if"),
    )
    assert [turn.stage for turn in turns[1:]] == ["answered", "answered", "answered", "asked", "asked"]
    assert session.request == Request(objective="max_rate", constraints={"max_power_w": 10.0})
    assert session.state.on_air is turns[0].run
    assert "2 W" in turns[1].reply
    assert dict(zip(*_columns(turns[1], "power"), strict=True)) == {"now": "10 W", "what if": "2 W"}
    assert turns[2].run is not None
    assert turns[2].run.decision.unit == "W"
    assert turns[3].run is not None
    assert turns[3].run.observation.missing.mean() == 0.5


def _columns(turn: Turn, label: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The names of a turn's columns and the row of this label."""
    table = turn.tables[0]
    return table.columns[1:], next(row[1:] for row in table.rows if row[0] == label)


def test_compare_with_the_last_and_with_methods_and_repairers() -> None:
    _, turns = talk(
        asks("max_rate", max_power_w=10.0),
        asks("max_rate", amends=True, max_power_w=5.0),
        means("command", topic="compare", details={"with": "last"}),
        means("command", topic="compare", details={"with": "greedy, user_mean"}),
        means("command", topic="compare", details={"with": "magic"}),
    )
    assert _columns(turns[2], "power") == (("turn 2", "turn 1"), ("5 W", "10 W"))
    assert _columns(turns[3], "power")[0] == ("dual", "greedy", "mean filling")
    assert turns[4].stage == "asked"
    assert "magic" in turns[4].reply
    _, (_, alone) = talk(asks("max_rate"), means("command", topic="compare", details={"with": "last"}))
    assert "no earlier decision" in alone.reply


def test_status_and_history_tell_what_holds() -> None:
    _, turns = talk(
        means("command", topic="status"),
        asks("max_rate", max_power_w=10.0),
        means("command", topic="status"),
        means("command", topic="history"),
        means("command", topic="history", details={"number": 2.0}),
        means("command", topic="history", details={"number": 9.0}),
    )
    assert "Nothing is asked for" in turns[0].reply
    assert "at most 10 W" in turns[2].reply
    assert "(turn 2)" in turns[2].reply
    assert [row[0] for row in turns[3].tables[0].rows] == ["1", "2", "3"]
    assert turns[1].reply in turns[4].reply
    assert turns[4].tables == turns[1].tables
    assert "turns 1 to 5" in turns[5].reply


def test_what_cannot_be_done_leaves_what_is_in_effect() -> None:
    session, turns = talk(asks("max_rate"), asks("max_rate", min_rate_bps=1e9), means("command", topic="apply"))
    assert turns[1].stage == "nothing"
    assert "infeasible" in turns[1].reply.lower()
    assert turns[2].stage == "answered"
    assert session.state.on_air is turns[0].run


def test_why_it_cannot_be_done_is_told_in_chinese_too() -> None:
    _, (turn,) = talk(asks("min_power", language="zh", max_power_w=0.5, min_rate_bps=1e6))
    assert turn.stage == "nothing"
    assert re.search(r"不可行：所要求的速率至少需要 1\.4\d W，超过允许的 500 mW", turn.reply), turn.reply


def test_a_question_about_a_user_is_answered_with_the_user() -> None:
    session, turns = talk(asks("max_rate"), asks("max_rate", amends=True, leave_out=("12",), max_power_w=4.0))
    assert turns[1].stage == "asked"
    assert "user 12" in turns[1].reply
    assert "user 4" in turns[1].reply
    assert session.request == Request(objective="max_rate")
    answered = session.say("sorry, user 2")
    assert answered.stage == "applied"
    assert session.request is not None
    assert dict(session.request.constraints) == {"leave_out": ("2",), "max_power_w": 4.0}


def test_a_question_about_nobody_asks_whom() -> None:
    session, turns = talk(asks("max_rate"), means("question", topic="why_user"))
    assert turns[1].stage == "asked"
    assert turns[1].reply == "About which user: user 1, user 2, user 3, user 4?"
    answered = session.say("3")
    assert answered.stage == "answered"
    assert answered.intent.details["user"] == "user 3"


def test_a_question_back_hands_what_was_read_to_the_recogniser() -> None:
    script = Scripted(
        [
            asks("max_rate", max_power_w=10.0),
            means("clarify", reply="Which aim?", pending={"min_rate_bps": 1e6}),
            asks("min_power", min_rate_bps=1e6),
            means("command", topic="status", language="zh"),
        ]
    )
    session = Session(SCENE, LOSS, seed=SEED, recogniser=script)
    turns = [session.say("…") for _ in range(4)]
    assert turns[1].reply == "Which aim?"
    first, second, third, last = (context for context in script.contexts if context is not None)
    assert (first.objective, first.awaits, first.language, first.user_names) == (None, "nothing", "", NAMES[:4])
    assert (second.objective, dict(second.constraints)) == ("max_rate", {"max_power_w": 10.0})
    assert (third.awaits, dict(third.question.pending)) == ("clarification", {"min_rate_bps": 1e6})
    assert (last.awaits, dict(last.question.pending), last.objective) == ("nothing", {}, "min_power")
    assert turns[3].reply.startswith("当前要求")


def test_users_are_found_by_name_and_place() -> None:
    found = posed(min_rate_bps={"all": 1e5, "3": 2e5}, weights={"User 1": 2}, leave_out=("2",), outage_probability=0.1)
    assert found.problem.min_rate_bps.tolist() == [1e5, 1e5, 2e5, 1e5, 1e5]
    assert found.problem.weights.tolist() == [2, 1, 1, 1, 1]
    assert found.problem.user_indices == (0, 2, 3, 4)
    assert found.notes == ()
    others = posed(names=("7", "anna", "3"), max_rate_bps={"3": 1e6, "anna": 2e6, "1": 3e6})
    assert others.problem.max_rate_bps.tolist() == [3e6, 2e6, 1e6]
    assert len(others.notes) == 1
    assert "place 1" in others.notes[0]
    assert posed(users=("1", "2", "3"), leave_out=("2",)).problem.users == ("user 1", "user 3")


def test_promises_are_made_with_a_probability_unless_it_is_said() -> None:
    assumed = posed(min_rate_bps=1e5)
    assert assumed.problem.outage_probability == 0.05
    assert "95 %" in assumed.notes[0]
    assert posed(min_rate_bps=1e5, outage_probability=0.2).problem.outage_probability == 0.2
    nothing_promised = posed(max_power_w=10.0)
    assert nothing_promised.problem.outage_probability is None
    assert nothing_promised.notes == ()


def test_what_fits_no_channel_is_asked_about() -> None:
    assert (
        question(users=("9",))
        == "There is no user 9 here: there are user 1, user 2, user 3, user 4, user 5. Whom did you mean?"
    )
    assert "另外 3 个" in question(names=tuple(f"u{number}" for number in range(15)), language="zh", users=("x",))
    assert "nobody to serve" in question(leave_out=("1", "2", "3", "4", "5"))
    assert "User 2 can't get at least 2 Mbit/s and at most 1 Mbit/s" in question(
        min_rate_bps={"2": 2e6}, max_rate_bps=1e6
    )
    assert posed(min_rate_bps=2e6, max_rate_bps={"2": 1e6}, leave_out=("2",)).problem.user_indices == (0, 2, 3, 4)
    assert "groups of a whole number" in question(resource_block_group_size=2.5)
    assert "Every weight is 0" in question(weights={"all": 0.0})


def test_what_is_assumed_is_told() -> None:
    assert posed("min_power").problem.min_rate_bps == 200e3
    assert "200 kbit/s for each user is assumed" in posed("min_power").notes[0]
    assert posed("min_power", min_rate_bps={"2": 1e6}).problem.min_rate_bps.tolist() == [0, 1e6, 0, 0, 0]
    limited = posed(max_power_w=50.0)
    assert limited.problem.max_power_w == 20
    assert "above the cell's limit of 20 W" in limited.notes[0]
    assert "left out" in posed("min_power", min_rate_bps=1e5, weights={"1": 2}).notes[0]
    assert posed(circuit_power_w=9.0).cell.circuit_power_w == 9
    assert posed(outage_probability=0.1, subcarrier_max_power_w=2.0, resource_block_group_size=4.0).problem == (
        wa.Problem(
            posed().problem.objective, outage_probability=0.1, subcarrier_max_power_w=2.0, resource_block_group_size=4
        )
    )


@pytest.mark.parametrize("language", ["en", "zh"])
def test_every_constraint_is_restated(language: str) -> None:
    given: dict[str, Any] = {
        "max_power_w": 12.5, "min_rate_bps": {"all": 3e5, "2": 7e6, "4": 7e6}, "max_rate_bps": 9e6,
        "circuit_power_w": 4.0, "outage_probability": 0.05, "weights": {"1": 2.5}, "users": ("1", "anna"),
        "leave_out": ("8",), "subcarrier_max_power_w": 0.5, "resource_block_group_size": 6.0,
    }  # fmt: skip
    assert set(given) == set(CONSTRAINTS)
    said = restated(Request(objective="max_rate", constraints=given), language)
    figures = ["12.5 W", "300 kbit/s", "7 Mbit/s", "9 Mbit/s", "4 W", "95 %", "2.5", "anna", "8", "500 mW", "6"]
    assert [figure for figure in figures if figure not in said] == []


class Broken:
    """A store that keeps nothing."""

    def append(self, turn: Turn) -> int:
        raise wa.WirelessAgentError(f"the disk is full at turn {turn.number}")


def test_turns_are_stored_and_a_failing_store_is_told_of() -> None:
    kept: list[Turn] = []

    class Store:
        def append(self, turn: Turn) -> None:
            kept.append(turn)

    session, turns = talk(asks("max_rate"), means("command", topic="help"), store=Store())
    assert kept == turns == list(session.turns)
    assert len({turn.session for turn in turns}) == 1
    _, (failed,) = talk(asks("max_rate"), store=Broken())
    assert failed.stage == "applied"
    assert "not recorded: the disk is full at turn 1" in failed.reply


def test_another_recogniser_than_the_chosen_one_is_named() -> None:
    other = Intent(
        kind="allocate", objective="max_rate", constraints={}, language="en", confidence=1, evidence={}, reply="",
        recogniser="offline (no answer in 5 s)",
    )  # fmt: skip
    _, (turn,) = talk(other)
    assert "offline (no answer in 5 s)" in turn.reply
    assert turn.recogniser == "offline (no answer in 5 s)"


def test_the_last_request_is_exported_as_a_standard_has_it() -> None:
    session, turns = talk(
        means("command", topic="export"),
        asks("max_rate", max_power_w=10.0),
        asks("max_rate", amends=True, max_power_w=5.0),
        means("question", topic="what_if", details={"missing_share": 0.4}),
        means("command", topic="export"),
        means("command", topic="export", details={"format": "tmf921"}),
        means("command", topic="export", details={"format": "word"}),
    )
    assert "nothing yet" in turns[0].reply
    assert f"{session.id}-3" in str(json.loads(turns[4].reply))
    assert json.loads(turns[5].reply) != json.loads(turns[4].reply)
    assert turns[6].stage == "asked"
