"""What is asked for, and what changed of it, as sentences with figures and units for the operator to check."""

from __future__ import annotations

from wirelessagent.language.replies import figure_in_words, limits_in_words
from wirelessagent.language.request import Diff, Request, constraints_of
from wirelessagent.telling.catalogue import called, joined, message
from wirelessagent.telling.parts import goal_words


def restated(request: Request, language: str = "en") -> str:
    """What is asked for, in one sentence.

    >>> restated(Request(objective="max_rate", constraints={"max_power_w": 10.0, "leave_out": ("3",)}))
    'The highest total rate: at most 10 W of radiated power, without user 3.'
    """
    goal, limits = goal_words(request.objective, language), limits_in_words(request.constraints, language)
    if request.method is not None:
        by = message(language, "request.by_method", method=called(language, request.method))
        limits = message(language, "text.between").join(part for part in (limits, by) if part)
    goal = goal[:1].upper() + goal[1:]
    return message(language, "request.whole" if limits else "request.aim_alone", goal=goal, limits=limits)


def changes_in_words(diff: Diff, language: str) -> str:
    """What was changed of a request that held; empty for a first request.

    >>> from wirelessagent.language.request import difference
    >>> old, new = (Request(objective="max_rate", constraints={"max_power_w": watts}) for watts in (10.0, 5.0))
    >>> changes_in_words(difference(old, new), "en")
    'Now: at most 5 W of radiated power (before: 10 W).'
    """
    then_aim, now_aim = diff.objective
    if then_aim is None:
        return ""
    said = list[str]()
    if now_aim is not None and then_aim != now_aim:
        then, now = goal_words(then_aim, language), goal_words(now_aim, language)
        said.append(message(language, "changed.aim", then=then, now=now))
    groups: dict[tuple[str, float | None, float], list[str]] = {}
    for one in diff.changes:
        if one.after is not None:
            groups.setdefault((one.kind, one.before, one.after), []).append(one.user)
    for (kind, before, after), users in groups.items():
        now = limits_in_words(constraints_of({(kind, user): after for user in users}), language)
        then = "" if before is None else figure_in_words(kind, before)
        said.append(message(language, "changed.instead", now=now, then=then) if then else now)
    told = message(language, "changed.changed", changes=message(language, "text.list").join(said)) if said else ""
    gone = limits_in_words(diff.gone, language)
    return joined(language, [told, message(language, "request.no_longer", limits=gone) if diff.gone else ""])
