"""Finding the known terms in a sentence: longest phrase first, any script, one slip of the finger forgiven.

A sentence becomes units: Latin words, and single Chinese characters. Words of five letters or more that are unknown and
one edit (a letter missing, added, changed or two swapped) from exactly one known word of the same first letter are read
as that word; so are Chinese ones whose characters an input method mixed up. Figures are masked beforehand, so that
"minimum" in "minimum 1 Mbit/s" is not taken for a wish.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from wirelessagent.language.deferred import deferred
from wirelessagent.language.text import CJK, CLAUSE_END, normalise
from wirelessagent.language.word_tables import languages_with, table

MASK = "#"

_UNIT = deferred(rf"[{CJK}]|(?:(?![{CJK}])[^\W_])+(?:'(?:(?![{CJK}])[^\W_])+)?|(?P<cut>{CLAUSE_END})")
_SIGN = 0.6  # a single Chinese character may be part of another word: 快 of 快递
_SHORTEST_CORRECTED, _LONG = 5, 8
_SLIPS = table("figures", "zh")["slips"]
_SOUND_OF = {letter: group[0] for group in _SLIPS["sounds"] for letter in group}
_MEANT = {"".join(_SOUND_OF.get(letter, letter) for letter in word): word for word in _SLIPS["words"]}
_RIGHT = frozenset((*_SLIPS["words"], *_SLIPS["right"]))
_PAIR = deferred(f"(?=([{CJK}]{{2}}))")


@dataclass(frozen=True, kw_only=True)
class Term:
    """What a phrase does in a sentence: its concept, and for "direct" the objective it means.

    A complaint ("buffering") means its objective too, but more of it would be the opposite.
    """

    concept: str
    objective: str = ""
    weight: float = 1.0
    complaint: bool = False


@dataclass(frozen=True, kw_only=True)
class Found:
    """A term found in a sentence: characters [start, end), units [first, last), and the clause that it stands in."""

    term: Term
    start: int
    end: int
    first: int
    last: int
    clause: int
    corrected: bool


@dataclass(frozen=True, kw_only=True)
class Unit:
    """A word or a Chinese character of a sentence."""

    word: str
    start: int
    end: int
    clause: int


@dataclass(frozen=True, kw_only=True)
class OwnWords:
    """The names and phrases that an objective brings with it."""

    objective: str
    names: tuple[str, ...]
    phrases: tuple[tuple[str, tuple[str, ...]], ...]


def units_of(plain: str, masked: Sequence[tuple[int, int]] = ()) -> list[Unit]:
    """The units of a normalised sentence; those inside a masked span become one ``MASK``."""
    units: list[Unit] = []
    clause = 0
    for match in _UNIT.finditer(plain):
        hidden = bool(masked) and any(start <= match.start() < end for start, end in masked)
        if match["cut"] is not None:
            clause += 0 if hidden else 1
        elif not hidden:
            word = match.group().replace("'", "").lower()
            units.append(Unit(word=word, start=match.start(), end=match.end(), clause=clause))
        elif not units or units[-1].word != MASK:
            units.append(Unit(word=MASK, start=match.start(), end=match.end(), clause=clause))
    return units


class Vocabulary:
    """The lexicon, ``lexicon/<language>.toml``, together with the objectives' own words."""

    def __init__(self, own: Iterable[OwnWords]) -> None:
        self._by_first: dict[str, list[tuple[tuple[str, ...], Term]]] = {}
        self._words: set[str] = set()
        known: dict[tuple[str, ...], Term] = {}
        tables = [table("lexicon", language) for language in languages_with("lexicon")]
        for each in tables:
            for concept, items in each["concepts"].items():
                known |= {_entry(item): Term(concept=concept) for item in items}
            for objective, items in each["direct"].items():
                known |= {
                    _entry(item): Term(concept="direct", objective=objective, weight=_SIGN if len(item) == 1 else 1.0)
                    for item in items
                }
        for words in own:
            spoken = [*words.names, *(phrase for _, phrases in words.phrases for phrase in phrases)]
            term = Term(concept="direct", objective=words.objective, weight=2.0)
            known |= {_entry(normalise(phrase)): term for phrase in spoken}
        for phrase in (_entry(item) for each in tables for item in each["also"]["complaints"]):
            known[phrase] = replace(known[phrase], complaint=True)
        known.pop((), None)
        for phrase, term in known.items():
            self._by_first.setdefault(phrase[0], []).append((phrase, term))
            self._words.update(phrase)
        for entries in self._by_first.values():
            entries.sort(key=lambda entry: -len(entry[0]))
        self._right = self._words.union(word for each in tables for word in each["also"].get("right", ()))
        self._long = sorted(word for word in self._words if len(word) >= _LONG - 1 and word.isascii())
        self._slips: dict[str, set[str]] = {}
        for word in self._words:
            if len(word) >= _SHORTEST_CORRECTED:
                for variant in _deletions(word):
                    self._slips.setdefault(variant, set()).add(word)

    def find(self, units: Sequence[Unit]) -> list[Found]:
        """The terms of a sentence from left to right, not overlapping, the longest first at each place."""
        corrections = [self._corrected(unit.word) for unit in units]
        found: list[Found] = []
        place, clause_shift = 0, 0
        while place < len(units):
            match = self._longest(units, corrections, place)
            if match is None:
                place += 1
                continue
            length, term = match
            if term.concept == "split":
                clause_shift += 1
            said = units[place : place + length]
            found.append(Found(
                term=term, start=said[0].start, end=said[-1].end, first=place, last=place + length,
                clause=said[0].clause + clause_shift,
                corrected=any(corrections[place + i] != unit.word for i, unit in enumerate(said)),
            ))  # fmt: skip
            place += length
        return found

    def _longest(self, units: Sequence[Unit], words: Sequence[str], place: int) -> tuple[int, Term] | None:
        for phrase, term in self._by_first.get(words[place], ()):
            length = len(phrase)
            one_clause = place + length <= len(units) and units[place + length - 1].clause == units[place].clause
            if one_clause and tuple(words[place : place + length]) == phrase:
                return length, term
        return None

    @functools.lru_cache(maxsize=4096)  # noqa: B019  # one vocabulary lives as long as the process
    def _corrected(self, word: str) -> str:
        if len(word) < _SHORTEST_CORRECTED or len(word) > 24 or word in self._right:
            return word
        near = {known for variant in _deletions(word) for known in self._slips.get(variant, ())}
        close = [known for known in near if known[0] == word[0] and one_edit(word, known)]
        if close or len(word) < _LONG:
            return close[0] if len(close) == 1 else word
        return nearest(word, self._long) or word


def _entry(item: str) -> tuple[str, ...]:
    return tuple(unit.word for unit in units_of(item))


def _deletions(word: str) -> list[str]:
    """The word itself and all that remain when one letter is taken out."""
    return [word, *(word[:i] + word[i + 1 :] for i in range(len(word)))]


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
        meant = _MEANT.get("".join(_SOUND_OF.get(letter, letter) for letter in pair))
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
