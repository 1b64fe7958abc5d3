"""Everything that a line of a talk may change of what holds, by its figures, its users and what was said before.

Which of it the line means is weighed elsewhere (:mod:`.weighing`); nothing else can be meant, so that no line changes a
figure that neither it nor the talk says.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator, Sequence

from wirelessagent.language.acts import Act, Aim, Everybody, Limit, Undo
from wirelessagent.language.conversation.change import Change, changed_by
from wirelessagent.language.conversation.figures_said import corrected, of_figures, of_shares
from wirelessagent.language.conversation.possible import OF_THE_CELL, Possible, may_hold
from wirelessagent.language.conversation.users_said import like_another, of_limits, of_users
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, is_allowed
from wirelessagent.language.request import acts_between
from wirelessagent.language.sentence import BUILT_IN

_MOST_STEPS = 3


def changes_of(possible: Possible) -> list[Change]:
    """Each that a line may say; what can't hold, or holds already, comes to nothing."""
    sayings = (of_figures, of_shares, corrected, like_another, of_users, of_limits, back_and_aims)
    found = itertools.chain.from_iterable(said(possible) for said in sayings)
    effects = ((each, possible.effect(each.acts)) for each in found if each.acts)
    return [
        dataclasses.replace(each, effect=effect if may_hold(effect) and _may_be_set(each.acts) else frozenset())
        for each, effect in effects
    ]


def _may_be_set(acts: Sequence[Act]) -> bool:
    """Whether each figure that acts set is one that a limit may have."""
    limits = ((act, EVERYBODY if isinstance(act.whom, Everybody) else "") for act in acts if isinstance(act, Limit))
    return all(is_allowed(limit.kind, limit.value, user=user) for limit, user in limits)


def back_and_aims(possible: Possible) -> Iterator[Change]:
    if possible.supposed:
        yield changed_by(possible.supposed, "as supposed")
    said = [int(figure.value) for figure in possible.line.figures if figure.kind == "number"]
    for steps in dict.fromkeys((*range(1, _MOST_STEPS + 1), *said)):
        if 0 < steps <= len(possible.context.past):
            form = f"undo {min(steps, _MOST_STEPS)}"
            yield changed_by([Undo(steps=steps)], form, "", "said" if steps in said else "")
    for objective in BUILT_IN:
        yield changed_by([Aim(objective=objective)], "aim", objective)
    yield from _as_before(possible)
    yield from _once_more(possible)


def _once_more(possible: Possible) -> Iterator[Change]:
    """The last change of figures again, by as much or as many times."""
    before = possible.past[0] if possible.past else {}
    stepped = [(key, before[key], after) for key, after in possible.figures.items() if after and before.get(key)]
    if any(one != other for _, one, other in stepped):
        sums, products = {k: 2 * b - a for k, a, b in stepped}, {k: b * b / a for k, a, b in stepped}
        for form, again in (("again", sums), ("as much again", products)):
            yield changed_by(acts_between(possible.figures, {**possible.figures, **again}), form, "", "last")


def _as_before(possible: Possible) -> Iterator[Change]:
    """A limit as it last was when it was otherwise: "the cap holds again", "back to ten"."""
    for kind in (*FIGURES_OF_USERS, *OF_THE_CELL):
        now = {key: figure for key, figure in possible.figures.items() if key[0] == kind}
        for held in possible.past:
            then = {key: figure for key, figure in held.items() if key[0] == kind}
            if then and then != now:
                yield changed_by(acts_between(now, then), "as before", kind, "held" if now else "gone")
                break
