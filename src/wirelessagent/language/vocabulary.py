"""Finding the known terms in a sentence: longest phrase first, any script, one slip of the finger forgiven.

A sentence becomes units: Latin words, and single Chinese characters. Words of five letters or more that are unknown and
one edit (a letter missing, added, changed or two swapped) from exactly one known word of the same first letter are read
as that word; so are Chinese ones whose characters an input method mixed up. Figures are masked beforehand, so that
"minimum" in "minimum 1 Mbit/s" is not taken for a wish.

Words of five languages go onto one small set of English base words, so that the models learn from all at once:
``base_words/<language>.tsv`` has a base word and the word forms that it stands for on each line, so that "langsamsten",
"lente" and 最慢 meet in "slow". Latin words that are not listed stand for themselves; Chinese is cut into the longest
listed expressions. The language of a line is told by the lists that have its words, and by its letters.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from wirelessagent.language.text import CJK, CLAUSE_END, WORD, has_chinese, is_chinese, normalise, unaccented
from wirelessagent.language.word_tables import deferred, languages_with, table

FOLDER = Path(__file__).with_name("base_words")
_SMALL = frozenset(("the", "a", "and", "of", "in", "to", "it", "be"))
_TELLING = 3
"""How much speaks for a language, or for it rather than another, where it surely is that one: more than a word."""
_ALONE, _NAME = 2, "name"
"""What a word counts that no other language lists; one of English counts 1, as such are said in any."""
_WORD = deferred(r"[^\W\d_]{2,}")
_LETTERS = {"es": "ñ¿¡", "fr": "çêœàùèîû", "de": "ßäöü"}


def based(tokens: Sequence[str], language: str) -> list[str]:
    """The base words of a sentence's tokens, without the smallest words.

    ``tokens`` are lower case, without accents, Chinese by the character; ``language`` is "en", "zh", "es", "fr" or
    "de".

    >>> based(["dem", "langsamsten", "nutzer"], "de")
    ['slow', 'user']
    """
    return [base for base, _ in _expressions(tokens, language) if base and base not in _SMALL]


def aligned(tokens: Sequence[str], language: str) -> list[str]:
    """For each of a sentence's tokens its base word, that of a Chinese expression for each of its characters.

    >>> aligned(["die", "langsamsten", "xqzt"], "de")
    ['the', 'slow', 'xqzt']
    """
    found = list[str]()
    for base, size in _expressions(tokens, language):
        found += [base or tokens[len(found)]] * size
    return found


def is_listed(word: str) -> bool:
    """Whether a language lists a word, in lower case and without accents; a Chinese character within an expression.

    >>> is_listed("langsamsten"), is_listed("xqzt")
    (True, False)
    """
    return word in _listed()


@functools.cache
def _bases() -> frozenset[str]:
    """The base words, which are English."""
    return frozenset(base for path in FOLDER.glob("*.tsv") for base in _base_words(path.stem).values())


@functools.cache
def _listed() -> frozenset[str]:
    words = [word for path in FOLDER.glob("*.tsv") for word in _base_words(path.stem)]
    return frozenset((*words, *(sign for word in words if is_chinese(word) for sign in word)))


def _expressions(tokens: Sequence[str], language: str) -> Iterator[tuple[str, int]]:
    """The base words of tokens, or of the longest listed expression where Chinese begins, and of how many it is.

    A Chinese character that is in no listed expression has none.
    """
    own, english, chinese = (_base_words(each) for each in (language, "en", "zh"))
    place, longest = 0, _longest_chinese()
    while place < len(tokens):
        token, size = tokens[place], 1
        run = "".join(itertools.takewhile(is_chinese, tokens[place : place + longest]))
        if run:
            size = next((size for size in range(len(run), 0, -1) if run[:size] in chinese), 1)
            yield chinese.get(run[:size], ""), size
        else:
            yield own.get(token) or (english.get(token, token) if language == "zh" else token), size
        place += size


@functools.cache
def _base_words(language: str) -> Mapping[str, str]:
    path = FOLDER / f"{language}.tsv"
    if not path.is_file():
        return {}
    lines = (line.split("\t") for line in path.read_text(encoding="utf-8").splitlines())
    return {word: base for base, words in lines for word in words.split(" ")}


@functools.cache
def _longest_chinese() -> int:
    return max(map(len, _base_words("zh")), default=0)


def language_of(text: str) -> str:
    """The language of a sentence: "zh" where a Chinese character stands, else "es", "fr" or "de" where its words and
    letters outweigh those of English, the first of these where two do alike, else "en".

    >>> language_of("boost 速度"), language_of("boost the speed"), language_of("la potencia más baja")
    ('zh', 'en', 'es')
    """
    if has_chinese(text):
        return "zh"
    counts = _counts(text)
    return max(counts, key=lambda language: counts[language])


def language_in_a_talk(text: str, before: str) -> str:
    """The language of a line: that of the talk before it, "" at its start, unless its own words tell another clearly.

    >>> language_in_a_talk("plus 6", "en"), language_in_a_talk("mejor 2 Mbit/s", "es"), language_in_a_talk("10 W", "zh")
    ('en', 'es', 'zh')
    >>> language_in_a_talk("and what is the rate of user 3?", "es"), language_in_a_talk("no", "")
    ('en', 'en')
    """
    own = language_of(text)
    if not before or own == "zh":
        return own
    counts, words = _counts(text), len(_WORD.findall(text))
    if before == "zh":
        return own if words > 1 else before
    ahead = counts[own] - counts[before]
    return own if ahead >= _ALONE or (ahead > 0 and words > 1) else before


def languages_of(text: str) -> tuple[str, ...]:
    """The languages that a sentence may be in: all of them where its words hardly tell.

    >>> languages_of("save the power"), languages_of("10 W")
    (('en',), ('en', 'es', 'fr', 'de'))
    """
    if has_chinese(text):
        return ("zh",)
    counts = _counts(text)
    best = max(counts.values())
    return tuple(language for language, count in counts.items() if count == best or best < _TELLING)


@functools.lru_cache(maxsize=64)
def _counts(text: str) -> Mapping[str, int]:
    """How much the words and letters of a sentence speak for each language."""
    small = text.lower()
    counts: dict[str, int] = dict.fromkeys(("en", "es", "fr", "de"), 0)
    for word in map(unaccented, _WORD.findall(small)):
        listing = [each for each in counts if _base_words(each).get(word, _NAME) != _NAME]
        if word in _bases() and "en" not in listing:
            listing.append("en")
        for language in listing:
            counts[language] += 1 if language == "en" or len(listing) > 1 else _ALONE
    for language, letters in _LETTERS.items():
        counts[language] += 2 * sum(small.count(letter) for letter in letters)
    return counts


MASK = "#"

_UNIT = deferred(rf"{WORD}|(?P<cut>{CLAUSE_END})")
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

    @property
    def concept(self) -> str:
        return self.term.concept


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
        self._by_first: dict[str, list[tuple[tuple[str, ...], Term]]] = {}
        for phrase, term in sorted(known.items(), key=lambda entry: -len(entry[0])):
            self._by_first.setdefault(phrase[0], []).append((phrase, term))
        words = {word for phrase in known for word in phrase}
        self._right = words.union(word for each in tables for word in each["also"].get("right", ()))
        self._able = sorted(word for word in words if len(word) >= _SHORTEST_CORRECTED)

    def find(self, units: Sequence[Unit]) -> list[Found]:
        """The terms of a sentence from left to right, not overlapping, the longest first at each place."""
        words, found = [self._corrected(unit.word) for unit in units], list[Found]()
        place, clause_shift = 0, 0
        while place < len(units):
            last, term = self._longest(units, words, place)
            if term is not None:
                clause_shift += term.concept == "split"
                said = units[place:last]
                found.append(Found(
                    term=term, start=said[0].start, end=said[-1].end, first=place, last=last,
                    clause=said[0].clause + clause_shift, corrected=words[place:last] != [unit.word for unit in said],
                ))  # fmt: skip
            place = last
        return found

    def _longest(self, units: Sequence[Unit], words: Sequence[str], place: int) -> tuple[int, Term | None]:
        """Where the longest phrase of a place ends, and what it does; the next place where none begins."""
        for phrase, term in self._by_first.get(words[place], ()):
            last = place + len(phrase)
            if words[place:last] == [*phrase] and units[last - 1].clause == units[place].clause:
                return last, term
        return place + 1, None

    @functools.lru_cache(maxsize=4096)  # noqa: B019  # one vocabulary lives as long as the process
    def _corrected(self, word: str) -> str:
        if len(word) < _SHORTEST_CORRECTED or len(word) > 24 or word in self._right:
            return word
        close = [known for known in self._able if known[0] == word[0] and one_edit(word, known)]
        if close or len(word) < _LONG:
            return close[0] if len(close) == 1 else word
        return nearest(word, (known for known in self._able if len(known) >= _LONG - 1 and known.isascii())) or word


def _entry(item: str) -> tuple[str, ...]:
    return tuple(unit.word for unit in units_of(item))


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
        meant = _MEANT.get("".join(_SOUND_OF.get(letter, letter) for letter in pair), pair)
        if sum(a != b for a, b in zip(meant, pair, strict=True)) == 1:
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
