"""What a line comes to: what holds for each user behind it, and did not before."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TypeAlias

from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, LISTS_OF_USERS
from wirelessagent.language.request import Key, Request, assuming, figures_of

Effect: TypeAlias = frozenset[tuple[Key, float | str | None]]
"""What holds after a change and did not before, by kind and user; None for what holds no longer."""

OBJECTIVE, OUT = "objective", "leave_out"


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
    return {**({} if objective is None else {(OBJECTIVE, ""): objective}), **_shown(figures, users)}


def _shown(figures: Mapping[Key, float], users: Sequence[str]) -> dict[Key, float | str]:
    alone = {user for kind, user in figures if kind == "users"}
    out = {user for user in users if (OUT, user) in figures or (alone and user not in alone)}
    shown: dict[Key, float | str] = {(OUT, user): 1.0 for user in users if user in out}
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


def may_hold(effect: Effect) -> bool:
    """Whether each figure of an effect is one that may hold."""
    return all(not isinstance(value, float) or 0 < value < (1 if kind == "outage_probability" else math.inf)
               for (kind, _), value in effect)  # fmt: skip
