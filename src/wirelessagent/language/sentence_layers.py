"""The network that judges sentences, in NumPy and, for its training, in ``jax.numpy``.

A word is the sum of what its features are embedded as. Each block lets a word see its neighbours (a gated convolution),
every other word (attention, with a bias for how far away it is), and itself. Of what is seen then a pool for each
question reads the answer: the kind of the sentence, whether it orders something, whether it says what was read of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any

import numpy as np

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
