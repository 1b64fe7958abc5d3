"""Make the model of talks anew: ``python -m wirelessagent.language.training.talks [FILE]``.

It takes twenty minutes on two cores, and 18 GB of memory.
It learns from ``talks/*.txt``: talks line by line, each with what it does to the request, in a notation of a few words
(``limit min_rate_bps 300000 @4``). Each line is put into its conversation as it would be with all lines before it
understood, and each change that it may mean is labelled by whether it comes to what the line does.
"""

from __future__ import annotations

import dataclasses
import itertools
import logging
import math
import multiprocessing
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy import optimize, sparse

from wirelessagent.language.acts import (
    Act,
    Aim,
    Drop,
    Everybody,
    LeaveOut,
    Limit,
    Named,
    Others,
    Scale,
    Serve,
    Suppose,
    Undo,
    Whom,
)
from wirelessagent.language.conversation import read_by_rules
from wirelessagent.language.conversation.anchors import Anchored
from wirelessagent.language.conversation.change import Change
from wirelessagent.language.conversation.effects import Effect, effect_between
from wirelessagent.language.conversation.heard import Read
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.conversation.possible import Possible
from wirelessagent.language.conversation.signs import (
    BUCKETS,
    TOGETHER,
    Signs,
    Together,
    block_places,
    place_of,
)
from wirelessagent.language.conversation.talk_model import BLOCK, OWN, TALKS_FILE, Meaning, TalkModel, meanings
from wirelessagent.language.conversation.users_said import dropped
from wirelessagent.language.intent import CONSTRAINTS, EVERYBODY, FIGURES_OF_USERS
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context
from wirelessagent.language.request import Key, Request, applied, figures_of
from wirelessagent.language.sentence import BUILT_IN
from wirelessagent.language.training.fit import rounded

TALKS = Path(__file__).with_name("talks")
USERS = tuple(f"user {number}" for number in range(1, 9))
_NUMBERS = tuple(str(number) for number in range(1, len(USERS) + 1))
_MAX_POWER_W, _RADIATED_W = 20.0, 5.0
_DIGITS = 1e-3
_RIDGE, _STEPS, _ROUNDS, _FAINT = 3e-6, 90, 2, 1
_SOMETHING: tuple[Act, ...] = (Serve(whom=Everybody()),)
_LOG = logging.getLogger(__name__)
_CHANGING = (Aim, Limit, Scale, Drop, Serve, LeaveOut)


class NotationError(ValueError):
    """What a line does is not written as it should be, or cannot be done to what holds."""


@dataclass(frozen=True, kw_only=True)
class Example:
    """A line in its conversation, and what it comes to.

    Attributes:
        effect: what it does to the request, or would do where it is only ``supposed``.
        may_suppose: whether one that does nothing may suppose something that is not written down.
    """

    text: str
    context: Context
    effect: Effect
    supposed: bool
    may_suppose: bool
    language: str


@dataclass
class _Talk:
    """A talk as far as it has come, with everything that was said understood."""

    language: str
    request: Request | None = None
    past: list[Request | None] = field(default_factory=list[Request | None])
    acts: tuple[Act, ...] = ()
    earlier: list[tuple[Act, ...]] = field(default_factory=list[tuple[Act, ...]])
    spoken_of: tuple[str, ...] = ()
    named: tuple[str, ...] = ()
    waiting: list[Act] = field(default_factory=list[Act])
    supposed: tuple[Act, ...] = ()
    may_suppose: bool = True

    @property
    def context(self) -> Context:
        assert self.request is not None
        return Context(
            user_names=USERS, max_power_w=_MAX_POWER_W, objective=self.request.objective,
            constraints=self.request.constraints, earlier=tuple(self.earlier), past=tuple(self.past),
            acts=(Suppose(acts=self.supposed),) if self.supposed else self.acts,
            spoken_of=self.spoken_of, language=self.language,
        )  # fmt: skip

    def say(self, text: str, notation: str) -> Example | None:
        """Take a line; the example that it is, where something was asked for before it."""
        context = None if self.request is None else self.context
        supposed = notation.startswith("suppose ")
        before, after, acts = self.request, *self._done(notation.replace("suppose ", ""))
        acts = [dataclasses.replace(act, words=text) if isinstance(act, Limit) else act for act in acts]
        example = None
        if context is not None:
            effect = effect_between(before, after, _NUMBERS)
            example = Example(
                text=text, context=context, effect=effect, language=self.language, supposed=supposed,
                may_suppose=self.may_suppose and not effect,
            )  # fmt: skip
        self.supposed = tuple(acts) if supposed else ()
        self._took(text, () if supposed else acts, before if supposed else after, supposes=supposed)
        return example

    def _done(self, notation: str) -> tuple[Request | None, list[Act]]:
        """What holds after a line, and its acts."""
        now, acts = self.request, list[Act]()
        parts = [part.split() for part in notation.split(";") if part.strip()]
        for words in sorted(parts, key=lambda words: words[0] not in ("aim", "undo")):
            if words[0] in ("nothing", "ask"):
                continue
            if words[0] == "undo":
                steps = int(words[1]) if len(words) > 1 else 1
                if not 0 < steps <= len(self.past):
                    raise NotationError(f"{notation}: nothing to undo")
                now, said = self.past[-steps], [Undo(steps=steps)]
            else:
                said = self._acts(words, now)
                now = now and applied(now, said, radiated_w=_RADIATED_W)[0]
            acts += said
        if self.request is None and not any(isinstance(act, Aim) for act in acts):
            self.waiting += acts  # limits before an aim are asked about, and kept
        elif self.request is None:
            now, _ = applied(None, [*acts, *self.waiting])
            self.waiting.clear()
        return now, acts

    def _acts(self, words: Sequence[str], now: Request | None) -> Sequence[Act]:
        """The acts of one part of a notation."""
        verb, *rest = words
        whom = _whom(rest[-1] if rest and rest[-1][0] == "@" else "")
        figures = {} if now is None else figures_of(now.constraints)
        if verb == "aim" and rest[0] in BUILT_IN:
            return [Aim(objective=rest[0])]
        if verb in ("out", "in", "only", "allin"):
            users = Named(_listed(",".join(rest)))
            return {"out": [LeaveOut(whom=users)], "in": [Serve(whom=users)], "only": [Serve(whom=users, alone=True)],
                    "allin": [Serve(whom=Everybody())]}[verb]  # fmt: skip
        if verb not in ("limit", "scale", "add", "drop", "dropown", "swap") or rest[0] not in CONSTRAINTS:
            raise NotationError(" ".join(words))
        kind = rest[0]
        whom = whom if kind in FIGURES_OF_USERS else Everybody()
        own = {user: value for (name, user), value in figures.items() if name == kind}
        if verb in ("drop", "dropown"):
            if not own:
                raise NotationError(f"{' '.join(words)}: no such limit holds")
            if verb == "dropown":
                return [Drop(kind=kind, whom=whom, own=True)]
            if isinstance(whom, Named):
                return dropped(kind, whom, figures, _NUMBERS)
            return [Drop(kind=kind, whom=whom, own=isinstance(whom, Others))]
        if verb == "swap":
            one, other = (Named((user,)) for user in whom.users) if isinstance(whom, Named) else (None, None)
            if one is None or other is None:
                raise NotationError(" ".join(words))
            first, second = (own.get(each.users[0], own.get(EVERYBODY, 0.0)) for each in (one, other))
            return [Limit(kind=kind, value=second, whom=one), Limit(kind=kind, value=first, whom=other)]
        figure = float(rest[1].replace("_", ""))
        if isinstance(whom, Others) and verb == "limit" and not own.keys() - {EVERYBODY}:
            whom = Named(tuple(user for user in _NUMBERS if user not in self.named))
        if verb == "limit":
            return [Limit(kind=kind, value=figure, whom=whom)]
        if kind == "max_power_w" and not own:
            own = {EVERYBODY: _MAX_POWER_W}
        return [*_scaled(kind, figure, whom, own, adds=verb == "add")]

    def _took(self, text: str, acts: Sequence[Act], after: Request | None, *, supposes: bool) -> None:
        """Remember a line that was understood."""
        found = Anchored.of(text, self.language, USERS).named(len(USERS))
        changing = [act for act in acts if isinstance(act, _CHANGING)]
        self.spoken_of = found if found or changing or supposes else self.spoken_of
        by_name = [user for act in acts if isinstance(whom := getattr(act, "whom", None), Named) for user in whom.users]
        self.named = tuple(dict.fromkeys(by_name)) or found or self.named
        steps = sum(act.steps or 1 for act in acts if isinstance(act, Undo))
        if steps:
            base = self.past[-steps]
            del self.past[-steps:]
            if after != base:
                self.past.append(base)
        elif acts and self.request != after:
            self.past.append(self.request)
        self.acts = tuple(acts) if changing else self.acts
        self.earlier.append(tuple(acts))
        self.request = after


def _whom(words: str) -> Whom:
    """For whom: "@3,5", "@4-6", "@others", "@all"."""
    if words in ("", "@all"):
        return Everybody()
    if words == "@others":
        return Others()
    return Named(_listed(words))


def _listed(words: str) -> tuple[str, ...]:
    """The users of a list: "3,5", "@4-6"."""
    users = list[str]()
    for part in filter(None, re.split(r"[@,\s]+", words)):
        first, _, last = part.partition("-")
        users += [str(user) for user in range(int(first), int(last or first) + 1)]
    return tuple(users)


def _scaled(kind: str, figure: float, whom: Whom, own: Mapping[str, float], *, adds: bool) -> Iterator[Act]:
    """What holds, multiplied by a figure or with it added."""
    whose: Mapping[str, Whom] = {user: Others() if user == EVERYBODY and len(own) > 1 else Everybody()
                                 if user == EVERYBODY else Named((user,)) for user in own}  # fmt: skip
    if isinstance(whom, Named):
        whose = {user: Named((user,)) for user in whom.users}
    elif isinstance(whom, Others):
        whose = {EVERYBODY: whom}
    for user, each in whose.items():
        held = own.get(user, own.get(EVERYBODY))
        if held is None:
            raise NotationError(f"{kind}: nothing holds for {user}")
        yield Limit(kind=kind, value=held + figure if adds else held * figure, whom=each)


def talks(folder: Path = TALKS) -> Iterator[tuple[str, list[tuple[str, str]], bool]]:
    """The talks: of each its language, its lines with what they do, and whether what is supposed is not written down.

    It is in the files that have suppositions at all.
    """
    for path in sorted(folder.glob("*.txt")):
        written = path.read_text("utf-8").strip()
        for block in re.split(r"\n\s*\n", written):
            head, *lines = block.splitlines()
            said = [line.rsplit("=>", 1) for line in lines if "=>" in line]
            listed = [(text.strip(), notation.strip()) for text, notation in said]
            yield head.strip("# ")[:2], listed, "=> suppose" not in written


def examples(folder: Path = TALKS) -> Iterator[Example]:
    """Each line behind a request; a line whose notation can't be done to what holds is left out."""
    for language, lines, may_suppose in talks(folder):
        talk = _Talk(language=language, may_suppose=may_suppose)
        for text, notation in lines:
            try:
                example = talk.say(text, notation)
            except (ValueError, KeyError, IndexError):
                continue
            if example is not None:
                yield example


@dataclass(frozen=True, kw_only=True)
class Parsed:
    """An example as numbers.

    Attributes:
        changes: that the line may mean.
        own: of each change the buckets of its own signs.
        blocks: the buckets of each block, once.
        blocks_of: of each change which blocks it has.
        together: what changes together are judged by.
        effect, supposed, may_suppose: of the example.
    """

    changes: tuple[Change, ...]
    own: tuple[npt.NDArray[np.int32], ...]
    blocks: tuple[npt.NDArray[np.int32], ...]
    blocks_of: tuple[tuple[int, ...], ...]
    together: Together
    effect: Effect
    supposed: bool
    may_suppose: bool

    def is_meant(self, meaning: Meaning) -> bool:
        """Whether a meaning is what the line comes to."""
        if self.may_suppose and meaning.supposed:
            return True
        return meaning.supposed == self.supposed and is_same(meaning.effect, self.effect)


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
    """Everything that a line may mean, with its signs."""
    line = Line.of(example.text, example.context)
    possible = Possible(Anchored.of(example.text, example.language, USERS), example.context)
    read = Read.of(line, read_by_rules(example.text, example.context, OfflineRecogniser()), possible)
    signs = Signs(line, possible, read, example.language)
    changes = tuple(signs.changes())
    named = [signs.blocks(change) for change in changes]
    blocks = {name: words for each in named for name, words in each}
    places = {name: place for place, name in enumerate(blocks)}
    return Parsed(
        changes=_light(changes), together=signs.together, effect=example.effect, supposed=example.supposed,
        may_suppose=example.may_suppose,
        own=tuple(np.array([place_of(sign) for sign in signs.own(change)], dtype=np.int32) for change in changes),
        blocks=tuple(block_places(name, words).astype(np.int32) for name, words in blocks.items()),
        blocks_of=tuple(tuple(places[name] for name, _ in each) for each in named),
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


def _parsed_at(place: int) -> Parsed:
    return parsed(_EXAMPLES[place])


def parsed_all(found: Sequence[Example], processes: int = 2) -> list[Parsed]:
    """All examples as numbers."""
    _EXAMPLES[:] = found
    with multiprocessing.get_context("fork").Pool(processes) as pool:
        return pool.map(_parsed_at, range(len(found)), chunksize=20)


def _rows(columns: Sequence[npt.NDArray[np.int32]], values: Sequence[float]) -> sparse.csr_matrix:
    """(row, bucket) with one value in each row."""
    sizes = np.array([len(each) for each in columns])
    starts = np.concatenate([[0], np.cumsum(sizes)])
    filled = np.repeat(np.array(values, dtype=np.float32), sizes)
    return sparse.csr_matrix((filled, np.concatenate(columns), starts), shape=(len(columns), BUCKETS))


class Scored:
    """The scores of all changes as a linear map of the weights."""

    def __init__(self, said: Sequence[Parsed]) -> None:
        self.starts = np.cumsum([0, *(len(each.changes) for each in said)])
        first = np.cumsum([0, *(len(each.blocks) for each in said)])
        blocks = [block for each in said for block in each.blocks]
        self._blocks = _rows(blocks, [BLOCK / max(len(block), 1) ** 0.5 for block in blocks])
        of = [[int(first[line]) + place for place in places] for line, each in enumerate(said)
              for places in each.blocks_of]  # fmt: skip
        ends = np.cumsum([0, *map(len, of)])
        flat = np.fromiter(itertools.chain.from_iterable(of), dtype=np.int64)
        self._has = sparse.csr_matrix((np.ones(len(flat), np.float32), flat, ends), shape=(len(of), len(blocks)))
        own = [each for line in said for each in line.own]
        self._own = _rows(own, [OWN] * len(own))
        self._back = [matrix.T.tocsr() for matrix in (self._blocks, self._has, self._own)]

    def of(self, weights: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """The score of each change."""
        return np.asarray(self._has @ (self._blocks @ weights) + self._own @ weights)

    def back(self, slope: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """What each weight adds to a sum of scores that are multiplied by a slope."""
        blocks, has, own = self._back
        return np.asarray(blocks @ (has @ slope) + own @ slope)


def fit(
    said: Sequence[Parsed], scored: Scored, weights: npt.NDArray[np.float32], together: npt.NDArray[np.float32],
    *, ridge: float = _RIDGE, steps: int = _STEPS,
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:  # fmt: skip
    """Better weights than these: those by which what lines come to is likeliest."""
    scores, members, lines, right, signs = (
        scored.of(weights),
        list[list[int]](),
        list[int](),
        list[bool](),
        list[list[int]](),
    )
    begins = list[int]()
    for line, each in enumerate(said):
        first = int(scored.starts[line])
        found = meanings(each.changes, scores[first : int(scored.starts[line + 1])])
        if not any(map(each.is_meant, found)):
            continue
        begins.append(len(members))
        for meaning in found:
            members.append([first + place for place in meaning.places])
            lines.append(len(begins) - 1)
            right.append(each.is_meant(meaning))
            signs.append(each.together.signs([each.changes[place] for place in meaning.places], meaning.effect))
    sums, of_signs = _incidence(members, len(scores)), _incidence(signs, TOGETHER)
    back_sums, back_signs = sums.T.tocsr(), of_signs.T.tocsr()
    line_of, is_right = np.array(lines), np.array(right)

    def loss(flat: npt.NDArray[np.float64]) -> tuple[float, npt.NDArray[np.float64]]:
        own, joint = flat[:BUCKETS].astype(np.float32), flat[BUCKETS:].astype(np.float32)
        total = np.asarray(sums @ scored.of(own) + of_signs @ joint, dtype=np.float64)
        likely = np.exp(total - np.maximum.reduceat(total, begins)[line_of])
        likely /= np.add.reduceat(likely, begins)[line_of]
        share = np.add.reduceat(likely * is_right, begins) + 1e-30
        slope = ((likely - likely * is_right / share[line_of]) / len(begins)).astype(np.float32)
        down = np.concatenate([scored.back(np.asarray(back_sums @ slope)), np.asarray(back_signs @ slope)])
        slopes = down.astype(np.float64) + 2 * ridge * flat
        return -float(np.log(share).mean()) + ridge * float(flat @ flat), slopes

    start = np.concatenate([weights, together]).astype(np.float64)
    found = optimize.minimize(loss, start, jac=True, method="L-BFGS-B", options={"maxiter": steps, "maxcor": 6})
    best = np.asarray(found.x, dtype=np.float64)
    _LOG.info("%d of %d lines, loss %.3f", len(begins), len(said), loss(best)[0])
    return best[:BUCKETS].astype(np.float32), best[BUCKETS:].astype(np.float32)


def _incidence(rows: Sequence[Sequence[int]], width: int) -> sparse.csr_matrix:
    ends = np.cumsum([0, *map(len, rows)])
    flat = np.fromiter(itertools.chain.from_iterable(rows), dtype=np.int64)
    return sparse.csr_matrix((np.ones(len(flat), np.float32), flat, ends), shape=(len(rows), width))


def trained(said: Sequence[Parsed]) -> TalkModel:
    """The model that a few rounds make: in each, changes go together that scored best in the one before."""
    scored = Scored(said)
    weights, together = np.zeros(BUCKETS, np.float32), np.zeros(TOGETHER, np.float32)
    for _ in range(_ROUNDS):
        weights, together = fit(said, scored, weights, together)
    found, scales = rounded(weights[:, None], _FAINT)
    return TalkModel(weights=found[:, 0], scale=float(scales[0]), together=together)


def main(path: Path) -> None:
    """Read, fit, write."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    said = parsed_all(list(examples()))
    model = trained(said)
    model.save(path)
    _LOG.info("%s: %d kB", path.name, path.stat().st_size // 1000)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else TALKS_FILE)
