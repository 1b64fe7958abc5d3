"""What an LLM may say of a sentence, and what it may not: the check itself, beside a reading by rules."""

from __future__ import annotations

import dataclasses
from typing import Any, get_args

import pytest

from wirelessagent.language.intent import CONSTRAINTS, LISTS_OF_USERS, Constraint, Intent, IntentKind
from wirelessagent.language.llm_check import Case, Objection, Read
from wirelessagent.language.llm_figures import KINDS, figures_of
from wirelessagent.language.llm_meaning import FiguredConstraint, Meaning, meaning_with
from wirelessagent.language.llm_reasons import told
from wirelessagent.language.recogniser import Context


def by_rules(
    kind: IntentKind = "clarify", objective: str | None = None, topic: str | None = None, **read: Constraint
) -> Intent:
    """What the rules read; they act or they keep it for the answer to their question."""
    place = "constraints" if kind == "allocate" else "pending"
    given: dict[str, Any] = {"constraints": {}, place: read}
    return Intent(
        kind=kind, objective=objective, topic=topic, language="en", confidence=0.5, evidence={}, reply="",
        recogniser="x", **given,
    )  # fmt: skip


def read(text: str, rules: Intent, context: Context | None = None, **filled: Any) -> Read:
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
    assert set(KINDS) == set(get_args(FiguredConstraint)) == set(CONSTRAINTS) - set(LISTS_OF_USERS)


def test_type_knows_objectives_and_topics() -> None:
    schema = meaning_with(("max_rate", "own_one")).model_json_schema()
    objective, topic = (str(schema["properties"][name]) for name in ("objective", "topic"))
    assert "own_one" in objective
    assert "min_power" not in objective
    assert "why_user" in topic
    assert "undo" in topic


def test_reliability_is_the_outage_that_it_leaves() -> None:
    rules = by_rules(outage_probability=0.01)
    for figure in ("F1", "F1b", 0.99, 0.01):
        found = read("faster at 99 %", rules, **RATE, constraints=[stated("outage_probability", figure)])
        assert found.constraints == {"outage_probability": pytest.approx(0.01)}


def test_share_of_the_power_is_worked_out_here() -> None:
    context = Context(max_power_w=40.0)
    rules = by_rules(max_power_w=16.0)
    found = read("faster on 40 % of the power", rules, context, **RATE, constraints=[stated("max_power_w", "F1c")])
    assert found.constraints == {"max_power_w": pytest.approx(16.0)}
    wrong = [stated("max_power_w", "F1d")]
    refused("otherwise", "faster on 40 % of the power", rules, context, **RATE, constraints=wrong)


def test_figures_by_user() -> None:
    text = "faster; users 1 and 2 need 4 Mbit/s, the others 500 kbit/s, and user 3 is out"
    rules = by_rules(min_rate_bps={"1": 4e6, "2": 4e6, "all": 5e5}, leave_out=("3",))
    constraints = [stated("min_rate_bps", "F1", "1", "user 2"), stated("min_rate_bps", 5e5)]
    found = read(text, rules, **RATE, constraints=constraints, leave_out=["3"])
    assert found.constraints == {"min_rate_bps": {"1": 4e6, "2": 4e6, "all": 5e5}, "leave_out": ("3",)}
    refused("otherwise", text, rules, **RATE, constraints=constraints)
    refused("otherwise", text, rules, **RATE, constraints=constraints, leave_out=["1"])
    refused("no_user", text, rules, **RATE, constraints=constraints, leave_out=["7"])
    refused("twice", text, rules, **RATE, constraints=[*constraints, stated("min_rate_bps", "F2", "1")])
    refused("cells_own", "faster, user 1 has 4 W", by_rules(), **RATE, constraints=[stated("max_power_w", "F1", "1")])


def test_weights_are_numbers_of_the_sentence() -> None:
    found = read("faster, user 5 counts twice", by_rules(), **RATE, constraints=[stated("weights", 2, "5")])
    assert found.constraints == {"weights": {"5": 2.0}}
    refused("invented", "faster, user 5 counts twice", by_rules(), **RATE, constraints=[stated("weights", 3, "5")])


def test_rules_in_doubt_about_a_figure_have_the_operator_asked() -> None:
    refused("doubtful", "faster, cut 5 W", by_rules(), **RATE, constraints=[stated("max_power_w", "F1")])
    refused("passed_over", "faster, 20", by_rules(), **RATE, set_aside=["F1"])
    refused("passed_over", "faster, at most 0 W", by_rules(), **RATE, set_aside=["F1"])
    refused("invented", "faster, at most 0 W", by_rules(), **RATE, constraints=[stated("max_power_w", "F1")])
    refused("invented", "faster, at most -3 W", by_rules(), **RATE, constraints=[stated("max_power_w", -3)])


def test_bounds_are_not_turned_round() -> None:
    text = "faster, at most 3 Mbit/s"
    refused("turned", text, by_rules(max_rate_bps=3e6), **RATE, constraints=[stated("min_rate_bps", "F1")])
    text = "faster, at least 3 Mbit/s, at most 1 Mbit/s"
    both = [stated("min_rate_bps", "F1"), stated("max_rate_bps", "F2")]
    refused("crossed", text, by_rules(min_rate_bps=3e6, max_rate_bps=1e6), **RATE, constraints=both)


class TestConversation:
    context = Context(objective="min_power", constraints={"min_rate_bps": 1e6, "max_power_w": 8.0}, max_power_w=20.0)

    def test_amending_keeps_the_objective(self) -> None:
        rules = by_rules("allocate", "min_power", max_power_w=10.0)
        found = read("now with 10 W", rules, self.context, amends=True, constraints=[stated("max_power_w", "F1")])
        assert (found.objective, found.amends, found.constraints) == ("min_power", True, {"max_power_w": 10.0})

    def test_the_sessions_own_figures_may_be_used(self) -> None:
        given = [stated("max_power_w", 8)]
        found = read("faster with the same power", by_rules(), self.context, **RATE, constraints=given)
        assert found.constraints == {"max_power_w": 8.0}
        refused("invented", "faster with more power", by_rules(), self.context, **RATE,
                constraints=[stated("max_power_w", 12)])  # fmt: skip

    def test_only_what_there_is_is_dropped(self) -> None:
        rules = by_rules("allocate", "min_power")
        text = "without the power limit"
        assert read(text, rules, self.context, amends=True, drops=["max_power_w"]).dropped == ("max_power_w",)
        refused("no_request", text, rules, self.context, amends=True, drops=["weights"])
        refused("no_request", text, by_rules(), None, amends=True, objective="min_power", objective_words="power")

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
        refused("mixed", "why?", by_rules(), kind="question", topic="undo")
        refused("mixed", "faster", by_rules(), **RATE, topic="undo")


def test_question_back_is_cleaned() -> None:
    found = read("hm", by_rules(), kind="clarify", question="What\x1b[31m do you\u202e want?")
    assert found.question == "What [31m do you  want?"


def test_figures_of_the_rules_have_labels_too() -> None:
    rules = by_rules("allocate", "max_rate", min_rate_bps=2.5e6)
    figures = figures_of("a quarter more for everyone", Context(), rules)
    assert [(f.label, f.value) for f in figures if f.kind == "rate"] == [("S2", 2.5e6)]


def test_reasons_in_both_languages() -> None:
    assert told("late", "en", {"seconds": 2.0}) == "the LLM did not answer: no answer within 2 s"
    assert told("invented", "zh", {}) == "大模型的答案不成立：给出了没有说过的数值"
    assert told("invented", "de", {}) == told("invented", "en", {})
