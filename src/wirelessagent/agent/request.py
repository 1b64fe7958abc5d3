"""What a conversation asks for at the moment: an objective and constraints, as sentences state and amend them."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field

from wirelessagent import plugins
from wirelessagent.language.conversation.methods import OWN_CHOICE
from wirelessagent.language.followups import joined
from wirelessagent.language.intent import EVERYBODY, Constraint, Intent, checked_constraints

ASSUMED_MIN_RATE_BPS = 200e3
"""Rate promised to each user where the least power is asked for and no rate was named."""


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

    def amended(
        self, constraints: Mapping[str, Constraint], *, objective: str | None = None, dropped: tuple[str, ...] = ()
    ) -> Request:
        """The same request with other figures: what is dropped goes first, then what is stated is merged.

        Figures of named users join those that hold; a figure for everybody replaces them all. Users to leave out add
        up, and users to serve replace all that was said of whom to serve.
        """
        merged = {name: value for name, value in self.constraints.items() if name not in dropped}
        for name, value in constraints.items():
            if name == "users":
                merged.pop("leave_out", None)
            merged[name] = joined(name, merged.get(name), value)
        return Request(objective=objective or self.objective, constraints=merged, method=self.method)


def requested(intent: Intent, before: Request | None) -> Request:
    """The request after a sentence that allocates, in a conversation that asked for ``before`` so far.

    A method that was named once is used until another one is, and a rate that was assumed for each user holds for the
    others where one of them is named.
    """
    assert intent.objective is not None
    if not intent.amends or before is None:
        request = Request(objective=intent.objective, constraints=intent.constraints)
    else:
        held = _with_the_assumed(before) if _names_users(intent.constraints.get("min_rate_bps")) else before
        request = held.amended(intent.constraints, objective=intent.objective, dropped=intent.dropped)
    named = str(intent.details.get("method") or (before and before.method) or OWN_CHOICE)
    return dataclasses.replace(request, method=None if named == OWN_CHOICE else named)


def stated_by(after: Request, before: Request | None) -> dict[str, Constraint]:
    """What a request says that the one before it did not: what "that" refers to in the line behind it."""
    held: Mapping[str, Constraint] = {} if before is None else _with_the_assumed(before).constraints
    changes = {name: _change(held.get(name), value) for name, value in after.constraints.items()}
    return {name: change for name, change in changes.items() if change is not None}


def _with_the_assumed(request: Request) -> Request:
    """A request with the rate for each user that is assumed where it names none, if one is."""
    if "min_rate_bps" in request.constraints or plugins.objective(request.objective).measure != "power":
        return request
    return request.amended({"min_rate_bps": ASSUMED_MIN_RATE_BPS})


def _names_users(rates: Constraint | None) -> bool:
    return isinstance(rates, Mapping) and EVERYBODY not in rates


def _change(held: Constraint | None, value: Constraint) -> Constraint | None:
    if isinstance(value, tuple):
        return tuple(user for user in value if not isinstance(held, tuple) or user not in held) or None
    if not isinstance(value, Mapping):
        return None if value == held else value
    before: Mapping[str, float] = {}
    if held is not None and not isinstance(held, tuple):
        before = held if isinstance(held, Mapping) else {EVERYBODY: held}
    changed = {user: figure for user, figure in value.items() if before.get(user, before.get(EVERYBODY)) != figure}
    return changed or None
