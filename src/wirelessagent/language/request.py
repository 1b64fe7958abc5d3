"""What is asked for in a conversation, and the one place that changes it: acts applied to a request, and their diff."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from wirelessagent import plugins
from wirelessagent.language import acts
from wirelessagent.language.acts import Act, Everybody, Named, Whom
from wirelessagent.language.intent import (
    EVERYBODY,
    FIGURES_OF_USERS,
    LISTS_OF_USERS,
    Constraint,
    checked_constraints,
    stated,
)

ASSUMED_MIN_RATE_BPS = 200e3
"""Rate promised to each user where the least power is asked for and no rate was named."""

Key: TypeAlias = tuple[str, str]
"""A constraint and a user; :data:`EVERYBODY` for a figure of everybody or of the cell."""

_NUMBERED = re.compile(r"(?i)(?:user\s*)?0*([1-9]\d*)")


@dataclass(frozen=True, kw_only=True)
class Request:
    """An objective by its registered name, and constraints as in :class:`~wirelessagent.language.intent.Intent`.

    ``method`` is the one that the operator named, by its registered name; None leaves the choice to the tools.
    """

    objective: str
    constraints: Mapping[str, Constraint] = field(default_factory=dict[str, Constraint])
    method: str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "constraints", checked_constraints(self.constraints))


@dataclass(frozen=True, kw_only=True)
class Change:
    """A figure that was set, changed or taken off: None where there was none, or is none any more.

    A user who is served or left out by name counts as 1.
    """

    kind: str
    user: str
    before: float | None
    after: float | None


@dataclass(frozen=True, kw_only=True)
class Diff:
    """What acts changed of a request.

    Attributes:
        objective: before and after.
        method: before and after.
        changes: of the constraints.
    """

    objective: tuple[str | None, str | None] = (None, None)
    method: tuple[str | None, str | None] = (None, None)
    changes: tuple[Change, ...] = ()

    @property
    def gone(self) -> dict[str, Constraint]:
        """What no longer holds, and has nothing in its place."""
        return constraints_of({
            (one.kind, one.user): one.before
            for one in self.changes if one.after is None and one.before is not None
        })  # fmt: skip


def applied(before: Request | None, said: Iterable[Act], *, radiated_w: float = 0.0) -> tuple[Request | None, Diff]:
    """The request after acts, and what they changed. Acts that change nothing of it, such as questions, are left out.

    ``radiated_w`` is the power of the last decision, which shares of the power refer to where no limit holds.
    """
    said, request = tuple(said), before
    if before is not None and _promises_to_some(said):
        figures = assuming(before.objective, figures_of(before.constraints))
        request = dataclasses.replace(before, constraints=constraints_of(figures))
    for act in said:
        request = _after(request, act, radiated_w)
    return request, difference(before, request)


def difference(before: Request | None, after: Request | None) -> Diff:
    """What differs between two requests."""
    old, new = (figures_of({} if each is None else each.constraints) for each in (before, after))
    keys = [key for key in dict.fromkeys((*old, *new)) if old.get(key) != new.get(key)]
    return Diff(
        objective=(before and before.objective, after and after.objective),
        method=(before and before.method, after and after.method),
        changes=tuple(Change(kind=key[0], user=key[1], before=old.get(key), after=new.get(key)) for key in keys),
    )


def _after(request: Request | None, act: Act, radiated_w: float) -> Request | None:
    if isinstance(act, acts.Forget):
        return None
    if isinstance(act, acts.Aim):
        return dataclasses.replace(request or Request(objective=act.objective), objective=act.objective)
    if request is None:
        return None
    if isinstance(act, acts.Prefer):
        return dataclasses.replace(request, method=act.method or None)
    figures = changed(figures_of(request.constraints), (act,), radiated_w=radiated_w)
    return dataclasses.replace(request, constraints=constraints_of(figures))


def changed(figures: Mapping[Key, float], said: Iterable[Act], *, radiated_w: float = 0.0) -> dict[Key, float]:
    """Figures by kind and user after acts; those that are about none of them change nothing."""
    after = dict(figures)
    for act in said:
        _change(after, act, radiated_w)
    return after


def acts_between(before: Mapping[Key, float], after: Mapping[Key, float]) -> tuple[Act, ...]:
    """The acts that make figures of others.

    >>> acts_between({("min_rate_bps", "3"): 1e5}, {("min_rate_bps", "3"): 2e5})
    (Limit(words='', kind='min_rate_bps', value=200000.0, whom=Named(users=('3',))),)
    """
    return (*_lists_between(before, after), *_figures_between(before, after))


def _lists_between(before: Mapping[Key, float], after: Mapping[Key, float]) -> Iterator[Act]:
    served, serves, out, outs = (
        tuple(user for kind, user in figures if kind == name)
        for name in ("users", "leave_out") for figures in (before, after)
    )  # fmt: skip
    if {*served} != {*serves} or (serves and not {*out} <= {*outs}):
        yield acts.Serve(whom=Named(serves), alone=True) if serves else acts.Serve(whom=Everybody())
        out = ()
    back, gone = (tuple(user for user in some if user not in others) for some, others in ((out, outs), (outs, out)))
    if back:
        yield acts.Serve(whom=Named(back))
    if gone:
        yield acts.LeaveOut(whom=Named(gone))


def _figures_between(before: Mapping[Key, float], after: Mapping[Key, float]) -> Iterator[Act]:
    for kind, user in before:
        if (kind, user) not in after and kind not in LISTS_OF_USERS:
            yield acts.Drop(kind=kind, whom=acts.Others() if user == EVERYBODY else Named((user,)), own=True)
    for (kind, user), value in after.items():
        if before.get((kind, user)) != value and kind not in LISTS_OF_USERS:
            common = acts.Others() if kind in FIGURES_OF_USERS else Everybody()
            yield acts.Limit(kind=kind, value=value, whom=common if user == EVERYBODY else Named((user,)))


def with_the_assumed(objective: str | None, figures: Mapping[Key, float], said: Iterable[Act]) -> dict[Key, float]:
    """Figures as acts find them: where these promise to some users, what is assumed holds for the others."""
    return assuming(objective, figures) if _promises_to_some(said) else dict(figures)


def _promises_to_some(said: Iterable[Act]) -> bool:
    return any(
        isinstance(act, acts.Limit) and act.kind == "min_rate_bps" and isinstance(act.whom, Named) for act in said
    )


def assuming(objective: str | None, figures: Mapping[Key, float]) -> dict[Key, float]:
    """Figures with the rate for each user that is assumed where least power is asked for and no rate is named."""
    named = any(kind == "min_rate_bps" for kind, _ in figures)
    if named or objective is None or plugins.objective(objective).measure != "power":
        return dict(figures)
    return {**figures, ("min_rate_bps", EVERYBODY): ASSUMED_MIN_RATE_BPS}


def _change(figures: dict[Key, float], act: Act, radiated_w: float) -> None:
    """What each act makes of the figures that hold."""
    match act:
        case acts.Limit():
            if isinstance(act.whom, Everybody):
                for key in _of(figures, act.kind):
                    del figures[key]
            users = _names(act.whom) if isinstance(act.whom, Named) else [EVERYBODY]
            figures |= {(act.kind, user): act.value for user in users}
        case acts.Scale(reference="radiated"):
            basis = figures.get((act.kind, EVERYBODY), radiated_w)
            if basis > 0:
                figures[act.kind, EVERYBODY] = act.factor * basis
        case acts.Scale():
            for key in _meant(figures, act.kind, act.whom):
                held = figures.get(key, figures.get((act.kind, EVERYBODY)))
                if held is not None:
                    figures[key] = held * act.factor
        case acts.Drop():
            own_only = act.own or not isinstance(act.whom, Named) or act.kind != "min_rate_bps"
            for key in _meant(figures, act.kind, act.whom):
                figures.pop(key, None)
                if not own_only and (act.kind, EVERYBODY) in figures:
                    figures[key] = 0.0  # to whom nothing is promised
        case acts.Serve():
            users, alone = _names(act.whom) if isinstance(act.whom, Named) else None, _of(figures, "users")
            for kind, user in (*_of(figures, "leave_out"), *alone):
                if act.alone or users is None or (kind == "leave_out" and user in users):
                    del figures[kind, user]
            if users is not None and (act.alone or alone):
                figures |= {("users", user): 1.0 for user in users}
                for _, user in _of(figures, "leave_out"):  # the last who was served was left out
                    if figures.pop(("users", user), None):
                        del figures["leave_out", user]
        case acts.LeaveOut(whom=Named() as whom):
            users, served = _names(whom), {user for _, user in _of(figures, "users")}
            if served - set(users):  # the list of who is served is shortened
                for user in users:
                    figures.pop(("users", user), None)
            else:
                figures |= {("leave_out", user): 1.0 for user in users}
        case _:
            pass


def _of(figures: Mapping[Key, float], kind: str) -> list[Key]:
    return [key for key in figures if key[0] == kind]


def _meant(figures: Mapping[Key, float], kind: str, whom: Whom) -> list[Key]:
    """What an act on a figure is about: of users by name, whether they have one of their own, else of those held."""
    if isinstance(whom, Named):
        return [(kind, user) for user in _names(whom)]
    return [key for key in _of(figures, kind) if key[1] == EVERYBODY or isinstance(whom, Everybody)]


def _names(whom: Named) -> list[str]:
    return [numbered(user) for user in whom.users]


def numbered(user: str) -> str:
    """One name for a user who can be named by number: "user 3" is "3"."""
    found = _NUMBERED.fullmatch(user.strip())
    return found[1] if found else user


def figures_of(constraints: Mapping[str, Constraint]) -> dict[Key, float]:
    """Constraints by kind and user.

    >>> figures_of({"min_rate_bps": {"all": 5e5, "user 3": 2e6}, "leave_out": ("2",)})
    {('min_rate_bps', 'all'): 500000.0, ('min_rate_bps', '3'): 2000000.0, ('leave_out', '2'): 1.0}
    """
    figures: dict[Key, float] = {}
    for kind, value in constraints.items():
        if isinstance(value, Mapping):
            figures |= {(kind, numbered(user)): figure for user, figure in value.items()}
        elif isinstance(value, tuple):
            figures |= {(kind, numbered(user)): 1.0 for user in value}
        else:
            figures[kind, EVERYBODY] = value
    return figures


def constraints_of(figures: Mapping[Key, float]) -> dict[str, Constraint]:
    """The constraints that :func:`figures_of` takes apart."""
    found: dict[str, Constraint] = {}
    for kind in dict.fromkeys(kind for kind, _ in figures):
        by_user = {user: value for (name, user), value in figures.items() if name == kind}
        if kind in LISTS_OF_USERS:
            found[kind] = tuple(by_user)
        elif kind in FIGURES_OF_USERS and list(by_user) != [EVERYBODY]:
            found[kind] = by_user
        else:
            found[kind] = by_user[EVERYBODY]
    return found


def merged(earlier: Mapping[str, Constraint], later: Mapping[str, Constraint]) -> dict[str, Constraint]:
    """Constraints that were read before, with those of a later line, such as the answer to a question.

    >>> merged({"min_rate_bps": 5e5, "max_power_w": 8.0}, {"min_rate_bps": {"3": 2e6}, "max_power_w": 5.0})
    {'min_rate_bps': {'all': 500000.0, '3': 2000000.0}, 'max_power_w': 5.0}
    """
    return constraints_of(changed(figures_of(earlier), stated(later)))


def serving(
    users: tuple[str, ...], constraints: Mapping[str, Constraint], user_names: Sequence[str] = ()
) -> tuple[dict[str, Constraint], tuple[str, ...]]:
    """What serving these users too changes of constraints: those to state, and those to drop before.

    Of the cell's ``user_names`` the second is also user 2.

    >>> serving(("2",), {"leave_out": ("2", "5")}), serving(("2",), {"max_power_w": 5.0})
    (({'leave_out': ('5',)}, ('leave_out',)), ({}, ()))
    >>> serving(("2",), {"leave_out": ("Bob",)}, ("Ada", "Bob"))
    ({}, ('leave_out',))
    """
    places = {numbered(name).casefold(): str(place) for place, name in enumerate(user_names, start=1)}

    def place(user: str) -> str:
        return places.get(numbered(user).casefold(), numbered(user))

    listed = [constraints.get(name) for name in LISTS_OF_USERS]
    spelt = {place(user): user for each in listed if isinstance(each, tuple) for user in each}
    users = tuple(spelt.get(place(user), user) for user in users)
    held = constraints_of(figures_of(constraints))
    after = constraints_of(changed(figures_of(constraints), [acts.Serve(whom=Named(users))]))
    values = {name: after[name] for name in LISTS_OF_USERS if name in after and after[name] != held.get(name)}
    return values, ("leave_out",) if after.get("leave_out") != held.get("leave_out") else ()


def users_in(constraints: Mapping[str, Constraint]) -> list[str]:
    """Everybody whom constraints name, each once, in their order; "all" is nobody's name.

    >>> users_in({"max_power_w": 5.0, "min_rate_bps": {"all": 1e5, "3": 1e6}, "users": ("3", "5")})
    ['3', '5']
    """
    named = (value for value in constraints.values() if isinstance(value, Mapping | tuple))
    return list(dict.fromkeys(user for users in named for user in users if user != EVERYBODY))
