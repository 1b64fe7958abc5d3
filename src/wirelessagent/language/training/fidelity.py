"""Teach what judges readings anew: ``python -m wirelessagent.language.training.fidelity [FILE]``; ten minutes.

It learns from all that people wrote down (:mod:`.spoken`): a sentence whose meaning was read of it is faithful, one of
which something else was read is not, nor is one that has to be asked about. Of what orders nothing others judge
(:mod:`.orders`). Words are seen as the network of sentences sees them, which has to be taught before. It needs JAX and
Optax, of the development group.
"""

from __future__ import annotations

import dataclasses
import functools
import logging
import math
import random
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple, cast

import numpy as np

from wirelessagent.language.fidelity import FIDELITY_FILE, Fidelity, seen_of
from wirelessagent.language.intent import EVERYBODY
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.sentence_layers import EMBEDDED, WIDTH
from wirelessagent.language.sentence_model import Word, shipped_sentences
from wirelessagent.language.training.compose import mistyped
from wirelessagent.language.training.fit import in_parallel
from wirelessagent.language.training.network import LENGTHS, Shown, drawn, first_head, fit, loss_of_fidelity
from wirelessagent.language.training.spoken import Spoken, spoken

PASSES, _SLIPS = 8.0, 0.15
"""How often the sentences are read, and how much of what has a meaning is read with a slip as well."""

_CLOSE = 1e-4
_LOG = logging.getLogger(__name__)


class Judged(NamedTuple):
    """The words of a sentence, and whether it says what was read of it."""

    words: list[Word]
    faithful: bool


def judged(each: Spoken) -> Judged | None:
    """What a sentence teaches; None where the reader asks about it anyway, or nobody knows."""
    sentence = Sentence(each.text, own_words())
    reading, words = sentence.reading, sentence.words[: LENGTHS[-1]]
    if reading.doubts or reading.strangers:
        return None
    if each.constraints is None:
        return Judged(words, faithful=False) if each.label == "clarify" else None
    return Judged(words, are_equal(reading.values, each.constraints))


def are_equal(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Whether constraints are the same: a rate of everybody who is served is one of each of them."""
    return one.keys() == other.keys() and all(_is_same(_spread(one, name), _spread(other, name)) for name in one)


def _spread(constraints: Mapping[str, Any], name: str) -> Any:
    value = constraints[name]
    if isinstance(value, Mapping):
        return {str(user): float(each) for user, each in cast("Mapping[str, float]", value).items()}
    if name in ("min_rate_bps", "max_rate_bps"):
        return dict.fromkeys(map(str, constraints.get("users", ())), float(value)) or {EVERYBODY: float(value)}
    return value if isinstance(value, int | float) else sorted(map(str, value))


def _is_same(one: Any, other: Any) -> bool:
    if isinstance(one, dict) and isinstance(other, dict):
        mine, theirs = cast("dict[str, float]", one), cast("dict[str, float]", other)
        return mine.keys() == theirs.keys() and all(_is_same(mine[user], theirs[user]) for user in mine)
    if isinstance(one, int | float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=_CLOSE)
    return bool(one == other)


def taught(passes: float = PASSES, processes: int = 2) -> Fidelity:
    """What judges readings, taught by what people wrote down."""
    slips, said = random.Random(1), list(spoken())
    chosen = [each for each in said if each.constraints is not None and slips.random() < _SLIPS]
    said += [dataclasses.replace(each, text=mistyped(each.text, slips)) for each in chosen]
    every = [each for each in in_parallel(judged, said, processes) if each is not None]
    roles = tuple(sorted({word.role for each in every for word in each.words} - {""}))
    _LOG.info("%d sentences, %d faithful; %d roles", len(every), sum(each.faithful for each in every), len(roles))
    weights = fit(Shown(
        rows=[seen_of(each.words, roles) for each in every],
        known={"faithful": np.array([each.faithful for each in every], np.float32)},
        turns=np.ones(len(every)),
        lost_words=0.0,  # one word turns a sentence round
    ), functools.partial(_first_weights, roles=len(roles)), loss_of_fidelity, passes)  # fmt: skip
    return Fidelity(roles=roles, weights=weights)


def _first_weights(chance: np.random.Generator, roles: int) -> dict[str, Any]:
    """Those of the network of sentences, with some for the roles, and a head of their own."""
    weights = dict(shipped_sentences().weights)
    own = {name: each for name, each in weights.items() if name[0].isdigit() or name in ("in", "norm")}
    own["in"] = np.concatenate([own["in"], drawn(chance, roles, WIDTH) * EMBEDDED**-0.5])
    return own | first_head(chance, "faithful", 1)


def main(path: Path) -> None:
    """Read, teach, write."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    start = time.perf_counter()
    taught().save(path)
    _LOG.info("%s: %d kB (%.0f s)", path.name, path.stat().st_size // 1000, time.perf_counter() - start)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FIDELITY_FILE)
