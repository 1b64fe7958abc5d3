"""How dictation spells what is said: "thirty dee bee em" is dBm, "twenty what's" are watts, "user to gets" is user 2.

Which words are heard for which is data (``figures/<language>.toml``, ``[heard]``): anywhere, right behind a number, and
right behind a user who is named by no more: "each user to", "limit user to 2 Mbit/s" are none.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping

from wirelessagent.language.mentions import without_corrected
from wirelessagent.language.numerals import numbers
from wirelessagent.language.shares import worked_out
from wirelessagent.language.text import normalise, replaced
from wirelessagent.language.vocabulary import language_of
from wirelessagent.language.word_tables import deferred, table

_NOT_A_FIGURE = r"(?!\s*[0-9])"


def as_meant(text: str) -> str:
    """The sentence as it is meant: spelt as it was said, with what its shares come to, without what it takes back.

    Everything else stays at its place.
    """
    return without_corrected(worked_out(heard(text)))


def heard(text: str) -> str:
    """The sentence spelt as it was said.

    >>> " ".join(heard("stay below thirty dee bee em and leave out user ate").split())
    'stay below thirty dBm and leave out user 8'
    """
    plain, language = normalise(text), language_of(text)
    ends = {number.end for number in numbers(plain)}
    spans = list[tuple[int, int, str]]()
    for name, words in table("figures", language).get("heard", {}).items():
        for match in _misheard(name, language).finditer(plain):
            start, end = match.span("said")
            if name != "behind_numbers" or len(plain[:start].rstrip()) in ends:
                spans.append((start, end, words[match["said"].lower()].ljust(end - start)))
    return replaced(text, sorted(spans))


@functools.cache
def _misheard(name: str, language: str) -> re.Pattern[str]:
    words: Mapping[str, str] = table("figures", language)["heard"][name]
    said = rf"(?P<said>{'|'.join(sorted(map(re.escape, words), key=len, reverse=True))})(?![\w'])"
    if name != "behind_users":
        return deferred(rf"(?i)(?<![\w'])(?:{said})")
    ahead = "|".join(table("figures", language)["users"]["heard_ahead"])
    return deferred(rf"(?i)(?:^|[,;.]\s*|\b(?:{ahead})\s+)users?\s+{said}{_NOT_A_FIGURE}")
