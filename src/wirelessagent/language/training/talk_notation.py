"""Talks line by line with what each does to the request, in a notation of a few words.

``limit min_rate_bps 300000 @4``, ``scale max_power_w 0.5``, ``suppose out 3``. Each line is put into its conversation
as it would be with all lines before it understood.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

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
from wirelessagent.language.conversation.anchors import Anchored
from wirelessagent.language.conversation.changes import dropped
from wirelessagent.language.conversation.possible import Effect, effect_between, spoken_of, users_of
from wirelessagent.language.intent import CONSTRAINTS, EVERYBODY, FIGURES_OF_USERS
from wirelessagent.language.recogniser import Context
from wirelessagent.language.request import Request, applied, figures_of
from wirelessagent.language.sentence import BUILT_IN

TALKS = Path(__file__).with_name("talks")
USERS = tuple(f"user {number}" for number in range(1, 9))
_NUMBERS = tuple(str(number) for number in range(1, len(USERS) + 1))
_MAX_POWER_W, _RADIATED_W = 20.0, 5.0
_CHANGING = (Aim, Limit, Scale, Drop, Serve, LeaveOut)


class NotationError(ValueError):
    """What a line does is not written as it should be, or cannot be done to what holds."""


@dataclass(frozen=True, kw_only=True)
class Example:
    """A line in its conversation, and what it comes to.

    Attributes:
        effect: what it does to the request, or would do where it is only ``supposed``.
        undoes: whether it takes changes back and does nothing else.
        may_suppose: whether one that does nothing may suppose something that is not written down.
    """

    text: str
    context: Context
    effect: Effect
    undoes: bool
    supposed: bool
    may_suppose: bool


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
                text=text, context=context, effect=effect, supposed=supposed,
                may_suppose=self.may_suppose and not effect, undoes=[type(act) for act in acts] == [Undo],
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
                said = self._acts(words, now, users_of(acts) or self.named)
                now = now and applied(now, said, radiated_w=_RADIATED_W)[0]
            acts += said
        if self.request is None and not any(isinstance(act, Aim) for act in acts):
            self.waiting += acts  # limits before an aim are asked about, and kept
        elif self.request is None:
            now, _ = applied(None, [*acts, *self.waiting])
            self.waiting.clear()
        return now, acts

    def _acts(self, words: Sequence[str], now: Request | None, named: Sequence[str]) -> Sequence[Act]:
        """The acts of one part of a notation; the others are those who are not ``named``."""
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
            first, second = (own.get(user, own.get(EVERYBODY, 0.0)) for (user,) in (one.users, other.users))
            return [Limit(kind=kind, value=second, whom=one), Limit(kind=kind, value=first, whom=other)]
        figure = float(rest[1].replace("_", ""))
        if isinstance(whom, Others) and verb == "limit" and not own.keys() - {EVERYBODY}:
            whom = Named(tuple(user for user in _NUMBERS if user not in named))
        if verb == "limit":
            return [Limit(kind=kind, value=figure, whom=whom)]
        if kind == "max_power_w" and not own:
            own = {EVERYBODY: _MAX_POWER_W}
        return [*_scaled(kind, figure, whom, own, adds=verb == "add")]

    def _took(self, text: str, acts: Sequence[Act], after: Request | None, *, supposes: bool) -> None:
        """Remember a line that was understood."""
        changing = any(isinstance(act, _CHANGING) for act in acts)
        found = spoken_of(Anchored.of(text, self.language, USERS), len(USERS), acts if changing or supposes else ())
        self.spoken_of = found if found or changing or supposes else self.spoken_of
        self.named = users_of(acts) or found or self.named
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
