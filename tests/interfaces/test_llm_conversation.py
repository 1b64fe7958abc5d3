"""The conversations of fifteen turns with an LLM that knows what is meant, each turn's state checked."""

from __future__ import annotations

from typing import Any

import pytest
from conversations import CHINESE, ENGLISH, LOSS, SCENE, SEED, Line
from llm_stub import StubLlm, truthful

from wirelessagent.agent.session import Session
from wirelessagent.language.llm.client import LlmSettings
from wirelessagent.language.llm.prompt import plain
from wirelessagent.language.llm.reader import LlmRecogniser

pytestmark = pytest.mark.machine_code

pytest.importorskip("pydantic_ai")


def row(line: Line) -> dict[str, Any]:
    """What the table of the stub says of a line."""
    intent = line.intent
    return {
        "text": line.text,
        "language": intent.language,
        "kind": intent.kind,
        "objective": intent.objective,
        "constraints": unmapped(intent.constraints),
        "topic": intent.topic,
        "details": unmapped(intent.details),
        "amends": intent.amends,
        "dropped": list(intent.dropped),
        "words": "" if intent.amends and "least power" not in line.text and "最低" not in line.text else line.text,
    }


def unmapped(values: Any) -> Any:
    return {name: dict(value) if hasattr(value, "items") else value for name, value in values.items()}


@pytest.mark.parametrize("lines", [ENGLISH, CHINESE], ids=["en", "zh"])
def test_a_conversation_of_fifteen_turns(lines: tuple[Line, ...]) -> None:
    with StubLlm(truthful(map(row, lines))) as stub:
        recogniser = LlmRecogniser(LlmSettings(base_url=stub.url, model="m"))
        session, read_by = Session(SCENE, LOSS, seed=SEED, recogniser=recogniser), list[str]()
        for line in lines:
            turn = session.say(line.text)
            read_by.append(turn.recogniser)
            assert turn.stage == line.stage, line.text
            assert session.request is not None
            assert session.request.objective == line.objective
            assert plain(session.request.constraints) == plain(line.constraints)
            assert all(told in turn.reply or told in str(turn.tables) for told in line.told), line.text
        assert {*read_by} == {"llm", "conversation"}  # and nobody fell back
        assert read_by[0] == "llm"
