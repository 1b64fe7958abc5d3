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
    """Weights (bucket, label) as int8, a scale and an intercept per label, and the words that are known.

    The last column is no label's: it says whether a sentence orders something now.
    """

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
        score = self._scores(text, concepts, language)[:-1]
        likely = np.exp(score - score.max())
        likely /= likely.sum()
        return dict(zip(self.labels, likely.tolist(), strict=True))

    def is_order(self, text: str, concepts: Sequence[str] = (), language: str = "en") -> float:
        """How likely a sentence orders something now, and does not only tell, ask or wonder.

        Its concepts have the classes of mood among them (:func:`.moods.classes_in`).
        """
        return float(1 / (1 + np.exp(-self._scores(text, concepts, language)[-1])))

    def _scores(self, text: str, concepts: Sequence[str], language: str) -> npt.NDArray[np.float64]:
        found = buckets(text, concepts, language)
        return self.intercepts + self.scales * self.weights[found].sum(axis=0, dtype=np.int32) / np.sqrt(len(found))


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
