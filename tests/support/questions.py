"""Questions about a decision, as a recogniser prints them."""

from __future__ import annotations

from typing import Any

import wirelessagent as wa
from wirelessagent.agent.asking import Asked, answered
from wirelessagent.language.acts import Ask
from wirelessagent.language.intent import Intent, acts_of
from wirelessagent.telling.catalogue import Table
from wirelessagent.telling.facts.case import Case


def answer(
    case: Case, topic: str, language: str = "en", user: int | None = None, **figures: float
) -> tuple[str, tuple[Table, ...]]:
    details: dict[str, Any] = {**figures, **({} if user is None else {"user": case.estimate.user_names[user]})}
    intent = Intent(
        kind="question", objective=None, constraints={}, language=language, confidence=1.0, evidence={}, reply="",
        recogniser="test", topic=topic, details=details,
    )  # fmt: skip
    act = acts_of(intent)[0]
    assert isinstance(act, Ask)
    return answered(Asked(case=case, report=wa.report(case.decision), language=language), act)
