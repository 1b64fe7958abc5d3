"""What speaks for or against a change that a line may mean: hashed signs of the line, of the talk, and of both.

Words of the line stand beside what the change does, of which limit and for whom; so do the words around its figure and
its users, what was said last, and what the readers of sentences make of the line.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from wirelessagent.language.acts import Act, Aim, Suppose, Undo
from wirelessagent.language.conversation.anchors import Anchor
from wirelessagent.language.conversation.changes import changes_of
from wirelessagent.language.conversation.line import NAME, Line
from wirelessagent.language.conversation.possible import Change, Effect, Possible
from wirelessagent.language.figure_roles import answers
from wirelessagent.language.intent import RATES, Intent, acts_of, stated
from wirelessagent.language.moods import classes_in
from wirelessagent.language.number_roles import first_look
from wirelessagent.language.request import changed
from wirelessagent.language.sentence import BUILT_IN
from wirelessagent.language.text import hashed, overlaps
from wirelessagent.language.vocabulary import aligned, based


@dataclass(frozen=True, kw_only=True)
class Read:
    """What the readers of sentences make of a line.

    Attributes:
        kind: of their intent; ``topic`` is who read it, and what it is about or what it asks.
        acts, guessed: what they would do, or suppose, and what they ask whether to do.
        effect, guess: what that comes to; None for nothing.
    """

    kind: str
    topic: str
    acts: tuple[Act, ...]
    guessed: tuple[Act, ...]
    effect: Effect | None
    guess: Effect | None

    @classmethod
    def of(cls, intent: Intent, possible: Possible) -> Read:
        """What an intent does to what holds."""
        acts, guessed = _changing(intent), _guessed(intent)
        return cls(
            kind=intent.kind, topic=f"{intent.recogniser == NAME}:{intent.asks or intent.topic or ''}", acts=acts,
            guessed=guessed, effect=_effect(acts, possible), guess=_effect(guessed, possible),
        )  # fmt: skip

    @property
    def supposes(self) -> bool:
        """Whether they would only suppose it."""
        return self.kind == "question"


def _roles(line: Line) -> dict[int, Mapping[str, float]]:
    """What the figures, the numbers and the users of a line are there for, each by where it stands."""
    look = first_look(line.sentence.plain, line.sentence.quantities, line.context.user_names)
    view, found = look.view(), dict[int, Mapping[str, float]]()
    for place, figure in enumerate(look.figures):
        found[figure.start] = answers(figure.kind, view.figure(place))
    for mention in look.mentions:
        if mention.role == "named":
            found[mention.start] = answers("user", view.user(mention))
    for number in look.loose:
        found[number.start] = answers("number", view.number(number, look.bound(number)))
    return found


def _changing(intent: Intent) -> tuple[Act, ...]:
    """What an intent does to the request, or supposes of it."""
    acts = acts_of(intent)
    if len(acts) == 1 and type(acts[0]) is Suppose and acts[0].missing_share is None:
        return acts[0].acts
    return acts if intent.kind == "allocate" or intent.topic == "undo" else ()


def _guessed(intent: Intent) -> tuple[Act, ...]:
    """What a question back has understood, or offers for a yes."""
    if intent.guess is not None:
        return _changing(intent.guess)
    aim = (Aim(objective=intent.offered),) if intent.offered in BUILT_IN else ()
    return (*aim, *stated(intent.pending)) if intent.kind == "clarify" else ()


def _effect(acts: Sequence[Act], possible: Possible) -> Effect | None:
    steps = [act.steps for act in acts if isinstance(act, Undo)]
    too_many = steps and not (steps[0] is not None and 0 < steps[0] <= len(possible.context.past))
    return None if too_many or not acts else possible.effect(acts)


BUCKETS = 1 << 20
Places = npt.NDArray[np.int64]

RELATIONS = ("none", "equal", "part", "more", "other", "apart", "nothing")
"""What a change is to what the readers of sentences make of the line."""
_KINDS = ("allocate", "command", "question", "clarify", "out_of_scope")
_STEPS = (0.02, 0.1, 0.3, 0.5, 0.7, 0.9)
_NEAR, _MOST = 3, 3
_LIKELY = 0.15
_SPREAD = np.uint32(2654435761)
TOGETHER = 64


@functools.lru_cache(maxsize=1 << 16)
def place_of(sign: str) -> int:
    return hashed(sign) % BUCKETS


def level(share: float) -> int:
    """A share in seven steps."""
    return sum(share >= step for step in _STEPS)


def _hashes(signs: Iterable[str]) -> npt.NDArray[np.uint32]:
    return np.unique(np.array([hashed(sign) for sign in signs], dtype=np.uint32))


def relation(effect: Effect, other: Effect | None) -> str:
    """What an effect is to another one, None for that of no change at all."""
    if not other:
        return "none" if effect else "equal"
    if not effect:
        return "nothing"
    if effect == other:
        return "equal"
    if effect < other or other < effect:
        return "part" if effect < other else "more"
    return "other" if {key for key, _ in effect} & {key for key, _ in other} else "apart"


SUPPOSED = Change(acts=(), effect=frozenset(), form="suppose")
"""That what a line names is only supposed."""


class Signs:
    """The signs of the changes that one line may mean."""

    def __init__(self, line: Line, possible: Possible, read: Read, language: str) -> None:
        self._line, self._possible, self._read, self.anchored = line, possible, read, possible.line
        self._order, self._kinds, self._roles = line.sentence.chances.order, line.sentence.chances.kinds, _roles(line)
        words = self.anchored.words
        bases = [f"B{word}" for word in based(words, language)]
        pairs = [f"{a} {b}" for a, b in itertools.pairwise(["<", *words, ">"])]
        pairs += [f"B{a} {b}" for a, b in itertools.pairwise(bases)]
        moods = [f"M{name}" for name, _ in classes_in(self.anchored.plain)]
        self._all = _hashes([*words, *bases, *pairs, *moods])
        self._single = _hashes([*words, *bases])
        self._whole = _hashes(self._of_line())
        self._padded = ["<"] * _NEAR + [*words] + [">"] * _NEAR
        self._bases = ["<"] * _NEAR + aligned(words, language) + [">"] * _NEAR
        acts = {f"{type(act).__name__}:{getattr(act, 'kind', '')}" for act in possible.context.acts}
        self._last = "+".join(sorted(acts))[:60]
        self._last_kinds = {getattr(act, "kind", "") for act in possible.context.acts}
        named = tuple(anchor for anchor in self.anchored.anchors if anchor.kind in ("users", "others", "everybody"))
        self.together = Together(figures=len(self.anchored.figures), named=named, read=read.effect, kind=read.kind)

    def plainness(self, changes: Sequence[Change], likely: float) -> tuple[bool, int, float]:
        """How plainly changes say what they come to: of those whom the line names, with few figures that change."""
        before = self._possible.figures
        after = changed(before, (act for each in changes for act in each.acts))
        written = sum(before.get(key) != after.get(key) for key in {*before, *after})
        is_said = not any(change.source.startswith(("not:", "alike:")) for change in changes)
        return is_said, -written - len(changes), likely

    def in_order(self, changes: Sequence[Change]) -> list[Change] | None:
        """Changes in an order in which they come to all that each comes to, as they are said if so; None for none."""
        effect = frozenset(item for change in changes for item in change.effect)
        orders = itertools.permutations(sorted(changes, key=_start))
        together = ((order, [act for change in order for act in change.acts]) for order in orders)
        return next(([*order] for order, acts in together if not acts or self._possible.effect(acts) == effect), None)

    def changes(self) -> list[Change]:
        """Each change that is possible, all that the readers take the line for, and last, that it is supposed."""
        read = self._read
        whole = [Change(acts=acts, effect=effect, form=form) for form, acts, effect
                 in (("read", read.acts, read.effect), ("guessed", read.guessed, read.guess)) if effect]  # fmt: skip
        return [*changes_of(self._possible), *whole, SUPPOSED]

    def _of_line(self) -> Iterator[str]:
        """What is said of a line as a whole."""
        kinds, order = self._kinds, level(self._order)
        asked = level(sum(share for kind, share in kinds.items() if kind.startswith(("question", "out_of_scope"))))
        yield f"asked:{self._line.is_asked}"
        yield from (f"q:{asked}", f"o:{order}", f"o:{order}:q:{asked}")
        yield f"top:{max(kinds, key=lambda kind: kinds[kind])}"
        yield f"length:{min(len(self.anchored.words) // 3, 8)}"
        yield f"aims:{level(max(kinds[aim] for aim in BUILT_IN))}"
        yield f"read:{self._read.kind}:{self._read.topic}"
        yield f"figures:{len(self.anchored.figures)}"
        yield "anchors:" + "+".join(anchor.kind for anchor in self.anchored.anchors)

    def blocks(self, change: Change) -> list[tuple[str, npt.NDArray[np.uint32]]]:
        """What a change does, coarse to fine, each beside the words of the line that speak of so much."""
        form, kind = change.form, f"{change.form}:{change.kind}"
        whole = f"{kind}:{change.source}"
        blocks = [(form, self._all), (kind, self._single), (whole, self._whole)]
        blocks += [(f"{form}@{change.source}", self._single)] if change.source else []
        ratio = None if change.figure is None else self._ratio(change)
        return blocks if ratio is None else [*blocks, (f"{'up' if ratio > 0 else 'down'}:{form}", self._single)]

    def _ratio(self, change: Change) -> float | None:
        """How many times two the first figure that changes becomes."""
        for key, after in sorted(change.effect, key=lambda item: item[0]):
            before = self._possible.before.get(key)
            if isinstance(after, float) and isinstance(before, float) and before > 0 and after > 0:
                return math.log2(after / before)
        return None

    def own(self, change: Change) -> Iterator[str]:
        """The signs of one change by itself."""
        form, kind = change.form, f"{change.form}:{change.kind}"
        whole, figure = f"{kind}:{change.source}", change.figure
        said = "-" if figure is None else figure.kind
        used = [(anchor.start, anchor.end) for anchor in (figure, *change.users) if anchor is not None]
        left = [anchor for anchor in self.anchored.anchors
                if anchor.kind != "pronoun" and not overlaps((anchor.start, anchor.end), used)]  # fmt: skip
        others = "+".join(sorted(anchor.kind for anchor in left))
        yield from (form, kind, whole, f"{whole}:{said}", f"left:{others}|{form}", f"left:{others}|{whole}")
        yield f"left:{len(left)}|{form}:{change.source}"
        yield from self._around_the_figure(change, form, kind, said)
        yield from self._around_the_users(change, form, kind)
        yield from self._by_roles(change, left, form, kind, whole)
        held, context = self._possible.before, self._possible.context
        users = {user for (_, user), _ in change.effect}
        yield f"users:{min(len(users), _MOST)}:{len(users) == len(self._possible.users)}|{form}:{change.source}"
        yield f"last:{self._last}|{kind}:{change.source}"
        yield f"same kind:{change.kind in self._last_kinds}|{form}:{change.source}:{said}"
        own = any(name == change.kind and user not in ("", "all") for name, user in held)
        yield f"held:{change.kind in context.constraints}:{own}|{kind}:{change.source}"
        yield f"out:{bool(self._possible.out)}|{form}:{change.source}"
        if any(self._is_of(anchor, change.kind) for anchor in left):
            yield from (f"old|{form}", f"old|{kind}")
        last_users = self._possible.last_users
        if any(anchor.whom and {*anchor.whom} <= last_users for anchor in left):  # "not 4, 5" behind what was said of 4
            yield from (f"last left|{form}", f"last left|{whole}")
        if change.is_supposition:
            yield f"supposes:{self._read.supposes}:{bool(self._read.effect)}"
        if form == "aim":
            share = self._kinds[change.kind]
            yield from (f"aim:{level(share)}", f"aim:{level(share)}:{level(self._order)}")
            yield f"aim first:{share == max(self._kinds[aim] for aim in BUILT_IN)}"
        for name, other in (("read", self._read.effect), ("guess", self._read.guess)):
            related = relation(change.effect, other)
            if name == "read" or other is not None:
                yield from (f"{name}:{related}", f"{name}:{related}|{form}", f"{name}:{related}|{whole}")
                yield f"{name}:{related}:{level(self._order)}"

    def _by_roles(self, change: Change, left: Sequence[Anchor], form: str, kind: str, whole: str) -> Iterator[str]:
        """What the model of roles makes of the figure and the users of a change, and of what it leaves."""
        named: list[tuple[str, Sequence[Anchor]]] = [
            ("figure", () if change.figure is None else (change.figure,)), ("users", change.users), ("left", left),
        ]  # fmt: skip
        for name, anchors in named:
            for anchor in anchors[:_MOST]:
                for role, share in self._roles.get(anchor.start, {}).items():
                    if share >= _LIKELY:
                        sign = f"{name}:{role}:{level(share)}"
                        yield from (f"{sign}|{form}", f"{sign}|{kind}")
                        if name != "left":
                            yield f"{sign}|{whole}"

    def _is_of(self, anchor: Anchor, kind: str) -> bool:
        """Whether a figure is one that holds of a kind, so that another may stand in its place."""
        if anchor.kind not in ("rate", "power", "number"):
            return False
        scales = (1.0, 1e3, 1e6) if anchor.kind == "number" and kind in RATES else (1.0,)
        held = [value for (name, _), value in self._possible.before.items() if name == kind]
        return any(
            isinstance(value, float) and math.isclose(anchor.value * scale, value, rel_tol=1e-5)
            for value in held for scale in scales
        )  # fmt: skip

    def _around_the_figure(self, change: Change, form: str, kind: str, said: str) -> Iterator[str]:
        figure = change.figure
        if figure is None or figure not in self.anchored.places:
            return
        place = self.anchored.places[figure]
        for step, word in self._beside(place, place):
            yield from (f"f{step}:{kind}|{word}", f"f{step}:{form}|{word}")
        padded, at = self._padded, place + _NEAR
        yield from (f"f=:{kind}|{padded[at - 1]} {padded[at + 1]}", f"f<:{kind}|{padded[at - 2]} {padded[at - 1]}")
        yield f"f>:{kind}|{padded[at + 1]} {padded[at + 2]}"
        ratio = self._ratio(change)
        if ratio is None:
            yield f"new|{kind}:{said}:{change.source}"
        else:
            steps = max(-10, min(10, round(2 * ratio)))
            yield from (f"by:{steps}|{kind}:{said}", f"by:{steps}|{form}")
        size = round(2 * math.log10(figure.value)) if figure.value > 0 else 0
        yield f"size:{size}|{kind}:{said}"

    def _around_the_users(self, change: Change, form: str, kind: str) -> Iterator[str]:
        places = [self.anchored.places[anchor] for anchor in change.users if anchor in self.anchored.places]
        if not places:
            return
        for step, word in self._beside(places[0], places[-1]):
            yield from (f"u{step}:{form}|{word}", f"u{step}:{kind}|{word}")
        yield f"u=:{form}|{self._padded[places[0] + _NEAR - 1]} {self._padded[places[-1] + _NEAR + 1]}"
        yield f"list:{'+'.join(anchor.kind for anchor in change.users[:_MOST])}|{form}"
        place = None if change.figure is None else self.anchored.places.get(change.figure)
        if place is None:
            return
        behind = places[-1] < place
        between = self.anchored.words[places[-1] + 1 : place] if behind else self.anchored.words[place + 1 : places[0]]
        side = "behind" if behind else "ahead"
        anchors = [word for word in between if word[0] == "@"]
        yield from (f"{side}:{min(len(between), 8)}|{form}", f"{side}:{len(anchors)}|{kind}")
        yield f"{side}:{'+'.join(anchors[:_MOST])}|{form}:{change.source}"
        for word in between[:8]:
            yield f"{side}:{form}|{word}"

    def _beside(self, first: int, last: int) -> Iterator[tuple[int, str]]:
        """The words next to what stands at some places and what they mean, with how far they are."""
        for step, place in ((side * away, end + _NEAR + side * away)
                            for away in range(1, _NEAR + 1) for side, end in ((-1, first), (1, last))):  # fmt: skip
            yield step, self._padded[place]
            if self._bases[place] != self._padded[place]:
                yield step, f"B{self._bases[place]}"


@dataclass(frozen=True, kw_only=True)
class Together:
    """What changes that a line may mean together are judged by.

    Attributes:
        figures: how many the line says.
        named: whoever it names.
        read: what the readers of sentences would do.
        kind: of what they take the line for.
    """

    figures: int
    named: tuple[Anchor, ...]
    read: Effect | None
    kind: str

    def signs(self, said: Sequence[Change], effect: Effect) -> list[int]:
        """The signs of changes together, each by its number below :data:`TOGETHER`."""
        changes = [change for change in said if not change.is_supposition]
        used = len({change.figure for change in changes if change.figure is not None})
        related, some = RELATIONS.index(relation(effect, self.read)), bool(changes)
        found = [
            related, 8 + min(len(changes), 3), 12 + min(self.figures - used, 3), 16 + 4 * some + min(self.figures, 3),
            24 + _KINDS.index(self.kind) + 6 * some,
        ]  # fmt: skip
        found += [36 + related] if len(changes) > 1 else []
        found += [60 + min(self._forgotten(changes), 3)] if some else []
        return found if len(said) == len(changes) else [*found, 44 + 8 * (self.kind == "question") + related]

    def _forgotten(self, changes: Sequence[Change]) -> int:
        """How many of those whom the line names changes are not for; what the readers hear is for all of them."""
        if any(change.form in ("read", "guessed") for change in changes):
            return 0
        meant = [anchor for change in changes for anchor in (*change.users, change.model) if anchor is not None]
        spans = [(anchor.start, anchor.end) for anchor in meant]
        return sum(not overlaps((anchor.start, anchor.end), spans) for anchor in self.named)


def _start(change: Change) -> int:
    """Where a change is said first; what has no figure and names no users is said ahead."""
    return min((anchor.start for anchor in (*change.users, change.figure) if anchor is not None), default=-1)


def block_places(name: str, words: npt.NDArray[np.uint32]) -> Places:
    """The buckets of what a change does beside each word."""
    seed = np.uint32(hashed(name))
    with np.errstate(over="ignore"):
        return np.asarray((seed * _SPREAD + words) % np.uint32(BUCKETS), dtype=np.int64)
