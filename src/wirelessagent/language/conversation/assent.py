"""Whether a line lets the waiting plan be applied: a closed grammar, no model, whichever recogniser is at work.

A base station is only told to act by a line that is, as a whole, an assent or a plain command to apply: "yes, please",
"apply it now", "好的，应用吧". A negation, a question mark, a condition, a time, another target, a figure or any word
left over makes it something else, which at most leads to a question. The words are data, those of all languages
together (``[assent]`` in ``talk_forms/<language>.toml``).
"""

from __future__ import annotations

import functools
import re
from typing import Literal, TypeAlias

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Intent
from wirelessagent.language.text import lowered, normalise
from wirelessagent.language.word_tables import languages_with, table, written

Assent: TypeAlias = Literal["yes", "mild", "apply", "no", "later", "doubtful", "other"]
"""What a line is to a plan that waits: a yes; a mild one, such as "ok", which may only take note of an answer; a
command to apply; a refusal; a wish to wait; words about applying that are none of these, such as a question; or
anything else."""

_LONGEST = 100
"""Characters of a line that may be an assent."""
_WORDS = "talk_forms"
_APART = r"(?:(?<![^\W\d_])|(?<=[\u3400-\u9fff]))"
_OVER = r"(?:(?![^\W\d_])|(?=[\u3400-\u9fff]))"
_NO_ASSENT = deferred(r"[?\d]|[是对對]吧")
"""A question or a figure, which no assent has in it."""
_PLAIN = deferred(r"[\s,，、.。!~；;:…]+")
_ABOUT = ("of_applying", "of_assent", "mild_of_assent")


@functools.cache
def _either(*classes: str) -> re.Pattern[str]:
    """The words of these classes in all languages."""
    return re.compile("|".join(
        written(_WORDS, language, each)
        for language in languages_with(_WORDS)
        for name in classes
        for each in table(_WORDS, language)["assent"].get(name, ())
    ))  # fmt: skip


@functools.cache
def _all_of(*classes: str) -> re.Pattern[str]:
    """Up to nine words of these classes, each one apart; a group by each class."""
    words = (f"(?P<{name}>{_APART}(?:{_either(name).pattern}){_OVER})" for name in classes)
    return re.compile(rf"(?: *(?:{'|'.join(words)})){{1,9}} *")


@functools.cache
def _known() -> tuple[frozenset[str], frozenset[str]]:
    """The words, and the Chinese signs, of which a line about a plan may be made and nothing else of the cell."""
    listed = [table(_WORDS, language)["assent"] for language in languages_with(_WORDS)]
    signs = "".join(words.get("known_signs", "") for words in listed)
    return frozenset(word for words in listed for word in words.get("known", "").split()), frozenset(signs)


def assent(text: str) -> Assent:
    """What a line is to a plan that waits.

    >>> assent("Yes, please apply it now!"), assent("apply nothing"), assent("should I apply it?"), assent("non merci")
    ('apply', 'no', 'doubtful', 'no')
    >>> assent("好的，应用吧"), assent("ok, hold on"), assent("now with 5 W")
    ('apply', 'later', 'other')
    """
    if len(text) > _LONGEST:
        return "other"
    said = lowered(normalise(text)).strip()
    match = (
        None
        if _NO_ASSENT.search(said)
        else _all_of("apply", "mild", "yes", "polite").fullmatch(_PLAIN.sub(" ", said).strip())
    )
    if match is not None and (match["apply"] or match["yes"] or match["mild"]):
        return "apply" if match["apply"] else "yes" if match["yes"] else "mild"
    plain = " ".join(_PLAIN.sub(" ", said).split())
    return _about_applying(plain) if _is_known(plain) else "other"


def is_assent(text: str) -> bool:
    """Whether a line, as a whole, lets the waiting plan be applied."""
    return assent(text) in ("yes", "mild", "apply")


def speaks_of_applying(text: str) -> bool:
    """Whether a line has a word of assent or of applying in it, whatever it says of it."""
    return _either(*_ABOUT[:2]).search(lowered(normalise(text[:_LONGEST]))) is not None


def read_assent(line: Line) -> Intent | None:
    """A line that is about the plan that waits for a yes and about nothing else; None for any other."""
    if line.context.awaits != "confirmation":
        return None
    said = assent(line.text)
    if said == "other":
        return None
    if said == "no":
        return line.command("reject")
    return line.command("apply" if said == "apply" else "confirm")


def _is_known(plain: str) -> bool:
    """Whether every word, or every Chinese sign, is one of those that speak of applying and nothing else."""
    known, signs = _known()
    words = re.findall(r"[^\W\d_]+(?:'[^\W\d_]+)?|\S", plain)
    return all(word in known or word in "?'\"" or signs.issuperset(word) for word in words)


def _about_applying(plain: str) -> Assent:
    if _all_of("no").fullmatch(plain) and not _all_of("courtesy").fullmatch(plain):
        return "no"
    about, condition = _either(*_ABOUT).search(plain), _either("condition").search(plain)
    if _either("taken_back").search(plain) or (about and ("?" in plain or _either("asked").search(plain))):
        return "doubtful"
    if _either("later").search(plain):
        return "doubtful" if condition else "later"
    if about is None:
        return "other"
    if condition or _either("contradicts").search(plain):
        return "doubtful"
    return "no" if _either("refused").search(plain) else "doubtful"
