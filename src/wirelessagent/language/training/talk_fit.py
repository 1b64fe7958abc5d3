"""The fit of the model of talks: its likelihood, line after line, by adaptive gradient steps (Duchi et al. 2011).

A line says which changes it may mean and by which buckets each is weighed; what it means is one of the changes or a few
of them together, and the weights move so that the right ones become likelier. Everything lies flat in arrays, and a
pass over millions of changes takes seconds. The order of the lines is drawn with a fixed seed: equal talks make equal
weights.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from wirelessagent.kernels.supply import foreground
from wirelessagent.language.conversation.change import Change
from wirelessagent.language.conversation.signs import BUCKETS, TOGETHER, Together
from wirelessagent.language.conversation.talk_model import BLOCK, OWN, Meaning, TalkModel, meanings
from wirelessagent.language.training.fit import rounded
from wirelessagent.language.training.fit_kernel import Places
from wirelessagent.language.training.talk_fit_kernel import one_pass, scores_of

_PASSES, _STEP, _FAINT = (2, 4), 0.5, 1
"""Passes of each round, in which those changes may go together that scored best before it; the size of a step; weights
of so many 127ths of the largest are none."""
_EPSILON = 1.0
"""What is seen seldom moves its weights less; so much tells lines of other authors best."""
_LOG = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class Flat:
    """Sequences of numbers as one array; that at ``place`` is ``values[starts[place]:starts[place + 1]]``."""

    values: Places
    starts: Places

    @classmethod
    def of(cls, each: Iterable[Places | Sequence[int]]) -> Flat:
        parts = [np.array(one, dtype=np.int32) for one in each]
        starts = np.cumsum([0, *map(len, parts)])
        values = np.concatenate([np.zeros(0, np.int32), *parts])
        return cls(values=values, starts=starts)

    @classmethod
    def joined(cls, flats: Sequence[Flat]) -> Flat:
        """One after the other."""
        sizes = [np.diff(flat.starts) for flat in flats]
        starts = np.concatenate([np.zeros(1, np.int64), np.cumsum(np.concatenate(sizes))])
        return cls(values=np.concatenate([flat.values for flat in flats]), starts=starts)

    def __len__(self) -> int:
        return len(self.starts) - 1


@dataclass(frozen=True, kw_only=True)
class Line:
    """What a line may mean, as numbers.

    Attributes:
        changes: that the line may mean.
        own: of each change the buckets of its own signs.
        blocks: the buckets of each block.
        blocks_of: of each change which blocks it has.
        together: what changes together are judged by.
        is_meant: whether a meaning is right.
    """

    changes: tuple[Change, ...]
    own: Flat
    blocks: Flat
    blocks_of: Flat
    together: Together
    is_meant: Callable[[Meaning], bool]


@foreground()
def trained(lines: Sequence[Line], passes: Sequence[int] = _PASSES, step: float = _STEP) -> TalkModel:
    """The model that a few rounds make: in each, changes go together that scored best in the one before."""
    own, blocks, blocks_of = (Flat.joined([getattr(line, name) for line in lines])
                              for name in ("own", "blocks", "blocks_of"))  # fmt: skip
    changes_at = np.cumsum([0, *(len(line.changes) for line in lines)], dtype=np.int64)
    blocks_at = np.cumsum([0, *(len(line.blocks) for line in lines)], dtype=np.int64)
    weights, squares = np.zeros(BUCKETS, np.float32), np.full(BUCKETS, _EPSILON, np.float32)
    joint, joint_squares = np.zeros(TOGETHER, np.float32), np.full(TOGETHER, _EPSILON, np.float32)
    slopes, mean, chance = np.zeros(BUCKETS, np.float32), np.zeros(BUCKETS, np.float32), np.random.default_rng(1)
    seen = (changes_at, own.values, own.starts, blocks_at, blocks.values, blocks.starts, blocks_of.values,
            blocks_of.starts, OWN, BLOCK)  # fmt: skip
    for turn, count in enumerate(passes):
        scores = np.concatenate([scores_of(line, *seen, weights) for line in range(len(lines))])
        learnt, said = _meant(lines, scores, changes_at)
        for _ in range(count):
            loss = one_pass(
                chance.permutation(learnt), *seen, *said, weights, squares, joint, joint_squares, slopes, step
            )
            _LOG.info("%d of %d lines, loss %.3f", len(learnt), len(lines), loss / len(learnt))
            if turn == len(passes) - 1:
                mean += weights / count
    found, scales = rounded(mean[:, None], _FAINT)
    return TalkModel(weights=found[:, 0], scale=float(scales[0]), together=joint)


def _meant(lines: Sequence[Line], scores: npt.NDArray[np.float32], changes_at: npt.NDArray[np.int64]) -> tuple[
    npt.NDArray[np.int64], tuple[Places, Places, Places, Places, Places, npt.NDArray[np.bool_]]
]:  # fmt: skip
    """Which lines can be learnt from, and what each line may mean: places, signs, and whether it is right."""
    found = [_meant_by(line, scores[changes_at[at] : changes_at[at + 1]]) for at, line in enumerate(lines)]
    places, signs = Flat.joined([each[0] for each in found]), Flat.joined([each[1] for each in found])
    right = np.concatenate([each[2] for each in found])
    counts = np.cumsum([0, *(len(each[2]) for each in found)], dtype=np.int64)
    learnt = np.array([at for at, each in enumerate(found) if each[2].any()])
    return learnt, (counts, places.values, places.starts, signs.values, signs.starts, right)


def _meant_by(line: Line, scores: npt.NDArray[np.float32]) -> tuple[Flat, Flat, npt.NDArray[np.bool_]]:
    """What a line may mean: places of changes, signs of those together, and whether it is right."""
    found = meanings(line.changes, scores)
    signs = [line.together.signs([line.changes[place] for place in each.places], each.effect) for each in found]
    return Flat.of([each.places for each in found]), Flat.of(signs), np.array([line.is_meant(each) for each in found])
