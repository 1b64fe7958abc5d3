"""Whether a sentence orders something now, judged by its frame: what stands around the wish, and not the wish.

Aims, figures and users are one mark each, words that training never saw are another, and signs count as words. What is
left says who wants it, when, whether it is told, asked, denied or supposed. It is seen as the words that are said, as
base words, which the languages share, and as classes of mood (:mod:`.moods`); of each view a logistic regression has
the runs of words and the side of the wish that they stand on. Trained by :mod:`wirelessagent.language.training.orders`.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from wirelessagent.language.moods import classes_in
from wirelessagent.language.text import WORD_OR_SIGN, Span, hashed, unaccented
from wirelessagent.language.vocabulary import based

if TYPE_CHECKING:
    from wirelessagent.language.sentence import Sentence

ORDER_FILE = Path(__file__).with_name("orders.npz")
BUCKETS = 1 << 18
WISH, UNKNOWN = "@", "~"
LIKELY = 0.4
"""The score from where on a sentence is likely to be an order."""

_MOST_TOKENS, _MOST_QUOTED = 80, 4
_COMMON = ("subject:ours", "subject:adverbial", "subject:speaker")
"""Classes that tell least of a word that has another, too."""
_CUT = frozenset(",;:.!?…—–-\n，。；：！？、")


@dataclass(frozen=True, kw_only=True)
class Frame:
    """The words and signs around a wish, one mark for each run of it.

    Attributes:
        tokens: in lower case and without accents, Chinese by the character.
        spans: where each stands in the text.
        moods: classes of mood with the tokens [first, last] that they are said by, in order.
        language: of the text.
    """

    tokens: tuple[str, ...]
    spans: tuple[Span, ...]
    moods: tuple[tuple[str, int, int], ...]
    language: str

    def without(self, first: int, size: int) -> Frame:
        """The same without some tokens side by side."""
        end = first + size
        moods = [each for each in self.moods if each[2] < first]
        moods += [(name, begin - size, last - size) for name, begin, last in self.moods if begin >= end]
        tokens, spans = self.tokens[:first] + self.tokens[end:], self.spans[:first] + self.spans[end:]
        return replace(self, tokens=tokens, spans=spans, moods=tuple(moods))


def frame_of(sentence: Sentence) -> Frame:
    """What is judged of a sentence.

    >>> from wirelessagent.language.sentence import Sentence, own_words
    >>> frame_of(Sentence("If it rains, at most 5 W for user 3", own_words())).tokens
    ('if', 'it', 'rains', ',', '@', 'for', '@')
    """
    found, wished = list[tuple[str, Span]](), {place for span in sentence.wished for place in range(*span)}
    for match in WORD_OR_SIGN.finditer(sentence.plain):
        start, end = match.span()
        if start in wished:
            if not found or found[-1][0] != WISH:
                found.append((WISH, (start, end)))
        else:
            found.append((unaccented(match.group().lower()), (start, end)))
    del found[_MOST_TOKENS:]
    moods = list[tuple[str, int, int]]()
    for name, (start, end) in classes_in(sentence.plain):
        said = [place for place, (_, (first, last)) in enumerate(found) if first < end and start < last]
        if said:
            moods.append((name, said[0], said[-1]))
    tokens, spans = tuple(token for token, _ in found), tuple(span for _, span in found)
    return Frame(tokens=tokens, spans=spans, moods=tuple(moods), language=sentence.language)


def features(frame: Frame, known: frozenset[int]) -> npt.NDArray[np.int64]:
    """The distinct buckets that a frame falls into, ascending; ``known`` are the hashes of known words."""
    return np.unique([hashed(gram) % BUCKETS for gram in _grams(frame, known)])


def word_hashes(frame: Frame) -> set[int]:
    """The hashes of a frame's words and signs."""
    return {hashed(token) for token in frame.tokens}


def _grams(frame: Frame, known: frozenset[int]) -> Iterator[str]:
    """What is said of a frame: four views of its words."""
    said = [token if token == WISH or hashed(token) in known else UNKNOWN for token in frame.tokens]
    classes = list(_classes(frame))
    yield from _view("w", said, 3)
    yield from _view("b", based(frame.tokens, frame.language), 3)
    yield from _view("c", classes, 4)
    yield from _view("e", [name for name in classes if name != UNKNOWN], 4)


def _classes(frame: Frame) -> Iterator[str]:
    """The classes of mood in the places of their words, signs and wishes as they are, and one mark for other words."""
    names = [token if token == WISH or not token.isalnum() else UNKNOWN for token in frame.tokens]
    for name, first, last in reversed(frame.moods):
        if name not in _COMMON or names[first] == UNKNOWN:
            names[first : last + 1] = [name, *[""] * (last - first)]
    before = ""
    for name in filter(None, names):
        if (name, before) != (UNKNOWN, UNKNOWN):
            yield name
        before = name


def _view(mark: str, said: Sequence[str], longest: int) -> Iterator[str]:
    """A sequence's words by their sides of the wish, its runs of up to so many words, and pairs around one."""
    for token, side in zip(said, _sides(said), strict=True):
        yield f"{mark}{side[0]}{token}"
        yield f"{mark}{side}{token}"
    padded = ["<", *said, ">"]
    for place, token in enumerate(padded):
        for size in range(1, min(longest, len(padded) - place) + 1):
            yield f"{mark}{size}{' '.join(padded[place : place + size])}"
        if place + 2 < len(padded):
            yield f"{mark}_{token} {padded[place + 2]}"


def _sides(said: Sequence[str]) -> list[str]:
    """For each word whether it stands before, behind or among the wishes, and whether in a clause with one."""
    wishes = [place for place, token in enumerate(said) if token == WISH]
    first, last = (wishes[0], wishes[-1]) if wishes else (len(said), -1)
    clause = 0
    clauses = [clause := clause + (token in _CUT) for token in said]
    shared = {clauses[place] for place in wishes}
    sides = ("<" if place < first else ">" if place > last else "=" for place in range(len(said)))
    return [side + ("+" if clause in shared else "-") for side, clause in zip(sides, clauses, strict=True)]


@dataclass(frozen=True, kw_only=True)
class OrderModel:
    """A logistic regression.

    Attributes:
        weights: (bucket,) as int8, with their ``scale`` and an ``intercept``.
        known: the hashes of known words.
    """

    weights: npt.NDArray[np.int8]
    scale: float
    intercept: float
    known: frozenset[int]

    @classmethod
    def load(cls, path: Path) -> OrderModel:
        with np.load(path) as arrays:
            return cls(
                weights=arrays["weights"], scale=float(arrays["scale"]), intercept=float(arrays["intercept"]),
                known=frozenset(arrays["known"].tolist()),
            )  # fmt: skip

    def save(self, path: Path) -> None:
        known = np.array(sorted(self.known), dtype=np.uint32)
        np.savez_compressed(path, weights=self.weights, scale=self.scale, intercept=self.intercept, known=known)

    def score(self, frame: Frame) -> float:
        """The logarithm of how much likelier a sentence of this frame orders something now than not."""
        found = features(frame, self.known)
        return self.intercept + self.scale * float(self.weights[found].sum(dtype=np.int32)) / float(len(found)) ** 0.5

    def against(self, frame: Frame) -> Span | None:
        """The words, four at most, without which a sentence is likeliest to order something; None where that is none.

        They stand side by side, as few of them as make it likely enough, and none is cut in two.
        """
        if self.score(frame) >= LIKELY:
            return None
        for size in range(1, _MOST_QUOTED + 1):
            scores = {
                place: self.score(frame.without(place, size))
                for place in range(len(frame.tokens) - size + 1)
                if WISH not in frame.tokens[place : place + size]
            }
            best = max(scores, key=lambda place: scores[place], default=0)
            if scores and scores[best] >= LIKELY:
                words = [(first, last) for _, first, last in frame.moods if first < best + size and best <= last]
                first, last = min([best, *(a for a, _ in words)]), max([best + size - 1, *(b for _, b in words)])
                return frame.spans[first][0], frame.spans[last][1]
        return None


@functools.cache
def shipped_order_model() -> OrderModel:
    """The model of this release."""
    return OrderModel.load(ORDER_FILE)
