"""Make the model of talks anew: ``python -m wirelessagent.language.training.talks [FILE]``.

It learns from ``talks/*.txt``: talks line by line, each with what it does to the request (:mod:`.talk_notation`). Each
change that a line may mean is labelled by whether it comes to what the line does (:mod:`.talk_fit`).
"""

from __future__ import annotations

import dataclasses
import functools
import logging
import math
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from wirelessagent.language.acts import Act, Everybody, Serve, Undo
from wirelessagent.language.conversation import read_by_rules
from wirelessagent.language.conversation.anchors import Anchored
from wirelessagent.language.conversation.change import Change
from wirelessagent.language.conversation.heard import Read
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.conversation.possible import Effect, Possible
from wirelessagent.language.conversation.signs import Signs, block_places, place_of
from wirelessagent.language.conversation.talk_model import TALKS_FILE, Meaning
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.request import Key
from wirelessagent.language.training import talk_fit
from wirelessagent.language.training.fit import in_parallel
from wirelessagent.language.training.talk_fit import Flat
from wirelessagent.language.training.talk_notation import USERS, Example, examples

_DIGITS = 1e-3
_SOMETHING: tuple[Act, ...] = (Serve(whom=Everybody()),)
_LOG = logging.getLogger(__name__)


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


def parsed(example: Example) -> talk_fit.Line:
    """Everything that a line may mean, as numbers."""
    line = Line.of(example.text, example.context)
    possible = Possible(Anchored.of(example.text, example.language, USERS), example.context)
    read = Read.of(line, read_by_rules(example.text, example.context, OfflineRecogniser()), possible)
    signs = Signs(line, possible, read, example.language)
    changes = tuple(signs.changes())
    named = [signs.blocks(change) for change in changes]
    blocks = {name: words for each in named for name, words in each}
    places = {name: place for place, name in enumerate(blocks)}
    undoing = frozenset(at for at, each in enumerate(changes) if any(isinstance(act, Undo) for act in each.acts))
    is_meant = functools.partial(
        _is_meant, example.effect, undoing, undoes=example.undoes, supposed=example.supposed,
        may_suppose=example.may_suppose,
    )  # fmt: skip
    return talk_fit.Line(
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
        found.append(dataclasses.replace(change, acts=acts, effect=effects[effect], users=(), model=None))
    return tuple(found)


_EXAMPLES = list[Example]()


def _parsed_at(place: int) -> talk_fit.Line:
    return parsed(_EXAMPLES[place])


def parsed_all(found: Sequence[Example], processes: int = 2) -> list[talk_fit.Line]:
    """All examples as numbers."""
    _EXAMPLES[:] = found
    return in_parallel(_parsed_at, range(len(found)), processes, at_once=20)


def main(path: Path) -> None:
    """Read, fit, write."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    start = time.perf_counter()
    lines = parsed_all(list(examples()))
    _LOG.info("%d lines (%.0f s)", len(lines), time.perf_counter() - start)
    talk_fit.trained(lines).save(path)
    _LOG.info("%s: %d kB (%.0f s)", path.name, path.stat().st_size // 1000, time.perf_counter() - start)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else TALKS_FILE)
