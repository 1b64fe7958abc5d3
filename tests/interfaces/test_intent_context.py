"""What sentences mean within a conversation, and that the same sentences alone never act."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.intent import same_constraints
from wirelessagent.language.offline import recognise
from wirelessagent.language.recogniser import Context, Question

RATE, POWER, FAIR = "max_rate", "min_power", "proportional_fairness"
CONTEXT = Context(
    user_names=tuple(f"user {k}" for k in range(1, 5)), max_power_w=40.0, objective=RATE,
    constraints={"max_power_w": 10.0, "leave_out": ("3", "4")}, language="en",
)  # fmt: skip

CHANGES: list[tuple[str, dict[str, Any], tuple[str, ...]]] = [
    ("now with 10 W", {"max_power_w": 10.0}, ()),
    ("10 W", {"max_power_w": 10.0}, ()),
    ("现在改为5瓦", {"max_power_w": 5.0}, ()),
    ("and at least 1 Mbit/s for everyone", {"min_rate_bps": 1e6}, ()),
    ("每个用户至少1 Mbit/s", {"min_rate_bps": 1e6}, ()),
    ("make that at least 50 Mbit/s for everyone", {"min_rate_bps": 5e7}, ()),
    ("user 2 needs at least 2 Mbit/s", {"min_rate_bps": {"2": 2e6}}, ()),
    ("用户2至少要2 Mbit/s", {"min_rate_bps": {"2": 2e6}}, ()),
    ("leave user 2 out", {"leave_out": ("2",)}, ()),
    ("不要用户2", {"leave_out": ("2",)}, ()),
    ("bring user 3 back", {"leave_out": ("4",)}, ("leave_out",)),
    ("bring users 3 and 4 back", {}, ("leave_out",)),
    ("without the power limit", {}, ("max_power_w",)),
    ("取消功率上限", {}, ("max_power_w",)),
    ("half power", {"max_power_w": 20.0}, ()),
    ("with half the power", {"max_power_w": 20.0}, ()),
    ("user 1 counts double", {"weights": {"1": 2.0}}, ()),
    ("with 95 % reliability", {"outage_probability": 0.05}, ()),
]  # fmt: skip

WISHES: list[tuple[str, str, bool]] = [
    ("the same with the least power", POWER, True),
    ("条件不变,改为功率最低", POWER, True),
    ("save power", POWER, True),
]

COMMANDS: list[tuple[str, str, dict[str, Any]]] = [
    ("undo", "undo", {}),
    ("撤销", "undo", {}),
    ("apply it", "apply", {}),
    ("应用", "apply", {}),
    ("yes", "confirm", {}),
    ("好的", "confirm", {}),
    ("no", "reject", {}),
    ("不", "reject", {}),
    ("解释一下", "explain", {}),
    ("explain", "explain", {}),
    ("compare with the last one", "compare", {"with": "last"}),
    ("和上一个比较", "compare", {"with": "last"}),
    ("compare with the paper", "compare", {"with": "paper"}),
    ("history", "history", {}),
    ("start over", "reset", {}),
    ("status", "status", {}),
    ("help", "help", {}),
    ("export it as TMF921", "export", {"format": "tmf921"}),
]

QUESTIONS: list[tuple[str, str, dict[str, Any]]] = [
    ("why did user 3 get nothing?", "why_user", {"user": "3"}),
    ("用户3为什么什么都没有?", "why_user", {"user": "3"}),
    ("what would one more watt buy?", "step", {"power_w": 1.0}),
    ("再多一瓦能换来什么?", "step", {"power_w": 1.0}),
    ("what if 40 % were missing?", "what_if", {"missing_share": 0.4}),
    ("如果缺失40%会怎样?", "what_if", {"missing_share": 0.4}),
    ("what if we had 5 W?", "what_if", {"constraints": {"max_power_w": 5.0}}),
    ("what if user 2 were gone?", "what_if", {"constraints": {"leave_out": ("2",)}}),
    ("why is it infeasible?", "why_infeasible", {}),
    ("is that optimal?", "certificate", {}),
    ("what does PF mean?", "concept", {}),
    ("what can you do?", "capabilities", {}),
]


@pytest.mark.parametrize(("text", "constraints", "dropped"), CHANGES)
def test_changes_of_the_request(text: str, constraints: dict[str, Any], dropped: tuple[str, ...]) -> None:
    intent = recognise(text, CONTEXT)
    assert (intent.kind, intent.objective, intent.amends, intent.dropped) == ("allocate", RATE, True, dropped), intent
    assert same_constraints(intent.constraints, constraints), intent.constraints


@pytest.mark.parametrize("text", [text for text, _, _ in CHANGES])
@pytest.mark.parametrize("context", [None, Context()])
def test_without_a_request_they_are_asked_about(text: str, context: Context | None) -> None:
    intent = recognise(text, context)
    assert intent.kind == "clarify", intent


@pytest.mark.parametrize(("text", "objective", "amends"), WISHES)
def test_wishes_keep_the_limits_or_replace_the_request(text: str, objective: str, amends: bool) -> None:
    intent = recognise(text, CONTEXT)
    assert (intent.kind, intent.objective, intent.amends) == ("allocate", objective, amends), intent


@pytest.mark.parametrize("context", [None, CONTEXT])
@pytest.mark.parametrize(
    ("kind", "text", "topic", "details"),
    [("command", *case) for case in COMMANDS] + [("question", *case) for case in QUESTIONS],
)
def test_commands_and_questions(
    kind: str, text: str, topic: str, details: dict[str, Any], context: Context | None
) -> None:
    intent = recognise(text, context)
    assert (intent.kind, intent.topic) == (kind, topic), intent
    found = {name: dict(value) if hasattr(value, "items") else value for name, value in intent.details.items()}
    assert found == details


def test_the_answer_to_a_question_uses_what_was_read_before() -> None:
    asked = recognise("at most 10 W")
    assert (asked.kind, dict(asked.pending)) == ("clarify", {"max_power_w": 10.0})
    question = Question(pending=asked.pending)
    answer = recognise("the highest total rate", Context(awaits="clarification", question=question))
    assert (answer.objective, dict(answer.constraints)) == (RATE, {"max_power_w": 10.0})
    later = recognise("the highest total rate, 5 W", Context(awaits="clarification", question=question))
    assert dict(later.constraints) == {"max_power_w": 5.0}
    alone = recognise("the highest total rate", Context(question=question))
    assert not alone.constraints


def test_a_bare_figure_is_answered_in_the_conversations_language() -> None:
    assert recognise("5 W", Context(language="zh")).language == "zh"
    assert recognise("5 W").language == "en"


def test_impossible_changes_are_asked_about() -> None:
    assert recognise("now with 0 W", CONTEXT).kind == "clarify"
    assert recognise("now with 10", CONTEXT).kind == "clarify"
    assert recognise("at least 5 Mbit/s and at most 1 Mbit/s each", CONTEXT).kind == "clarify"
