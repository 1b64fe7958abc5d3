"""What a sentence wants, and whether it orders that now: what the network makes of it.

A word is seen as it is said, by its letters and, in Chinese, with its neighbours, as the base word that the languages
share, by what the lexicon knows of it, by its classes of mood (:mod:`.moods`), and whether it is part of a wish.
Figures and users are one mark each, and so is every word that the training hardly saw. The mark of the start says what
the lexicon's rules make of the wish (:mod:`.goals`).
"""

from __future__ import annotations

import itertools
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from network.layers import BUCKETS, MOST_FEATURES, embedded, scores
from wirelessagent.language import base_words
from wirelessagent.language.deferred import deferred
from wirelessagent.language.mentions import mentions
from wirelessagent.language.moods import Span, classes_in
from wirelessagent.language.sentence import Sentence
from wirelessagent.language.text import CJK, is_chinese, unaccented

LIKELY = 0.8
"""How likely a sentence is one that orders something, at least, to be taken for one: at 0.9 a tenth fewer frames are
acted upon, and 1 % more of the orders are asked about."""

TOLD = "clarify.told"
"""The kind of what orders nothing and does not ask, either."""

KNOWN = 1 << 20
"""Of so many hashes it is known whether the training saw them often enough."""

_WORD = deferred(rf"[{CJK}]|(?:(?![{CJK}])[^\W_])+(?:['’](?:(?![{CJK}])[^\W_])+)?|[^\w\s\ud800-\udfff]")
_LONG_ENOUGH, _MOST_WORDS = 12, 400


class Word(NamedTuple):
    """A word, a Chinese character or a sign: as it is said, as a base word, what it means, its moods, and where.

    Attributes:
        said: in lower case and without accents; "@power", "@user" and the like for a figure or users.
        meant: the objective or the concept that the lexicon knows it by, "" for none.
        wished: whether it is part of a wish: a figure, a user, an aim.
    """

    said: str
    base: str
    meant: str
    moods: tuple[str, ...]
    wished: bool
    span: Span


START = Word("<s>", "<s>", "", (), True, (0, 0))


@dataclass(frozen=True, kw_only=True)
class Chances:
    """How likely a sentence is of each kind, and how likely it orders something now, and does not only tell or ask."""

    kinds: Mapping[str, float]
    order: float

    @property
    def is_order(self) -> bool:
        """Whether it is likely enough to order something, and most likely nothing that is only told."""
        return self.order >= LIKELY and max(self.kinds, key=lambda kind: self.kinds[kind]) != TOLD


def aligned(tokens: Sequence[str], language: str) -> list[str]:
    """For each of a sentence's tokens its base word, that of a Chinese expression for each of its characters."""
    own, english, chinese = (base_words._base_words(each) for each in (language, "en", "zh"))
    found = list[str]()
    while len(found) < len(tokens):
        token, ahead = tokens[len(found)], tokens[len(found) : len(found) + base_words._longest("zh")]
        run = "".join(itertools.takewhile(is_chinese, ahead))
        if run:
            size = next((size for size in range(len(run), 0, -1) if run[:size] in chinese), 1)
            found += [chinese.get(run[:size], token)] * size
        else:
            found.append(own.get(token) or (english.get(token, token) if language == "zh" else token))
    return found


def words_of(sentence: Sentence) -> list[Word]:
    """The words of a sentence behind its start, with one mark for each figure and each mention of users."""
    marked = [(q.phrase_start, q.phrase_end, f"@{q.kind}") for q in sentence.quantities]
    taken = [(start, end) for start, end, _ in marked]
    marked += [(m.start, m.end, "@user") for m in mentions(sentence.plain, (), taken) if m.role == "named"]
    found, place, plain = list[tuple[str, Span]](), 0, sentence.plain
    for start, end, mark in [*sorted(marked), (len(plain), len(plain), "")]:
        if start >= place:
            words = ((each.group(), each.span()) for each in _WORD.finditer(plain, place, start))
            found += [(word, span) for said, span in words if (word := unaccented(said.lower()))]
            found += [(mark, (start, end))] if mark else []
            place = end
    meant, wished = [""] * len(plain), [False] * len(plain)
    moods: list[tuple[str, ...]] = [()] * len(plain)
    for each in reversed(sentence.found):
        meant[each.start : each.end] = [each.term.objective or each.term.concept] * (each.end - each.start)
    for name, (start, end) in classes_in(plain):
        moods[start:end] = [(*said, name) for said in moods[start:end]]
    for start, end in sentence.wished:
        wished[start:end] = [True] * (end - start)
    goal = sentence.goal
    aims = dict.fromkeys((goal.objective, *goal.options))
    start = START._replace(moods=(goal.verdict, *(f"{goal.verdict}:{aim}" for aim in aims)))
    return [start] + [
        Word(
            said, base, next(filter(None, meant[slice(*span)]), ""),
            tuple(dict.fromkeys(name for each in moods[slice(*span)] for name in each)), wished[span[0]], span,
        )
        for (said, span), base in zip(found, aligned([said for said, _ in found], sentence.language), strict=True)
    ]  # fmt: skip


def hashes_of(words: Sequence[Word], *, bare: bool = False) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """The hashes of all that is seen of a sentence's words, and how many are of each.

    The first of each is of the word as it is said, 0 for none; of the words of a ``bare`` wish only what they mean is
    seen.
    """
    found, counts = list[int](), list[int]()
    for place, word in enumerate(words):
        before, behind = "", ""
        if is_chinese(word.said):
            before = words[place - 1].said if place > 1 else "<"
            behind = words[place + 1].said if place + 1 < len(words) else ">"
        own = bare and place > 0 and (word.wished or bool(word.meant))
        seen = dict.fromkeys(_seen(word, before, behind, bare=own))
        found += [0 if own else hashed("w" + word.said), *map(hashed, seen)]
        counts.append(1 + len(seen))
    return np.array(found), np.array(counts)


def _seen(word: Word, before: str, behind: str, *, bare: bool) -> Iterator[str]:
    """What is seen of a word between two others beside what is said; of a ``bare`` one only what it means."""
    if is_chinese(word.said) and not bare:
        yield from (f"p{before}{word.said}", f"p{word.said}{behind}", f"t{before}{word.said}{behind}")
    if word.base != word.said and not bare:
        yield "b" + word.base
    if word.meant:
        yield "C" + word.meant
    yield from ("m" + mood for mood in word.moods)
    if word.wished:
        yield "@"
    elif bare:
        yield "~"
    if not bare and len(word.said) > 3 and word.said.isalpha() and not is_chinese(word.said):
        letters = f"^{word.said[:_LONG_ENOUGH]}$"
        yield from ("c" + letters[at : at + size] for size in (3, 4) for at in range(len(letters) - size + 1))


def rows_of(
    hashes: npt.NDArray[np.int64], counts: npt.NDArray[np.int64], known: npt.NDArray[np.bool_]
) -> npt.NDArray[np.uint16]:
    """(word, MOST_FEATURES) the buckets of what is ``known`` of words; a word that is not has the mark of all such.

    What the training hardly saw would fall into the bucket of anything else, and be taken for that.
    """
    word, first = np.repeat(np.arange(len(counts)), counts), np.zeros(len(hashes), np.bool_)
    first[np.cumsum(counts) - counts] = True
    hashes = np.where(known[hashes % KNOWN] | (hashes == 0), hashes, first * UNKNOWN)
    word, hashes = word[hashes > 0], hashes[hashes > 0]
    place = np.arange(len(word)) - np.searchsorted(word, word)
    some, rows = place < MOST_FEATURES, np.zeros((len(counts), MOST_FEATURES), np.uint16)
    rows[word[some], place[some]] = 1 + hashes[some] % (BUCKETS - 1)
    return rows


def hashed(text: str) -> int:
    """A number for a text, the same everywhere."""
    return zlib.crc32(text.encode("utf-8", "replace"))


UNKNOWN = hashed("?")
"""What words have in common that the training hardly saw."""


@dataclass(frozen=True, kw_only=True)
class SentenceModel:
    """The network's weights, the kinds that it tells apart, and (KNOWN,) which hashes it knows."""

    labels: tuple[str, ...]
    weights: Mapping[str, npt.NDArray[Any]]
    known: npt.NDArray[np.bool_]

    @classmethod
    def load(cls, path: Path) -> SentenceModel:
        with np.load(path) as arrays:
            held = dict[str, npt.NDArray[Any]](arrays)
        labels, scale, known = held.pop("labels"), held.pop("scale"), held.pop("known")
        weights = {name: each.astype(np.float32) for name, each in held.items()}
        weights["embedding"] *= scale
        return cls(labels=tuple(map(str, labels)), weights=weights, known=np.unpackbits(known).astype(np.bool_))

    def save(self, path: Path) -> None:
        """Write the model: embeddings as int8 with one scale, other weights with 16 bits."""
        embedding = self.weights["embedding"]
        scale = np.float32(np.abs(embedding).max() / 127)
        weights: dict[str, Any] = {name: each.astype(np.float16) for name, each in self.weights.items()}
        weights["embedding"] = np.rint(embedding / scale).astype(np.int8)
        known = np.packbits(self.known)
        np.savez_compressed(path, allow_pickle=False, labels=np.array(self.labels), scale=scale, known=known, **weights)

    def chances(self, words: Sequence[Word]) -> Chances:
        """What a sentence of these words is; a very long one orders nothing, as its end is not read."""
        kinds, orders = self._scores(self._seen(words[:_MOST_WORDS])[None])
        likely = np.exp(kinds[0] - kinds[0].max())
        likely /= likely.sum()
        order = float(_logistic(orders)[0]) if len(words) <= _MOST_WORDS else 0.0
        return Chances(kinds=dict(zip(self.labels, likely.tolist(), strict=True)), order=order)

    def _seen(self, words: Sequence[Word]) -> npt.NDArray[np.float32]:
        """(word, EMBEDDED) of a sentence."""
        return np.asarray(embedded(np, self.weights, rows_of(*hashes_of(words), self.known)), np.float32)

    def _scores(self, seen: npt.NDArray[np.float32]) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
        """Scores of the kinds and of orders, of sentences as long as each other (sentence, word, EMBEDDED)."""
        with np.errstate(over="ignore"):  # exp(88) is infinite here, and 1 divided by it nothing
            return scores(np, self.weights, seen, np.ones(seen.shape[:2], np.float32))


def _logistic(scores: npt.NDArray[Any]) -> npt.NDArray[Any]:
    return 0.5 + 0.5 * np.tanh(scores / 2)
