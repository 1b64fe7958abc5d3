"""The fit of a network: AdamW with a warm start and a cosine, words and features that are lost, averaged weights.

It needs JAX and Optax, which are in the development group alone.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

import jax as untyped_jax
import jax.numpy as untyped_jnp
import numpy as np
import numpy.typing as npt
import optax as untyped_optax  # pyright: ignore[reportMissingTypeStubs]

from wirelessagent.language.sentence_model import (
    ANSWERS,
    BLOCKS,
    BUCKETS,
    EMBEDDED,
    HEADS,
    MOST_FEATURES,
    REACH,
    WIDTH,
    embedded,
    scores,
)

jax, jnp, optax = cast("Any", untyped_jax), cast("Any", untyped_jnp), cast("Any", untyped_optax)

PASSES = 8.0
BATCH, LENGTHS = 128, (8, 12, 16, 20, 26, 34, 48, 80)
"""Sentences read at once, all of at most so many words and the mark of their start."""

_PEAK, _LAST, _WARM, _DECAY, _CLIP, _FORGETS = 3e-3, 5e-5, 200, 0.02, 1.0, 0.998
_LOST, _LOST_FEATURES, _LOST_WORDS, _LOSING, _BARE = 0.1, 0.08, 0.2, 0.25, 0.2
"""What is lost of what is seen; of the features of words; of the words of some sentences, and of how many; and how
often a wish is left with what it means alone, which then says nothing about its kind."""
_FAITHFUL = 2.0
"""What it counts whether a sentence says what was read of it. One word turns it round: where some may be lost, nothing
is learned of that, and where something is, no feature is lost."""

_SMOOTH = 0.01
_LOG = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class Shown:
    """What sentences show.

    Attributes:
        rows: of each, the features of its words (word, MOST_FEATURES).
        bare: the same with what is left of a wish.
        known: (sentence, any) what is right, and how much that counts, by name.
        turns: (sentence,) in what share of the passes it is read.
    """

    rows: Sequence[npt.NDArray[np.uint16]]
    bare: Sequence[npt.NDArray[np.uint16]]
    known: Mapping[str, npt.NDArray[Any]]
    turns: npt.NDArray[np.float64]


def fit(shown: Shown, kinds: int, passes: float = PASSES, seed: int = 1) -> dict[str, npt.NDArray[np.float32]]:
    """The weights that make what is shown likely, for so many kinds: the same for the same on one machine."""
    chance = np.random.default_rng(seed)
    steps = int(passes * (shown.turns.sum() / BATCH + len(LENGTHS) / 2)) + 1
    rate = optax.warmup_cosine_decay_schedule(0.0, _PEAK, min(_WARM, steps // 10 + 1), steps + 1, _LAST)
    optimiser = optax.chain(optax.clip_by_global_norm(_CLIP), optax.adamw(rate, b2=0.98, weight_decay=_DECAY))
    weights = jax.tree.map(jnp.asarray, _first_weights(chance, kinds))
    state, mean, key = optimiser.init(weights), weights, jax.random.PRNGKey(seed)

    @jax.jit
    def step(weights: Any, state: Any, mean: Any, batch: Any, key: Any, done: Any) -> tuple[Any, Any, Any, Any]:
        keys = iter(jax.random.split(key, 32))

        def lose(seen: Any) -> Any:
            return jnp.where(jax.random.bernoulli(next(keys), 1 - _LOST, seen.shape), seen / (1 - _LOST), 0)

        lost, slope = jax.value_and_grad(loss)(weights, batch, lose)
        change, state = optimiser.update(slope, state, weights)
        weights = optax.apply_updates(weights, change)
        kept = jnp.minimum(_FORGETS, done / (done + 20.0))

        def averaged(one: Any, other: Any) -> Any:
            return one * kept + other * (1 - kept)

        return weights, state, jax.tree.map(averaged, mean, weights), lost

    done, start, lost = 0, time.perf_counter(), list[Any]()
    while done < steps:
        for batch in _batches(shown, chance):
            key, own = jax.random.split(key)
            weights, state, mean, each = step(weights, state, mean, batch, own, float(done))
            lost, done = [*lost[-99:], each], done + 1
            if done >= steps:
                break
        _LOG.info("step %d of %d, loss %.3f (%.0f s)", done, steps, float(sum(lost)) / len(lost),
                  time.perf_counter() - start)  # fmt: skip
    return {name: np.asarray(each) for name, each in mean.items()}


def _drawn(chance: np.random.Generator, *shape: int, gain: float = 1.0) -> npt.NDArray[np.float32]:
    """A matrix to begin with."""
    return (chance.standard_normal(shape) * gain / np.sqrt(np.prod(shape[:-1]))).astype(np.float32)


def _first_weights(chance: np.random.Generator, kinds: int) -> dict[str, npt.NDArray[np.float32]]:
    """Where a training begins, for so many kinds."""
    weights: dict[str, npt.NDArray[np.float32]] = {
        "embedding": (chance.standard_normal((BUCKETS, EMBEDDED)) * 0.1).astype(np.float32),
        "in": _drawn(chance, EMBEDDED, WIDTH),
    }
    for block in map(str, range(BLOCKS)):
        weights |= {
            block + "near": _drawn(chance, 3 * WIDTH, 2 * WIDTH), block + "sought": _drawn(chance, WIDTH, 3 * WIDTH),
            block + "found": _drawn(chance, WIDTH, WIDTH, gain=0.5),
            block + "far": np.zeros((HEADS, 2 * REACH + 1), np.float32),
            block + "up": _drawn(chance, WIDTH, 2 * WIDTH), block + "down": _drawn(chance, 2 * WIDTH, WIDTH, gain=0.5),
        }  # fmt: skip
        weights |= {f"{block}norm{place}": np.ones(WIDTH, np.float32) for place in range(3)}
    weights["norm"] = np.ones(WIDTH, np.float32)
    for name, labels in zip(ANSWERS, (kinds, 1, 1), strict=True):
        weights |= {
            name + "pool": _drawn(chance, WIDTH, HEADS), name: _drawn(chance, WIDTH * (HEADS + 1), labels, gain=0.5),
            name + "bias": np.zeros(labels, np.float32),
        }  # fmt: skip
    return weights


def loss(weights: Any, batch: Mapping[str, Any], lose: Callable[[Any], Any]) -> Any:
    """Of the kind of a sentence, whether it orders something, and whether it says what was read of it."""
    sentences, length = batch["there"].shape
    words = embedded(jnp, weights, batch["rows"].reshape(-1, MOST_FEATURES)).reshape(sentences, length, -1)
    kinds, order, faithful = scores(jnp, weights, words, batch["there"], lose)
    likely = jax.nn.log_softmax(kinds)
    right = jax.nn.logsumexp(jnp.where(batch["right"], likely, -1e9), -1)
    of_kind = ((1 - _SMOOTH) * right + _SMOOTH * likely.mean(-1)) @ batch["kind_counts"]
    of_order, of_faithful = (
        optax.sigmoid_binary_cross_entropy(score[..., 0], batch[name] * 0.98 + 0.01) @ batch[f"{name}_counts"]
        for name, score in (("order", order), ("faithful", faithful))
    )
    return (of_order + _FAITHFUL * of_faithful - of_kind) / sentences


def _batches(shown: Shown, chance: np.random.Generator) -> Iterator[Mapping[str, Any]]:
    """One pass over the sentences whose turn it is, in batches of about equal length."""
    turn = np.flatnonzero(chance.random(len(shown.turns)) < shown.turns)
    chance.shuffle(turn)
    sizes = np.array([len(shown.rows[each]) for each in list[int](turn.tolist())])
    fits = np.searchsorted(LENGTHS, sizes)
    groups = [(length, turn[fits == place]) for place, length in enumerate(LENGTHS)]
    full = [(length, np.resize(group, -(-len(group) // BATCH) * BATCH)) for length, group in groups]
    batches: list[tuple[int, npt.NDArray[np.int64]]] = [
        (length, group[at : at + BATCH]) for length, group in full for at in range(0, len(group), BATCH)
    ]
    order: list[int] = chance.permutation(len(batches)).tolist()
    for place in order:
        length, chosen = batches[place]
        rows = np.zeros((BATCH, length, MOST_FEATURES), np.int32)
        there = np.zeros((BATCH, length), np.float32)
        bare, loses = chance.random(BATCH) < _BARE, chance.random(BATCH) < _LOSING
        for at, sentence in enumerate(list[int](chosen.tolist())):
            seen = (shown.bare if bare[at] else shown.rows)[sentence]
            seen = seen[np.append(True, chance.random(len(seen) - 1) >= _LOST_WORDS * loses[at])]
            rows[at, : len(seen)], there[at, : len(seen)] = seen, 1
        known = {name: each[chosen] for name, each in shown.known.items()}
        known["kind_counts"] = known["kind_counts"] * ~bare
        known["faithful_counts"] = known["faithful_counts"] * ~(bare | loses)
        kept = chance.random(rows.shape, np.float32) >= _LOST_FEATURES
        rows *= kept | (known["faithful_counts"] > 0)[:, None, None]
        yield {"rows": rows, "there": there, **known}
