"""Closed classes of words by language, and what they say of a sentence, whatever it speaks of.

Its moods are data in ``moods/<language>.toml``. Its form is a question, a statement, a bare yes or no, or a program.
The words that lift a limit stand beside what limits are called (``[lifted]`` in ``figures/<language>.toml``).
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

from wirelessagent.language.intent import CONSTRAINTS
from wirelessagent.language.text import USER_NOUN, Span, is_within
from wirelessagent.language.vocabulary import languages_of
from wirelessagent.language.word_tables import deferred, either, table, words_of

if TYPE_CHECKING:
    from wirelessagent.language.recogniser import Context

_LETTER = r"[0-9A-Za-zÀ-ɏ]"


def table_of(language: str) -> Mapping[str, Mapping[str, Sequence[str]]]:
    """The classes of a language: words by class and by how far they reach."""
    return table("moods", language)


def places(words: Sequence[str], plain: str) -> Iterator[Span]:
    """Where any of these words stand, the longest where several begin; "*" is any ending, "#" a number.

    Only words of which a part is in the text are made patterns: a language has hundreds.

    >>> list(places(("so far", "so", "complain*"), "so far they complained"))
    [(0, 6), (12, 22)]
    """
    small, end = plain.lower(), 0
    found = [match.span() for word in words if _stem(word) in small for match in _pattern(word).finditer(plain)]
    for span in sorted(found, key=lambda span: (span[0], -span[1])):
        if span[0] >= end:
            end = span[1]
            yield span


def without(words: Sequence[str], plain: str) -> str:
    """A text without these words.

    >>> without(("the", "any"), "not the limit")
    'not  limit'
    """
    gone = list(places(words, plain))
    return "".join(sign for at, sign in enumerate(plain) if not any(start <= at < end for start, end in gone))


@functools.lru_cache(maxsize=16)
def classes_in(plain: str) -> tuple[tuple[str, Span], ...]:
    """The classes whose words stand in a text, with how far they reach, and where they stand, from left to right.

    >>> classes_in("if only it were 5 W")[0]
    ('condition:sentence', (0, 7))
    """
    small, found = plain.lower(), list[tuple[str, Span]]()
    for language in languages_of(plain):
        for name, words in _stems(language):
            able = [word for stem, word in words if stem in small]
            found += [(name, span) for span in places(able, plain)]
    return tuple(sorted(found, key=lambda each: (each[1][0], -each[1][1])))


def is_supposed(plain: str) -> bool:
    """Whether a word of a condition stands anywhere.

    >>> is_supposed("what if it were 5 W"), is_supposed("nothing above 5 W")
    (True, False)
    """
    return any(name.startswith("condition:") and name != "condition:first" for name, _ in classes_in(plain))


@functools.cache
def _stems(language: str) -> Sequence[tuple[str, Sequence[tuple[str, str]]]]:
    """A language's classes with how far they reach, and each word with the part of it that is always written so."""
    return [
        (f"{name}:{reach}", [(_stem(word), word) for word in words])
        for name, classes in table_of(language).items()
        for reach, words in classes.items()
    ]


@functools.cache
def _stem(word: str) -> str:
    """The longest part of a word that is always written so."""
    return max(re.split(r"[*# ]+", word.lower()), key=len)


@functools.cache
def _pattern(word: str) -> re.Pattern[str]:
    body = re.escape(word).replace(r"\ ", _GAP).replace(r"\*", r"\w*").replace(r"\#", r"\s?\d+\s?")
    latin = not any("\u3400" <= sign <= "\u9fff" for sign in (word[0], word[-1]))
    ahead, behind = (latin and sign.isalnum() for sign in (word[0], word[-1]))
    whole = (rf"(?<!{_LETTER})" if ahead else "") + body + (rf"(?!{_LETTER})" if behind else "")
    return re.compile(whole, re.IGNORECASE)


def _any(name: str) -> str:
    """What a sentence of any language may be said with, by a list of ``[sentences]`` in ``talk_forms``."""
    return either("talk_forms", "sentences", name)


_GAP = rf"\s+(?:(?:{_any('between')})\s+)?"
"""What may stand between words of an expression: "he'd also like"."""
_ASKS = deferred(rf"(?i)\s*[¿]?(?:(?:und|et|y) )?(?:{_any('asks')})")
_IMPERATIVE = deferred(rf"(?i)^\s*(?:\w+,? )?have\b|{_any('begs')}")
_KEEPING = deferred(rf"(?i)^\s*(?:{either('figures', 'kept', 'leads')})|{either('figures', 'kept', 'limits')}")
_ANSWERS = {topic: deferred(rf"(?i)\s*(?:{_any(topic)})\s*[.!。\uff01~]*\s*") for topic in ("confirm", "reject")}
_COMPARES = deferred(
    rf"(?i)\s*(?:please\s+|请)?(?:{'|'.join(words_of('talk_forms', 'sentences', 'compares'))})(?![A-Za-z])"
)
_CODE = deferred(  # programs, mark-up and injections are no wishes
    r"<[|/!a-zA-Z]|\{\{|\}\}|\$\(|--\s*$|\\x|__\w+__|"
    r"(?i:\b(?:select|delete|drop|insert|update)\b.*\b(?:from|table|into|set)\b.*[;*=]|;\s*commit\b|"
    r"\bdrop\s+table\b|\bbegin\b.*\bdelet|\b(?:os|"
    r"sys)\.\w+\()|"
    rf"(?i:{_any('injects')})"
)
_TAG = deferred(  # "…, will you?", "…, ¿vale?", "…，好吗？"
    rf"(?i)(?:[\s,]+(?:{_any('tags_alone')})|,\s*(?:{_any('tags')})|"
    rf"[,\uff0c]?\s*(?:{_any('particles')}))\s*[?\uff1f]\s*$"
)


def without_a_tag(text: str) -> str:
    """A text without the polite question at its end.

    >>> without_a_tag("stay below 8 W, will you?"), without_a_tag("is 8 W enough?")
    ('stay below 8 W', 'is 8 W enough?')
    """
    plain = text.replace("¿", "")
    tag = _TAG.search(plain)
    return plain[: tag.start()] if tag is not None else text


def begins_like_a_question(plain: str) -> bool:
    """Whether a sentence begins with who, what, how much or an auxiliary verb."""
    return _ASKS.match(plain) is not None


def asks_without_a_mark(plain: str) -> bool:
    """Whether a sentence is a question by its first words, with a question mark or without.

    >>> asks_without_a_mark("what's the total rate"), asks_without_a_mark("have everyone at 1 Mbit/s")
    (True, False)
    """
    return begins_like_a_question(plain) and _IMPERATIVE.search(plain) is None


def keeps_the_limits(plain: str) -> bool:
    """Whether a sentence with a wish changes the request at hand rather than replacing it."""
    return _KEEPING.search(plain) is not None


def is_a_program(text: str) -> bool:
    """Whether a text is a program, a query, mark-up, or speaks to a language model rather than of a cell."""
    return _CODE.search(text) is not None


def plain_command(plain: str) -> str:
    """The command that a sentence is as a whole ("yes", "compare …"), or ""."""
    if _COMPARES.match(plain):
        return "compare"
    return next((topic for topic, words in _ANSWERS.items() if words.fullmatch(plain)), "")


_GENERAL: Mapping[str, tuple[str, ...]] = MappingProxyType({
    "all": ("max_power_w", "min_rate_bps", "max_rate_bps", "outage_probability", "subcarrier_max_power_w"),
    "ceilings": ("max_power_w", "max_rate_bps", "subcarrier_max_power_w"),
})  # fmt: skip
"""What "the limits" and "the caps" may be."""
_TO = rf"(?:of|on|{either('figures', 'users', 'given_to')}|{either('figures', 'users', 'articles')})"
_OF_SOMEBODY = deferred(rf"(?i)\s*(?:{_TO}\s*)+{USER_NOUN}")  # "the limit of user 3", which is none of all


def dropped_in(plain: str, context: Context | None) -> tuple[tuple[str, ...], tuple[Span, ...]]:
    """The constraints that a sentence lifts, and the spans of the words that say so.

    >>> dropped_in("without the power limit", None)[0], dropped_in("forget the weights, and the power limit", None)[0]
    (('max_power_w',), ('max_power_w', 'weights'))
    """
    found, alone = lifted_in(plain), list(places(_lifted("alone"), plain))
    named = [name for name in CONSTRAINTS if name in found]
    general = [name for name in _GENERAL if name in found and not _OF_SOMEBODY.match(plain, found[name][1])]
    if alone or (general and not named):
        held = () if context is None or alone else tuple(context.constraints)
        meant = (name for name in CONSTRAINTS if name in held and any(name in _GENERAL[each] for each in general))
        named = [*meant] or ["max_power_w"]
        if len(named) > 1 and "all" not in general:  # which cap, the talk tells, where none is one of rates
            named = [name for name in named if name == "max_rate_bps"]
    return tuple(named), (*found.values(), *alone)


def may_be_lifted(kind: str, found: Iterable[str]) -> bool:
    """Whether a kind of limits may be meant by what a sentence lifts: by its name, or by a name for many."""
    return any(name in (kind, "all") or kind in _GENERAL.get(name, ()) for name in found)


def lifted_in(plain: str) -> dict[str, Span]:
    """The limits that a sentence lifts, each with the span of the words that say so.

    "all" is any limit, "ceilings" are any at most. Words that lift a limit stand ahead of its name or behind it, with
    no denial beside them; another may follow.
    """
    go, gone, denied = (list(places(words, plain)) for words in (_lifted("go"), _lifted("gone"), _denying()))
    found: dict[str, Span] = {}
    for span, name in named_in(plain):
        ahead = [each for each in go if _is_beside(plain, each, span)]
        ahead += [each for each in found.values() if _is_beside(plain, each, span, ",")]
        behind = [each for each in gone if _is_beside(plain, span, each)]
        whole = min([span, *ahead])[0], max([span, *behind])[1]
        denies = any(_is_beside(plain, each, whole) or _is_beside(plain, whole, each) for each in denied)
        if (ahead or behind) and not denies:
            found.setdefault(name, whole)
    return found


def is_denied(plain: str) -> bool:
    """Whether a word that lifts a limit is denied.

    >>> is_denied("don't drop user 2's minimum"), is_denied("drop the limit"), is_denied("no limit any more")
    (True, False, False)
    """
    lifts = [*places(_lifted("go"), plain), *places(_lifted("gone"), plain)]
    return any(_is_beside(plain, one, other) for one in places(_denying(), plain) for other in lifts)


def may_lift(name: str, plain: str) -> bool:
    """Whether a sentence names a limit, and has a word that may take it back."""
    back = (*_lifted("go"), *_lifted("gone"), *_denying())
    return any(each == name for _, each in named_in(plain)) and any(places(back, plain))


def named_in(plain: str) -> list[tuple[Span, str]]:
    """Where a sentence names a limit, and which; a name within a longer one is none."""
    named = [(span, name) for name in (*CONSTRAINTS, *_GENERAL) for span in places(_lifted(name), plain)]
    longer = [other for other, _ in named]
    return [
        each for each in sorted(named) if not any(each[0] != other and is_within(each[0], other) for other in longer)
    ]


def _lifted(name: str) -> tuple[str, ...]:
    return words_of("figures", "lifted", name)


def _denying() -> tuple[str, ...]:
    return words_of("moods", "negation", "clause")


def _is_beside(plain: str, first: Span, then: Span, joined_by: str = "") -> bool:
    """Whether nothing but small words stands between two places."""
    return first[1] <= then[0] and not without(_lifted("between"), plain[first[1] : then[0]]).strip(joined_by + " ")
