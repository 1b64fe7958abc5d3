"""Everything that a line of a talk may change of what holds, by its figures, its users and what was said before.

Which of it the line means is weighed elsewhere (:mod:`.weighing`); nothing else can be meant, so that no line changes a
figure that neither it nor the talk says.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from wirelessagent.language.acts import (
    Act,
    Aim,
    Drop,
    Everybody,
    Forget,
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
from wirelessagent.language.conversation.anchors import Anchor, Anchored
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, LISTS_OF_USERS
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.recogniser import Context
from wirelessagent.language.request import Key, Request, acts_between, changed, figures_of, numbered, with_the_assumed
from wirelessagent.language.sentence import BUILT_IN
from wirelessagent.model.units import human

Effect: TypeAlias = frozenset[tuple[Key, float | str | None]]
"""What holds after a change and did not before, by kind and user; None for what holds no longer."""

RATES, POWERS = ("min_rate_bps", "max_rate_bps"), ("max_power_w", "subcarrier_max_power_w", "circuit_power_w")
OF_THE_CELL = (*POWERS, "outage_probability", "resource_block_group_size")
OBJECTIVE, _OUT = "objective", "leave_out"
_FEW, _MOST_STEPS, _EARLIER, _LISTED = 20.0, 3, 2, 4
_DIVISORS = (2, 3, 4, 5, 10)
_LIKENED = ("named", "last", "spoken", "out")
_WITH_UNIT = ("rate", "power")
_NUMBER = re.compile(r"^[-+\d.,\s]+")


@dataclass(frozen=True, kw_only=True)
class Change:
    """One change that a line may make, and how the line says it.

    Attributes:
        acts: what makes it.
        effect: what it comes to.
        form: what is done: a figure is set, added, scaled, a user is left out, ...
        kind: of which limit.
        source: where the users whom it is about are from: "named" in the line, of the "last" act, "others", ...
        figure: that the line says, None where it needs none.
        users: where the line names them.
        model: where it names the user whose figure it is.
    """

    acts: tuple[Act, ...]
    effect: Effect
    form: str
    kind: str = ""
    source: str = ""
    figure: Anchor | None = None
    users: tuple[Anchor, ...] = ()
    model: Anchor | None = None

    @property
    def is_supposition(self) -> bool:
        """Whether it changes nothing, and says of others that they are only supposed."""
        return not self.acts

    @property
    def is_of_readers(self) -> bool:
        """Whether it is all that the readers of sentences make of the line, or ask about."""
        return self.form in ("read", "guessed")

    @property
    def is_said(self) -> bool:
        """Whether it is about whom the line says, and not about those who are left or happen to be alike."""
        return not self.source.startswith(("not:", "alike:"))


@dataclass(frozen=True, kw_only=True)
class _Group:
    """For whom a change may be."""

    whom: Whom
    source: str
    anchors: tuple[Anchor, ...] = ()


def visible(request: Request | None, users: Sequence[str]) -> dict[Key, float | str]:
    """What holds for each user who is served, however it was said; users are referred to by number or name.

    >>> visible(Request(objective="max_rate", constraints={"min_rate_bps": {"all": 1e5, "2": 2e5}}), ("1", "2"))
    {('objective', ''): 'max_rate', ('min_rate_bps', '1'): 100000.0, ('min_rate_bps', '2'): 200000.0}
    """
    if request is None:
        return {}
    return {(OBJECTIVE, ""): request.objective, **_shown(figures_of(request.constraints), users)}


def _shown(figures: Mapping[Key, float], users: Sequence[str]) -> dict[Key, float | str]:
    alone = {user for kind, user in figures if kind == "users"}
    out = {user for user in users if (_OUT, user) in figures or (alone and user not in alone)}
    shown: dict[Key, float | str] = {(_OUT, user): 1.0 for user in users if user in out}
    for kind in dict.fromkeys(kind for kind, _ in figures):
        if kind in LISTS_OF_USERS:
            continue
        common = figures.get((kind, EVERYBODY), 0.0)
        if kind not in FIGURES_OF_USERS:
            shown[kind, ""] = _rounded(common)
            continue
        none = 1.0 if kind == "weights" else 0.0
        for user in users:
            figure = figures.get((kind, user), common or none)
            if figure != none and user not in out:
                shown[kind, user] = _rounded(figure)
    return shown


def _rounded(figure: float) -> float:
    return float(f"{figure:.6g}")


def effect_of(before: Mapping[Key, float | str], after: Mapping[Key, float | str]) -> Effect:
    """What differs between what is visible of two requests."""
    return frozenset((key, after.get(key)) for key in {*before, *after} if before.get(key) != after.get(key))


class Possible:
    """What a line may change in its talk."""

    def __init__(self, line: Anchored, context: Context) -> None:
        self.line, self.context = line, context
        self.users = tuple(numbered(name) for name in context.user_names)
        aim, held = context.objective, context.constraints
        self.figures = figures_of(held)
        self.before = visible(None if aim is None else Request(objective=aim, constraints=held), self.users)
        self._held = [kind for kind in (*FIGURES_OF_USERS, *OF_THE_CELL) if kind in context.constraints]
        self.out = tuple(user for user in self.users if (_OUT, user) in self.before)
        self._supposed = tuple(act for one in context.acts if isinstance(one, Suppose) for act in one.acts)
        self._said = self._supposed or context.acts
        self._past = [{} if held is None else figures_of(held.constraints) for held in context.past[::-1]]
        self._last = [limit for act in self._said for limit in _as_limits(act, self.figures)]
        self.last_users = {*_users_of(self._said)}
        self._named = [(users, anchors) for users, anchors in line.groups(len(self.users)) if {*users} <= {*self.users}]
        self._groups = list(self._whom())

    def effect(self, acts: Sequence[Act]) -> Effect:
        """What acts come to."""
        if isinstance(acts[0], Undo):
            return effect_of(self.before, visible(self.context.past[-(acts[0].steps or 1)], self.users))
        aims = [act.objective for act in acts if isinstance(act, Aim)]
        before = self.context.objective
        aim = aims[-1] if aims else before
        held = {} if any(isinstance(act, Forget) for act in acts) else with_the_assumed(before, self.figures, acts)
        after: dict[Key, float | str] = {} if aim is None else {(OBJECTIVE, ""): aim}
        return effect_of(self.before, {**after, **_shown(changed(held, acts), self.users)})

    def changed(self, acts: Sequence[Act]) -> dict[Key, float]:
        """The figures after acts."""
        return changed(self.figures, acts)

    def is_out_of_sight(self, acts: Sequence[Act]) -> bool:
        """Whether acts change figures, and nothing that is visible."""
        return self.changed(acts) != self.figures and not self.effect(acts)

    def changes(self) -> list[Change]:
        """Each that a line may say; what can't hold, or holds already, comes to nothing."""
        found = itertools.chain(self._of_figures(), self._of_shares(), self._like_another(), self._of_users(),
                                self._of_limits(), self._back_and_aims())  # fmt: skip
        effects = ((each, self.effect(each.acts)) for each in found if each.acts)
        return [dataclasses.replace(each, effect=effect if _may_hold(effect) else frozenset())
                for each, effect in effects]  # fmt: skip

    # for whom

    def _whom(self) -> Iterator[_Group]:
        seen = set[frozenset[str]]()
        named = list[tuple[tuple[str, ...], str, tuple[Anchor, ...]]]()

        def add(users: Iterable[str], source: str, anchors: tuple[Anchor, ...] = ()) -> None:
            found = tuple(users)
            if found and {*found} <= {*self.users} and (anchors or frozenset(found) not in seen):
                seen.add(frozenset(found))
                named.append((found, source, anchors))

        for users, anchors in self._named:
            add(users, "named", anchors)
        add(_users_of(self._said), "last")
        add(map(numbered, self.context.spoken_of), "spoken")
        listed = _users_of(self._said)
        for place, user in enumerate(listed if 1 < len(listed) <= _LISTED else ()):  # "the second one"
            add((user,), "last one" if place == len(listed) - 1 else f"one {place}")
        earlier = [users for acts in self.context.earlier[::-1] if (users := _users_of(acts))]
        for place, users in enumerate(list(dict.fromkeys(earlier))[: _EARLIER + 1]):
            add(users, f"earlier{place}")
        for kind in FIGURES_OF_USERS:
            own = tuple(user for name, user in self.figures if name == kind and user != EVERYBODY)
            if len(own) == 2:
                add(own, "two")
        for users, source, anchors in list(named):
            add((user for user in self.users if user not in (*users, *self.out)), f"not:{source}", anchors)
        for kind in FIGURES_OF_USERS:
            alike = dict[float | str | None, list[str]]()
            for user in self.users:
                alike.setdefault(self.before.get((kind, user)), []).append(user)
            for figure, users in alike.items() if len(alike) > 1 else ():
                size = "none" if figure is None else "most" if 2 * len(users) > len(self.users) else "few"
                add(users, f"alike:{size}")
        add(self.out, "out")
        for users, source, anchors in named:
            if len(users) < len(self.users):
                yield _Group(whom=Named(users), source=source, anchors=anchors)
        for kind, whom in (("others", Others()), ("everybody", Everybody())):
            yield _Group(whom=whom, source=kind, anchors=tuple(a for a in self.line.anchors if a.kind == kind))

    # figures

    def _of_figures(self) -> Iterator[Change]:
        for figure in self.line.figures:
            for kind in FIGURES_OF_USERS:
                for value in self._values(figure, kind):
                    for group in self._groups:
                        if figure not in group.anchors:
                            yield from self._figure_for(figure, kind, value, group)
            for kind in OF_THE_CELL:
                for value in self._values(figure, kind):
                    yield self._change([Limit(kind=kind, value=value)], "set", kind, figure=figure)
                    held = self.figures.get((kind, EVERYBODY))
                    if held is None and kind == "max_power_w":  # the cell's, which can only become less
                        less = self.context.max_power_w - value
                        yield self._change([Limit(kind=kind, value=less)], "minus", kind, figure=figure)
                    if held is not None and kind in POWERS:
                        for form, sum_ in (("plus", held + value), ("minus", held - value)):
                            yield self._change([Limit(kind=kind, value=sum_)], form, kind, figure=figure)
        for limit in self._last:  # "one more"
            one = _in_its_unit(1.0, limit)
            for form, value in (("one more", limit.value + one), ("one less", limit.value - one)):
                if one and value > 0:
                    yield self._change([dataclasses.replace(limit, value=value)], form, limit.kind, "last")
            for form, factor in (("in thousands", 1e3), ("in thousandths", 1e-3)):  # "kilobits, sorry"
                if limit.kind in (*RATES, *POWERS):
                    again = dataclasses.replace(limit, value=limit.value * factor)
                    yield self._change([again], form, limit.kind, "last")

    def _figure_for(self, figure: Anchor, kind: str, value: float, group: _Group) -> Iterator[Change]:
        """A figure for a group: in the place of theirs, or so much more or less."""
        whom = group.whom
        yield self._for(group, [Limit(kind=kind, value=value, whom=whom)], "set", kind, figure)
        if isinstance(whom, Named) and {*whom.users} & {*self.out}:
            yield self._for(group, [Serve(whom=whom), Limit(kind=kind, value=value, whom=whom)], "serve", kind, figure)
        if kind not in self._held:
            return
        for form, sign in (("plus", 1), ("minus", -1)):
            sums = [(whose, held + sign * value) for whose, held in self._figures_of(kind, whom)]
            if sums:
                acts = [Limit(kind=kind, value=sum_, whom=whose) for whose, sum_ in sums]
                yield self._for(group, acts, form, kind, figure)

    def _figures_of(self, kind: str, whom: Whom) -> list[tuple[Whom, float]]:
        """The figures that hold for somebody, each with whose it is; none where somebody has none."""
        common = self.figures.get((kind, EVERYBODY))
        if isinstance(whom, Named):
            found = [(Named((user,)), self.figures.get((kind, user), common)) for user in whom.users]
            return [(whose, figure) for whose, figure in found if figure] if all(f for _, f in found) else []
        return [] if common is None else [(whom, common)]

    def _values(self, figure: Anchor, kind: str) -> set[float]:
        """What a figure may be worth as one of a kind; without a unit it may have that of what holds or was said."""
        value, unitless = figure.value, figure.kind == "number"
        if kind in ("weights", "resource_block_group_size"):
            whole = kind == "weights" or value == int(value)
            return (
                {value} if (unitless or (figure.kind == "factor" and kind == "weights")) and whole and value else set()
            )
        if kind == "outage_probability":
            share = value if figure.kind == "ratio" else value / 100 if unitless else 0.0
            known = figure.kind == "ratio" or kind in self._held
            return {round(1 - share if share > 0.5 else share, 9)} if known and 0 < share < 1 else set()
        if figure.kind == ("rate" if kind in RATES else "power"):
            return {value} if value > 0 else set()
        if not unitless or value <= 0:
            return set()
        if kind in RATES:
            found = {value * 1e6} if value <= _FEW else set[float]()
            found |= {value * 1e3} if value >= _FEW / 2 else set()
        else:
            found = {value / 1e3 if kind == "subcarrier_max_power_w" and value >= _FEW / 4 else value}
        models = [limit for limit in self._last if limit.kind == kind]
        held = [figure for (name, _), figure in self.figures.items() if name == kind]
        models = models or [Limit(kind=kind, value=figure) for figure in held[:1]]
        return found | {worth for limit in models if (worth := _in_its_unit(value, limit)) > 0}

    # shares

    def _of_shares(self) -> Iterator[Change]:
        for figure in self.line.figures:
            share = figure.value
            if figure.kind not in ("ratio", "factor") and not (figure.kind == "number" and share in _DIVISORS):
                continue
            multiple = figure.kind != "ratio" and share > 1
            ways = (("times", share), ("part", 1 / share)) if multiple else _ways(share)
            for form, factor in ways:
                for kind in dict.fromkeys((*self._held, "min_rate_bps")):
                    if kind in FIGURES_OF_USERS:
                        for group in self._groups:
                            if figure not in group.anchors:
                                scaled = [Scale(kind=kind, factor=factor, whom=group.whom)]
                                yield self._for(group, scaled, form, kind, figure)
                    else:
                        yield self._change([Scale(kind=kind, factor=factor)], form, kind, figure=figure)
                if "max_power_w" not in self._held:
                    limit = Limit(kind="max_power_w", value=self.context.max_power_w * factor)
                    yield self._change([limit], form, "max_power_w", "cell", figure)
                for last, group in itertools.product(self._last, self._groups):  # "half of that for 7"
                    if last.kind in RATES and group.whom != last.whom and figure not in group.anchors:
                        limit = Limit(kind=last.kind, value=last.value * factor, whom=group.whom)
                        yield self._for(group, [limit], f"{form} of that", last.kind, figure)

    def _like_another(self) -> Iterator[Change]:
        """The figure of one user, or a share of it, for others: "8 the same as 3", "half of what 1 gets for 6"."""
        alone = [(users[0], anchors[0]) for users, anchors in self._named if len(users) == 1]
        for group, (model, other) in itertools.product(self._groups, alone):
            users = group.whom.users if isinstance(group.whom, Named) and group.source in _LIKENED else ()
            if not users or other in group.anchors or model in users:
                continue
            side = "of" if not group.anchors else "ahead" if group.anchors[0].start < other.start else "behind"
            found = {kind: self.before.get((kind, model)) for kind in FIGURES_OF_USERS}
            limits = [Limit(kind=kind, value=figure, whom=group.whom) for kind, figure in found.items()
                      if isinstance(figure, float)]  # fmt: skip
            if len(limits) > 1:
                yield self._for(group, limits, f"all like {side}", model=other)
            for limit in limits:
                yield self._for(group, [limit], f"like {side}", limit.kind, model=other)
                for share in self.line.figures:
                    for form, factor in _ways(share.value) if share.kind in ("ratio", "factor") else ():
                        of_it = dataclasses.replace(limit, value=limit.value * factor)
                        yield self._for(group, [of_it], f"{form} like {side}", limit.kind, share, other)
        for group in self._groups:
            users = group.whom.users if isinstance(group.whom, Named) else ()
            for kind in FIGURES_OF_USERS if len(users) == 2 else ():
                one, other = (self.figures.get((kind, user)) for user in users)
                if one and other:
                    acts = [Limit(kind=kind, value=other, whom=Named(users[:1])),
                            Limit(kind=kind, value=one, whom=Named(users[1:]))]  # fmt: skip
                    yield self._for(group, acts, "swap", kind)

    # users and limits without a figure

    def _of_users(self) -> Iterator[Change]:
        for group in self._groups:
            if not isinstance(group.whom, Named):
                continue
            yield self._for(group, [LeaveOut(whom=group.whom)], "out")
            yield self._for(group, [Serve(whom=group.whom)], "in")
            yield self._for(group, [Serve(whom=group.whom, alone=True)], "only")
            yield from self._too(group, group.whom)
        yield self._change([Serve(whom=Everybody())], "all in")

    def _too(self, group: _Group, whom: Named) -> Iterator[Change]:
        """What was said last, of these users too, or of them instead."""
        for limit in self._last if group.source != "last" else ():
            if limit.kind in FIGURES_OF_USERS:
                yield self._for(group, [dataclasses.replace(limit, whom=whom)], "too", limit.kind)
        for act in self._said if group.source != "last" else ():
            if isinstance(act, Scale) and act.kind in FIGURES_OF_USERS:
                yield self._for(group, [dataclasses.replace(act, whom=whom)], "too scaled", act.kind)
            elif isinstance(act, Drop) and act.kind in self._held and act.kind in FIGURES_OF_USERS:
                yield self._for(group, dropped(act.kind, whom, self.figures, self.users), "too dropped", act.kind)
        past = () if self._supposed else self.context.past[-1:]
        of_users = [act for act in self.context.acts if isinstance(act, Serve | LeaveOut)
                    or (isinstance(act, Limit | Scale | Drop) and act.kind in FIGURES_OF_USERS)]  # fmt: skip
        for base in past if of_users else ():
            meant = [dataclasses.replace(act, whom=whom) if act in of_users else act for act in self.context.acts]
            held = with_the_assumed(None if base is None else base.objective, self._past[0], meant)
            acts = acts_between(self.figures, changed(held, meant))
            if acts:
                yield self._for(group, acts, "instead")

    def _of_limits(self) -> Iterator[Change]:
        for kind in (*FIGURES_OF_USERS, *OF_THE_CELL):
            if kind not in FIGURES_OF_USERS or kind not in self._held:
                yield self._change([Drop(kind=kind)], "drop", kind)
                continue
            for group in self._groups:
                if isinstance(group.whom, Named):
                    yield self._for(group, dropped(kind, group.whom, self.figures, self.users), "drop", kind)
                    yield self._for(group, [Drop(kind=kind, whom=group.whom, own=True)], "drop own", kind)
                else:
                    own = isinstance(group.whom, Others)
                    yield self._for(group, [Drop(kind=kind, whom=group.whom, own=own)], "drop", kind)

    def _back_and_aims(self) -> Iterator[Change]:
        if self._supposed:
            yield self._change(self._supposed, "as supposed")
        said = [int(figure.value) for figure in self.line.figures if figure.kind == "number"]
        for steps in dict.fromkeys((*range(1, _MOST_STEPS + 1), *said)):
            if 0 < steps <= len(self.context.past):
                form = f"undo {min(steps, _MOST_STEPS)}"
                yield self._change([Undo(steps=steps)], form, "", "said" if steps in said else "")
        for objective in BUILT_IN:
            yield self._change([Aim(objective=objective)], "aim", objective)
        yield from self._as_before()
        yield from self._once_more()

    def _once_more(self) -> Iterator[Change]:
        """The last change of figures again, by as much or as many times."""
        before = self._past[0] if self._past else {}
        stepped = [(key, before[key], after) for key, after in self.figures.items() if after and before.get(key)]
        if any(one != other for _, one, other in stepped):
            sums, products = {k: 2 * b - a for k, a, b in stepped}, {k: b * b / a for k, a, b in stepped}
            for form, again in (("again", sums), ("as much again", products)):
                yield self._change(acts_between(self.figures, {**self.figures, **again}), form, "", "last")

    def _as_before(self) -> Iterator[Change]:
        """A limit as it last was when it was otherwise: "the cap holds again", "back to ten"."""
        for kind in (*FIGURES_OF_USERS, *OF_THE_CELL):
            now = {key: figure for key, figure in self.figures.items() if key[0] == kind}
            for held in self._past:
                then = {key: figure for key, figure in held.items() if key[0] == kind}
                if then and then != now:
                    yield self._change(acts_between(now, then), "as before", kind, "held" if now else "gone")
                    break

    def _for(
        self, group: _Group, acts: Sequence[Act], form: str, kind: str = "", figure: Anchor | None = None,
        model: Anchor | None = None,
    ) -> Change:  # fmt: skip
        return self._change(acts, form, kind, group.source, figure, group.anchors, model)

    @staticmethod
    def _change(
        acts: Sequence[Act], form: str, kind: str = "", source: str = "", figure: Anchor | None = None,
        users: tuple[Anchor, ...] = (), model: Anchor | None = None,
    ) -> Change:  # fmt: skip
        return Change(
            acts=tuple(acts), effect=frozenset(), form=form, kind=kind, source=source, figure=figure, users=users,
            model=model,
        )  # fmt: skip


def dropped(kind: str, whom: Named, figures: Mapping[Key, float], users: Sequence[str]) -> list[Act]:
    """A limit taken off some users; a ceiling of all is written out for the others, as there is none for nobody."""
    common = figures.get((kind, EVERYBODY))
    if kind != "max_rate_bps" or common is None:
        return [Drop(kind=kind, whom=whom)]
    kept = [user for user in users if user not in whom.users]
    return [Drop(kind=kind), *(Limit(kind=kind, value=figures.get((kind, user), common), whom=Named((user,)))
                               for user in kept)]  # fmt: skip


def _may_hold(effect: Effect) -> bool:
    """Whether each figure of an effect is one that may hold."""
    return all(not isinstance(value, float) or 0 < value < (1 if kind == "outage_probability" else math.inf)
               for (kind, _), value in effect)  # fmt: skip


def _ways(share: float) -> Iterator[tuple[str, float]]:
    """How something may be changed by a share: to it, by it less, by it more."""
    for form, factor in (("to", share), ("less", 1 - share), ("more", 1 + share)):
        if factor > 0:
            yield form, factor


def _users_of(acts: Iterable[Act]) -> tuple[str, ...]:
    """The users whom acts name, each once."""
    named = [whom for act in acts if isinstance(whom := getattr(act, "whom", None), Named)]
    return tuple(dict.fromkeys(numbered(user) for whom in named for user in whom.users))


def _as_limits(act: Act, figures: Mapping[Key, float]) -> Iterator[Limit]:
    """The figure that an act stated, or that it made of another."""
    if isinstance(act, Limit):
        yield act
    elif isinstance(act, Scale):
        user = numbered(act.whom.users[0]) if isinstance(act.whom, Named) else EVERYBODY
        value = figures.get((act.kind, user), figures.get((act.kind, EVERYBODY)))
        if value is not None:
            yield Limit(kind=act.kind, value=value, whom=act.whom)


def _in_its_unit(value: float, limit: Limit) -> float:
    """A figure in the unit of a limit, in SI units; 0 where it has none."""
    if limit.kind in ("weights", "resource_block_group_size"):
        return value
    if limit.kind == "outage_probability":
        return 0.0
    shown = human(limit.value, "W" if limit.kind.endswith("_w") else "bit/s")
    said = [one.text for one in parse_quantities(limit.words) if one.kind in _WITH_UNIT and one.text[:1].isdigit()]
    found = parse_quantities(f"{value:g} {_NUMBER.sub('', (said or [shown])[0]).strip()}")
    return found[0].value if found and found[0].kind != "bare" else 0.0
