"""Which of the changes that a line of a talk may mean it does mean, and how surely.

A log-linear model weighs no change at all, each change that is possible (:mod:`.changes`), and two or three of them
together, by their signs (:mod:`.signs`); trained by :mod:`wirelessagent.language.training.talks`. What the readers of
sentences make of the line is a sign among others.
"""

from __future__ import annotations

import dataclasses
import functools
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from wirelessagent.language.acts import Act, Aim, Suppose, Undo
from wirelessagent.language.conversation.anchors import Anchored
from wirelessagent.language.conversation.changes import Change, Effect, Possible
from wirelessagent.language.conversation.line import NAME, Line
from wirelessagent.language.conversation.signs import Read, Signs, block_places, place_of
from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import NAME as OFFLINE
from wirelessagent.language.recogniser import Context
from wirelessagent.language.request import changed, constraints_of

TALKS_FILE = Path(__file__).parent.parent / "talks.npz"
BLOCK, OWN = 1.0, 0.25
"""What a sign counts: one of all the words beside what is done (over the root of how many they are), and one alone."""

SURE, SURER, AGREED, LIKELY = 0.6, 0.95, 0.25, 0.3
"""From where on a line does what it likeliest means, from where on if that leaves out a figure, from where on what its
readers make of it, and from where on it is asked whether it does."""

UNLIKELY = 0.25
"""How likely a frame is one of an order, below which a line does nothing that its readers don't hear."""

_FACTS = frozenset({
    "not_promised", "no_limit_of_its_own", "nothing_left_of_it", "served_already", "all_served", "who_is_back",
    "negated", "refused", "no_rate_to_change", "not_understood",
})  # fmt: skip
"""Questions back that tell what holds or what was heard, and that no other reading answers."""

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


@dataclass(frozen=True, kw_only=True)
class Weighed:
    """What a line means likeliest.

    Attributes:
        acts: what it does or supposes; nothing where it changes nothing.
        said: what that comes to.
        shares: how likely each is.
        whole: whether each new figure of the line says something of it.
    """

    acts: tuple[Act, ...]
    said: Said
    shares: dict[Said, float]
    whole: bool

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
    alike = [place for place, each in enumerate(found) if (each.supposed, each.effect) == said]
    best = max(alike, key=lambda place: signs.plainness([changes[one] for one in found[place].places], likely[place]))
    parts = sorted((changes[place] for place in found[best].places if said[1]), key=_start)
    acts = tuple(act for change in parts for act in change.acts)
    used = {anchor for change in parts for anchor in (change.figure, change.model, *change.users)}
    whole = signs.new_figures <= used or any(change.is_of_readers for change in parts)
    return Weighed(acts=acts, said=said, shares=shares, whole=whole)


def _start(change: Change) -> int:
    """Where a change is said first; what has no figure and names no users is said ahead."""
    return min((anchor.start for anchor in (*change.users, change.figure) if anchor is not None), default=-1)


def weighed(line: Line, intent: Intent) -> Intent:
    """What a line means behind a request: what its readers make of it, or what it means surely instead.

    What nobody is sure of is asked about, with the likeliest meaning for a plain yes.
    """
    context = line.context
    if context.objective is None or _stands(intent, context):
        return intent
    language = line.voice.language
    possible = Possible(Anchored.of(line.text, language, context.user_names), context)
    read = Read.of(line, intent, possible)
    if read.rests:
        return intent
    found = weigh(Signs(line, possible, read, language))
    heard: Said = (read.supposes and bool(read.effect), read.effect or frozenset())
    share = found.shares.get(heard, 0.0)
    if share >= AGREED or found.said == heard:
        return intent
    if not found.acts:
        return asking_whether(line, intent) if read.effect and not read.supposes else intent
    meant = _done(line, possible, found)
    if found.said[0]:  # nothing is done
        return meant if found.whole and found.share > (LIKELY if intent.kind == "question" else SURE) else intent
    aims = any(isinstance(act, Aim) for act in found.acts)
    sure = SURE if found.whole and not (aims or read.effect) else SURER
    if found.share >= sure and read.order >= UNLIKELY and intent.guess is None and intent.offered is None:
        return meant
    if read.effect:  # readers and weights are of two minds
        return asking_whether(line, meant if found.share > share else intent)
    likelier = found.share > max(LIKELY, found.shares.get((False, read.guess or frozenset()), 0.0))
    return asking_whether(line, meant) if intent.kind == "clarify" and likelier else intent


def _stands(intent: Intent, context: Context) -> bool:
    """Whether what is read of a line is not weighed.

    That is a line of closed words, a request with its aim, a command, what names a method, a question of a certain
    thing, what a language model read, and what has to be asked about whatever the line may mean.
    """
    meant = intent.guess or intent
    whole = meant.kind == "allocate" and "objective" in meant.evidence
    another = intent.recogniser not in (OFFLINE, NAME)
    if another or whole or "method" in intent.details or intent.asks in _FACTS:
        return True
    if intent.kind == "question":
        return bool(intent.details) or intent.topic not in ("other", "what_if")
    if intent.kind == "clarify":
        return context.awaits == "clarification"
    return intent.recogniser == NAME or (intent.kind == "command" and intent.topic != "undo")


def _done(line: Line, possible: Possible, found: Weighed) -> Intent:
    """The intent of what is meant, with what it changes in words."""
    acts = found.acts
    if found.said[0]:
        return dataclasses.replace(line.question("what_if"), acts=(Suppose(acts=acts),))
    undone = next((act for act in acts if isinstance(act, Undo)), None)
    if undone is not None and len(acts) == 1:
        return line.command("undo", steps=float(undone.steps or 1))
    intent, before = line.changed_by(acts), possible.figures
    after = changed(before, acts)
    stated = constraints_of({key: figure for key, figure in after.items() if before.get(key) != figure})
    gone = dict.fromkeys(kind for kind, user in before if (kind, user) not in after)
    aims = [line.voice.label(act.objective) for act in acts if isinstance(act, Aim)]
    said = ", ".join([*aims, line.voice.amended(stated, tuple(gone))])
    return dataclasses.replace(intent, reply=said.strip(", "))


def asking_whether(line: Line, guess: Intent) -> Intent:
    """The question whether an intent is meant."""
    said = guess.reply.rstrip(" .。")
    question = line.ask("no_order", guess=said[:1].lower() + said[1:])
    return dataclasses.replace(question, guess=guess)


@functools.cache
def shipped_talk_model() -> TalkModel:
    """The model of this release."""
    return TalkModel.load(TALKS_FILE)
