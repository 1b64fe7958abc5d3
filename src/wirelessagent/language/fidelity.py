"""Whether a sentence says what was read of it: of one that is ordered, what the guard asks last.

Every figure and user may have been read, and the sentence may yet mean something else: "ignore the 10 W limit", "all
but users 5 and 6 are out". A small network judges it, which sees words as the other one does (:mod:`.sentence_model`),
and beside each figure and user what that was read as. Trained by :mod:`wirelessagent.language.training.fidelity`.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from wirelessagent.language.sentence_model import Word, scored, shipped_sentences, stored, weights_in

FIDELITY_FILE = Path(__file__).with_name("fidelity.npz")
_MOST_WORDS, _LEVELS = 120, 31
"""Words that are read, and levels of a weight on either side of zero: 6 bits judge as well as 8, in less."""


def seen_of(words: Sequence[Word], roles: Sequence[str]) -> npt.NDArray[np.float32]:
    """(word, EMBEDDED + role) of a sentence: its words as the other network sees them, and 1 for the role of each."""
    role = np.array([[word.role == each for each in roles] for word in words], np.float32).reshape(len(words), -1)
    return np.concatenate([shipped_sentences().seen(words), role], axis=1)


@dataclass(frozen=True, kw_only=True)
class Fidelity:
    """The network's weights, and the roles of figures and users that it tells apart."""

    roles: tuple[str, ...]
    weights: Mapping[str, npt.NDArray[Any]]

    @classmethod
    def load(cls, path: Path) -> Fidelity:
        with np.load(path) as arrays:
            held = dict[str, npt.NDArray[Any]](arrays)
        return cls(roles=tuple(map(str, held.pop("roles"))), weights=weights_in(held))

    def save(self, path: Path) -> None:
        np.savez_compressed(path, allow_pickle=False, roles=np.array(self.roles), **stored(self.weights, _LEVELS))

    def chance(self, words: Sequence[Word]) -> float:
        """How likely a sentence of these words orders what was read of it, and nothing beside."""
        (((score,),),) = scored(self.weights, seen_of(words[:_MOST_WORDS], self.roles), ("faithful",))
        return 0.5 + 0.5 * math.tanh(float(score) / 2)


@functools.cache
def shipped_fidelity() -> Fidelity:
    """The model of this release."""
    return Fidelity.load(FIDELITY_FILE)
