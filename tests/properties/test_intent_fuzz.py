"""No text breaks the recogniser, and none without a wish makes it act; ``benchmarks/bars_intents.py`` tries more."""

from __future__ import annotations

import pytest
from hypothesis import example, given, settings
from utterances import INJECTIONS, LONG, NOTHING_WISHED

from wirelessagent.language.offline import recognise
from wirelessagent.language.recogniser import Context

CONTEXT = Context(user_names=("user 1", "user 2"), objective="max_rate", constraints={"max_power_w": 5.0})
CHANGING = ("apply", "undo", "reset")


def acts(text: str, context: Context | None = None) -> bool:
    intent = recognise(text, context)
    assert intent.reply
    assert (intent.kind == "allocate") == (intent.objective is not None)
    return intent.kind == "allocate" or (intent.kind == "command" and intent.topic in CHANGING)


@settings(deadline=None, max_examples=250, derandomize=True)
@given(NOTHING_WISHED)
@example("WW瓦")
@example("M瓦")
@example("ټڅڕ")
def test_noise_never_acts(text: str) -> None:
    assert not acts(text), text


@settings(deadline=None, max_examples=60, derandomize=True)
@given(NOTHING_WISHED)
def test_no_text_breaks_a_conversation(text: str) -> None:
    acts(text, CONTEXT)


@pytest.mark.parametrize("text", INJECTIONS)
def test_attacks_never_act(text: str) -> None:
    assert not acts(text)


@pytest.mark.parametrize("text", LONG)
def test_a_megabyte_is_asked_about(text: str) -> None:
    intent = recognise(text)
    assert intent.kind == "clarify"
    assert len(intent.reply) < 500
