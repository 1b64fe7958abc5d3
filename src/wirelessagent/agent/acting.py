"""Apply, read back, compare with the promise, and revert to the last good allocation where it was not kept.

A base station may do something else than it was told, stop half-way, or do as told on a channel that is not as it was
estimated. Each of these is found in what is read back:

- the allocation that is in effect is not the one that was decided;
- what the true channel carries of the rates promised is more than a tolerance below them in all;
- more promises are missed than the outage probability explains: less than one channel in a thousand misses as many;
- the allocation that was in effect before keeps the same request, and does so better by more than the tolerance.

Where no outage probability was accepted, a missed promise is no fault by itself: on an estimate about half are.
"""

from __future__ import annotations

import contextlib
import re
from dataclasses import dataclass, fields
from numbers import Real
from typing import cast

import numpy as np

from wirelessagent.acting.base_station import BaseStation
from wirelessagent.agent.turn import Run
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.metrics import RATE_TOLERANCE, LinkMetrics
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import message
from wirelessagent.telling.facts.case import in_use
from wirelessagent.telling.parts import name_of_figure

TOLERANCE = 0.1
"""Share by which what is achieved may fall short of what was promised or of what there was before."""

_SAME_POWER = 1e-3
"""Share of the power by which two allocations may differ and be the same: what radios round that do not say how far."""

_ROUNDING = 1e-9

_FIGURES = {each.name for each in fields(LinkMetrics)} - {"user_rate_bps"}

_ESCAPES = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
_LONGEST_MESSAGE = 300
"""Characters of a base station's own message that are told."""

_UNLIKELY = 1e-3
"""Probability below which so many missed promises are not chance."""


@dataclass(frozen=True, kw_only=True)
class Effect:
    """What came of applying a run.

    Attributes:
        run: the run with what was read back; its outcome is None where the base station failed.
        faults: why it was not kept, each in one sentence; empty where it is good.
        restored: what was read back after the last good allocation was put back; None where it was not.
        trouble: why it could not be put back; empty where it could, or where there was none.
        as_decided: whether what was read back is what was decided, whatever it achieves.
    """

    run: Run
    faults: tuple[str, ...] = ()
    restored: Outcome | None = None
    trouble: str = ""
    as_decided: bool = True


def carry_out(run: Run, station: BaseStation, last_good: Run | None, tolerance: float = TOLERANCE) -> Effect:
    """Apply a run's decision; where it is at fault, put the last good one back."""
    language, done = run.intent.language, run
    match _applied(run, station, language):
        case str() as failure:
            faults = amiss = [failure]
        case done, outcome:
            faults = amiss = _differences(run.decision, outcome, station, language)
            if not amiss:
                broken = _broken_promises(run.decision, outcome, tolerance, language)
                faults = [*broken, *_worse(done, last_good, tolerance)]
    restored, trouble = None, ""
    if faults and last_good is not None:
        try:
            _, restored, trouble = put_back(last_good, station, language)
        except InputError as error:  # something was applied before, so what is in effect has to be told
            trouble = message(language, "station.failed", station=station.name, why=_plain(error))
    return Effect(run=done, faults=tuple(faults), restored=restored, trouble=trouble, as_decided=not amiss)


def put_back(good: Run, station: BaseStation, language: str) -> tuple[Run, Outcome | None, str]:
    """An earlier run after it was applied again, what was read back, and what went wrong with that."""
    match _applied(good, station, language):
        case str() as failure:
            return good, None, failure
        case back, outcome:
            return back, outcome, " ".join(_differences(good.decision, outcome, station, language))


def applied_line(run: Run) -> str:
    """What the base station made of a run, in one sentence."""
    language, outcome = run.intent.language, run.outcome
    assert outcome is not None
    if outcome.written_to is not None:
        return message(language, "applied.written", path=outcome.written_to)
    if outcome.achieved is None:
        return message(language, "applied.unmeasured", station=outcome.base_station)
    promised = outcome.promised_bps > 0
    kept, served = int(np.count_nonzero(promised & ~outcome.missed)), int(np.count_nonzero(promised))
    count = message(language, "applied.all" if kept == served > 1 else "applied.some", kept=kept, served=served)
    key = f"applied.{run.decision.problem.firmness}"
    return message(language, key, station=outcome.base_station, count=count)


def same_allocation(one: Decision, other: Decision) -> bool:
    """Whether two decisions are the same for the base station and the users, within rounding."""
    return (
        (one.owner.shape, one.rate_bps.shape) == (other.owner.shape, other.rate_bps.shape)
        and bool(np.array_equal(in_use(one), in_use(other)))
        and bool(np.allclose(one.power_w, other.power_w, rtol=0, atol=_ROUNDING * one.total_power_w))
        and bool(np.allclose(one.committed_bps, other.committed_bps, rtol=_ROUNDING, atol=0))
    )


def respects(allocation: Decision | Outcome, wanted: Decision) -> bool:
    """Whether an allocation keeps the limits on power and on who is served where that another decision of the same cell
    had to keep.
    """
    problem, users = wanted.problem, wanted.rate_bps.size
    used = np.flatnonzero(allocation.power_w > 0)
    owner = allocation.owner[used]
    cap = np.inf if problem.subcarrier_max_power_w is None else problem.subcarrier_max_power_w
    return bool(
        allocation.owner.shape == wanted.owner.shape
        and allocation.power_w.sum() <= problem.budget_w(wanted.cell) * (1 + RATE_TOLERANCE)
        and np.all(allocation.power_w <= np.asarray(cap) * (1 + RATE_TOLERANCE))
        and np.all(problem.serves(users)[owner])
        and np.all(problem.allows((users, allocation.owner.size))[owner, used])
    )


def _applied(run: Run, station: BaseStation, language: str) -> tuple[Run, Outcome] | str:
    """A run after it was applied, with what was read back, or why nothing can be made of that."""
    try:
        outcome = station.apply(run.decision)
    except InputError:  # what it was made with, or was given, cannot be used; nothing was touched
        raise
    except (Exception, SystemExit) as error:  # noqa: BLE001  # equipment of any make must not end the conversation
        return message(language, "station.failed", station=station.name, why=_plain(error))
    if _is_readable(outcome, run.decision):
        with contextlib.suppress(Exception):  # figures of any kind may be read back
            return run.with_outcome(outcome), outcome
    return message(language, "station.misread", station=station.name)


def _plain(error: BaseException) -> str:
    """The message of an error as one short line, without control characters and their sequences."""
    try:
        said = str(error)
    except Exception:  # noqa: BLE001  # not even that is sure of equipment of any make
        said = type(error).__name__
    shown = "".join(sign if sign.isprintable() else " " for sign in _ESCAPES.sub("", said))
    return " ".join(shown.split())[:_LONGEST_MESSAGE]


def _is_readable(outcome: object, decision: Decision) -> bool:
    """Whether what was read back is an allocation in arrays of numbers, of any size, with rates of these users."""
    if not isinstance(outcome, Outcome):
        return False
    users, achieved = decision.rate_bps.shape, outcome.achieved
    rates = [outcome.promised_bps, outcome.missed, *([] if achieved is None else [achieved.user_rate_bps])]
    figures = [] if achieved is None else [getattr(achieved, name) for name in _FIGURES]
    readable = all(map(_is_row, (outcome.owner, outcome.power_w, *rates)))
    readable &= all(isinstance(figure, Real) for figure in figures)
    return readable and outcome.owner.shape == outcome.power_w.shape and all(each.shape == users for each in rates)


def _is_row(values: object) -> bool:
    if not isinstance(values, np.ndarray):
        return False
    row = cast("np.ndarray[tuple[int, ...], np.dtype[np.generic]]", values)
    return row.ndim == 1 and row.dtype.kind in "biuf"


def _differences(decision: Decision, outcome: Outcome, station: BaseStation, language: str) -> list[str]:
    """How what was read back differs from what was decided, beyond the steps in which the base station sets power."""
    count = decision.owner.size
    if outcome.owner.shape != decision.owner.shape or outcome.power_w.shape != decision.power_w.shape:
        return [message(language, "station.other_shape", read=outcome.owner.size, planned=count)]
    found: list[str] = []
    away = np.abs(outcome.power_w - decision.power_w)
    off = np.where(away <= station.power_resolution_w, 0.0, away)
    if not off.sum() <= _SAME_POWER * decision.total_power_w:  # NaN is a difference too
        read, planned = float(outcome.power_w.sum()), decision.total_power_w
        found.append(message(language, "station.other_power", read=human(read, "W"), planned=human(planned, "W")))
    moved = int(np.count_nonzero((in_use(outcome) != in_use(decision)) & (outcome.power_w > 0)))
    if moved:
        found.append(message(language, "station.other_owner", moved=moved, total=count))
    return found


def _broken_promises(decision: Decision, outcome: Outcome, tolerance: float, language: str) -> list[str]:
    """What the true channel carries less of than was promised."""
    if outcome.achieved is None:
        return []
    found: list[str] = []
    promised, achieved_bps = outcome.promised_bps, outcome.achieved.user_rate_bps
    carried, total = float(np.minimum(_known(achieved_bps), promised).sum()), float(decision.committed_bps.sum())
    if not carried >= total * (1 - tolerance):  # NaN is not kept
        short, of = percent(1 - carried / total), human(total, "bit/s")
        found.append(message(language, "station.too_little", carried=human(carried, "bit/s"), promised=of, short=short))
    outage, unknown = decision.problem.outage_probability, np.isnan(achieved_bps) & (promised > 0)
    missed, served = int(np.count_nonzero(outcome.missed | unknown)), int(np.count_nonzero(promised > 0))
    if outage is not None and missed:
        from scipy.special import bdtrc  # a quarter of a second, and few need it

        if float(bdtrc(missed - 1, served, outage)) < _UNLIKELY:  # so many or more, each missed with this outage
            sure = reliability(outage)
            found.append(message(language, "station.too_many", missed=missed, served=served, sure=sure))
    return found


def _known(rate: FloatArray) -> FloatArray:
    """Rates with 0 for those that were not measured: what is not known is not kept."""
    return np.where(np.isnan(rate), 0.0, rate)


def _worse(run: Run, good: Run | None, tolerance: float) -> list[str]:
    """What the last good allocation, where it keeps the same request, gives more than the new one."""
    if good is None or not _keeps(run, good):
        return []
    now, before = _worth(run, run.outcome), _worth(run, good.outcome)
    lost = now - before * (1 + tolerance) if run.case.falls else before * (1 - tolerance) - now
    if lost <= 0:  # NaN is worse
        return []
    language, unit = run.intent.language, run.decision.unit
    figure = name_of_figure(run.decision, language) or message(language, "text.value")
    told = {"figure": figure, "now": human(now, unit), "before": human(before, unit)}
    return [message(language, "station.worse_than_before", **told)]


def _worth(run: Run, outcome: Outcome | None) -> float:
    """The value of what was read back, for the objective of ``run``."""
    problem, achieved = run.decision.problem, outcome and outcome.achieved
    assert achieved is not None
    users = achieved.user_rate_bps.size
    useful = np.minimum(_known(achieved.user_rate_bps), problem.max_rates_bps(users))
    return run.case.objective.value(useful, achieved.power_w, run.decision.cell, problem.weights_of(users))


def _keeps(run: Run, good: Run) -> bool:
    """Whether an earlier allocation, as it was read back on the same channel, keeps the constraints of ``run``."""
    problem, outcome = run.decision.problem, good.outcome
    truth, earlier = run.scene.current_truth, good.scene.current_truth
    if outcome is None or outcome.achieved is None or run.outcome is None or run.outcome.achieved is None:
        return False
    if truth is None or earlier is None or not np.array_equal(truth, earlier):
        return False
    least, slack = run.case.promised_bps, 0.0 if outcome.slack_bps is None else outcome.slack_bps
    return bool(
        respects(outcome, run.decision)
        and np.all(outcome.achieved.user_rate_bps >= least * (1 - RATE_TOLERANCE) - slack)
        and problem.resource_block_group_size in (1, good.decision.problem.resource_block_group_size)
    )
