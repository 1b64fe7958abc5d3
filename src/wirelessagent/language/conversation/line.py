"""One line of a conversation as its shape: "@" for the users it names, "#" for its figures, the words as they are.

``User 2's rate: 1 Mbit/s`` has the shape ``@'s rate: #``, so that one pattern reads every user and every figure. What a
shape says is told by forms, as data by language (``talk_forms/<language>.toml``): one that has Chinese in it by the
Chinese ones, every other by those of the European languages, of which only English has all.

Users go by what operators call them as well: once "user 3 is the ambulance" was said, "the ambulance" is user 3, for
the rest of the talk or until somebody else is called so. Only what is said with an article, or in Chinese with no more
than a few signs, names somebody: "user 3 is slow" does not (``[nicknames]``).
"""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from wirelessagent.language.conversation.anchors import Anchored
from wirelessagent.language.guard import READ_IN_A_TALK
from wirelessagent.language.intent import Constraint, Detail, Intent
from wirelessagent.language.mentions import mentions
from wirelessagent.language.moods import without
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.recogniser import Context
from wirelessagent.language.replies import Answer, Voice
from wirelessagent.language.sentence import Sentence, beside_the_same, labels_of, own_words, read_once
from wirelessagent.language.text import Span, has_chinese, normalise, overlaps, replaced
from wirelessagent.language.vocabulary import language_in_a_talk, language_of, languages_of
from wirelessagent.language.word_tables import deferred, languages_with, table, words_of, written

Forms: TypeAlias = Mapping[str, tuple[str, Mapping[str, Detail]]]
"""What lines ask or order by their forms: a topic, and its details."""
NAME = READ_IN_A_TALK
_ASKED = deferred(r"[?？]\s*$|[呢吗]\s*[?？]?\s*$")
_AHEAD, _BEHIND = ("|".join(words_of("talk_forms", "sentences", name)) for name in ("polite_ahead", "polite_behind"))
_POLITE = deferred(rf"^(?:(?:{_AHEAD})(?:(?<![a-z])|\b)[,，\s]*)+(?=\S)|[,，\s]*(?:{_BEHIND})?[\s.!。！~]*$")
_SPACED = sorted((each for each in languages_with("talk_forms") if each != "zh"), key=lambda each: each != "en")
"""The languages with blanks between their words; English, which has all forms, goes first."""


@functools.cache
def form(name: str, language: str) -> tuple[re.Pattern[str], ...]:
    """The patterns of a form; none where a language has no such form."""
    patterns = table("talk_forms", language).get("forms", {}).get(name, ())
    return tuple(re.compile(written("talk_forms", language, pattern)) for pattern in patterns)


def is_all(name: str, said: str) -> re.Match[str] | None:
    """The match of a form that is all that is said."""
    return _found(name, said, re.Pattern[str].fullmatch)


def begins(name: str, said: str) -> re.Match[str] | None:
    """The match of a form that what is said begins with."""
    return _found(name, said, re.Pattern[str].match)


def has(name: str, said: str) -> re.Match[str] | None:
    """The first match of a form in what is said.

    >>> has("promise", "what can we promise?") is None, has("promise", "10 W") is None
    (False, True)
    """
    return _found(name, said, re.Pattern[str].search)


def _found(name: str, said: str, how: Callable[[re.Pattern[str], str], re.Match[str] | None]) -> re.Match[str] | None:
    languages = ("zh",) if has_chinese(said) else _SPACED
    found = (how(pattern, said) for language in languages for pattern in form(name, language))
    return next((match for match in found if match is not None), None)


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
        text = beside_the_same(text, context)
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

    @functools.cached_property
    def anchored(self) -> Anchored:
        """The line as its figures and its users with the words between."""
        return Anchored.of(self.text, self.voice.language, self.context.user_names)

    @property
    def sentence(self) -> Sentence:
        """The line as those who read sentences see it."""
        return read_once(self.text, own_words(), self.context)

    def allocate(self, objective: str, constraints: Mapping[str, Constraint], *, amends: bool, **fields: Any) -> Intent:
        """A request, or a change of the one that holds."""
        dropped = fields.get("dropped", ())
        reply = self.voice.amended(constraints, dropped) if amends else self.voice.restated(objective, constraints, ())
        given: dict[str, Any] = {"reply": reply, "evidence": dict.fromkeys(constraints, self.text.strip()), **fields}
        return self.answer.intent("allocate", 1.0, objective=objective, constraints=constraints, amends=amends, **given)

    @property
    def answer(self) -> Answer:
        """Intents of the conversation."""
        return Answer(self.voice, NAME)


def _nicknames(language: str) -> Mapping[str, Any]:
    return table("talk_forms", language)["nicknames"]


def called(texts: Sequence[str]) -> Mapping[str, str]:
    """The numbers of users by what lines of a talk call them, the later ones holding.

    >>> called(["User 3 is the ambulance, just so you know", "users 1 and 2 are the slow ones"])
    {'ambulance': '3'}
    """
    return {name: number for text in texts for _, name, number in _given(normalise(text))}


def with_users(text: str, names: Mapping[str, str]) -> str:
    """A line with users in the places of what they are called; the place where a name is given keeps it.

    >>> with_users("the ambulance needs 2 Mbit/s", {"ambulance": "3"})
    'user 3 needs 2 Mbit/s'
    """
    plain, language = normalise(text), language_of(text)
    given, words = _given(plain), _nicknames(language)
    known = {**names, **called([text])}
    spans = [
        (*match.span(), words["before"].get((match["before"] or "").lower(), words["user"]) + number)
        for name, number in known.items()
        if name in plain.lower()
        for match in _called(name, language).finditer(plain)
        if not overlaps(match.span(), (span for span, *_ in given))
    ]
    return replaced(text, sorted(spans))


def only_called(text: str) -> Mapping[str, str]:
    """What a line calls users, where it says nothing else.

    >>> only_called("user 3 is the ambulance, just so you know"), only_called("user 3 is the ambulance: 2 Mbit/s")
    ({'ambulance': '3'}, {})
    """
    plain = normalise(text)
    given = _given(plain)
    rest = "".join(" " if any(a <= at < b for (a, b), *_ in given) else sign for at, sign in enumerate(plain))
    for language in languages_of(text) if given else ():
        rest = without(_nicknames(language)["aside"], rest)
    return {} if any(map(str.isalnum, rest)) else called([text])


@functools.lru_cache(maxsize=256)
def _given(plain: str) -> tuple[tuple[Span, str, str], ...]:
    """Where a name is given, the name, and the number of the user who gets it; each line of a talk is asked often."""
    return tuple(
        (match.span(), name, str(int(match["user"])))
        for language in languages_of(plain)
        for pattern in _patterns(language)
        for match in pattern.finditer(plain)
        if plain[match.end() :].lstrip()[:1] not in ("?", "？")
        and _names_somebody(name := match["name"].lower().strip(), language)
    )


def _names_somebody(name: str, language: str) -> bool:
    """Whether words are no words of a request or of talking: "the slowest", "the others", "the one" name nobody."""
    never = set(_nicknames(language)["never"].split())
    return not (never.intersection((name, *name.split())) or Sentence(name, own_words()).concepts or mentions(name))


@functools.cache
def _patterns(language: str) -> tuple[re.Pattern[str], ...]:
    given = (written("talk_forms", language, pattern) for pattern in _nicknames(language)["given"])
    return tuple(re.compile(pattern, re.IGNORECASE) for pattern in given)


@functools.lru_cache(maxsize=256)
def _called(name: str, language: str) -> re.Pattern[str]:
    """A name with the words before it that belong to it, in any case of its language."""
    words = _nicknames(language)
    leading: Mapping[str, str] = words["before"]
    before = "|".join(sorted(map(re.escape, leading), key=len, reverse=True))
    said = rf"(?P<before>(?:{before}))?{re.escape(name)}"
    whole = said if language == "zh" else rf"(?<![^\W_]){said}(?:{words['endings']})?(?![^\W_])"
    return re.compile(whole, re.IGNORECASE)
