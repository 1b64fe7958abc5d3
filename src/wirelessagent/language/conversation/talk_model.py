"""The model of talks: how likely a line means each of the changes that are possible, or two or three of them together.

A log-linear model weighs no change at all, each change (:mod:`.changes`), and those that go together, by their signs
(:mod:`.signs`); trained by :mod:`wirelessagent.language.training.talks`.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from wirelessagent.language.acts import Act, Undo
from wirelessagent.language.conversation.anchors import Anchor
from wirelessagent.language.conversation.possible import Change, Effect
from wirelessagent.language.conversation.signs import Signs, block_places, place_of

TALKS_FILE = Path(__file__).parent.parent / "talks.npz"
BLOCK, OWN = 1.0, 0.25
"""What a sign counts: one of all the words beside what is done (over the root of how many they are), and one alone."""

_IN_PAIRS, _IN_THREES = 10, 6


@dataclass(frozen=True, kw_only=True)
class Meaning:
    """What a line may mean: no change, one, or several together, as places among those that are possible.

    Such changes may be ``supposed``; the last place says so.
    """

    places: tuple[int, ...]
    effect: Effect
    supposed: bool = False


@dataclass(frozen=True, kw_only=True)
class TalkModel:
    """Weights of signs, as int8 with their ``scale``, and of what changes are together."""

    weights: npt.NDArray[np.int8]
    scale: float
    together: npt.NDArray[np.float32]

    @classmethod
    def load(cls, path: Path) -> TalkModel:
        with np.load(path) as arrays:
            return cls(weights=arrays["weights"], scale=float(arrays["scale"]), together=arrays["together"])

    def save(self, path: Path) -> None:
        np.savez_compressed(path, weights=self.weights, scale=self.scale, together=self.together)

    def scores(self, signs: Signs, changes: Sequence[Change]) -> npt.NDArray[np.float64]:
        """How strongly the signs speak for each change."""
        blocks: dict[str, float] = {}
        found = np.zeros(len(changes))
        for place, change in enumerate(changes):
            for name, words in signs.blocks(change):
                if name not in blocks:
                    total = self.weights[block_places(name, words)].sum(dtype=np.int64)
                    blocks[name] = BLOCK * float(total) / max(len(words), 1) ** 0.5
                found[place] += blocks[name]
            own = [place_of(sign) for sign in signs.own(change)]
            found[place] += OWN * float(self.weights[own].sum(dtype=np.int64))
        return found * self.scale


Said: TypeAlias = tuple[bool, Effect]
"""Whether something is only supposed, and what it comes to."""
NOTHING: Said = (False, frozenset())


@dataclass(frozen=True, kw_only=True)
class Weighed:
    """What a line means likeliest.

    Attributes:
        acts: what it does or supposes; nothing where it changes nothing.
        said: what that comes to.
        shares: how likely each is.
        used: the figures and users of the line that it is about.
    """

    acts: tuple[Act, ...]
    said: Said
    shares: dict[Said, float]
    used: frozenset[Anchor]

    @property
    def share(self) -> float:
        """How likely it is."""
        return self.shares[self.said]


def meanings(
    changes: Sequence[Change], scores: Sequence[float] | npt.NDArray[np.float32] | npt.NDArray[np.float64]
) -> list[Meaning]:
    """No change, each one, those that score best together, and all this as suppositions, which the last one marks."""
    mark = len(changes) - 1
    found = [Meaning(places=(place,), effect=changes[place].effect) for place in range(mark)]
    best = dict[Effect, int]()
    for place in sorted(range(mark), key=lambda place: -scores[place]):
        if changes[place].effect and not any(isinstance(act, Undo) for act in changes[place].acts):
            best.setdefault(changes[place].effect, place)
    likely = list(best.values())[:_IN_PAIRS]
    pairs = {pair for pair in itertools.combinations(likely, 2) if _go_together(changes[pair[0]], changes[pair[1]])}
    threes = [three for three in itertools.combinations(likely[:_IN_THREES], 3)
              if {*itertools.combinations(three, 2)} <= pairs]  # fmt: skip
    for places in (*sorted(pairs), *threes):
        effect = frozenset(item for place in places for item in changes[place].effect)
        found.append(Meaning(places=places, effect=effect))
    supposed = [Meaning(places=(*each.places, mark), effect=each.effect, supposed=True) for each in found
                if not any(isinstance(act, Undo) for place in each.places for act in changes[place].acts)]  # fmt: skip
    return [Meaning(places=(), effect=frozenset()), *found, *supposed]


def _go_together(one: Change, other: Change) -> bool:
    """Whether two changes are of different figures, and of different things that hold."""
    apart = not {key for key, _ in one.effect} & {key for key, _ in other.effect}
    return apart and (one.figure is None or one.figure is not other.figure)


def weigh(signs: Signs, model: TalkModel | None = None) -> Weighed:
    """What a line means likeliest, by the model of this release or another one."""
    model, changes = model or shipped_talk_model(), signs.changes()
    scores, together = model.scores(signs, changes), signs.together
    found = meanings(changes, scores)
    total = np.array([
        sum(scores[place] for place in each.places)
        + model.together[together.signs([changes[place] for place in each.places], each.effect)].sum()
        for each in found
    ])  # fmt: skip
    likely = np.exp(total - total.max())
    likely /= likely.sum()
    shares = dict[Said, float]()
    for each, share in zip(found, likely.tolist(), strict=True):
        shares[each.supposed, each.effect] = shares.get((each.supposed, each.effect), 0.0) + share
    said = max(shares, key=lambda each: shares[each])
    alike = {at: likely[at] for at, each in enumerate(found) if said[1] and (each.supposed, each.effect) == said}
    ways = {at: [changes[place] for place in found[at].places] for at in alike}
    plainest = sorted(ways, key=lambda at: signs.plainness(ways[at], alike[at]), reverse=True)
    in_order = (signs.in_order(ways[at]) for at in plainest)
    parts = next((way for way in in_order if way is not None), None) if said[1] else []
    if parts is None:  # one undoes what the other does
        said, parts = NOTHING, list[Change]()
    acts = tuple(act for change in parts for act in change.acts)
    used = set[Anchor | None]()
    for change in parts:  # all that the line names, where it is what its readers make of the whole line
        whole = change.form in ("read", "guessed")
        used.update(signs.anchors if whole else (change.figure, change.model, *change.users))
    return Weighed(acts=acts, said=said, shares=shares, used=frozenset(each for each in used if each is not None))


@functools.cache
def shipped_talk_model() -> TalkModel:
    """The model of this release."""
    return TalkModel.load(TALKS_FILE)
