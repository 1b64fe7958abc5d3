"""Lines of talks in words that no form knows, weighed against all that they may change."""

from __future__ import annotations

from typing import Any

import pytest
from conversations import agreed_into, talked_into
from hypothesis import given, settings
from hypothesis import strategies as st

from wirelessagent.language.acts import Limit, Named, Suppose
from wirelessagent.language.conversation import read_by_rules, weighing
from wirelessagent.language.conversation.anchors import Anchored
from wirelessagent.language.conversation.changes import changes_of
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.conversation.possible import Possible
from wirelessagent.language.conversation.signs import SUPPOSED, Read, Signs
from wirelessagent.language.conversation.weighing import meanings, weigh
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context
from wirelessagent.language.request import Request

LEAST = ("least power, 300 kbit/s each",)


@pytest.mark.parametrize(
    ("lines", "holds"),
    [
        (("émets le moins possible et personne sous deux cents kilobits", "trois cents pardon"), {"min_rate_bps": 3e5}),
        (("max rate, 16 W tops", "4 at least a meg"), {"max_power_w": 16.0, "min_rate_bps": {"4": 1e6}}),
        (("max rate", "leave user 3 out", "venga, todos otra vez"), {}),
        ((*LEAST, "user 2 at least 100 kbit/s", "bump all the others up by a fifth"),
         {"min_rate_bps": {"all": 3.6e5, "2": 1e5}}),
        (("max rate, user 1 counts triple", "hmm double rather"), {"weights": {"1": 2.0}}),
    ],
)  # fmt: skip
def test_lines_in_other_words_do_what_they_say_or_do_it_at_a_yes(lines: tuple[str, ...], holds: dict[str, Any]) -> None:
    held, _ = agreed_into(*lines)
    assert held == {name: pytest.approx(value) if isinstance(value, float) else value for name, value in holds.items()}


@pytest.mark.parametrize(
    "wondered",
    ["how would it look at 7?", "¿qué pasaría con cinco vatios menos, digamos 7?", "und mit 7, was wäre dann"],
)
def test_what_is_only_supposed_changes_nothing_until_it_is_taken_up(wondered: str) -> None:
    held, turns = talked_into("highest total rate, at most 12 W", wondered)
    assert held == {"max_power_w": 12.0}
    assert turns[1].acts == (Suppose(acts=(Limit(kind="max_power_w", value=7.0),)),)
    assert talked_into("highest total rate, at most 12 W", wondered, "do that")[0] == {"max_power_w": 7.0}


@pytest.mark.parametrize(
    "said",
    ["Du darfst auf gar keinen Fall Nutzer 1 rausschmeißen!", "nice weather up here by the way, 12 degrees",
     "los monitores son del 5, creo", "我就随口一说,没别的意思"],
)  # fmt: skip
def test_what_does_nothing_changes_nothing(said: str) -> None:
    assert talked_into("max rate, at most 12 W", "user 2 at least 1 Mbit/s", said)[0] == {
        "max_power_w": 12.0, "min_rate_bps": {"2": 1e6},
    }  # fmt: skip


NAMES = tuple(f"user {number}" for number in range(1, 5))
HELD = Context(
    user_names=NAMES, objective="max_rate", language="en", constraints={"min_rate_bps": {"all": 3e5, "2": 6e5}},
    acts=(Limit(kind="min_rate_bps", value=6e5, whom=Named(("2",)), words="600 kbit/s"),),
    past=(Request(objective="max_rate", constraints={"min_rate_bps": 3e5}),),
)  # fmt: skip


def possible(text: str, context: Context = HELD) -> Possible:
    return Possible(Anchored.of(text, "en", context.user_names), context)


def test_only_what_the_line_or_the_talk_says_can_be_meant() -> None:
    figures = {value for change in changes_of(possible("make it 500 for 4")) for (kind, _), value in change.effect
               if kind == "min_rate_bps" and value is not None}  # fmt: skip
    assert 5e5 in figures
    assert figures <= {5e5, 3e5, 6e5, 5e8, 4e6, 4e3, 8e5, 1.1e6, 1e5, 4.3e6, 4.6e6, 1.2e6, 2.4e6, 1.5e5, 7.5e4, 6.4e5,
                       3.4e5, 3.04e5, 6.04e5, 5.96e5, 2.96e5, 6.01e5, 5.99e5, 6e8, 6e2,
                       3e5 + 5e8, 6e5 + 5e8, 9e5}  # fmt: skip


@pytest.mark.parametrize(
    ("text", "effect"),
    [
        ("and 4 too", {("min_rate_bps", "4"): 6e5}),
        ("no, user 3", {("min_rate_bps", "2"): 3e5, ("min_rate_bps", "3"): 6e5}),
        ("undo", {("min_rate_bps", "2"): 3e5}),
        ("user 4 is the one who calls, not 2", {("min_rate_bps", "2"): 3e5, ("min_rate_bps", "4"): 6e5}),
        ("no, a third more", {("min_rate_bps", "2"): 4e5}),
        ("by 200k, not 300k", {("min_rate_bps", "2"): 5e5}),
        ("the same step for 3 and 4", {("min_rate_bps", "3"): 6e5, ("min_rate_bps", "4"): 6e5}),
        ("3 dB less for 2", {("min_rate_bps", "2"): 300712.0}),
        ("the others 400k", {("min_rate_bps", user): 4e5 for user in "134"}),
        ("everybody but 1 half of that", {("min_rate_bps", user): value for user, value in
                                          (("2", 3e5), ("3", 1.5e5), ("4", 1.5e5))}),
        ("drop the floor", {("min_rate_bps", user): None for user in "1234"}),
        ("only 1 and 2", {**{("leave_out", user): 1.0 for user in "34"},
                          **{("min_rate_bps", user): None for user in "34"}}),
    ],
)  # fmt: skip
def test_what_a_line_means_is_among_what_it_may(text: str, effect: dict[tuple[str, str], float | None]) -> None:
    found = [dict(change.effect) for change in changes_of(possible(text))]
    assert effect in found


@pytest.mark.parametrize("said", ["1 Mbit/s less", "2 Mbit/s less for everybody", "minus 1 Mbit/s"])
def test_what_would_leave_nothing_of_a_limit_is_not_done(said: str) -> None:
    held, _ = talked_into("highest total rate, everybody at most 1 Mbit/s", said)
    assert held == {"max_rate_bps": 1e6}


def test_no_figure_of_all_the_others_becomes_nothing() -> None:
    held, _ = agreed_into(
        "proportional fairness, 300 kbit/s each, user 2 at least 1 Mbit/s",
        "Turn it down to the lowest level at which the 300 kbps guarantees hold.",
    )
    assert held["min_rate_bps"] in (3e5, {"all": 3e5, "2": 1e6})
    zero = [change for change in changes_of(possible("300k less")) if change.effect
            and any(isinstance(act, Limit) and act.value == 0 for act in change.acts)]  # fmt: skip
    assert all(isinstance(act.whom, Named) for change in zero for act in change.acts if isinstance(act, Limit))


@pytest.mark.parametrize(
    "said",
    ["at most 1e400 W", "9999 dB more", "-5000 dB", "user 3 at least 1e308 Gbit/s", "weight 1e400 for user 3",
     "don't halve it", "never 5 W", "nie 5 W", "jamais 5 W", "nicht halbieren", "at most -5 W", "power minus 20 W",
     "user 2's minimum stays", "die Mindestrate von Nutzer 2 bleibt", "el mínimo del usuario 2 se queda",
     "don't drop user 2's minimum", "we must not forget user 2"],
)  # fmt: skip
def test_what_cannot_be_and_what_is_denied_is_not_done(said: str) -> None:
    held, _ = talked_into("highest total rate, at most 10 W", "at least 1 Mbit/s for user 2", said)
    assert held == {"max_power_w": 10.0, "min_rate_bps": {"2": 1e6}}


@pytest.mark.parametrize("said", ["au plus 5 W", "nunca más de 5 W", "never more than 5 W", "no more than 5 W"])
def test_a_bound_is_no_change_by_so_much(said: str) -> None:
    assert talked_into("highest total rate, at most 10 W", said)[0] == {"max_power_w": 5.0}


def test_changes_of_the_same_thing_or_by_the_same_figure_are_not_meant_together() -> None:
    changes = [*changes_of(possible("4 gets 500k, leave 3 out")), SUPPOSED]
    scores = [0.0] * len(changes)
    for meaning in meanings(changes, scores):
        parts = [changes[place] for place in meaning.places]
        assert meaning.supposed == (SUPPOSED in parts)
        keys = [key for change in parts for key, _ in change.effect]
        figures = [change.figure for change in parts if change.figure is not None]
        assert len(keys) == len({*keys})
        assert len(figures) == len({*figures})
    said = {("min_rate_bps", "4"): 5e5, ("leave_out", "3"): 1.0, ("min_rate_bps", "3"): None}
    scores = [float(change.effect <= said.items()) for change in changes]
    assert said in [dict(meaning.effect) for meaning in meanings(changes, scores)]


def test_what_nobody_is_sure_of_is_asked_and_done_at_a_yes(monkeypatch: pytest.MonkeyPatch) -> None:
    for bar in ("SURE", "AGREED"):
        monkeypatch.setattr(weighing, bar, 1.01)
    held, turns = talked_into("max rate", "leave user 3 out", "venga, todos otra vez", "yes")
    assert turns[2].stage == "asked"
    assert held == {}


_WORDS = (
    "sorry", "no", "not", ",", "2", "3", "4", "user 1", "and", "too", "out", "back", "half", "drop", "1M", "9 W",
    "the others", "swap", "than", "more",
)  # fmt: skip


@given(st.lists(st.sampled_from(_WORDS), min_size=2, max_size=7))
@settings(max_examples=60, deadline=None)
def test_all_that_is_meant_together_is_what_its_acts_come_to(words: list[str]) -> None:
    text = " ".join(words)
    line, held = Line.of(text, HELD), possible(text)
    read = Read.of(read_by_rules(text, HELD, OfflineRecogniser()), held)
    found = weigh(Signs(line, held, read, "en"))
    assert not found.acts or held.effect(found.acts) == found.said[1]
