"""Conversations of fifteen turns with what each turn means and leaves behind, for any recogniser; and one that reads a
script instead of the text.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import wirelessagent as wa
from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn
from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context, Recogniser

SCENE = wa.simulate("rayleigh", wa.Cell(max_power_w=20), num_users=4, seed=3)
LOSS, SEED = wa.loss.random(0.2), 3


def talk(*lines: str, confirm: bool = False) -> tuple[Session, list[Turn]]:
    """A conversation of these lines with the offline recogniser, and its turns."""
    session = Session(SCENE, LOSS, seed=SEED, confirm=confirm)
    return session, [session.say(line) for line in lines]


def talked_into(*lines: str) -> tuple[dict[str, Any], list[Turn]]:
    """The constraints that are asked for after these lines, and their turns."""
    session, turns = talk(*lines)
    return asked_for(session), turns


def asked_for(session: Session) -> dict[str, Any]:
    """The constraints that are asked for."""
    held = {} if session.request is None else session.request.constraints
    return {name: dict(value) if isinstance(value, Mapping) else value for name, value in held.items()}


def agreed(session: Session, said: str) -> Turn:
    """The turn of a line, or of a yes where it is asked whether just that is meant."""
    turn = session.say(said)
    return session.say("yes") if turn.stage == "asked" and turn.intent.guess is not None else turn


def agreed_into(*lines: str) -> tuple[dict[str, Any], list[Turn]]:
    """The constraints that are asked for after these lines and a yes to each question whether one is meant."""
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    turns = [agreed(session, line) for line in lines]
    return asked_for(session), turns


class Scripted(Recogniser):
    """Means what was written down beforehand, whatever is said; remembers the contexts."""

    name = "scripted"

    def __init__(self, intents: Iterable[Intent]) -> None:
        self._intents = list(intents)
        self.contexts: list[Context | None] = []

    def read(self, text: str, context: Context | None = None) -> Intent:
        self.contexts.append(context)
        return self._intents.pop(0)


class PartlyScripted(OfflineRecogniser):
    """Means what was written down beforehand of some sentences, and what the offline one reads of all others."""

    def __init__(self, said: Iterable[tuple[str, Intent]]) -> None:
        self.left = list(said)

    def read(self, text: str, context: Context | None = None) -> Intent:
        return self.left.pop(0)[1] if self.left and self.left[0][0] == text else super().read(text, context)


def means(kind: Any, objective: str | None = None, /, language: str = "en", **fields: Any) -> Intent:
    """An intent of which only what matters is said."""
    return Intent(
        kind=kind, objective=objective, constraints=fields.pop("constraints", {}), language=language, confidence=1.0,
        evidence={}, reply=fields.pop("reply", ""), recogniser="scripted", **fields,
    )  # fmt: skip


def asks(objective: str, /, *, language: str = "en", amends: bool = False, **constraints: Any) -> Intent:
    """A request, or an amendment of one."""
    return means("allocate", objective, language=language, amends=amends, constraints=constraints)


@dataclass(frozen=True, kw_only=True)
class Line:
    """One turn: what is said, what it means, what it comes to, and what is asked for afterwards."""

    text: str
    intent: Intent
    stage: str
    objective: str
    constraints: Mapping[str, Any]
    told: tuple[str, ...] = field(default=())


def _line(
    text: str, intent: Intent, stage: str, objective: str, told: tuple[str, ...] = (), **constraints: Any
) -> Line:
    return Line(text=text, intent=intent, stage=stage, objective=objective, constraints=constraints, told=told)


_EACH = {"max_power_w": 5.0, "min_rate_bps": 1e6}
_MUCH = {"max_power_w": 5.0, "min_rate_bps": 5e7}
_SOME = {"max_power_w": 5.0, "min_rate_bps": {"all": 1e6, "2": 2e6}}


def _conversation(language: str, texts: Iterable[str]) -> tuple[Line, ...]:
    def amends(objective: str = "max_rate", **constraints: Any) -> Intent:
        return asks(objective, language=language, amends=True, **constraints)

    def wonders(topic: str, **details: Any) -> Intent:
        return means("question", language=language, topic=topic, details=details)

    def orders(topic: str, said: str = language, **details: Any) -> Intent:
        return means("command", language=said, topic=topic, details=details)

    rest = iter(texts)

    def line(intent: Intent, stage: str, objective: str, *told: str, **constraints: Any) -> Line:
        return _line(next(rest), intent, stage, objective, told, **constraints)

    return (
        line(
            asks("max_rate", language=language, max_power_w=10.0), "applied", "max_rate", "10 W", "bit/s",
            max_power_w=10.0,
        ),
        line(amends(max_power_w=5.0), "applied", "max_rate", "5 W", max_power_w=5.0),
        line(amends(min_rate_bps=1e6), "applied", "max_rate", "5 W", "1 Mbit/s", **_EACH),
        line(amends(leave_out=("3",)), "applied", "max_rate", "1 Mbit/s", "3", **_EACH, leave_out=("3",)),
        line(wonders("what_if", missing_share=0.4), "answered", "max_rate", "40 %", **_EACH, leave_out=("3",)),
        line(orders("compare", **{"with": "last"}), "answered", "max_rate", "3", **_EACH, leave_out=("3",)),
        line(wonders("why_user", user="3"), "answered", "max_rate", "3", **_EACH, leave_out=("3",)),
        line(wonders("step", power_w=1.0), "answered", "max_rate", "bit/s", **_EACH, leave_out=("3",)),
        line(orders("undo"), "undone", "max_rate", "1 Mbit/s", **_EACH),
        line(orders("apply"), "nothing", "max_rate", **_EACH),
        line(amends(min_rate_bps={"2": 2e6}), "applied", "max_rate", "2 Mbit/s", "1 Mbit/s", **_SOME),
        line(amends("min_power"), "applied", "min_power", "W", **_SOME),
        line(amends("min_power", min_rate_bps=5e7), "nothing", "min_power", "50 Mbit/s", **_MUCH),
        line(orders("undo"), "undone", "min_power", "2 Mbit/s", **_SOME),
        line(orders("explain", "zh"), "answered", "min_power", "子载波", **_SOME),
    )  # fmt: skip


ENGLISH = _conversation(
    "en",
    (
        "Highest total rate with at most 10 W",
        "now with 5 W",
        "and at least 1 Mbit/s for everyone",
        "leave user 3 out",
        "what if 40 % were missing?",
        "compare with the last one",
        "why did user 3 get nothing?",
        "what would one more watt buy?",
        "undo",
        "apply it",
        "user 2 needs at least 2 Mbit/s",
        "the same with the least power",
        "make that at least 50 Mbit/s for everyone",
        "undo",
        "解释一下",
    ),
)

CHINESE = _conversation(
    "zh",
    (
        "总速率最高，功率不超过10瓦",
        "现在改为5瓦",
        "每个用户至少1 Mbit/s",
        "不要用户3",
        "如果缺失40%会怎样？",
        "和上一个比较",
        "用户3为什么什么都没有？",
        "再多一瓦能换来什么？",
        "撤销",
        "应用",
        "用户2至少要2 Mbit/s",
        "条件不变，改为功率最低",
        "改为每个用户至少50 Mbit/s",
        "撤销",
        "解释一下",
    ),
)
