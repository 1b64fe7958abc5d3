"""Short lines of a talk in words that no form knows: "quatsch, 2 mein ich", "7 + 8 are visitors. skip".

What such a line does to what was said before, a small linear model judges (trained by
:mod:`wirelessagent.language.training.talk`) from its words, their classes, and where its figures and users stand; what
it does it to, and by how much, is read by the readers of lines whose words are all known.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from wirelessagent.language.acts import Drop, LeaveOut, Limit, Named, Others, Scale, Serve, Suppose
from wirelessagent.language.conversation.corrections import moved, swapped
from wirelessagent.language.conversation.figure_in_place import holding, read_figure
from wirelessagent.language.conversation.fragments import taken_up
from wirelessagent.language.conversation.limits_off import dropped, exempted, restored
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.conversation.relative import read_relative
from wirelessagent.language.conversation.tokens import NOUNS, ONES, UNITS, Token, Words, tokens_of
from wirelessagent.language.conversation.who_is_served import all_served, of_whom, served
from wirelessagent.language.intent import Intent
from wirelessagent.language.linear_model import TALK_FILE, shipped_model
from wirelessagent.language.numerals import numbers
from wirelessagent.language.order_model import frame_of, shipped_order_model
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.text import language_in_a_talk, normalise

NONE = "none"
LEANS = ("exempt", "figure", "less", "more", "swap", "too", "user")
"""Labels of what no sentence of its own does."""

LIKELY, SURE = 0.6, 0.85
"""How likely a line has to do something, among what it may do here: where a recogniser of sentences would ask, and
before one is asked."""

_UNLIKELY = 0.25
"""How likely its frame is one of an order, below which a line has to do something surely."""

_LONGEST, _MOST_STEPS = 80, 10


class Leaning:
    """A line and how likely it does what; judged once, where anything asks."""

    def __init__(self, line: Line) -> None:
        self._line = line
        self._language = language_in_a_talk(line.text, line.context.language)

    def read(self, needed: float, among: Sequence[str] = ()) -> Intent | None:
        """What a short line does, ``among`` some labels or all; None where none of them is so likely as needed.

        A label that the talk does not bear out, such as another user where none was named, is left out of account.
        """
        if not self._tokens:
            return None
        labels = {*(among or _READERS)}
        if not any("unknown" in token.classes for token in self._tokens):
            labels -= {"undo"}  # which has a closed grammar of its own
        left = 1.0
        for label in sorted(self._likely, key=lambda label: -self._likely[label]):
            enough = (needed if self._is_order and label != "undo" else SURE) * left
            if label not in labels or self._likely[label] < enough:
                return None
            intent = _read(label, self._line, self._tokens, self._language)
            if intent is not None and intent.kind in ("allocate", "command"):
                return intent
            left -= self._likely[label]
        return None

    def exempts(self) -> Intent | None:
        """ "User 4 doesn't need it", behind what everybody is promised: served without it, and not left out."""
        last = [act for act in self._line.context.acts if isinstance(act, Limit) and act.kind in UNITS["rate"]]
        return self.read(LIKELY, ["exempt"]) if any(not isinstance(act.whom, Named) for act in last) else None

    @functools.cached_property
    def _tokens(self) -> Sequence[Token]:
        """The words of a short line that may lean on the talk; none of any other."""
        line, context = self._line, self._line.context
        alone = context.objective is None or context.awaits != "nothing"
        if alone or len(line.text) > _LONGEST or line.is_asked:
            return ()
        tokens = tokens_of(line, self._language, lenient=True) or ()
        return () if any("denial" in token.classes for token in tokens) else tokens

    @functools.cached_property
    def _likely(self) -> Mapping[str, float]:
        return shipped_model(TALK_FILE).probabilities(*seen(self._line, self._tokens, self._language))

    @functools.cached_property
    def _is_order(self) -> bool:
        return shipped_order_model().probability(frame_of(self._line.sentence)) >= _UNLIKELY


def _read(label: str, line: Line, tokens: Sequence[Token], language: str) -> Intent | None:
    """What a line with a label does."""
    classes, read = _READERS[label]
    if label == "user" or not any(token.users for token in tokens):
        tokens = _with_users(tokens, len(line.context.user_names), alone=label in _OF_USERS)
    tokens = [replace(token, classes=token.classes | {"skip"}) for token in tokens]  # each was judged
    words = Words(line, [*tokens, Token(frozenset({*classes.split(), "skip"}))], language)
    words.is_unsure = False
    return read(words)


def _with_users(tokens: Sequence[Token], num_users: int, *, alone: bool) -> list[Token]:
    """The tokens with bare numbers as users, where they stand ``alone`` or beside a figure with a unit, or a share."""
    counted = any(token.classes & {"figure", "ratio", "factor"} for token in tokens)
    return [
        Token(frozenset({"users"}), users=(f"{token.figure.value:g}",))
        if (alone or counted) and token.figure and token.figure.kind == "bare"
        and token.figure.value in range(1, num_users + 1)
        else token
        for token in tokens
    ]  # fmt: skip


def seen(line: Line, tokens: Sequence[Token], language: str) -> tuple[str, list[str], str]:
    """A line as the model sees it: the words with placeholders, their classes in order, and the language."""
    text, *_ = line.sentence.for_model()
    return text, ["+".join(sorted(token.classes)) for token in tokens if token.classes - {"skip"}], language


def _undone(words: Words) -> Intent:
    """The last change taken back, or as many as a line says."""
    found = [number.value for number in numbers(normalise(words.line.text), words.language)]
    counts = [float(value) for value in found if value is not None and 1 < value < _MOST_STEPS]
    return words.line.command("undo", steps=2.0 if words.has("both") else next(iter(counts), 1.0))


def _figure(words: Words) -> Intent | None:
    """Another figure, another weight ("hmm, triple rather"), or the same figure in another unit ("kilobits, sorry")."""
    words.tokens = [replace(token, classes=token.classes - {"by", "instead"}) for token in words.tokens]
    last, factors = words.last(Limit), [token.factor for token in words.tokens if token.factor]
    if words.figures and not last and not words.users and not words.last(Suppose):  # "he needs 500", behind "5 is back"
        words.users = next((act.whom.users for act in words.last(Serve, Drop) if isinstance(act.whom, Named)), ())
    if words.figures or not last:
        return read_figure(words)
    kind = last[-1].kind
    if len(factors) == 1 and kind == "weights":
        whom = Named(words.users) if words.users else last[-1].whom
        return words.acts([Limit(kind=kind, value=factors[0], whom=whom)])
    number = next(iter(re.findall(r"\d[\d.,]*", last[-1].words)), "")
    meant = {
        figure.value
        for word in words.line.text.split() if number
        for figure in parse_quantities(f"{number} {word.strip(',.!')}") if kind in UNITS.get(figure.kind, ())
    }  # fmt: skip
    return words.acts([replace(act, value=meant.pop()) for act in last]) if len(meant) == 1 else None


def _by(words: Words) -> Intent | None:
    """An amount or a share more or less; "one less" is one of what was said last, "4 down to 1 Mbit/s" is a figure."""
    if words.has("to", "moves", "up_to"):
        return _figure(words)
    if not any(token.classes & {"more", "less", "unknown"} for token in words.tokens[:-1]):
        return None  # "14 W"
    of = [limit for figure in words.figures if figure.kind == "bare" for limit in holding(words, figure)]
    if of and len(words.figures) > 1:  # "raise the 350 by 10 %"
        words.figures = [figure for figure in words.figures if figure.kind != "bare"]
        words.tokens = [*words.tokens, Token(frozenset({"others", "skip"}))] if of[0].whom == Others() else words.tokens
    elif not words.figures and not any(token.factor for token in words.tokens):
        said = normalise(words.line.text.lower())
        if not ONES & {*re.findall(r"\w+", said)}:
            return None
        words.figures = [Quantity(value=1.0, kind="bare", text="1", start=0, end=0, phrase_start=0, phrase_end=0)]
        words.tokens = [Token(frozenset({"bare", "skip"}), figure=words.figures[0]), *words.tokens]
    whose, last = _of_users_last(words), {act.kind for act in words.last(Limit, Scale)}
    fitting = {kind for figure in words.figures for kind in UNITS.get(figure.kind, last)} or last
    if not words.users and whose and not last & fitting and not words.has("others", "every"):
        words.users = whose[0].whom.users
    return read_relative(words)


def _of_users_last(words: Words) -> Sequence[Any]:
    """What was said of users by name, the last time that anything was."""
    for acts in (words.line.context.acts, *words.line.context.earlier[::-1]):
        for kinds in (Limit, (Scale, LeaveOut, Serve, Drop)):
            said = [act for act in acts if isinstance(act, kinds) and isinstance(act.whom, Named)]
            if said:
                return said
    return ()


def _taken(words: Words) -> Intent | None:
    """What was supposed is asked for, with the figure that is said where there is one."""
    return read_figure(words) if words.figures else taken_up(words)


def _another(words: Words) -> Intent | None:
    """Another user, where users were named."""
    return moved(words) if _of_users_last(words) and not _is_common(words) else None


def _is_common(words: Words) -> bool:
    """Whether what was said last is for everybody."""
    last = words.last(Limit, Scale)
    return bool(last) and not any(isinstance(act.whom, Named) for act in last)


def _too(words: Words) -> Intent | None:
    """The same of further users."""
    users, last = of_whom(words), _of_users_last(words)
    again = [replace(act, whom=Named(users)) for act in last if users]
    again = [replace(act, alone=False) if isinstance(act, Serve) else act for act in again]
    return words.acts(again[:1]) if len(set(again)) == 1 else None


def _back(words: Words) -> Intent | None:
    """Users who are served again, or whose weight is what it was: "user 3 back to his normal weight"."""
    if words.has("weight") and words.users:
        return words.acts([Drop(kind="weights", whom=Named(words.users), own=True)])
    return served(words)


def _out(words: Words) -> Intent | None:
    """Users who are not served any more."""
    users = of_whom(words)
    return words.acts([LeaveOut(whom=Named(users))]) if users else None


def _removed(words: Words) -> Intent | None:
    """A limit that goes: one that is named, else the last one."""
    if words.has(*NOUNS):
        return dropped(words)
    last, users = {act.kind for act in words.last(Limit, Scale)}, of_whom(words)
    if len(last) != 1:
        return None
    return exempted(words) if users else words.acts([Drop(kind=last.pop())])


_READERS: Mapping[str, tuple[str, Callable[[Words], Intent | None]]] = {
    "figure": ("make take", _figure),
    "user": ("whose correct", _another),
    "too": ("too", _too),
    "out": ("leave", _out),
    "back": ("serve", _back),
    "everyone": ("every serve", all_served),
    "exempt": ("except", exempted),
    "more": ("more by", _by),
    "less": ("less by", _by),
    "remove": ("remove", _removed),
    "restore": ("restore", restored),
    "swap": ("swap", swapped),
    "undo": ("undo", _undone),
    "take": ("take", _taken),
}
"""By label: the classes that the line has by it, and who reads the rest."""

_OF_USERS = ("user", "too", "out", "back", "exempt", "remove", "swap")
"""Labels by which a number is a user's."""
