"""Patterns of whole phrases, which most sentences do not hold: searched without capitals, and only where it may help.

Ignoring the case of letters makes a pattern of many words several times slower than searching a text in lower case.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator

from wirelessagent.language.deferred import deferred
from wirelessagent.language.text import lowered


class Phrases:
    """A pattern in small letters of normalised texts in whatever letters; matches hold small letters.

    ``marks`` are pieces of words, an underscore being a space, one of which stands in every match: a text that holds
    none need not be searched. No marks: search any text.

    >>> quarters = Phrases(r"\\bquarters? of\\b", "quarter")
    >>> quarters.search("A Quarter of it").span(), quarters.search("half of it")
    ((2, 12), None)
    """

    def __init__(self, pattern: str, marks: str = "") -> None:
        self.compiled = deferred(pattern)
        self.marks = tuple(mark.replace("_", " ") for mark in marks.split())

    def search(self, plain: str, start: int = 0, end: int = sys.maxsize) -> re.Match[str] | None:
        text = lowered(plain)
        return self.compiled.search(text, start, end) if self.may_match(text) else None

    def finditer(self, plain: str, start: int = 0, end: int = sys.maxsize) -> Iterator[re.Match[str]]:
        text = lowered(plain)
        return self.compiled.finditer(text, start, end) if self.may_match(text) else iter(())

    def may_match(self, text: str) -> bool:
        """Whether a text in small letters holds any of the marks."""
        return not self.marks or any(mark in text for mark in self.marks)
