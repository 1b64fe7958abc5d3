"""Sentences said shorter with the same meaning: users by their numbers alone, units only once.

"User 3 gets 2 Mbit/s, user 5 gets 1 Mbit/s" teaches as well what "3 gets 2 Mbit/s, 5 gets 1 Mbit/s" and "user 3 gets
2 Mbit/s, user 5 gets 1" mean. People shorten so, and few who write sentences down do.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from wirelessagent.language.mentions import mentions
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.readings import readings
from wirelessagent.language.text import USER_NOUN, normalise

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
    parts: list[str] = []
    place = 0
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
    said: dict[str, str] = {}
    parts: list[str] = []
    place = 0
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
