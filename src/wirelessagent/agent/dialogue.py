"""What is asked for in a conversation, and the one place that changes it: acts applied to a request, and their diff."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from wirelessagent import plugins
from wirelessagent.language.acts import (
    Act,
    Aim,
    Drop,
    Everybody,
    Forget,
    LeaveOut,
    Limit,
    Named,
    Prefer,
    Scale,
    Serve,
    Whom,
)  # fmt: skip
from wirelessagent.language.intent import (
    EVERYBODY,
    FIGURES_OF_USERS,
    LISTS_OF_USERS,
    Constraint,
    checked_constraints,
)  # fmt: skip

ASSUMED_MIN_RATE_BPS = 200e3
"""Rate promised to each user where the least power is asked for and no rate was named."""

Key: TypeAlias = tuple[str, str]
"""A constraint and a user; :data:`EVERYBODY` for a figure of everybody or of the cell."""

_NUMBERED = re.compile(r"(?i)user\s*0*([1-9]\d*)")


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

    def after(self, before: Request | None) -> Request | None:
        """The request that this diff makes of the one before it."""
        if self.objective[1] is None:
            return None
        figures = {} if before is None else figures_of(before.constraints)
        for one in self.changes:
            figures.pop((one.kind, one.user), None)
            if one.after is not None:
                figures[one.kind, one.user] = one.after
        return Request(objective=self.objective[1], constraints=constraints_of(figures), method=self.method[1])


def applied(before: Request | None, acts: Iterable[Act], *, radiated_w: float = 0.0) -> tuple[Request | None, Diff]:
    """The request after acts, and what they changed. Acts that change nothing of it, such as questions, are left out.

    ``radiated_w`` is the power of the last decision, which shares of the power refer to where no limit holds.
    """
    acts = tuple(acts)
    of_users = any(isinstance(act, Limit) and (act.kind, type(act.whom)) == ("min_rate_bps", Named) for act in acts)
    request = with_the_assumed(before) if of_users else before  # which holds for the others
    for act in acts:
        request = _after(request, act, radiated_w)
    return request, difference(before, request)


def difference(before: Request | None, after: Request | None) -> Diff:
    """What differs between two requests."""
    old = {} if before is None else figures_of(before.constraints)
    new = {} if after is None else figures_of(after.constraints)
    return Diff(
        objective=(before and before.objective, after and after.objective),
        method=(before and before.method, after and after.method),
        changes=tuple(
            Change(kind=key[0], user=key[1], before=old.get(key), after=new.get(key))
            for key in dict.fromkeys((*old, *new))
            if old.get(key) != new.get(key)
        ),
    )


def _after(request: Request | None, act: Act, radiated_w: float) -> Request | None:
    if isinstance(act, Forget):
        return None
    if isinstance(act, Aim):
        return dataclasses.replace(request or Request(objective=act.objective), objective=act.objective)
    if request is None:
        return None
    if isinstance(act, Prefer):
        return dataclasses.replace(request, method=act.method or None)
    figures = figures_of(request.constraints)
    if isinstance(act, Limit):
        _set(figures, act.kind, act.whom, act.value)
    elif isinstance(act, Scale):
        _scale(figures, act, radiated_w)
    elif isinstance(act, Drop):
        _drop(figures, act)
    elif isinstance(act, Serve):
        _serve(figures, act)
    elif isinstance(act, LeaveOut):
        _leave_out(figures, act.whom)
    return dataclasses.replace(request, constraints=constraints_of(figures))


def with_the_assumed(request: Request | None) -> Request | None:
    """A request with the rate for each user that is assumed where least power is asked for and no rate is named."""
    if request is None or "min_rate_bps" in request.constraints:
        return request
    if plugins.objective(request.objective).measure != "power":
        return request
    return dataclasses.replace(request, constraints={**request.constraints, "min_rate_bps": ASSUMED_MIN_RATE_BPS})


def _set(figures: dict[Key, float], kind: str, whom: Whom, value: float) -> None:
    if isinstance(whom, Named):
        figures |= {(kind, _name(user)): value for user in whom.users}
        return
    if isinstance(whom, Everybody):
        for key in _of(figures, kind):
            del figures[key]
    figures[kind, EVERYBODY] = value


def _scale(figures: dict[Key, float], act: Scale, radiated_w: float) -> None:
    if act.reference == "radiated":
        basis = figures.get((act.kind, EVERYBODY), radiated_w)
        if basis > 0:
            figures[act.kind, EVERYBODY] = act.factor * basis
        return
    if isinstance(act.whom, Named):
        for user in act.whom.users:
            key = (act.kind, _name(user))
            held = figures.get(key, figures.get((act.kind, EVERYBODY)))
            if held is not None:
                figures[key] = held * act.factor
        return
    for key in _of(figures, act.kind):
        if key[1] == EVERYBODY or isinstance(act.whom, Everybody):
            figures[key] *= act.factor


def _drop(figures: dict[Key, float], act: Drop) -> None:
    kind, whom = act.kind, act.whom
    if isinstance(whom, Named):
        for user in whom.users:
            figures.pop((kind, _name(user)), None)
            if kind == "min_rate_bps" and (kind, EVERYBODY) in figures and not act.own:
                figures[kind, _name(user)] = 0.0  # to whom nothing is promised
        return
    for key in _of(figures, kind):
        if isinstance(whom, Everybody) or key[1] == EVERYBODY:
            del figures[key]


def _serve(figures: dict[Key, float], act: Serve) -> None:
    out, alone = _of(figures, "leave_out"), _of(figures, "users")
    if not isinstance(act.whom, Named):
        for key in (*out, *alone):
            del figures[key]
        return
    users = [_name(user) for user in act.whom.users]
    for key in out:
        if act.alone or key[1] in users:
            del figures[key]
    for key in alone:
        if act.alone:
            del figures[key]
    if act.alone or alone:
        figures |= {("users", user): 1.0 for user in users}


def _leave_out(figures: dict[Key, float], whom: Whom) -> None:
    """Take users off the list of who is served, or put them on that of who is not."""
    if not isinstance(whom, Named):
        return
    users, served = [_name(user) for user in whom.users], [key[1] for key in _of(figures, "users")]
    if served and set(served) - set(users):
        for user in users:
            figures.pop(("users", user), None)
    else:
        figures |= {("leave_out", user): 1.0 for user in users}


def _of(figures: Mapping[Key, float], kind: str) -> list[Key]:
    return [key for key in figures if key[0] == kind]


def _name(user: str) -> str:
    """One name for a user who can be named by number: "user 3" is "3"."""
    numbered = _NUMBERED.fullmatch(user.strip())
    return numbered[1] if numbered else user


def figures_of(constraints: Mapping[str, Constraint]) -> dict[Key, float]:
    """Constraints by kind and user.

    >>> figures_of({"min_rate_bps": {"all": 5e5, "user 3": 2e6}, "leave_out": ("2",)})
    {('min_rate_bps', 'all'): 500000.0, ('min_rate_bps', '3'): 2000000.0, ('leave_out', '2'): 1.0}
    """
    figures: dict[Key, float] = {}
    for kind, value in constraints.items():
        if isinstance(value, Mapping):
            figures |= {(kind, _name(user)): figure for user, figure in value.items()}
        elif isinstance(value, tuple):
            figures |= {(kind, _name(user)): 1.0 for user in value}
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


def stated_by(after: Request, before: Request | None) -> dict[str, Constraint]:
    """What a request says that the one before it did not: what "that" refers to in the line behind it."""
    held = with_the_assumed(before)
    old = {} if held is None else figures_of(held.constraints)
    new = figures_of(after.constraints)
    return constraints_of({
        key: value for key, value in new.items() if old.get(key, old.get((key[0], EVERYBODY))) != value
    })  # fmt: skip
