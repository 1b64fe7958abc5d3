"""The small linear model: which label a sentence's n-grams speak for, as a probability.

A multinomial logistic regression with weights of eight bits, one scale per label; trained by
:mod:`wirelessagent.language.training`. It knows kinds and topics of sentences, and no figure.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from wirelessagent.language.features import buckets, word_hashes

MODEL_FILE = Path(__file__).with_name("model.npz")


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
