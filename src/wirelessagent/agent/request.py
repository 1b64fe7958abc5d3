"""What a conversation asks for at the moment: an objective and constraints, as sentences state and amend them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, Constraint, Intent, checked_constraints


@dataclass(frozen=True, kw_only=True)
class Request:
    """An objective by its registered name, and constraints as in :class:`~wirelessagent.language.intent.Intent`."""

    objective: str
    constraints: Mapping[str, Constraint] = field(default_factory=dict[str, Constraint])

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
            merged[name] = _joined(name, merged.get(name), value)
        return Request(objective=objective or self.objective, constraints=merged)


def requested(intent: Intent, before: Request | None) -> Request:
    """The request after a sentence that allocates, in a conversation that asked for ``before`` so far."""
    assert intent.objective is not None
    if not intent.amends or before is None:
        return Request(objective=intent.objective, constraints=intent.constraints)
    return before.amended(intent.constraints, objective=intent.objective, dropped=intent.dropped)


def _joined(name: str, held: Constraint | None, stated: Constraint) -> Constraint:
    if name == "leave_out" and isinstance(held, tuple) and isinstance(stated, tuple):
        return tuple(dict.fromkeys((*held, *stated)))
    if name not in FIGURES_OF_USERS or held is None or not isinstance(stated, Mapping) or EVERYBODY in stated:
        return stated
    assert not isinstance(held, tuple)
    return {**(held if isinstance(held, Mapping) else {EVERYBODY: held}), **stated}
