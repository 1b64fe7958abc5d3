"""What was assumed, told with a reply; that rates are promised at 95 % is told once, until the probability changes."""

from __future__ import annotations

from collections.abc import Sequence

from wirelessagent.agent.posing import ASSUMED_OUTAGE_PROBABILITY
from wirelessagent.agent.turn import Run
from wirelessagent.model.units import reliability
from wirelessagent.telling.catalogue import message


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
