"""What stands around a figure or a user: the words beside it, as hashed features for the model of roles.

Figures and users are placeholders, so that the model knows no numbers. What lies beyond the end of a clause counts
apart from what is near; letters within words catch compounds such as "Ruheverbrauch".
"""

from __future__ import annotations

import functools
import itertools
import zlib
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from wirelessagent.language.base_words import based
from wirelessagent.language.deferred import deferred
from wirelessagent.language.text import CJK, unaccented

BUCKETS = 1 << 16
_REACH = 12
_PAIRED = 5
_BASE_REACH, _BASE_NEAR = 8, 3
_TOKEN = deferred(rf"[{CJK}]|(?:(?![{CJK}])[^\W\d_])+(?:'(?=[^\W\d_]))?|[0-9]+|\S")
_CLAUSE_ENDS = frozenset(",;!?.。，；！？…—\n")


class Token(NamedTuple):
    """A word, a Chinese character, a mark or a placeholder ("@rate") at characters [start, end) of a sentence."""

    word: str
    start: int
    end: int = -1


def tokens_of(plain: str, placed: Iterable[Token]) -> list[Token]:
    """The tokens of a normalised sentence from left to right, those among them that are ``placed`` already."""
    found: list[Token] = []
    place = 0
    for token in sorted(placed, key=lambda each: (each.start, -each.end)):
        if token.start < place:
            continue
        found.extend(_words(plain, place, token.start))
        found.append(token)
        place = token.end
    found.extend(_words(plain, place, len(plain)))
    return found


def _words(plain: str, start: int, end: int) -> Iterator[Token]:
    for match in _TOKEN.finditer(plain, start, end):
        yield Token(_simple(match.group()), *match.span())


@functools.lru_cache(maxsize=4096)
def _simple(word: str) -> str:
    """Lower case without accents."""
    return unaccented(word.lower()) or word


def in_base_words(tokens: Sequence[Token], language: str) -> list[Token]:
    """The same with base words, which five languages share, in place of words; placeholders stay what they are."""
    found: list[Token] = []
    words: list[str] = []
    for token in (*tokens, Token("@", -1)):
        if token.word[0] != "@":
            words.append(token.word)
            continue
        found.extend(Token(word, -1) for word in based(words, language))
        words = []
        found.append(token)
    return found[:-1]


def around_base(tokens: Sequence[Token], place: int) -> set[str]:
    """The features of the base words about the token at ``place``."""
    found: set[str] = set()
    near: list[str] = []
    for side, words in _sides(tokens, place, _BASE_REACH):
        clause = list(itertools.takewhile(lambda word: word not in _CLAUSE_ENDS, words))
        near += [f"{side}{word}" for word in clause[:_PAIRED]]
        where, previous = f"base {side}0", ""
        for distance, word in enumerate(words, start=1):
            found |= {f"{where}{word}", f"{where}{previous} {word}"}
            if distance <= _BASE_NEAR:
                found |= {f"{where}~{word}", f"base {word}"}
            if word in _CLAUSE_ENDS:
                where = f"base {side}1"
            previous = word
    found.update(f"pair {one} {other}" for one, other in itertools.combinations(sorted(set(near)), 2))
    return found


def around(tokens: Sequence[Token], place: int, known: Sequence[str] = ()) -> set[str]:
    """The features of the token at ``place``; ``known`` are things that the rules say of it."""
    found = {"bias", *known}
    found.update([f"{one}&{other}" for index, one in enumerate(known) for other in known[index + 1 :]])
    for side, words in _sides(tokens, place, _REACH):
        _add_words(found, side, words)
        _add_near(found, side, words)
    left = tokens[place - 1].word if place else "<"
    right = tokens[place + 1].word if place + 1 < len(tokens) else ">"
    found.add(f"M{left} {right}")
    return found


def _sides(tokens: Sequence[Token], place: int, reach: int) -> tuple[tuple[str, list[str]], tuple[str, list[str]]]:
    """The words on the left and on the right of a token, the nearest first, as far as they may count."""
    left = [token.word for token in tokens[max(0, place - reach) : place]]
    return ("L", left[::-1]), ("R", [token.word for token in tokens[place + 1 : place + 1 + reach]])


def _add_words(found: set[str], side: str, words: Sequence[str]) -> None:
    """Single words, pairs and triples of one side, by how many clauses lie between."""
    clauses, where, previous, before_previous = 0, f"{side}0", "", ""
    for distance, word in enumerate(words, start=1):
        found.add(f"{where}{word}")
        if distance <= 4:
            found.add(f"{where}{'=' if distance < 2 else '~'}{word}")
        if previous:
            found.add(f"{where}{previous} {word}")
            if before_previous and distance <= 6:
                found.add(f"{where}{before_previous} {previous} {word}")
        if word in _CLAUSE_ENDS:
            clauses += 1
            where = f"{side}{min(clauses, 2)}"
        before_previous, previous = previous, word
    if len(words) < _REACH:
        found.add(f"{side}{min(clauses, 1)}end{min(len(words) + 1, 3)}")


def _add_near(found: set[str], side: str, words: Sequence[str]) -> None:
    """The words of the same clause on one side whatever their order, with their letters, and the next placeholder."""
    same_clause, next_known = True, False
    for word in words:
        if word[0] == "@" and not next_known:
            next_known = True
            found.add(f"{side}next{not same_clause}{word}")
        elif same_clause:
            found.add(f"near {word}")
            if len(word) > 4:
                found.update(_letters(word))
        if word in _CLAUSE_ENDS:
            same_clause = False
            if next_known:
                return


@functools.lru_cache(maxsize=4096)
def _letters(word: str) -> tuple[str, ...]:
    padded = f"^{word[:20]}$"
    return tuple(f"letters {padded[start : start + 4]}" for start in range(len(padded) - 3))


def hashed(question: str, features: Iterable[str]) -> npt.NDArray[np.int64]:
    """The distinct buckets of features, ascending; each question has its own hash."""
    seed = zlib.crc32(question.encode())
    found = {zlib.crc32(each.encode("utf-8", "replace"), seed) % BUCKETS for each in features}
    buckets = np.fromiter(found, dtype=np.int64, count=len(found))
    buckets.sort()
    return buckets
