"""Make the model of talks anew: ``python -m wirelessagent.language.training.talks [FILE]``.

It learns from ``talks/*.txt``: talks line by line, each with what it does to the request (:mod:`.talk_notation`). A
line may mean one of some changes, or a few of them together; each is labelled by whether it comes to what the line
does.

The fit raises the likelihood, line after line, by adaptive gradient steps (Duchi et al. 2011): a line says by which
buckets each of its changes is weighed, and the weights move so that the right ones become likelier. Everything lies
flat in arrays, and a pass over millions of changes takes seconds. The order of the lines is drawn with a fixed seed:
equal talks make equal weights.
"""

from __future__ import annotations

import dataclasses
import functools
import logging
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from wirelessagent.kernels.supply import foreground
from wirelessagent.language.acts import Act, Everybody, Serve, Undo
from wirelessagent.language.conversation import read_by_rules
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.conversation.possible import Change, Effect, Possible
from wirelessagent.language.conversation.signs import BUCKETS, TOGETHER, Read, Signs, Together, block_places, place_of
from wirelessagent.language.conversation.weighing import BLOCK, OWN, TALKS_FILE, Meaning, TalkModel, meanings
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.request import Key
from wirelessagent.language.training.fit import in_parallel, rounded, write
from wirelessagent.language.training.fit_kernel import Places, one_pass_of_talks, scores_of
from wirelessagent.language.training.talk_notation import Example, examples

_PASSES, _STEP, _FAINT = (2, 4), 0.5, 1
"""Passes of each round, in which those changes may go together that scored best before it; the size of a step; weights
of so many 127ths of the largest are none."""
_EPSILON = 1.0
"""What is seen seldom moves its weights less; so much tells lines of other authors best."""
_DIGITS = 1e-3
_SOMETHING: tuple[Act, ...] = (Serve(whom=Everybody()),)
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
class Parsed:
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


def _is_meant(
    effect: Effect, undoing: frozenset[int], meaning: Meaning, *, undoes: bool, supposed: bool, may_suppose: bool
) -> bool:
    """Whether a meaning is what a line comes to, and takes changes back if that does."""
    if may_suppose and meaning.supposed:
        return True
    same = meaning.supposed == supposed and is_same(meaning.effect, effect)
    return same and (not effect or undoes != undoing.isdisjoint(meaning.places))


def is_same(one: Effect, other: Effect) -> bool:
    """Whether two effects are the same, but for the digits of a third."""
    if len(one) != len(other):
        return False
    known = dict(other)
    return one == other or all(
        key in known and (value == known[key] or (isinstance(value, float) and isinstance(other_ := known[key], float)
                          and math.isclose(value, other_, rel_tol=_DIGITS)))
        for key, value in one
    )  # fmt: skip


def parsed(example: Example) -> Parsed:
    """Everything that a line may mean, as numbers."""
    line = Line.of(example.text, example.context)
    possible = Possible(line.anchored, example.context)
    read = Read.of(read_by_rules(example.text, example.context, OfflineRecogniser()), possible)
    signs = Signs(line, possible, read, line.voice.language)
    changes = tuple(signs.changes())
    named = [signs.blocks(change) for change in changes]
    blocks = {name: words for each in named for name, words in each}
    places = {name: place for place, name in enumerate(blocks)}
    undoing = frozenset(at for at, each in enumerate(changes) if any(isinstance(act, Undo) for act in each.acts))
    is_meant = functools.partial(
        _is_meant, example.effect, undoing, undoes=example.undoes, supposed=example.supposed,
        may_suppose=example.may_suppose,
    )  # fmt: skip
    return Parsed(
        changes=_light(changes), together=signs.together, is_meant=is_meant,
        own=Flat.of([place_of(sign) for sign in signs.own(change)] for change in changes),
        blocks=Flat.of(block_places(name, words).astype(np.int32) for name, words in blocks.items()),
        blocks_of=Flat.of([places[name] for name, _ in each] for each in named),
    )  # fmt: skip


def _light(changes: Sequence[Change]) -> tuple[Change, ...]:
    """Changes with no more than their weighing asks for, so that millions of them fit into memory."""
    items, effects = dict[object, tuple[Key, float | str | None]](), dict[Effect, Effect]()
    found = list[Change]()
    for change in changes:
        effect = change.effect
        if effect not in effects:
            effects[effect] = frozenset(items.setdefault(item, item) for item in effect)
        acts = change.acts if any(isinstance(act, Undo) for act in change.acts) else _SOMETHING[: len(change.acts)]
        found.append(dataclasses.replace(change, acts=acts, effect=effects[effect]))
    return tuple(found)


@foreground()
def trained(lines: Sequence[Parsed]) -> TalkModel:
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
    for turn, count in enumerate(_PASSES):
        scores = np.concatenate([scores_of(line, *seen, weights) for line in range(len(lines))])
        learnt, said = _meant(lines, scores, changes_at)
        for _ in range(count):
            order = chance.permutation(learnt)
            loss = one_pass_of_talks(order, *seen, *said, weights, squares, joint, joint_squares, slopes, _STEP)
            _LOG.info("%d of %d lines, loss %.3f", len(learnt), len(lines), loss / len(learnt))
            if turn == len(_PASSES) - 1:
                mean += weights / count
    found, scale = rounded(mean, _FAINT)
    return TalkModel(weights=found, scale=float(scale), together=joint)


def _meant(lines: Sequence[Parsed], scores: npt.NDArray[np.float32], changes_at: npt.NDArray[np.int64]) -> tuple[
    npt.NDArray[np.int64], tuple[Places, Places, Places, Places, Places, npt.NDArray[np.bool_]]
]:  # fmt: skip
    """Which lines can be learnt from, and what each line may mean: places, signs, and whether it is right."""
    found = [_meant_by(line, scores[changes_at[at] : changes_at[at + 1]]) for at, line in enumerate(lines)]
    places, signs = Flat.joined([each[0] for each in found]), Flat.joined([each[1] for each in found])
    right = np.concatenate([each[2] for each in found])
    counts = np.cumsum([0, *(len(each[2]) for each in found)], dtype=np.int64)
    learnt = np.array([at for at, each in enumerate(found) if each[2].any()])
    return learnt, (counts, places.values, places.starts, signs.values, signs.starts, right)


def _meant_by(line: Parsed, scores: npt.NDArray[np.float32]) -> tuple[Flat, Flat, npt.NDArray[np.bool_]]:
    """What a line may mean: places of changes, signs of those together, and whether it is right."""
    found = meanings(line.changes, scores)
    signs = [line.together.signs([line.changes[place] for place in each.places], each.effect) for each in found]
    return Flat.of([each.places for each in found]), Flat.of(signs), np.array([line.is_meant(each) for each in found])


if __name__ == "__main__":
    write(TALKS_FILE, lambda path: trained(in_parallel(parsed, list(examples()), at_once=20)).save(path))
