"""What a line may never take away or apply unasked: assumed rates, limits that hold, what is only supposed."""

from __future__ import annotations

from typing import Any

import pytest
from conversations import agreed_into as talk
from conversations import talked_into

from wirelessagent.language.conversation.questions import supposes

pytestmark = pytest.mark.machine_code

HELD = "highest total rate, 300 kbit/s each, at most 10 W"


def test_an_assumed_rate_stays_for_the_others_when_one_user_is_named() -> None:
    held, turns = talk("least power", "user 2 needs 1 Mbit/s")
    assert held == {"min_rate_bps": {"all": 2e5, "2": 1e6}}
    assert "at least 200 kbit/s for everyone else" in turns[-1].reply
    held, _ = talk("least power", "user 2 needs 1 Mbit/s", "no, I meant user 3")
    assert held == {"min_rate_bps": {"all": 2e5, "3": 1e6}}
    assert talk("least power", "now with 300 kbit/s each")[0] == {"min_rate_bps": 3e5}
    assert talk("highest total rate", "user 2 needs 1 Mbit/s")[0] == {"min_rate_bps": {"2": 1e6}}


@pytest.mark.parametrize("said", ["user 2 doesn't need 1 Mbit/s", "2号不需要1兆", "user 2 needs no 1 Mbit/s"])
def test_a_rate_that_nobody_promised_takes_no_other_one_away(said: str) -> None:
    held, turns = talked_into("least power, 300 kbit/s each", said)
    assert (held, turns[-1].stage) == ({"min_rate_bps": 3e5}, "asked")


@pytest.mark.parametrize(
    "said",
    ["what if instead we maximise energy efficiency", "what if we used the least power instead, 200 kbit/s each",
     "suppose we went for least power", "imagine 2 Mbit/s for user 3", "should we save power?",
     "would it be better to save power?", "how about 5 W", "if we used 5 W instead", "要不要省点电？",
     "每人1兆最少要多少瓦", "假如改成最低功率", "如果只用5瓦会怎样", "换成最低功率呢"],
)  # fmt: skip
def test_what_is_supposed_is_never_applied(said: str) -> None:
    held, turns = talk(HELD, said)
    assert held == {"max_power_w": 10.0, "min_rate_bps": 3e5}
    assert (turns[-1].intent.kind, turns[-1].stage) == ("question", "answered")


@pytest.mark.parametrize("said", ["要不要省点电？", "should we save power?", "should we use the least power?"])
def test_what_is_weighed_is_compared_and_can_be_taken(said: str) -> None:
    _, turns = talk(HELD, said, "do that")
    assert "10 W" in turns[1].reply
    assert "mW" in turns[1].reply
    assert (turns[2].stage, turns[2].intent.objective) == ("applied", "min_power")


@pytest.mark.parametrize(
    "said",
    ["if possible, 1 Mbit/s each", "现在5瓦，如果可以的话", "no matter how much power it takes, at least 1 Mbit/s each",
     "如果可能，改成5瓦", "能给多少给多少，功率不超过5瓦", "use whatever it takes", "could you use 5 W?",
     "每人给多少都行，省电为主",
     "I would like the highest total rate", "it would be great if everyone got 1 Mbit/s", "share it evenly"],
)  # fmt: skip
def test_a_polite_or_careless_request_is_no_what_if(said: str) -> None:
    assert not supposes(said)


@pytest.mark.parametrize(
    ("said", "held"),
    [
        ("fair share with weight 2 for user 1", {"max_power_w": 10.0, "min_rate_bps": 3e5, "weights": {"1": 2.0}}),
        ("faster 5 W", {"max_power_w": 5.0, "min_rate_bps": 3e5}),
        ("proportional fairness, 5 W", {"max_power_w": 5.0, "min_rate_bps": 3e5}),
        ("least power with 200 kbit/s each", {"max_power_w": 10.0, "min_rate_bps": 2e5}),
        ("highest total rate, user 2 at least 1 Mbit/s", {"max_power_w": 10.0, "min_rate_bps": {"all": 3e5, "2": 1e6}}),
        ("最大化能效，每人200k", {"max_power_w": 10.0, "min_rate_bps": 2e5}),
        ("new request: least power with 200 kbit/s each", {"min_rate_bps": 2e5}),
        ("instead of all that, highest total rate with 5 W", {"max_power_w": 5.0}),
        ("新的要求：功率最低，每人200k", {"min_rate_bps": 2e5}),
    ],
)
def test_another_aim_with_a_figure_keeps_the_limits_that_it_does_not_name(said: str, held: dict[str, Any]) -> None:
    assert talk(HELD, said)[0] == held


def test_what_stays_is_told() -> None:
    turn = talk(HELD, "proportional fairness, 5 W")[1][-1]
    assert "at least 300 kbit/s for each user" in turn.lines.decided
    assert "发射功率不超过 10 W" in talk(HELD, "最大化能效，每人200k")[1][-1].lines.decided


@pytest.mark.parametrize(
    ("lines", "held"),
    [
        (("user 4 at least 2 Mbit/s", "please set it to 1.5 Mbit/s"), {"min_rate_bps": {"4": 1.5e6}}),
        (("no more than 300 mW on any one subcarrier", "Geh auf 250 mW"), {"subcarrier_max_power_w": 0.25}),
        (("at most 14 W", "cap user 1 at 5 Mbit/s", "the power limit can go"), {"max_rate_bps": {"1": 5e6}}),
        (("nobody above four megabits a second", "user three can have up to six"),
         {"max_rate_bps": {"all": 4e6, "3": 6e6}}),
        (("Rmin(user 2) = 900 kbit/s", "Rmin(user 2) x2"), {"min_rate_bps": {"2": 1.8e6}}),
        (("user 3 at least 1 Mbit/s", "oops, the hospital is user 4, not 3"), {"min_rate_bps": {"4": 1e6}}),
        (("at least 300 kbit/s each", "keep the emitted power at or below 4 W"),
         {"min_rate_bps": 3e5, "max_power_w": 4.0}),
        (("user 2 weight 4", "wipe the slate clean, then maximise the total rate"), {}),
    ],
)  # fmt: skip
def test_what_a_line_leaves_out_is_that_of_the_last_act(lines: tuple[str, ...], held: dict[str, Any]) -> None:
    assert talk("highest total rate", *lines)[0] == held


@pytest.mark.parametrize("said", ["perdón, para el 3", "non, pardon, pour le 3", "nein, für 3", "no, for 3"])
def test_a_number_behind_for_is_a_user(said: str) -> None:
    assert talk("highest total rate", "user 2 at least 1 Mbit/s", said)[0] == {"min_rate_bps": {"3": 1e6}}


@pytest.mark.parametrize("said", ["sin tasa mínima para el usuario 3", "utilisateur 3 sans débit minimal"])
def test_no_least_rate_leaves_nobody_out(said: str) -> None:
    assert talk("highest total rate", "user 2 at least 1 Mbit/s", said)[0] == {"min_rate_bps": {"2": 1e6}}
    assert talk("highest total rate, 300 kbit/s each", said)[0] == {"min_rate_bps": {"all": 3e5, "3": 0.0}}


@pytest.mark.parametrize("said", ["haz eso", "fais cela", "mach das", "do that", "就这样办"])
def test_what_was_supposed_is_taken_up_in_every_language(said: str) -> None:
    assert talk("highest total rate", "what if we used 5 W", said)[0] == {"max_power_w": 5.0}
