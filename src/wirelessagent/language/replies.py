"""What the operator reads of what was understood: restatements with figures and units, and specific questions."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from wirelessagent.language.intent import CONSTRAINTS, EVERYBODY, Constraint, Detail, Intent, IntentKind
from wirelessagent.model.units import prefixed, reliability
from wirelessagent.telling.catalogue import capital, goal_named, in_a_row, listed, message

_ROUNDING = 1e-9


class Voice:
    """Replies in one language, about the objectives that are on offer.

    Attributes:
        language: the operator's.
        labels: what each registered objective is called, in the order in which they are offered.
    """

    def __init__(self, language: str, labels: Mapping[str, str]) -> None:
        self.language, self.labels = language, labels

    def say(self, key: str, **places: str) -> str:
        """The reply of this key with its places filled in; {choices} and {offers} list what is on offer."""
        offers = message(self.language, "reply.offers", choices=self.choices("either"))
        given = {
            "choices": self.choices(),
            "offers": offers,
            "help": message(self.language, "reply.help", offers=offers),
        }
        return message(self.language, f"reply.{key}", **(given | places))

    def choices(self, last: str = "or", *, without: str = "") -> str:
        """The objectives on offer, "a, b or c"."""
        return self.both([name for name in self.labels if name != without], last)

    def label(self, objective: str) -> str:
        """What an objective is called."""
        return goal_named(objective, self.labels.get(objective, objective), self.language)

    def both(self, objectives: Sequence[str], last: str = "and") -> str:
        """Several objectives in one list."""
        return in_a_row(self.language, [self.label(name) for name in objectives], last)

    def constraints(self, values: Mapping[str, Constraint]) -> str:
        """The constraints with figures and units, "at least 1 Mbit/s for each user, at most 10 W …"."""
        return limits_in_words(values, self.language)

    def users(self, references: Sequence[str]) -> str:
        """Users in one list: "user 3" for "3", "everyone else" for everybody who is not named."""
        return users_in_words(references, self.language)

    def amended(self, values: Mapping[str, Constraint], dropped: Sequence[str]) -> str:
        """What changes in the current request, as one sentence; "" where no figure of it is known yet."""
        gone = [message(self.language, f"dropped.{name}") for name in dropped if name not in values]
        parts = [self.constraints(values)] if values else []
        if gone:
            parts.append(self.say("taken_off", text=in_a_row(self.language, gone)))
        return self._sentence([capital(parts[0]), *parts[1:]]) if parts else ""

    def changed(
        self, aims: Sequence[str], values: Mapping[str, Constraint], dropped: Sequence[str],
        lost: Mapping[str, Constraint],
    ) -> str:  # fmt: skip
        """What becomes of a request, as one sentence: another aim, limits, and those that hold no longer."""
        gone = message(self.language, "request.no_longer", limits=self.constraints(lost)) if lost else ""
        parts = [*aims, self.amended(values, dropped), gone]
        return self._sentence([f"{part[:1].lower()}{part[1:]}".rstrip(" .。") for part in parts if part])

    def restated(self, objective: str, values: Mapping[str, Constraint], not_used: Sequence[str]) -> str:
        """What was understood, as one sentence."""
        sentence = aimed("request.understood", self.label(objective), self.constraints(values), self.language)
        return sentence + (self.say("not_used", text=in_a_row(self.language, not_used)) if not_used else "")

    def _sentence(self, parts: Sequence[str]) -> str:
        return message(self.language, "text.sentence", line=message(self.language, "text.comma").join(parts))


class Answer:
    """Intents of one recogniser in one operator's language."""

    def __init__(self, voice: Voice, recogniser: str) -> None:
        self.voice, self.recogniser = voice, recogniser

    def ask(
        self, key: str, confidence: float = 0.5, pending: Mapping[str, Constraint] | None = None,
        offered: str | None = None, **names: str,
    ) -> Intent:  # fmt: skip
        """A question back: ``pending`` was understood already, ``offered`` is what a plain yes means."""
        reply = self.voice.say(key, **names)
        return self.intent("clarify", confidence, reply, pending=pending or {}, offered=offered, asks=key)

    def command(self, topic: str, confidence: float = 1.0, /, **details: Detail) -> Intent:
        """A command of a topic."""
        return self.intent("command", confidence, self.voice.say(f"command.{topic}"), topic=topic, details=details)

    def question(self, topic: str, confidence: float = 1.0, /, **details: Detail) -> Intent:
        """A question of a topic."""
        reply = self.voice.say(f"question.{topic}", user=self.voice.users((str(details.get("user", "")),)))
        return self.intent("question", confidence, reply, topic=topic, details=details)

    def out_of_scope(self, key: str, confidence: float = 1.0, /, **names: str) -> Intent:
        """What asks for nothing that can be done, with the sentence of a key."""
        return self.intent("out_of_scope", confidence, self.voice.say(key, **names))

    def allocate(
        self, objective: str, values: Mapping[str, Constraint], evidence: Mapping[str, str], reply: str,
        confidence: float,
    ) -> Intent:  # fmt: skip
        """A request: an objective with constraints, and the words that each came from."""
        ordered = {name: values[name] for name in CONSTRAINTS if name in values}
        kept = {name: words for name, words in evidence.items() if name not in CONSTRAINTS or name in ordered}
        return self.intent("allocate", confidence, reply, objective=objective, constraints=ordered, evidence=kept)

    def intent(self, kind: IntentKind, confidence: float, reply: str, **fields: Any) -> Intent:
        """An intent with a reply, and with nothing stated but in its ``fields``."""
        given: dict[str, Any] = {"objective": None, "constraints": {}, "evidence": {}, **fields}
        return Intent(
            kind=kind, language=self.voice.language, confidence=confidence, reply=reply, recogniser=self.recogniser,
            **given,
        )  # fmt: skip


def aimed(key: str, goal: str, limits: str, language: str) -> str:
    """An aim with its limits in one sentence, that of a key, or of an aim without limits."""
    return message(language, key if limits else "request.aim_alone", goal=capital(goal), limits=limits)


def limits_in_words(limits: Mapping[str, Constraint], language: str) -> str:
    """Limits with their figures, the same figures for several users together.

    >>> limits_in_words({"min_rate_bps": {"all": 1e6, "2": 3e6, "4": 3e6}, "leave_out": ("3",)}, "en")
    'at least 3 Mbit/s for user 2 and user 4, at least 1 Mbit/s for everyone else, without user 3'
    >>> limits_in_words({"min_rate_bps": {"all": 1e6, "3": 0.0}}, "en")
    'at least 1 Mbit/s for each user but user 3'
    """
    return message(language, "text.between").join(
        part for name, value in limits.items() for part in _limit(language, name, value)
    )


def users_in_words(references: Sequence[str], language: str) -> str:
    """Users in a row, "3" as "user 3"; EVERYBODY is everyone who is not named.

    >>> users_in_words(("3", "anna", "all"), "en"), users_in_words(("user 3",), "zh")
    ('user 3, anna and everyone else', '用户3')
    >>> users_in_words(("1", "user 3", "4"), "en")
    'users 1, 3 and 4'
    """
    everybody_else = message(language, "whom.everybody_else")
    names = (everybody_else if reference == EVERYBODY else reference for reference in references)
    return listed(language, (f"user {name}" if name.isdecimal() else name for name in names))


def _limit(language: str, name: str, value: Constraint) -> list[str]:
    if isinstance(value, tuple):
        return [message(language, f"holds.{name}", who=users_in_words(value, language))]
    by_user = value if isinstance(value, Mapping) else {EVERYBODY: value}
    exempt = [user for user, figure in by_user.items() if figure == 0 and name == "min_rate_bps"]
    promised = {user: figure for user, figure in by_user.items() if figure > 0 or not exempt}
    said: list[str] = [
        message(language, f"holds.{name}", figure=figure_in_words(name, figure), who=who)
        for figure, who in _by_figure(language, promised, exempt)
    ]
    if EVERYBODY in promised or not exempt:
        return said
    return [*said, message(language, "whom.no_promise", who=users_in_words(exempt, language))]


def _by_figure(language: str, by_user: Mapping[str, float], exempt: list[str]) -> list[tuple[float, str]]:
    """(figure, who gets it), the same figures together and those who are not named last, but for the exempt."""
    named: dict[float, list[str]] = {}
    for user, figure in by_user.items():
        if figure != by_user.get(EVERYBODY):
            named.setdefault(figure, []).append(user)
    said = [(figure, users_in_words(users, language)) for figure, users in named.items()]
    if EVERYBODY in by_user:
        others = message(language, "whom.everybody_else" if named else "whom.everybody")
        if exempt:
            others = message(language, "whom.but", who=others, users=users_in_words(exempt, language))
        said.append((by_user[EVERYBODY], others))
    return said


def figure_in_words(name: str, value: float) -> str:
    """A figure as the operator may check it: four digits, an SI prefix, and dBm where those are rounder.

    >>> figure_in_words("max_power_w", 10**0.3), figure_in_words("min_rate_bps", 1.5e6)
    ('33 dBm (1.995 W)', '1.5 Mbit/s')
    """
    if name == "outage_probability":
        return reliability(value)
    if name in ("weights", "resource_block_group_size"):
        return f"{value:g}"
    scale, unit = prefixed(value, "bit/s" if name.endswith("bps") else "W")
    said = f"{value / scale:.4g} {unit}"
    if name.endswith("bps") or abs(float(f"{value:.4g}") - value) <= _ROUNDING * value:
        return said
    dbm = 10 * math.log10(value) + 30
    return f"{round(dbm, 1):g} dBm ({said})" if abs(dbm - round(dbm, 1)) <= _ROUNDING else said
