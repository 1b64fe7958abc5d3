"""Slips of the pen made good: Chinese characters that an input method mixes up, and Latin words a letter or two off."""

from __future__ import annotations

from collections.abc import Iterable

from wirelessagent.language.deferred import deferred
from wirelessagent.language.text import CJK
from wirelessagent.language.word_tables import table

_SLIPS = table("figures", "zh")["slips"]
SOUND_OF = {letter: group[0] for group in _SLIPS["sounds"] for letter in group}
_MEANT = {"".join(SOUND_OF.get(letter, letter) for letter in word): word for word in _SLIPS["words"]}
_RIGHT = frozenset((*_SLIPS["words"], *_SLIPS["right"]))
_PAIR = deferred(f"(?=([{CJK}]{{2}}))")


def respelt(plain: str) -> str:
    """The text with words of the trade put right that sound as they should; same length.

    >>> respelt("发射功律要最抵"), respelt("比列公平")
    ('发射功率要最低', '比例公平')
    """
    letters = list(plain)
    for match in _PAIR.finditer(plain):
        pair, place = match[1], match.start()
        if pair in _RIGHT:
            continue
        meant = _MEANT.get("".join(SOUND_OF.get(letter, letter) for letter in pair))
        changed = meant is not None and sum(a != b for a, b in zip(meant, pair, strict=True)) == 1
        if meant is not None and changed:
            letters[place : place + 2] = meant
    return "".join(letters)


def nearest(word: str, known: Iterable[str], most: int = 2) -> str:
    """The one known word with the same first letter that is at most so many edits away; "" for none or several."""
    close = [other for other in known if other[0] == word[0] and abs(len(other) - len(word)) <= most]
    letters = set(word)
    near = [other for other in close if len(letters.difference(other)) <= most and _edits(word, other, most) <= most]
    return near[0] if len(near) == 1 else ""


def _edits(a: str, b: str, most: int) -> int:
    """Letters missing, added or changed between two words; anything beyond ``most`` is as good as another."""
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, start=1):
        previous, row[0] = row[0], i
        for j, y in enumerate(b, start=1):
            previous, row[j] = row[j], min(row[j] + 1, row[j - 1] + 1, previous + (x != y))
        if min(row) > most:
            return most + 1
    return row[-1]


def one_edit(a: str, b: str) -> bool:
    """Whether one letter missing, added, changed, or a swap of neighbours makes a into b."""
    if len(a) > len(b):
        a, b = b, a
    at = next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), len(a))
    if len(a) < len(b):
        return len(b) == len(a) + 1 and a[at:] == b[at + 1 :]
    swapped = a[at + 1 : at + 2] + a[at : at + 1] + a[at + 2 :]
    return a[at + 1 :] == b[at + 1 :] or swapped == b[at:]
