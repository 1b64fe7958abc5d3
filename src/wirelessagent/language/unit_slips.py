"""Words for units with one slip of the pen: "12 wats", "2 megabts", "500 kbis/s".

A slip is a letter missing, added, changed or two swapped. Never the first one, which tells the prefixes apart; and not
where bits and bytes are as near ("megabites"), or where the word is another one ("8 want", "3 wait").
"""

from __future__ import annotations

import functools

from wirelessagent.language.deferred import deferred
from wirelessagent.language.spelling import one_edit

_WORD = deferred(r"[A-Za-zÀ-ÿ]{3,12}(?:/s(?![A-Za-z]))?(?![A-Za-z0-9])")
_PREFIXED = [f"{prefix}{core}" for prefix in ("kilo", "mega", "giga") for core in ("bit", "bits", "byte", "bytes")]
_PER_SECOND = [f"{prefix}{core}/s" for prefix in "kmg" for core in ("bit", "bits", "byte", "bytes")]
_SHORT = ("kbps", "mbps", "gbps", "dbm", "dbw")
_POWERS = [f"{prefix}{core}" for prefix in ("", "milli", "kilo", "mega") for core in ("watt", "watts")]
_UNITS = (*_POWERS, "vatio", "vatios", *_PREFIXED, *_PER_SECOND, *_SHORT)
_OTHER_WORDS = frozenset(("wait", "waits", "want", "wants", "wart", "warts", "waft", "wafts"))
_NEXT_KEY = {"dbn": "dbm"}
_ANOTHER_TIME = ("pm", "ph", "pd")


@functools.lru_cache(maxsize=1024)
def unit_meant(word: str) -> str:
    """The unit that a word with one slip stands for, "" where it is none or several.

    >>> unit_meant("wats"), unit_meant("kbis/s"), unit_meant("megabites"), unit_meant("want")
    ('watts', 'kbits/s', '', '')
    """
    small = word.lower()
    if small in _NEXT_KEY:
        return _NEXT_KEY[small]
    if small in _OTHER_WORDS or small in _UNITS or small.endswith(_ANOTHER_TIME):
        return ""
    near = [unit for unit in _UNITS if unit[0] == small[0] and one_edit(small, unit) and _may_be(small, unit)]
    meanings = {unit.replace("/s", "").rstrip("s") for unit in near}
    return max(near, key=lambda unit: (len(unit) == len(small) + 1, unit)) if len(meanings) == 1 else ""


def _may_be(word: str, unit: str) -> bool:
    """Whether a word has letters enough for a unit: "mbs" may as well be bytes."""
    return unit not in _SHORT or len(word) >= len(unit)


def slip_at(text: str, position: int) -> tuple[str, int] | None:
    """The unit meant by the misspelt word at this place of a text, and where that word ends."""
    match = _WORD.match(text, position)
    meant = unit_meant(match.group()) if match is not None else ""
    return (meant, match.end()) if match is not None and meant else None
