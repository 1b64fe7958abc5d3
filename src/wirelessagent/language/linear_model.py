"""The small linear model: which label a sentence's n-grams speak for, as a probability.

A multinomial logistic regression with weights of eight bits, one scale per label; trained by
:mod:`wirelessagent.language.training`. It knows kinds and topics of sentences, and no figure.
"""

from __future__ import annotations

import functools
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from wirelessagent.language.base_words import based
from wirelessagent.language.deferred import deferred
from wirelessagent.language.spelling import SOUND_OF
from wirelessagent.language.text import CJK, is_chinese, unaccented

MODEL_FILE = Path(__file__).with_name("model.npz")
BUCKETS = 1 << 16
_MAX_TOKENS = 120
_TOKEN = deferred(rf"@[a-z]+|[{CJK}]|(?:(?![{CJK}])[^\W_])+(?:'(?:(?![{CJK}])[^\W_])+)?|[?\uff1f]")


@dataclass(frozen=True, kw_only=True)
class LinearModel:
    """Weights (bucket, label) as int8, a scale and an intercept per label, and the words that are known."""

    labels: tuple[str, ...]
    weights: npt.NDArray[np.int8]
    scales: npt.NDArray[np.float32]
    intercepts: npt.NDArray[np.float32]
    known: frozenset[int]

    def familiarity(self, text: str) -> float:
        """The share of a sentence's words that the model was trained with; 0 for none at all."""
        words = word_hashes(text)
        return sum(word in self.known for word in words) / len(words) if words else 0.0

    def probabilities(self, text: str, concepts: Sequence[str] = (), language: str = "en") -> Mapping[str, float]:
        """How likely each label is for a sentence whose figures are placeholders."""
        found = buckets(text, concepts, language)
        score = self.intercepts + self.scales * self.weights[found].sum(axis=0, dtype=np.int32) / np.sqrt(len(found))
        likely = np.exp(score - score.max())
        likely /= likely.sum()
        return dict(zip(self.labels, likely.tolist(), strict=True))


@functools.cache
def shipped_model() -> LinearModel:
    """The model of this release."""
    with np.load(MODEL_FILE) as arrays:
        return LinearModel(
            labels=tuple(str(label) for label in arrays["labels"]),
            weights=arrays["weights"],
            scales=arrays["scales"],
            intercepts=arrays["intercepts"],
            known=frozenset(arrays["known"].tolist()),
        )


def buckets(text: str, concepts: Sequence[str] = (), language: str = "en") -> npt.NDArray[np.int64]:
    """The distinct buckets that a sentence falls into, ascending."""
    tokens = _tokens(text)
    found = {zlib.crc32(gram.encode("utf-8", "replace")) % BUCKETS for gram in _grams(tokens, concepts, language)}
    found = found.union(*map(_letter_buckets, set(tokens)))
    ascending = np.fromiter(found, dtype=np.int64, count=len(found))
    ascending.sort()
    return ascending


def word_hashes(text: str) -> list[int]:
    """The hashes of a sentence's words and Chinese characters, placeholders aside."""
    words = [token for token in _tokens(text) if token[0] not in "@?\uff1f"]
    return [zlib.crc32(word.encode("utf-8", "replace")) for word in words]


@functools.lru_cache(maxsize=16)
def _tokens(text: str) -> tuple[str, ...]:
    return tuple(match.group() for match in _TOKEN.finditer(unaccented(text.lower())))[:_MAX_TOKENS]


def _grams(tokens: Sequence[str], concepts: Sequence[str], language: str) -> Iterator[str]:
    yield from _runs(["<", *based(tokens, language), ">"], "WBST")
    padded = ["<", *tokens, ">"]
    yield from _runs(padded, "wbst")
    for place in range(len(padded) - 3):
        if is_chinese(padded[place]):
            yield f"q{''.join(padded[place : place + 4])}"
    heard = [SOUND_OF.get(token, token) for token in tokens if is_chinese(token)]
    for place in range(len(heard) - 1):
        yield f"h{heard[place]}{heard[place + 1]}"
        if place + 2 < len(heard):
            yield f"i{heard[place]}{heard[place + 1]}{heard[place + 2]}"
    for place, concept in enumerate(concepts):
        yield "C" + concept
        for other in concepts[place + 1 : place + 3]:
            yield f"D{concept} {other}"


@functools.lru_cache(maxsize=4096)
def _letter_buckets(token: str) -> frozenset[int]:
    """The buckets of three to five letters within a word; none of a short word, of a placeholder or of Chinese."""
    if len(token) <= 3 or not token.isalpha() or is_chinese(token):
        return frozenset()
    word = f"^{token[:20]}$"
    grams = ["c" + word[start : start + size] for size in (3, 4, 5) for start in range(len(word) - size + 1)]
    return frozenset(zlib.crc32(gram.encode("utf-8", "replace")) % BUCKETS for gram in grams)


def _runs(words: Sequence[str], marks: str) -> Iterator[str]:
    """Words alone, two side by side, two with one between, and three, each behind its mark."""
    one, two, skip, three = marks
    for place, word in enumerate(words):
        yield one + word
        if place + 1 < len(words):
            yield f"{two}{word} {words[place + 1]}"
        if place + 2 < len(words):
            yield f"{skip}{word} _ {words[place + 2]}"
            yield f"{three}{word} {words[place + 1]} {words[place + 2]}"
