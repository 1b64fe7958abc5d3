"""What an LLM may say of a sentence, and what it may not: the check itself, beside a reading by rules."""

from __future__ import annotations

import contextlib
import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_args

import pytest

from wirelessagent.language.guard import guarded
from wirelessagent.language.intent import CONSTRAINTS, EVERYBODY, LISTS_OF_USERS, Constraint, Intent, IntentKind
from wirelessagent.language.llm.client import NoAnswer, Objection
from wirelessagent.language.llm.prompt import KINDS, Details, FiguredConstraint, Meaning, figures_of, meaning_with
from wirelessagent.language.llm.reader import Case
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context
from wirelessagent.language.sentence import Sentence, own_words

INTENTS = Path(__file__).parents[1] / "intents"


def by_rules(
    kind: IntentKind = "clarify",
    objective: str | None = None,
    topic: str | None = None,
    *,
    amends: bool = False,
    **read: Constraint,
) -> Intent:
    """What the rules read; they act or they keep it for the answer to their question."""
    place = "constraints" if kind == "allocate" else "pending"
    given: dict[str, Any] = {"constraints": {}, place: read}
    return Intent(
        kind=kind, objective=objective, topic=topic, language="en", confidence=0.5, evidence={}, reply="",
        recogniser="x", amends=amends, **given,
    )  # fmt: skip


def read(text: str, rules: Intent, context: Context | None = None, **filled: Any) -> Intent:
    meaning = Meaning.model_validate({"kind": "allocate", "language": "en"} | filled)
    return Case(text, context or Context(), rules).read(meaning)


def refused(key: str, text: str, rules: Intent, context: Context | None = None, **filled: Any) -> None:
    with pytest.raises(Objection) as caught:
        read(text, rules, context, **filled)
    assert caught.value.key == key


def stated(name: str, figure: str | float, *users: str) -> dict[str, Any]:
    return {"constraint": name, "figure": figure, "users": list(users)}


RATE = {"objective": "max_rate", "objective_words": "faster"}


def test_every_constraint_has_a_kind_of_figure() -> None:
    assert set(get_args(FiguredConstraint)) == set(CONSTRAINTS) - set(LISTS_OF_USERS)
    assert set(KINDS) - set(get_args(FiguredConstraint)) == set(Details.model_fields) - {
        "user",
        "compared_with",
        "format",
    }


def test_type_knows_objectives_and_topics() -> None:
    schema = meaning_with(("max_rate", "own_one")).model_json_schema()
    objective, topic = (str(schema["properties"][name]) for name in ("objective", "topic"))
    assert "own_one" in objective
    assert "min_power" not in objective
    assert "why_user" in topic
    assert "undo" in topic


def test_reliability_is_the_outage_that_it_leaves() -> None:
    rules = by_rules(outage_probability=0.01)
    for figure in ("F1", "S2", 0.99, 0.01):
        found = read("faster at 99 %", rules, **RATE, constraints=[stated("outage_probability", figure)])
        assert found.constraints == {"outage_probability": pytest.approx(0.01)}


def test_share_of_the_power_is_worked_out_here() -> None:
    context = Context(max_power_w=40.0)
    rules = by_rules(max_power_w=16.0)
    found = read("faster on 40 % of the power", rules, context, **RATE, constraints=[stated("max_power_w", "S2")])
    assert found.constraints == {"max_power_w": pytest.approx(16.0)}
    wrong = [stated("max_power_w", "S1")]
    refused("otherwise", "faster on 40 % of the power", rules, context, **RATE, constraints=wrong)


def test_figures_by_user() -> None:
    text = "faster; users 1 and 2 need 4 Mbit/s, the others 500 kbit/s, and user 3 is out"
    rules = by_rules(min_rate_bps={"1": 4e6, "2": 4e6, "all": 5e5}, leave_out=("3",))
    constraints = [stated("min_rate_bps", "F1", "1", "user 2"), stated("min_rate_bps", 5e5)]
    found = read(text, rules, **RATE, constraints=constraints, leave_out=["3"])
    assert found.constraints == {"min_rate_bps": {"1": 4e6, "2": 4e6, "all": 5e5}, "leave_out": ("3",)}
    refused("left_out", text, rules, **RATE, constraints=constraints)
    refused("otherwise", text, rules, **RATE, constraints=constraints, leave_out=["1"])
    refused("no_user", text, rules, **RATE, constraints=constraints, leave_out=["7"])
    refused(
        "otherwise", text, rules, **RATE, constraints=[*constraints, stated("min_rate_bps", "F2", "1")], leave_out=["3"]
    )
    refused("doubtful", "faster, user 1 has 4 W", by_rules(), **RATE, constraints=[stated("max_power_w", "F1", "1")])
    what_if = {"kind": "question", "topic": "what_if", "constraints": [stated("max_power_w", "F1", "1")]}
    refused("impossible", "what if user 1 had 4 W?", by_rules("question"), **what_if)


def test_weights_are_numbers_of_the_sentence() -> None:
    text = "faster, user 5 counts twice"
    rules = OfflineRecogniser().read(text)
    assert read(text, rules, **RATE, constraints=[stated("weights", 2, "5")]).constraints == {"weights": {"5": 2.0}}
    refused("invented", text, rules, **RATE, constraints=[stated("weights", 3, "5")])


def test_rules_in_doubt_about_a_figure_have_the_operator_asked() -> None:
    refused("doubtful", "faster, cut 5 W", by_rules(), **RATE, constraints=[stated("max_power_w", "F1")])
    refused("doubtful", "faster, at most 0 W", by_rules(), **RATE)
    refused("doubtful", "faster with 30 dB", by_rules(), **RATE)
    refused("invented", "faster, at most 0 W", by_rules(), **RATE, constraints=[stated("max_power_w", "F1")])
    refused("invented", "faster, at most -3 W", by_rules(), **RATE, constraints=[stated("max_power_w", -3)])


def test_bounds_are_not_turned_round() -> None:
    text = "faster, at most 3 Mbit/s"
    refused("doubtful", text, by_rules(max_rate_bps=3e6), **RATE, constraints=[stated("min_rate_bps", "F1")])
    text = "faster, at least 3 Mbit/s, at most 1 Mbit/s"
    both = [stated("min_rate_bps", "F1"), stated("max_rate_bps", "F2")]
    refused("doubtful", text, by_rules(min_rate_bps=3e6, max_rate_bps=1e6), **RATE, constraints=both)


class TestConversation:
    context = Context(objective="min_power", constraints={"min_rate_bps": 1e6, "max_power_w": 8.0}, max_power_w=20.0)

    def test_amending_keeps_the_objective(self) -> None:
        rules = by_rules("allocate", "min_power", amends=True, max_power_w=10.0)
        found = read("now with 10 W", rules, self.context, amends=True, constraints=[stated("max_power_w", "F1")])
        assert (found.objective, found.amends, found.constraints) == ("min_power", True, {"max_power_w": 10.0})

    def test_the_sessions_own_figures_may_be_used(self) -> None:
        given = [stated("max_power_w", 8)]
        found = read("faster with the same power", by_rules(), self.context, **RATE, amends=True, constraints=given)
        assert found.constraints == {"max_power_w": 8.0}
        refused("invented", "faster with more power", by_rules(), self.context, **RATE, amends=True,
                constraints=[stated("max_power_w", 12)])  # fmt: skip

    @pytest.mark.parametrize(
        ("key", "name", "figure"),
        [
            ("invented", "subcarrier_max_power_w", "S1"), ("invented", "circuit_power_w", "S3"),
            ("doubtful", "max_power_w", "S1"),  # the cell's limit does not lift the operator's
            ("invented", "max_rate_bps", 1e6),
        ],
    )  # fmt: skip
    def test_a_figure_of_the_session_stays_what_it_was(self, key: str, name: str, figure: str | float) -> None:
        text = "faster with the same figures"
        given = [stated(name, figure)]
        refused(key, text, by_rules(), self.context, **RATE, amends=True, constraints=given)
        assert read(text, by_rules(), self.context, **RATE, amends=True, constraints=[stated("max_power_w", "S3")])

    def test_only_what_there_is_is_dropped(self) -> None:
        rules = by_rules("allocate", "min_power", amends=True)
        text = "without the power limit"
        assert read(text, rules, self.context, amends=True, drops=["max_power_w"]).dropped == ("max_power_w",)
        refused("no_request", text, rules, self.context, amends=True, drops=["weights"])
        refused("no_request", text, by_rules(), None, amends=True, objective="min_power", objective_words="power")

    def test_no_limit_goes_that_nobody_took_back(self) -> None:
        rules = by_rules("allocate", "min_power", amends=True, max_power_w=5.0)
        now = {"amends": True, "constraints": [stated("max_power_w", "F1")]}
        refused("let_go", "now with 5 W", rules, self.context, **now, drops=["min_rate_bps"])
        refused("let_go", "now with 5 W", rules, self.context, **now | {"amends": False, "objective": "min_power"})
        lifted = by_rules("allocate", "min_power", amends=True)
        text = "without the power limit"
        refused("let_go", text, lifted, self.context, amends=True, drops=["max_power_w", "min_rate_bps"])
        refused("let_go", text, lifted, self.context, amends=True, constraints=[stated("max_power_w", "S3")])
        text = "nobody is promised a speed any more"
        assert read(text, by_rules(), self.context, amends=True, drops=["min_rate_bps"]).dropped == ("min_rate_bps",)
        refused("let_go", text, by_rules(), self.context, amends=True, drops=["max_power_w"])

    def test_a_wish_without_figures_keeps_the_limits(self) -> None:
        refused("let_go", "faster", by_rules(), self.context, **RATE)
        assert read("faster", by_rules(), self.context, **RATE, amends=True).amends
        rules = by_rules("allocate", "max_rate", max_power_w=5.0)
        whole = {**RATE, "constraints": [stated("max_power_w", "F1")]}
        refused("no_request", "faster on at most 5 W", rules, self.context, **whole, amends=True)
        assert not read("faster on at most 5 W", rules, self.context, **whole).amends

    @pytest.mark.parametrize("topic", ["undo", "reset"])
    def test_undo_and_reset_have_to_be_said(self, topic: str) -> None:
        said = {"kind": "command", "topic": topic}
        for text in ("hello there", "what if we had 20 W?"):
            offline = OfflineRecogniser().recognise(text, self.context)
            assert offline.topic != topic, text
            with pytest.raises(Objection):
                read(text, offline, self.context, **said)
        words = {"undo": "oops, reverted it should be", "reset": "all of that was nonsense, a fresh start please"}
        assert read(words[topic], by_rules(), self.context, **said).topic == topic

    @pytest.mark.parametrize("topic", ["apply", "confirm"])
    def test_only_the_operator_says_yes(self, topic: str) -> None:
        plain = by_rules("command", topic=topic)
        asked = Context(awaits="confirmation")
        assert read("yes", plain, asked, kind="command", topic=topic).topic == topic
        refused("go_ahead", "sounds interesting", by_rules(), asked, kind="command", topic=topic)
        other = "confirm" if topic == "apply" else "apply"
        refused("go_ahead", "yes", by_rules("command", topic=other), asked, kind="command", topic=topic)

    def test_nothing_is_confirmed_that_was_not_asked(self) -> None:
        refused("go_ahead", "yes", by_rules("command", topic="confirm"), kind="command", topic="confirm")

    def test_other_commands_and_questions_have_details(self) -> None:
        rules = by_rules("question")
        why = {"kind": "question", "topic": "why_user", "details": {"user": "user 3"}}
        assert read("why did user 3 get nothing?", rules, **why).details == {"user": "3"}
        step = {"kind": "question", "topic": "step", "details": {"power_w": "F1"}}
        assert read("what would 1 W more buy?", rules, **step).details == {"power_w": 1.0}
        by_words = dataclasses.replace(rules, details={"power_w": 1.0})
        step["details"] = {"power_w": 1.0}
        assert read("what would a bit more buy?", by_words, **step).details == {"power_w": 1.0}
        lost = {"kind": "question", "topic": "what_if", "details": {"missing_share": 0.4}}
        assert read("what if 40 % were missing?", rules, **lost).details == {"missing_share": 0.4}
        half = {"kind": "question", "topic": "what_if", "constraints": [stated("max_power_w", "F1")]}
        assert read("what if I had 5 W?", rules, **half).details == {"constraints": {"max_power_w": 5.0}}
        refused("invented", "what if I had 5 W?", rules, **half | {"constraints": [stated("max_power_w", 50)]})
        shown = {"kind": "command", "topic": "history", "details": {"number": 3}}
        assert read("show number 3", rules, **shown).details == {"number": 3.0}
        against = {"kind": "command", "topic": "compare", "details": {"compared_with": "last"}}
        assert read("compare with the last one", rules, **against).details == {"with": "last"}

    def test_a_topic_of_another_kind_is_refused(self) -> None:
        refused("impossible", "why?", by_rules(), kind="question", topic="undo")
        refused("impossible", "faster", by_rules(), **RATE, topic="undo")


def test_question_back_is_cleaned() -> None:
    found = read("hm", by_rules(), kind="clarify", question="What\x1b[31m do you\u202e want?")
    assert found.reply == "What [31m do you  want?"


def test_question_back_only_asks() -> None:
    def asked(question: str) -> str:
        return read("hm", by_rules(), kind="clarify", question=question).reply

    assert asked("All is applied. Type yes.\nLeast power or most speed?") == "Least power or most speed?"
    assert asked("已应用。要速率还是要省电？") == "要速率还是要省电？"
    assert asked("What should be done first?") == "What should be done first?"
    for question in (
        "Done, applied, anything else?", "I have set it, all right?", "已经应用了，还要什么？",
        "See http://evil.example, ok?", "Will you visit evil.example/x?", "Ask me@evil.example?",
        "[link=x]Faster?[/link]",
    ):  # fmt: skip
        refused("pretended", "hm", by_rules(), kind="clarify", question=question)
    refused("asked_nothing", "hm", by_rules(), kind="clarify", question="Done, applied. Type 'yes'.")


@pytest.mark.parametrize(
    ("text", "objective", "words"),
    [
        ("hello there", "max_rate", "hello"), ("what if we had 20 W?", "max_rate", "we"),
        ("don't save power today", "min_power", "save power"), ("is save power a good idea?", "min_power", "is"),
        ("is save power a good idea?", "min_power", "save power"), ("tell me a joke about speed", "max_rate", "speed"),
        ("Highest total rate", "min_power", "Highest total rate"), ("let's drain the battery", "min_power", "battery"),
        ("the concert begins", "max_rate", "the concert"), ("max rate? no", "max_rate", "max rate"),
        ("the powerful concert begins", "min_power", "powerful"), ("不要省电", "min_power", "省电"),
        ("你好", "max_rate", "你好"),
    ],
)  # fmt: skip
def test_no_request_from_a_sentence_that_makes_none(text: str, objective: str, words: str) -> None:
    rules = OfflineRecogniser().recognise(text)
    try:
        intent = read(text, rules, objective=objective, objective_words=words)
    except Objection:
        return
    assert guarded(text, None, intent).kind == "clarify"


@pytest.mark.parametrize(
    ("text", "objective", "words"),
    [
        ("the batteries on site are nearly flat", "min_power", "batteries"),
        ("everyone should get a slice of the cake", "proportional_fairness", "a slice of the cake"),
        ("can you save power?", "min_power", "save power"), ("the picture stutters", "max_rate", "stutters"),
        ("谁都别垫底", "max_min_rate", "垫底"),
    ],
)  # fmt: skip
def test_indirect_wishes_are_the_llms(text: str, objective: str, words: str) -> None:
    rules = OfflineRecogniser().recognise(text)
    assert read(text, rules, objective=objective, objective_words=words).objective == objective


def test_users_are_those_who_were_named() -> None:
    text, rules = "highest total rate with 7 W", by_rules("allocate", "max_rate", max_power_w=7.0)
    power = {"objective": "max_rate", "objective_words": "rate", "constraints": [stated("max_power_w", "F1")]}
    for lists in ({"leave_out": ["7"]}, {"users": ["user 7"]}, {"leave_out": ["W"]}, {"leave_out": ["total"]}):
        refused("no_user", text, rules, **power, **lists)
    text = "highest total rate with 7 W for user 7"
    refused("doubtful", text, rules, **power, leave_out=["7"])  # named, but not to be left out
    why = {"kind": "question", "topic": "why_user", "details": {"user": "7"}}
    assert read(text, rules, **why).details == {"user": "7"}
    refused("no_user", "why did it get 7 W?", by_rules("question"), **why)


@pytest.mark.parametrize("label", ["F1 ", "f1", " f1 "])
def test_a_label_is_a_label_however_it_is_spelt(label: str) -> None:
    rules = by_rules("allocate", "max_rate", max_power_w=3.0)
    found = read("faster, at most 3 W", rules, **RATE, constraints=[stated("max_power_w", label)])
    assert found.constraints == {"max_power_w": 3.0}


def test_figures_of_the_rules_have_labels_too() -> None:
    rules = by_rules("allocate", "max_rate", min_rate_bps=2.5e6)
    sentence = Sentence("a quarter more for everyone", own_words())
    figures = figures_of(sentence, Context(), rules, rules.constraints)
    assert [(f.label, f.value) for f in figures if f.kind == "rate"] == [("S2", 2.5e6)]


def test_reasons_in_both_languages() -> None:
    assert NoAnswer("late", {"seconds": 2.0}).told("en") == "the LLM did not answer: no answer within 2 s"
    assert NoAnswer("invented").told("zh") == "大模型的答案不成立：给出了没有说过的数值"
    assert NoAnswer("invented").told("pt") == NoAnswer("invented").told("en")


def test_an_llm_that_lies_about_the_aim_gets_next_to_nothing_through() -> None:
    """Every aim for each sentence of the development sets, quoted whole, with the figures that the rules read."""
    aims = ("max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate")
    lines = [
        line for path in sorted(INTENTS.glob("development*.jsonl")) for line in path.read_text("utf-8").splitlines()
    ]
    told, acted = {True: 0, False: 0}, {True: 0, False: 0}
    for row in map(json.loads, lines[::6]):
        rules = OfflineRecogniser().read(row["text"])
        case = Case(row["text"], Context(), rules)
        for aim in aims:
            is_true = row["objective"] == aim
            said = {"kind": "allocate", "language": "en", "objective": aim, "objective_words": row["text"]}
            told[is_true] += 1
            with contextlib.suppress(Objection):
                acted[is_true] += case.read(Meaning.model_validate(said | repeated(case.rules))).kind == "allocate"
    assert acted[True] >= 0.97 * told[True]
    assert acted[False] <= 0.02 * told[False]


def repeated(rules: Mapping[str, Constraint]) -> dict[str, Any]:
    """What an LLM fills in that reads what the rules read."""
    lists = {name: list(value) for name, value in rules.items() if isinstance(value, tuple)}
    constraints: list[dict[str, Any]] = []
    for name, value in rules.items():
        if not isinstance(value, tuple):
            each = value if isinstance(value, Mapping) else {EVERYBODY: value}
            constraints += [stated(name, one, *({user} - {EVERYBODY})) for user, one in each.items()]
    return lists | {"constraints": constraints}
