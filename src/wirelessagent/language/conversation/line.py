"""One line of a conversation as its shape: "@" for the users it names, "#" for its figures, the words as they are.

``User 2's rate: 1 Mbit/s`` has the shape ``@'s rate: #``, so that one pattern reads every user and every figure.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from wirelessagent.language.deferred import deferred
from wirelessagent.language.guard import READ_IN_A_TALK
from wirelessagent.language.intent import Constraint, Detail, Intent, IntentKind
from wirelessagent.language.mentions import mentions
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.recogniser import Context
from wirelessagent.language.replies import Voice
from wirelessagent.language.sentence import labels_of, own_words
from wirelessagent.language.text import language_of, normalise

NAME = READ_IN_A_TALK
_WORD = deferred(r"[^\W\d_]{3,}")
_POLITE = deferred(
    r"^(?:(?:(?:ok(?:ay)?|please|hey|well|then|so|now|and|(?:could|can|would|will) you|let's|let us)\b|请|"
    r"麻烦(?:你|您)?|帮我|那就?)[,，\s]*)+(?=\S)|[,，\s]*(?:please|thanks|thank you|谢谢|吧|了吧)?[\s.!。！~]*$"
)


@dataclass(frozen=True, kw_only=True)
class Line:
    """What was said, and where in the conversation.

    Attributes:
        text: what was said.
        shape: the same in lower case with "@" for named users and "#" for rates and powers.
        wish: the shape without the words of politeness around it.
        users: the references of the users named, in their order.
        figures: the rates and powers, in their order.
        context: what the line may refer to.
        voice: replies in the operator's language.
    """

    text: str
    shape: str
    wish: str
    users: tuple[str, ...]
    figures: tuple[Quantity, ...]
    context: Context
    voice: Voice

    @classmethod
    def of(cls, text: str, context: Context) -> Line:
        """The line with its shape."""
        plain, language = normalise(text), language_of(text)
        figures = tuple(figure for figure in parse_quantities(text) if figure.kind in ("rate", "power"))
        spans = [(figure.start, figure.end, "#") for figure in figures]
        taken = [(start, end) for start, end, _ in spans]
        named = [each for each in mentions(plain, context.user_names, taken) if each.role == "named"]
        spans += [(each.start, each.end, "@") for each in named]
        shape = " ".join(_replaced(plain, sorted(spans)).lower().split())
        if context.language and language == "en" and not _WORD.search(shape):
            language = context.language
        users = tuple(dict.fromkeys(user for each in named for user in each.users))
        return cls(
            text=text, shape=shape, wish=_POLITE.sub("", shape), users=users, figures=figures, context=context,
            voice=Voice(language, labels_of(own_words(), language)),
        )  # fmt: skip

    def allocate(
        self, objective: str, constraints: Mapping[str, Constraint], *, amends: bool, dropped: tuple[str, ...] = (),
        taken_off: Mapping[str, Constraint] | None = None, details: Mapping[str, Detail] | None = None,
    ) -> Intent:  # fmt: skip
        """A request, or a change of the one that holds; ``taken_off`` are figures of users that no longer hold."""
        further: dict[str, Detail] = {**(details or {}), **({"taken_off": taken_off} if taken_off else {})}
        said = self.voice.amended if amends else None
        reply = said(constraints, dropped) if said else self.voice.restated(objective, constraints, ())
        evidence = {name: self.text.strip() for name in constraints}
        return self._intent(
            "allocate", reply, objective=objective, constraints=constraints, evidence=evidence, amends=amends,
            dropped=dropped, details=further,
        )  # fmt: skip

    def command(self, topic: str, **details: Detail) -> Intent:
        return self._intent("command", self.voice.say(f"command.{topic}"), topic=topic, details=details)

    def question(self, topic: str, **details: Detail) -> Intent:
        return self._intent("question", self.voice.say(f"question.{topic}"), topic=topic, details=details)

    def courtesy(self, key: str) -> Intent:
        """Words that ask for nothing, answered in kind."""
        return self._intent("out_of_scope", self.voice.say(key))

    def ask(self, key: str, pending: Mapping[str, Constraint] | None = None, /, **names: str) -> Intent:
        """A question back, whose answer may use what is pending."""
        return self._intent("clarify", self.voice.say(key, **names), pending=pending or {}, asks=key)

    def ask_whether(self, topic: str) -> Intent:
        """The question of yes or no whether a command was meant."""
        said = self.voice.say("unsure_command", text=self.voice.say(f"command.{topic}"))
        return self._intent("clarify", said, offered=topic, asks="unsure_command")

    def _intent(self, kind: IntentKind, reply: str, **fields: Any) -> Intent:
        given: dict[str, Any] = {
            "objective": None,
            "constraints": dict[str, Constraint](),
            "evidence": dict[str, str](),
            **fields,
        }
        return Intent(
            kind=kind, reply=reply, language=self.voice.language, confidence=1.0, recogniser=NAME, **given
        )  # fmt: skip


def _replaced(plain: str, spans: list[tuple[int, int, str]]) -> str:
    parts, place = list[str](), 0
    for start, end, sign in spans:
        if start >= place:
            parts += [plain[place:start], sign]
            place = end
    return "".join([*parts, plain[place:]])
