"""A request as one sentence, with figures and units, for the operator to check; what was assumed; what was changed."""

from __future__ import annotations

from collections.abc import Sequence

from wirelessagent.agent.dialogue import Diff, Request, constraints_of
from wirelessagent.agent.posing import ASSUMED_OUTAGE_PROBABILITY
from wirelessagent.agent.turn import Run, Shift
from wirelessagent.language.restating import figure_in_words, limits_in_words
from wirelessagent.model.units import human, reliability
from wirelessagent.telling.catalogue import called, joined, message
from wirelessagent.telling.parts import goal_words


def restated(request: Request, language: str = "en") -> str:
    """What is asked for, in one sentence.

    >>> restated(Request(objective="max_rate", constraints={"max_power_w": 10.0, "leave_out": ("3",)}))
    'The highest total rate: at most 10 W of radiated power, without user 3.'
    """
    goal, limits = goal_words(request.objective, language), limits_in_words(request.constraints, language)
    said = goal[:1].upper() + goal[1:]
    if request.method is not None:
        by = message(language, "request.by_method", method=called(language, request.method))
        limits = message(language, "text.between").join(part for part in (limits, by) if part)
    return message(language, "request.whole" if limits else "request.aim_alone", goal=said, limits=limits)


def plan_named(request: Request | None, language: str) -> str:
    """What is asked for, as a part of a sentence."""
    plan = "–" if request is None else restated(request, language).rstrip(".。")
    return plan[:1].lower() + plan[1:]


def notes(run: Run, *, noted: bool, before: Sequence[str] = ()) -> list[str]:
    """The notes of a run as sentences, without those of ``before`` and, where it was ``noted``, without the 95 %."""
    language = run.intent.language
    known = {*before, *([_assumed(language)] if noted else [])}
    return [message(language, "text.note", note=note[:1].upper() + note[1:]) for note in run.notes if note not in known]


def noted_after(run: Run | None, *, noted: bool, requested: bool) -> bool:
    """Whether the 95 % were told, after a turn with this run; another probability that is requested forgets it."""
    if run is None:
        return noted
    if _assumed(run.intent.language) in run.notes:
        return True
    return noted and not (requested and run.decision.problem.outage_probability is not None)


def _assumed(language: str) -> str:
    return message(language, "assumed.outage", sure=reliability(ASSUMED_OUTAGE_PROBABILITY))


def changes_in_words(diff: Diff, shift: Shift | None, language: str) -> str:
    """What was changed of a request that held, and of its decision; empty for a first request.

    >>> from wirelessagent.agent.dialogue import difference
    >>> old, new = (Request(objective="max_rate", constraints={"max_power_w": watts}) for watts in (10.0, 5.0))
    >>> changes_in_words(difference(old, new), None, "en")
    'Now: at most 5 W of radiated power (before: 10 W).'
    """
    if diff.objective[0] is None:
        return ""
    said = list[str]()
    if diff.objective[0] != diff.objective[1] and diff.objective[1] is not None:
        then, now = (goal_words(str(name), language) for name in diff.objective)
        said.append(message(language, "changed.aim", then=then, now=now))
    groups: dict[tuple[str, float | None, float], list[str]] = {}
    for one in diff.changes:
        if one.after is not None:
            groups.setdefault((one.kind, one.before, one.after), []).append(one.user)
    for (kind, before, after), users in groups.items():
        now = limits_in_words(constraints_of({(kind, user): after for user in users}), language)
        then = "" if before is None else figure_in_words(kind, before)
        said.append(message(language, "changed.instead", now=now, then=then) if then else now)
    told = [message(language, "changed.changed", changes=message(language, "text.list").join(said))] if said else []
    if diff.gone:
        told.append(message(language, "request.no_longer", limits=limits_in_words(diff.gone, language)))
    return joined(language, [*told, _shifted(shift, language)])


def _shifted(shift: Shift | None, language: str) -> str:
    """What became of the allocation; empty where that is the same, or where there was none before."""
    if shift is None:
        return ""
    said: list[str] = []
    for name, pair, unit in (("sum_rate", shift.sum_rate_bps, "bit/s"), ("power", shift.power_w, "W")):
        before, now = (human(value, unit) for value in pair)
        said += [message(language, f"changed.{name}", before=before, now=now)] if before != now else []
    if shift.subcarriers:
        said.append(message(language, "changed.subcarriers", moved=shift.subcarriers, total=shift.total))
    if not said:
        return ""
    listed = message(language, "text.list").join(said)
    return message(language, "changed.allocation", changes=listed[:1].upper() + listed[1:])
