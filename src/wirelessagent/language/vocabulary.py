"""Finding the known terms in a sentence: longest phrase first, any script, one slip of the finger forgiven.

A sentence becomes units: Latin words, and single Chinese characters. Words of five letters or more that are unknown and
one edit (a letter missing, added, changed or two swapped) from exactly one known word of the same first letter are read
as that word. Figures are masked beforehand, so that "minimum" in "minimum 1 Mbit/s" is not taken for a wish.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from wirelessagent.language.deferred import deferred
from wirelessagent.language.spelling import nearest, one_edit
from wirelessagent.language.text import CJK, CLAUSE_END, normalise
from wirelessagent.language.word_tables import languages_with, table

MASK = "#"

_UNIT = deferred(rf"[{CJK}]|(?:(?![{CJK}])[^\W_])+(?:'(?:(?![{CJK}])[^\W_])+)?|(?P<cut>{CLAUSE_END})")
_SIGN = 0.6  # a single Chinese character may be part of another word: 快 of 快递
_SHORTEST_CORRECTED, _LONG = 5, 8


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
            found.append(
                Found(
                    term=term,
                    start=units[place].start,
                    end=units[place + length - 1].end,
                    first=place,
                    last=place + length,
                    clause=units[place].clause + clause_shift,
                    corrected=any(corrections[place + i] != units[place + i].word for i in range(length)),
                )
            )
            place += length
        return found

    def _longest(self, units: Sequence[Unit], words: Sequence[str], place: int) -> tuple[int, Term] | None:
        for phrase, term in self._by_first.get(words[place], ()):
            length = len(phrase)
            one_clause = place + length <= len(units) and units[place + length - 1].clause == units[place].clause
            if one_clause and all(words[place + i] == phrase[i] for i in range(length)):
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
