"""What lets a plan be applied at a base station that is not simulated: a plain yes that follows its name."""

from __future__ import annotations

from pathlib import Path

import pytest
from conversations import LOSS, SCENE, SEED, asks, means

import wirelessagent as wa
from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn
from wirelessagent.language.conversation.answers import assent, is_assent
from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context, Recogniser
from wirelessagent.telling.catalogue import message

TEN = "Highest total rate with at most 10 W"
PLAN = "the highest total rate: at most 10 W of radiated power"

REFUSED = (
    "apply nothing", "never apply it", "apply it not", "I would not apply it", "nothing should be applied", "no", "n",
    "please don't apply", "cancel the apply", "confirm nothing", "stop the deployment", "refuse to apply", "not ok",
    "取消应用", "不要应用", "什么都不应用", "不行", "不同意", "nicht anwenden", "no lo apliques", "ne l'applique pas",
    "no, thank you",
)  # fmt: skip
POSTPONED = (
    "hold off applying", "ok, hold on", "ok wait", "apply it tomorrow", "wait, don't do it yet", "not yet", "not now",
    "先别应用", "等会儿再应用", "好的，等一下", "晚点再说",
)  # fmt: skip
DOUBTFUL = (
    "should I apply it?", "when will you apply it", "can you apply it?", "is it applied", "yes?", "yes I see",
    "why not", "apply it if it is safe", "apply the previous one", "apply turn 1", "apply 0 W",
    "yes and no", "apply it at 6 pm", "confirm the power", "apply for a job", "no problem",
    "looks good but",
    "he said yes", "ok I understand", "应用吗", "可以吗", "应用什么", "是吧", "对吧",
    "is that ok?", "what happens if I apply it",
)  # fmt: skip
YES = (
    "yes", "Yes, please!", "y", "yes yes yes", "go ahead", "do it", "confirm", "confirmed", "I agree", "let's do it",
    "ok", "okay", "sure", "great", "good, thanks", "looks good", "sounds good to me", "that's fine",
    "perfect, go ahead", "apply", "apply it", "Apply it!!!", "apply the plan", "please apply it now", "yes, apply it",
    "go ahead and apply it",
    "好", "好的", "可以", "行", "是的", "对", "确认", "应用", "应用吧", "执行", "下发", "就这样",
    "好的，请应用这个方案", "我同意",
    "sí, por favor", "aplícalo", "oui", "applique-le", "ja, bitte", "bitte anwenden",
)  # fmt: skip


class Eager(Recogniser):
    """Takes every line but the request for a yes, as a language model may."""

    name = "eager"

    def __init__(self, topic: str) -> None:
        self.topic = topic

    def read(self, text: str, context: Context | None = None) -> Intent:
        return asks("max_rate", max_power_w=10.0) if text == TEN else means("command", topic=self.topic)


class Written:
    """A conversation at a base station behind a file."""

    def __init__(self, folder: Path, recogniser: Recogniser | None = None) -> None:
        self.path = folder / "allocation.json"
        station = wa.plugins.create("base_station", "file", {"path": self.path}, SCENE)
        assert isinstance(station, wa.BaseStation)
        self.session = Session(SCENE, LOSS, seed=SEED, recogniser=recogniser, base_station=station)

    def say(self, *lines: str) -> Turn:
        return [self.session.say(line) for line in lines][-1]

    def is_written(self) -> bool:
        return self.path.exists()


def recognisers() -> tuple[Recogniser, ...]:
    return OfflineRecogniser(), Eager("apply"), Eager("confirm")


@pytest.mark.parametrize("said", REFUSED)
def test_a_refusal_drops_the_plan_whatever_the_recogniser(said: str, tmp_path: Path) -> None:
    for recogniser in recognisers():
        talk = Written(tmp_path, recogniser)
        turn = talk.say(TEN, said)
        assert (turn.stage, talk.session.state.planned) == ("nothing", None), turn.reply
        assert message(turn.intent.language, "plan.dropped") in turn.reply
        assert not talk.is_written()


@pytest.mark.parametrize("said", POSTPONED)
def test_a_wish_to_wait_leaves_the_plan_waiting(said: str, tmp_path: Path) -> None:
    for recogniser in recognisers():
        talk = Written(tmp_path, recogniser)
        turn = talk.say(TEN, said)
        assert turn.stage == "nothing"
        assert "goes on waiting" in turn.reply or "继续等待" in turn.reply
        assert talk.session.state.awaits == "confirmation"
        assert not talk.is_written()
    assert talk.say("yes").stage == "applied"


@pytest.mark.parametrize("said", DOUBTFUL)
def test_questions_conditions_and_other_words_are_asked_about(said: str, tmp_path: Path) -> None:
    for recogniser in recognisers():
        talk = Written(tmp_path, recogniser)
        turn = talk.say(TEN, said)
        assert turn.stage == "asked", turn.reply
        assert "Shall I apply it?" in turn.reply or "是否应用？" in turn.reply
        assert talk.session.state.awaits == "confirmation"
        assert not talk.is_written()
    assert PLAN in talk.say("is it applied?").reply
    assert talk.say("yes").stage == "applied"
    assert talk.session.state.awaits == "nothing"


@pytest.mark.parametrize("said", YES)
def test_a_plain_yes_applies_the_plan(said: str, tmp_path: Path) -> None:
    talk = Written(tmp_path, OfflineRecogniser())
    assert talk.say(TEN, said).stage == "applied"
    assert talk.is_written()


@pytest.mark.parametrize(
    "said",
    ["yes with 5 W", "ok but leave out user 1", "apply to everyone at least 1 Mbit/s"],
)
def test_a_change_behind_a_yes_is_planned(said: str, tmp_path: Path) -> None:
    talk = Written(tmp_path)
    assert talk.say(TEN, said).stage == "planned"
    assert not talk.is_written()


@pytest.mark.parametrize(
    "between",
    ["what would one more watt buy?", "thanks", "compare with greedy", "write me a poem", "explain", "what if 5 W?"],
)
def test_an_answer_to_something_else_names_the_plan_and_a_mere_ok_is_no_yes(between: str, tmp_path: Path) -> None:
    talk = Written(tmp_path)
    assert f"'yes' applies {PLAN}" in talk.say(TEN, between).reply
    assert "Shall I apply it" in talk.say("ok").reply
    assert not talk.is_written()
    assert talk.say("ok").stage == "applied"
    assert Written(tmp_path).say(TEN, between, "yes").stage == "applied"


def test_behind_a_document_a_yes_is_asked_about(tmp_path: Path) -> None:
    talk = Written(tmp_path)
    assert talk.say(TEN, "export as TMF921").reply.endswith("}")
    assert "Shall I apply it" in talk.say("yes").reply
    assert talk.say("yes").stage == "applied"


def test_a_simulated_cell_asks_about_an_apply_with_words_left_over() -> None:
    station = wa.SimulatedBaseStation(SCENE)
    session = Session(SCENE, LOSS, seed=SEED, recogniser=Eager("apply"), base_station=station, confirm=True)
    assert session.say(TEN).stage == "planned"
    assert session.say("no").stage == "nothing"
    assert session.say("apply it to cell 2").stage == "asked"
    assert session.state.on_air is None
    assert session.say("yes").stage == "applied"
    assert session.say("apply it if it is safe").stage == "nothing"


def test_that_a_limit_holds_is_told_with_the_yes_too(tmp_path: Path) -> None:
    talk = Written(tmp_path)
    assert "50 W is above the cell's limit of 20 W" in talk.say("Highest total rate with at most 50 W", "yes").reply


def test_long_lines_and_repetitions_are_no_assent_and_read_at_once() -> None:
    assert not any(map(is_assent, ("go on", "行了", "应用了", "对吧")))
    for said in ("好吧" * 49 + "x", "yes " * 24 + "x", "就那就" * 30, "y" * 500):
        assert assent(said) == "other"
