"""What a sentence wants, whether it orders that now, and says what was read of it: what the network makes of it.

A word is seen as it is said, by its letters and, in Chinese, with its neighbours, as the base word that the languages
share, by what the lexicon knows of it, by its classes of mood (:mod:`.moods`), and whether it is part of a wish.
Figures and users are one mark each, with what they were read as, and so is every word that the training hardly saw. The
mark of the start says what the lexicon's rules make of the wish (:mod:`.goals`). Every figure and user may have been
read, and the sentence may yet mean something else: "ignore the 10 W limit", "all but users 5 and 6 are out".

The network is written once, for NumPy and, in its training, for ``jax.numpy``. A word is the sum of what its features
are embedded as. Each block lets a word see its neighbours (a gated convolution), every other word (attention, with a
bias for how far away it is), and itself. Of what is seen then a pool for each question reads the answer: the kind of
the sentence, whether it orders something, whether it says what was read of it.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from wirelessagent.language.text import hashed, is_chinese

LIKELY = 0.87
"""How likely a sentence is one that orders something, at least, to be taken for one."""

_SUREST = 9.2
"""No reader's score for an order counts more than this: one of two that is sure does not decide alone."""

TOLD = "clarify.told"
"""The kind of what orders nothing and does not ask, either."""

KNOWN = 1 << 21
"""How many bits say which hashes the training saw often enough: a Bloom filter (1970) of four a hash."""
_PROBES = np.array((0x9E3779B1, 0x85EBCA77, 0xC2B2AE3D, 0x27D4EB2F))

SENTENCES_FILE = Path(__file__).with_name("sentences.npz")

BUCKETS = 1 << 15
"""Of features; bucket 0 stands for none."""
MOST_FEATURES = 28
"""Of a word."""
EMBEDDED, WIDTH, BLOCKS, HEADS = 28, 96, 2, 4
"""How many numbers a feature and a word are seen as; how many blocks, and how often each looks at other words."""
ANSWERS = ("kind", "order", "faithful")
"""What is read off a sentence, each by a head of its own."""
REACH = 12
"""Up to how many words away one distance is told from another."""
_STEEP = 1.7
"""x/(1 + exp(−1.7 x)) is close to the Gaussian error linear unit (Hendrycks and Gimpel 2016)."""

Weights = Mapping[str, Any]

_LONG_ENOUGH, _MOST_WORDS = 12, 400


class Word(NamedTuple):
    """A word, a Chinese character or a sign: as it is said, as a base word, what it means, and its moods.

    Attributes:
        said: in lower case and without accents; "@power", "@user" and the like for a figure or users.
        meant: the objective or the concept that the lexicon knows it by, "" for none.
        wished: whether it is part of a wish: a figure, a user, an aim.
        role: what a figure or a user was read as, "" for none.
    """

    said: str
    base: str
    meant: str
    moods: tuple[str, ...]
    wished: bool
    role: str = ""


START = Word("<s>", "<s>", "", (), True)


@dataclass(frozen=True, kw_only=True)
class Chances:
    """How likely a sentence is of each kind, that it orders something now, and that it says what was read of it.

    What only tells or asks orders nothing; what says something beside is not faithful.
    """

    kinds: Mapping[str, float]
    order: float
    faithful: float

    @property
    def likeliest(self) -> str:
        """The likeliest kind."""
        return max(self.kinds, key=lambda kind: self.kinds[kind])

    @property
    def is_told(self) -> bool:
        """Whether it is likeliest to tell of something that nobody orders, nor asks."""
        return self.likeliest == TOLD

    @property
    def is_order(self) -> bool:
        """Whether it is likely enough to order something, and does not only tell of it."""
        return self.orders(LIKELY)

    def orders(self, least: float) -> bool:
        """The same where that has to be likely to so much."""
        return self.order >= least and not self.is_told


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
    if word.role and not bare:
        yield "r" + word.role
    if word.wished:
        yield "@"
    elif bare:
        yield "~"
    if not bare and len(word.said) > 3 and word.said.isalpha():
        letters = f"^{word.said[:_LONG_ENOUGH]}$"
        yield from ("c" + letters[at : at + size] for size in (3, 4) for at in range(len(letters) - size + 1))


def places_of(hashes: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """(probe, hash) which bits say that hashes are known."""
    return (hashes * _PROBES[:, None] & 0xFFFFFFFF) // ((1 << 32) // KNOWN)


def _are_known(hashes: npt.NDArray[np.int64], known: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    return np.asarray(known[places_of(hashes)].all(axis=0), np.bool_)


def rows_of(
    hashes: npt.NDArray[np.int64], counts: npt.NDArray[np.int64], known: npt.NDArray[np.bool_]
) -> npt.NDArray[np.uint16]:
    """(word, MOST_FEATURES) the buckets of what is ``known`` of words; a word that is not has the mark of all such.

    What the training hardly saw would fall into the bucket of anything else, and be taken for that.
    """
    word, first = np.repeat(np.arange(len(counts)), counts), np.zeros(len(hashes), np.bool_)
    first[np.cumsum(counts) - counts] = True
    hashes = np.where(_are_known(hashes, known) | (hashes == 0), hashes, first * UNKNOWN)
    word, hashes = word[hashes > 0], hashes[hashes > 0]
    place = np.arange(len(word)) - np.searchsorted(word, word)
    some, rows = place < MOST_FEATURES, np.zeros((len(counts), MOST_FEATURES), np.uint16)
    rows[word[some], place[some]] = 1 + hashes[some] % (BUCKETS - 1)
    return rows


UNKNOWN = hashed("?")
"""What words have in common that the training hardly saw."""


@dataclass(frozen=True, kw_only=True)
class SentenceModel:
    """The network's weights, the kinds that it tells apart, and (KNOWN,) the bits of the hashes it knows."""

    labels: tuple[str, ...]
    weights: Mapping[str, npt.NDArray[Any]]
    known: npt.NDArray[np.bool_]

    @classmethod
    def load(cls, path: Path) -> SentenceModel:
        with np.load(path) as arrays:
            held = dict[str, npt.NDArray[Any]](arrays)
        labels, known = held.pop("labels"), np.unpackbits(held.pop("known")).astype(np.bool_)
        return cls(labels=tuple(map(str, labels)), weights=_weights_in(held), known=known)

    def save(self, path: Path) -> None:
        known = np.packbits(self.known)
        np.savez_compressed(
            path, allow_pickle=False, labels=np.array(self.labels), known=known, **_stored(self.weights)
        )

    def knows(self, word: str) -> bool:
        """Whether the training saw a word of more than three letters often enough, and all that they are seen by."""
        hashes, _ = hashes_of([Word(word, word, "", (), False)])
        return len(hashes) > 1 and bool(_are_known(hashes, self.known).all())

    def saw(self, word: str) -> bool:
        """Whether the training saw a word often enough."""
        return bool(_are_known(np.array([hashed("w" + word)]), self.known)[0])

    def chances(self, words: Sequence[Word], other: float | None = None) -> Chances:
        """What a sentence of these words is; a very long one orders nothing, as its end is not read.

        ``other`` is a score for an order by another reader of it, which counts as much as the network's.
        """
        rows = rows_of(*hashes_of(words[:_MOST_WORDS]), self.known)
        seen = np.asarray(embedded(np, self.weights, rows), np.float32)[None]
        with np.errstate(over="ignore"):  # exp(88) is infinite here, and 1 divided by it nothing
            (kinds,), ((own,),), ((faithful,),) = scores(np, self.weights, seen, np.ones(seen.shape[:2], np.float32))
        likely = _shares(np, kinds)
        score = float(np.clip([own, own if other is None else other], -_SUREST, _SUREST).mean())
        return Chances(
            kinds=dict(zip(self.labels, likely.tolist(), strict=True)),
            order=_chance(score) if len(words) <= _MOST_WORDS else 0.0, faithful=_chance(float(faithful)),
        )  # fmt: skip


def embedded(xp: ModuleType, weights: Weights, features: Any) -> Any:
    """(word, EMBEDDED) of the features of words (word, MOST_FEATURES)."""
    some = features > 0
    return (weights["embedding"][features] * some[..., None]).sum(1) / xp.sqrt(some.sum(1) + 1e-6)[:, None]


def scores(
    xp: ModuleType, weights: Weights, words: Any, there: Any, lose: Callable[[Any], Any] = lambda seen: seen
) -> list[Any]:
    """Scores (sentence, label) for each of :data:`ANSWERS`, of ``words`` (sentence, word, EMBEDDED).

    ``there`` (sentence, word) is 1 for a word and 0 behind the last; ``lose`` is what training loses of what is seen.
    """
    length: int = words.shape[1]
    away = np.clip(np.arange(length)[None] - np.arange(length)[:, None], -REACH, REACH) + REACH
    seen = lose(words) @ weights["in"] * there[..., None]
    for block in map(str, range(BLOCKS)):
        own = _normed(xp, seen, weights[block + "norm0"]) * there[..., None]
        none = xp.zeros_like(own[:, :1])
        ahead, behind = xp.concatenate([none, own[:, :-1]], 1), xp.concatenate([own[:, 1:], none], 1)
        near = xp.concatenate([ahead, own, behind], -1) @ weights[block + "near"]
        seen = seen + lose(near[..., :WIDTH] / (1 + xp.exp(-near[..., WIDTH:])))
        sought = _normed(xp, seen, weights[block + "norm1"]) @ weights[block + "sought"]
        asks, has, gives = (
            sought[..., part * WIDTH : (part + 1) * WIDTH].reshape(-1, length, HEADS, WIDTH // HEADS).swapaxes(1, 2)
            for part in range(3)
        )
        match = asks @ has.swapaxes(-1, -2) / np.float32((WIDTH / HEADS) ** 0.5) + weights[block + "far"][:, away]
        found = _shares(xp, xp.where(there[:, None, None] > 0, match, -1e9)) @ gives
        seen = seen + lose(found.swapaxes(1, 2).reshape(seen.shape) @ weights[block + "found"])
        more = _normed(xp, seen, weights[block + "norm2"]) @ weights[block + "up"]
        seen = seen + lose((more / (1 + xp.exp(-_STEEP * more))) @ weights[block + "down"])
    seen = _normed(xp, seen, weights["norm"])
    most = xp.where(there[..., None] > 0, seen, -1e9).max(1)

    def head(name: str) -> Any:
        looks = xp.where(there[..., None] > 0, seen @ weights[name + "pool"], -1e9)
        pooled = (_shares(xp, looks.swapaxes(1, 2)) @ seen).reshape(len(seen), -1)
        return lose(xp.concatenate([pooled, most], -1)) @ weights[name] + weights[name + "bias"]

    return list(map(head, ANSWERS))


def _normed(xp: ModuleType, seen: Any, gain: Any) -> Any:
    return seen * gain / xp.sqrt((seen * seen).mean(-1, keepdims=True) + 1e-6)


def _shares(xp: ModuleType, looks: Any) -> Any:
    likely = xp.exp(looks - looks.max(-1, keepdims=True))
    return likely / likely.sum(-1, keepdims=True)


def _chance(score: float) -> float:
    return 0.5 + 0.5 * math.tanh(score / 2)


def _weights_in(arrays: Mapping[str, npt.NDArray[Any]]) -> dict[str, npt.NDArray[Any]]:
    """Weights as they are used, of a file that :func:`_stored` was written into."""
    scales = {name: arrays[f"{name}_scales"] for name in arrays if f"{name}_scales" in arrays}
    names = (name for name in arrays if not name.endswith("_scales"))
    return {name: arrays[name].astype(np.float32) * scales.get(name, 1) for name in names}


def _stored(weights: Mapping[str, npt.NDArray[Any]]) -> dict[str, npt.NDArray[Any]]:
    """Matrices as int8 with a scale for each column, other weights as they are."""
    arrays = dict[str, npt.NDArray[Any]]()
    for name, each in weights.items():
        if each.ndim > 1:
            scales = np.maximum(np.abs(each).max(axis=0), 1e-9).astype(np.float32) / 127
            arrays[name], arrays[f"{name}_scales"] = np.rint(each / scales).astype(np.int8), scales
        else:
            arrays[name] = each.astype(np.float32)
    return arrays


@functools.cache
def shipped_sentences() -> SentenceModel:
    """The model of this release."""
    return SentenceModel.load(SENTENCES_FILE)
