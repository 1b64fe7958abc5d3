"""What a line of a talk may be about: what holds, what was said before, whom it may be for, and its figures' worth."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from wirelessagent.language.acts import Act, Aim, Drop, Everybody, Forget, Limit, Named, Others, Scale, Suppose, Undo
from wirelessagent.language.conversation.anchors import Anchor, Anchored
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, LISTS_OF_USERS, RATES, is_allowed
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.recogniser import Context
from wirelessagent.language.request import Key, Request, assuming, changed, figures_of, numbered, with_the_assumed
from wirelessagent.model.units import human

POWERS = ("max_power_w", "subcarrier_max_power_w", "circuit_power_w")
LIMITS = (*FIGURES_OF_USERS, *POWERS, "outage_probability", "resource_block_group_size")
_FEW, _EARLIER, _LISTED = 20.0, 2, 4
_WITH_UNIT = ("rate", "power")
_NUMBER = re.compile(r"^[-+\d.,\s]+")
Effect: TypeAlias = frozenset[tuple[Key, float | str | None]]
"""What holds after a change and did not before, by kind and user; None for what holds no longer."""
OBJECTIVE, OUT = "objective", "leave_out"


@dataclass(frozen=True)
class Change:
    """One change that a line may make, and how the line says it.

    Attributes:
        acts: what makes it.
        form: what is done: a figure is set, added, scaled, a user is left out, ...
        kind: of which limit.
        source: where the users whom it is about are from: "named" in the line, of the "last" act, "others", ...
        figure: that the line says, None where it needs none.
        users: where the line names them.
        model: where it names the user whose figure it is.
        effect: what it comes to, nothing until that is worked out.
    """

    acts: tuple[Act, ...]
    form: str
    kind: str = ""
    source: str = ""
    figure: Anchor | None = None
    users: tuple[Anchor, ...] = ()
    model: Anchor | None = None
    effect: Effect = frozenset()

    @property
    def is_supposition(self) -> bool:
        """Whether it changes nothing, and says of others that they are only supposed."""
        return not self.acts


@dataclass(frozen=True, kw_only=True)
class Group:
    """For whom a change may be."""

    whom: Everybody | Named | Others
    source: str
    anchors: tuple[Anchor, ...] = ()

    @property
    def users(self) -> tuple[str, ...]:
        """Those who are named; nobody where it is everybody, or the others."""
        return self.whom.users if isinstance(self.whom, Named) else ()

    def change(
        self, acts: Sequence[Act], form: str, kind: str = "", figure: Anchor | None = None, model: Anchor | None = None
    ) -> Change:
        """A change for this group."""
        return Change(tuple(acts), form, kind, self.source, figure, self.anchors, model)


class Possible:
    """What a line may change in its talk."""

    def __init__(self, line: Anchored, context: Context) -> None:
        self.line, self.context = line, context
        unknown = (user for anchor in line.anchors if anchor.kind == "users" for user in anchor.users)
        self.users = tuple(dict.fromkeys((*(numbered(name) for name in context.user_names), *unknown)))
        self.radiated_w = _rounded(context.radiated_w or context.max_power_w)
        aim, held = context.objective, context.constraints
        self.figures = figures_of(held)
        self.request = None if aim is None else Request(objective=aim, constraints=held)
        self.before = visible(self.request, self.users, assumed=True)
        self.held = [kind for kind in LIMITS if kind in context.constraints]
        self.out = tuple(user for user in self.users if (OUT, user) in self.before)
        self.supposed = tuple(act for one in context.acts if isinstance(one, Suppose) for act in one.acts)
        self.said = self.supposed or context.acts
        self.past = [{} if held is None else figures_of(held.constraints) for held in context.past[::-1]]
        self.last = [limit for act in self.said for limit in _as_limits(act, self.figures)]
        self.last_users = {*users_of(self.said)}
        self.shares_power = any(_is_a_share(limit, context.max_power_w) for limit in self.last)
        self.last_kinds = {act.kind for act in self.said if isinstance(act, Limit | Scale | Drop)}
        self.named = [(users, anchors) for users, anchors in line.groups(len(self.users)) if {*users} <= {*self.users}]
        self.cell = Group(whom=Everybody(), source="")  # for which limits are that no user has
        self.groups = list(self._whom())

    def effect(self, acts: Sequence[Act]) -> Effect:
        """What acts come to."""
        if isinstance(acts[0], Undo):
            return effect_between(self.request, self.context.past[-(acts[0].steps or 1)], self.users)
        aims = [act.objective for act in acts if isinstance(act, Aim)]
        before = self.context.objective
        held = {} if any(isinstance(act, Forget) for act in acts) else with_the_assumed(before, self.figures, acts)
        after = changed(held, acts)
        if not aims or aims[-1] == before:
            return difference(self.before, seen(before, assuming(before, after), self.users))
        return difference(visible(self.request, self.users), seen(aims[-1], after, self.users))

    def able_effect(self, acts: Sequence[Act]) -> Effect:
        """What acts come to; nothing where a figure is set that a limit can't have, or comes out that can't hold."""
        limits = ((act, "" if isinstance(act.whom, Named) else EVERYBODY) for act in acts if isinstance(act, Limit))
        effect, able = self.effect(acts), all(is_allowed(act.kind, act.value, user=user) for act, user in limits)
        holds = all(not isinstance(value, float) or 0 < value < (1 if kind == "outage_probability" else math.inf)
                    for (kind, _), value in effect)  # fmt: skip
        return effect if able and holds else frozenset()

    def _whom(self) -> Iterator[Group]:
        seen, named = set[frozenset[str]](), list[Group]()

        def add(users: Iterable[str], source: str, anchors: tuple[Anchor, ...] = ()) -> None:
            found = tuple(users)
            if found and {*found} <= {*self.users} and (anchors or frozenset(found) not in seen):
                seen.add(frozenset(found))
                named.append(Group(whom=Named(found), source=source, anchors=anchors))

        for users, anchors in self.named:
            add(users, "named", anchors)
        listed = users_of(self.said)
        add(listed, "last")
        add(map(numbered, self.context.spoken_of), "spoken")
        for place, user in enumerate(listed if 1 < len(listed) <= _LISTED else ()):  # "the second one"
            add((user,), "last one" if place == len(listed) - 1 else f"one {place}")
        earlier = [users for acts in self.context.earlier[::-1] if (users := users_of(acts))]
        for place, users in enumerate(list(dict.fromkeys(earlier))[: _EARLIER + 1]):
            add(users, f"earlier{place}")
        for kind in FIGURES_OF_USERS:
            own = tuple(user for name, user in self.figures if name == kind and user != EVERYBODY)
            if 1 < len(own) <= _LISTED:  # "both", "those three"
                add(own, f"own {len(own)}")
        for group in list(named):
            apart = (user for user in self.users if user not in (*group.users, *self.out))
            add(apart, f"not:{group.source}", group.anchors)
        for kind in FIGURES_OF_USERS:
            alike = dict[float | str | None, list[str]]()
            for user in self.users:
                alike.setdefault(self.before.get((kind, user)), []).append(user)
            for figure, users in alike.items() if len(alike) > 1 else ():
                size = "none" if figure is None else "most" if 2 * len(users) > len(self.users) else "few"
                add(users, f"alike:{size}")
        add(self.out, "out")
        yield from (group for group in named if len(group.users) < len(self.users))
        for kind, whom in (("others", Others()), ("everybody", Everybody())):
            yield Group(whom=whom, source=kind, anchors=tuple(a for a in self.line.anchors if a.kind == kind))

    def groups_for(self, kind: str, figure: Anchor | None = None) -> list[Group]:
        """For whom a limit of a kind may be changed, perhaps by a figure, which is no user then."""
        if kind not in FIGURES_OF_USERS:
            return [self.cell]
        return [group for group in self.groups if figure not in group.anchors]

    def limits_of(self, kind: str, group: Group) -> list[Limit]:
        """The limits that hold for a group, each with whose it is; none where somebody named has none."""
        common = self.figures.get((kind, EVERYBODY))
        own = {user: figure for (name, user), figure in self.figures.items() if name == kind and user != EVERYBODY}
        of_each = {user: own.get(user, common) for user in group.users} or own
        held = [Limit(kind=kind, value=figure, whom=Named((user,))) for user, figure in of_each.items() if figure]
        if group.users:
            return held if len(held) == len(of_each) else []
        of_all = [Limit(kind=kind, value=common, whom=Others() if own else group.whom)] if common else []
        return [*of_all, *(held if isinstance(group.whom, Everybody) else [])]

    def values(self, figure: Anchor, kind: str) -> set[float]:
        """What a figure may be worth as one of a kind; without a unit it may have that of what holds or was said."""
        value, unitless = figure.value, figure.kind == "number"
        if kind in ("weights", "resource_block_group_size"):
            whole = kind == "weights" or value == int(value)
            said = unitless or (figure.kind == "factor" and kind == "weights")
            return {value} if said and whole and value else set()
        if figure.kind == "ratio" and self.shares_power:  # "70 % of the power", "no, 60 %"
            return {value * self.context.max_power_w} if kind == "max_power_w" else set()
        if kind == "outage_probability":
            share = value if figure.kind == "ratio" or value < 1 else value / 100
            known = figure.kind == "ratio" or (unitless and (value < 1 or kind in self.held))
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
        models = [limit for limit in self.last if limit.kind == kind]
        held = [figure for (name, _), figure in self.figures.items() if name == kind]
        models = models or [Limit(kind=kind, value=figure) for figure in held[:1]]
        return found | {worth for limit in models if (worth := in_its_unit(value, limit)) > 0}


def _is_a_share(limit: Limit, max_power_w: float) -> bool:
    """Whether a power was said as a share of the cell's."""
    shares = (figure.value for figure in parse_quantities(limit.words) if figure.kind == "ratio")
    return limit.kind == "max_power_w" and any(math.isclose(share * max_power_w, limit.value) for share in shares)


def users_of(acts: Iterable[Act]) -> tuple[str, ...]:
    """The users whom acts name, each once."""
    named = [whom for act in acts if isinstance(whom := getattr(act, "whom", None), Named)]
    return tuple(dict.fromkeys(numbered(user) for whom in named for user in whom.users))


def spoken_of(said: Anchored, most: int, acts: Sequence[Act]) -> tuple[str, ...]:
    """The users whom a line names that makes these acts, if any, among so many at ``most``.

    A number alone names nobody where something else is changed by it: "blocks of 5".
    """
    users = said.named(most)
    if not acts or any(anchor.kind == "users" for anchor in said.anchors):
        return users
    return tuple(user for user in users if user in users_of(acts))


def _as_limits(act: Act, figures: Mapping[Key, float]) -> Iterator[Limit]:
    """The figure that an act stated, or that it made of another."""
    if isinstance(act, Limit):
        yield act
    elif isinstance(act, Scale):
        user = numbered(act.whom.users[0]) if isinstance(act.whom, Named) else EVERYBODY
        value = figures.get((act.kind, user), figures.get((act.kind, EVERYBODY)))
        if value is not None:
            yield Limit(kind=act.kind, value=value, whom=act.whom)


def in_its_unit(value: float, limit: Limit) -> float:
    """A figure in the unit of a limit, in SI units; 0 where it has none."""
    if limit.kind in ("weights", "resource_block_group_size"):
        return value
    if limit.kind == "outage_probability":
        return 0.0
    shown = human(limit.value, "W" if limit.kind.endswith("_w") else "bit/s")
    said = [one.text for one in parse_quantities(limit.words) if one.kind in _WITH_UNIT and one.text[:1].isdigit()
            and math.isclose(one.value, limit.value, rel_tol=1e-3)]  # fmt: skip
    found = parse_quantities(f"{value:g} {_NUMBER.sub('', (said or [shown])[0]).strip()}")
    return found[0].value if found and found[0].kind != "bare" else 0.0


def visible(request: Request | None, users: Sequence[str], *, assumed: bool = False) -> dict[Key, float | str]:
    """What holds for each user who is served, however it was said; users are referred to by number or name.

    With what is ``assumed``, a rate for each user is part of the least power.

    >>> visible(Request(objective="max_rate", constraints={"min_rate_bps": {"all": 1e5, "2": 2e5}}), ("1", "2"))
    {('objective', ''): 'max_rate', ('min_rate_bps', '1'): 100000.0, ('min_rate_bps', '2'): 200000.0}
    """
    if request is None:
        return {}
    figures = figures_of(request.constraints)
    return seen(request.objective, assuming(request.objective, figures) if assumed else figures, users)


def seen(objective: str | None, figures: Mapping[Key, float], users: Sequence[str]) -> dict[Key, float | str]:
    """What is visible of an aim and figures."""
    shown: dict[Key, float | str] = {} if objective is None else {(OBJECTIVE, ""): objective}
    alone = {user for kind, user in figures if kind == "users"}
    out = {user for user in users if (OUT, user) in figures or (alone and user not in alone)}
    shown |= {(OUT, user): 1.0 for user in users if user in out}
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


def effect_between(before: Request | None, after: Request | None, users: Sequence[str]) -> Effect:
    """What differs between two requests; what is assumed with an aim does not where the aim is another."""
    assumed = before is not None and after is not None and before.objective == after.objective
    return difference(visible(before, users, assumed=assumed), visible(after, users, assumed=assumed))


def difference(before: Mapping[Key, float | str], after: Mapping[Key, float | str]) -> Effect:
    """What differs between what is visible before and after."""
    return frozenset((key, after.get(key)) for key in {*before, *after} if before.get(key) != after.get(key))
