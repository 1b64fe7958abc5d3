"""Spelling made uniform without moving a single character, so that every finding can be quoted from the original.

Deliberately not NFKC: that would turn "10² W" into "102 W".
"""

from __future__ import annotations

import re

_SAME_LENGTH = {
    # Full-width ASCII, but for the comma and the semicolon: they never stand inside a number.
    **{chr(code): chr(code - 0xFEE0) for code in range(0xFF01, 0xFF5F) if code not in (0xFF0C, 0xFF1B)},
    **dict.fromkeys("\u3000\u00a0\u2009\u202f\t\r", " "),
    **dict.fromkeys("\u2018\u2019\u02bc", "'"),
    "\u00b5": "\u03bc",  # the micro sign and the Greek letter
    "\u2212": "-",
    "〜": "~",
    "≦": "≤",
    "≧": "≥",
    "⩽": "≤",
    "⩾": "≥",
}

_TABLE = str.maketrans(_SAME_LENGTH)

CJK = "\u3400-\u9fff\uf900-\ufaff"
_CJK = re.compile(f"[{CJK}]")

CLAUSE_END = r"[,;:!?()\n\uff0c\uff1b。、…—]|\.(?![0-9])"


def normalise(text: str) -> str:
    """The text with full-width forms, odd spaces, minus signs and apostrophes made plain; same length.

    >>> normalise("\uff11\uff10\u00a0\u00b5W")
    '10 μW'
    """
    return text.translate(_TABLE)


def language_of(text: str) -> str:
    """The language to answer in: "zh" where a Chinese character stands, "en" otherwise.

    >>> language_of("boost 速度"), language_of("boost the speed")
    ('zh', 'en')
    """
    return "zh" if _CJK.search(text) else "en"
