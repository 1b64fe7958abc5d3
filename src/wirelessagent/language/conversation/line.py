"""One line of a conversation as its shape: "@" for the users it names, "#" for its figures, the words as they are.

``User 2's rate: 1 Mbit/s`` has the shape ``@'s rate: #``, so that one pattern reads every user and every figure. What a
shape says is told by forms, as data by language (``talk_forms/<language>.toml``): one that has Chinese in it by the
Chinese ones, every other by those of the European languages, of which only English has all.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from wirelessagent.language.base_words import language_in_a_talk
from wirelessagent.language.deferred import deferred
from wirelessagent.language.guard import READ_IN_A_TALK
from wirelessagent.language.intent import Constraint, Detail, Intent, IntentKind
from wirelessagent.language.mentions import mentions
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.recogniser import Context
from wirelessagent.language.replies import Voice
from wirelessagent.language.sentence import Sentence, labels_of, own_words, read_once
from wirelessagent.language.text import has_chinese, normalise, replaced
from wirelessagent.language.word_tables import table, written

NAME = READ_IN_A_TALK
_ASKED = deferred(r"[?？]\s*$|[呢吗]\s*[?？]?\s*$")
_POLITE = deferred(
    r"^(?:(?:(?:ok(?:ay)?|please|hey|well|then|so|now|and|(?:could|can|would|will) you|let's|let us)\b|请|"
    r"麻烦(?:你|您)?|帮我|那就?)[,，\s]*)+(?=\S)|[,，\s]*(?:please|thanks|thank you|谢谢|吧|了吧)?[\s.!。！~]*$"
)


@functools.cache
def form(name: str, language: str) -> tuple[re.Pattern[str], ...]:
    """The patterns of a form; none where a language has no such form."""
    patterns = table("talk_forms", language).get("forms", {}).get(name, ())
    return tuple(re.compile(written("talk_forms", language, pattern)) for pattern in patterns)


def is_all(name: str, said: str) -> re.Match[str] | None:
    """The match of a form that is all that is said."""
    found = (pattern.fullmatch(said) for pattern in _forms(name, said))
    return next((match for match in found if match is not None), None)


def begins(name: str, said: str) -> re.Match[str] | None:
    """The match of a form that what is said begins with."""
    found = (pattern.match(said) for pattern in _forms(name, said))
    return next((match for match in found if match is not None), None)


def has(name: str, said: str) -> re.Match[str] | None:
    """The first match of a form in what is said.

    >>> has("promise", "what can we promise?") is None, has("promise", "10 W") is None
    (False, True)
    """
    found = (pattern.search(said) for pattern in _forms(name, said))
    return next((match for match in found if match is not None), None)


def _forms(name: str, said: str) -> Iterator[re.Pattern[str]]:
    for language in ("zh",) if has_chinese(said) else ("en", "de", "es", "fr"):
        yield from form(name, language)


def group(match: re.Match[str], *names: str) -> str:
    """What the first of these groups, or of all, that took part holds; "" where none did."""
    groups = match.groupdict()
    return next((groups[name] for name in names or groups if groups.get(name)), "")


@dataclass(frozen=True, kw_only=True)
class Line:
    """What was said, and where in the conversation.

    Attributes:
        text: what was said.
        shape: the same in lower case with "@" for named users and "#" for rates and powers.
        wish: the shape without the words of politeness around it.
        said: the wish without the stop or the question mark at its end.
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
        plain = normalise(text)
        figures = tuple(figure for figure in parse_quantities(text) if figure.kind in ("rate", "power"))
        spans = [(figure.start, figure.end, "#") for figure in figures]
        taken = [(start, end) for start, end, _ in spans]
        named = [each for each in mentions(plain, context.user_names, taken) if each.role == "named"]
        spans += [(each.start, each.end, "@") for each in named]
        shape = " ".join(replaced(plain, sorted(spans)).lower().split())
        language = language_in_a_talk(text, context.language)
        users = tuple(dict.fromkeys(user for each in named for user in each.users))
        return cls(
            text=text, shape=shape, wish=_POLITE.sub("", shape), users=users, figures=figures, context=context,
            voice=Voice(language, labels_of(own_words(), language)),
        )  # fmt: skip

    @property
    def said(self) -> str:
        return self.wish.rstrip("?.。! ")

    @property
    def is_asked(self) -> bool:
        return _ASKED.search(self.text) is not None

    @property
    def sentence(self) -> Sentence:
        """The line as those who read sentences see it."""
        return read_once(self.text, own_words(), self.context)

    def allocate(self, objective: str, constraints: Mapping[str, Constraint], *, amends: bool, **fields: Any) -> Intent:
        """A request, or a change of the one that holds."""
        dropped = fields.get("dropped", ())
        reply = self.voice.amended(constraints, dropped) if amends else self.voice.restated(objective, constraints, ())
        given = {"reply": reply, "evidence": dict.fromkeys(constraints, self.text.strip()), **fields}
        return self._intent("allocate", objective=objective, constraints=constraints, amends=amends, **given)

    def command(self, topic: str, **details: Detail) -> Intent:
        return self._intent("command", reply=self.voice.say(f"command.{topic}"), topic=topic, details=details)

    def question(self, topic: str, **details: Detail) -> Intent:
        said = self.voice.say(f"question.{topic}", user=self.voice.user(str(details.get("user", ""))))
        return self._intent("question", reply=said, topic=topic, details=details)

    def courtesy(self, key: str, /, **names: str) -> Intent:
        """Words that ask for nothing, answered in kind."""
        return self._intent("out_of_scope", reply=self.voice.say(key, **names))

    def ask(self, key: str, pending: Mapping[str, Constraint] | None = None, /, **names: str) -> Intent:
        """A question back, whose answer may use what is pending."""
        return self._intent("clarify", reply=self.voice.say(key, **names), pending=pending or {}, asks=key)

    def ask_whether(self, topic: str) -> Intent:
        """The question of yes or no whether a command was meant."""
        said = self.voice.say("unsure_command", text=self.voice.say(f"command.{topic}"))
        return self._intent("clarify", reply=said, offered=topic, asks="unsure_command")

    def _intent(self, kind: IntentKind, **fields: Any) -> Intent:
        given: dict[str, Any] = {"objective": None, "constraints": {}, "evidence": {}, **fields}
        return Intent(kind=kind, language=self.voice.language, confidence=1.0, recogniser=NAME, **given)
