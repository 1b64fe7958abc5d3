"""More sentences for the model of roles: said shorter with the same meaning, and with names of users or none.

Users are called by their numbers alone, and units are said only once: "user 3 gets 2 Mbit/s, user 5 gets 1 Mbit/s"
teaches as well what "3 gets 2 Mbit/s, 5 gets 1 Mbit/s" and "user 3 gets 2 Mbit/s, user 5 gets 1" mean. People shorten
so, and few who write sentences down do.

People and things are called by a name in ``named/<language>.txt``. A name that stands for a user is marked, "[the
camera]{name} can wait"; other nouns are nobody's. Beside them count those that have a meaning: as they are, and with
names in the places of those whom they name by number.
"""

from __future__ import annotations

import itertools
import random
import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path

from wirelessagent.language.base_words import language_of
from wirelessagent.language.looks import first_look
from wirelessagent.language.mentions import mentions
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.readings import readings
from wirelessagent.language.text import USER_NOUN, normalise
from wirelessagent.language.training.compose import OBJECTIVES
from wirelessagent.language.training.examples import FILLED, framed, spoken
from wirelessagent.language.training.marked import unmarked
from wirelessagent.language.training.meant import sentences
from wirelessagent.language.training.talk_notation import talks

NAMED = Path(__file__).with_name("named")
Span = tuple[int, int]
_COUNT = 3
"""How often a marked sentence counts, beside one that has a meaning."""

_SHARE, _MISSPELT = 0.8, 0.4
"""How many of the others count, and in how many of all a word is misspelt: no name either."""

_OF_TALKS = 3
"""One of so many lines of a talk that do something; those that do nothing may speak of anybody."""

_LONG_WORD = re.compile(r"[^\W\d_\u3400-\u9fff]{5,}")

_NOUN = re.compile(rf"(?i)(?P<article>\b(?:à\s+l'|de\s+l'|l'))?(?P<noun>{USER_NOUN})\s+(?=[0-9])")
_ARTICLES = {"à l'": "au ", "de l'": "du ", "l'": "le "}
_MAY_FOLLOW = re.compile(r"\s*(?:$|[^\W\d_]|[,.;:!?)\uff0c。；、](?!\s*[0-9]))")


def shortened(text: str) -> Iterator[str]:
    """The shorter ways to say a sentence, none where there is nothing to leave out."""
    for shorter in (without_nouns(text), without_units(text)):
        if shorter != text:
            yield shorter


def without_nouns(text: str) -> str:
    """The sentence with users called by their numbers alone.

    >>> without_nouns("let user 3 have 1 Mbit/s and drop users 5 and 7")
    'let 3 have 1 Mbit/s and drop 5 and 7'
    """
    plain = normalise(text)
    spans = [(q.start, q.end) for q in parse_quantities(text)]
    parts, place = list[str](), 0
    for mention in mentions(plain, (), spans):
        noun = _NOUN.search(plain, max(place, mention.start - 5), mention.end)
        if mention.role != "named" or noun is None or _MAY_FOLLOW.match(plain, mention.end) is None:
            continue
        article = _ARTICLES.get(" ".join((noun["article"] or "").lower().split()), "")
        parts += [text[place : noun.start()], article]
        place = noun.end()
    return "".join([*parts, text[place:]])


def without_units(text: str) -> str:
    """The sentence with a unit only where it is not that of the figure before.

    >>> without_units("user 3 gets 2 Mbit/s, the others 1 Mbit/s")
    'user 3 gets 2 Mbit/s, the others 1'
    """
    plain = normalise(text)
    said, parts, place = dict[str, str](), list[str](), 0
    for reading in readings(plain):
        unit = reading.unit
        if unit is None or unit.kind == "ratio" or reading.number.value is None or unit.end != reading.end:
            continue
        words = plain[reading.number.end : unit.end].strip().lower()
        if said.get(unit.kind) == words and words:
            parts.append(text[place : reading.number.end])
            place = unit.end
        said[unit.kind] = words
    return "".join([*parts, text[place:]])


def named() -> Iterator[tuple[str, list[Span], int]]:
    """Sentences, the names in them, and how often each counts."""
    chance, names = random.Random(1), defaultdict[str, list[str]](list)
    for path in sorted(NAMED.glob("*.txt")):
        for line in path.read_text(encoding="utf-8").splitlines():
            text, marks = unmarked(line)
            spans = [(start, end) for start, end, _ in marks]
            names[path.stem] += [text[start:end] for start, end in spans]
            yield text, spans, _COUNT
    for text in _without_names():
        turn = chance.random()
        if turn < _SHARE:
            yield misspelt(text, chance) if turn < _MISSPELT else text, [], 1
            swapped, spans = with_names(text, names[language_of(text)], chance)
            if spans:
                yield swapped, spans, 1


def with_names(text: str, names: Sequence[str], chance: random.Random) -> tuple[str, list[Span]]:
    """A sentence with names in the places of those whom it names by number, and where they stand."""
    plain, spans, place, found = normalise(text), list[Span](), 0, ""
    for mention in first_look(plain, parse_quantities(text)).mentions:
        if mention.role == "named":
            found, name = found + plain[place : mention.start], chance.choice(names)
            spans.append((len(found), len(found) + len(name)))
            found, place = found + name, mention.end
    return found + plain[place:], spans


def misspelt(text: str, chance: random.Random) -> str:
    """A sentence in which one of the longer words lacks a letter."""
    words = list(_LONG_WORD.finditer(text))
    if not words:
        return text
    start, end = chance.choice(words).span()
    place = chance.randrange(start + 1, end)
    return text[:place] + text[place + 1 :]


def _without_names() -> Iterator[str]:
    """Sentences that call nobody by a name."""
    yield from (text for text, _ in sentences())
    wordless = (each for each in spoken() if each.constraints is None)
    yield from (each.text for each in wordless if each.label in OBJECTIVES or each.label.startswith("command"))
    yield from (text for text, *_ in itertools.islice(framed(), 0, None, FILLED))
    yield from (text for _, lines, _ in talks() for text, does in lines[::_OF_TALKS] if does != "nothing")
