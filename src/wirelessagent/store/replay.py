"""Doing a turn's work again: the same observation, problem, cell and tools, and what comes of them now.

On the same version and platform the decision is the same bit for bit, else within 1e-9. A deadline is replayed by the
restarts that it left time for and not by the clock.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast

import numpy as np

from wirelessagent import __version__, chain, plugins
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.store.content import estimate_content, estimate_of, observation_of
from wirelessagent.store.plain import canonical
from wirelessagent.store.rebuilt import cell_of, problem_of
from wirelessagent.store.record_of import decision_columns, ran, this_platform
from wirelessagent.store.stored import StoredTurn

if TYPE_CHECKING:
    from wirelessagent.store.store import Store

TOLERANCE = 1e-9
"""Relative difference up to which figures from another version or platform count as the same."""

Verdict: TypeAlias = Literal["identical", "close", "different"]


@dataclass(frozen=True, kw_only=True)
class Replay:
    """What came of doing a turn's work again.

    Attributes:
        turn: the turn.
        decision: the decision as it is made now.
        verdict: identical (bit for bit), close (all figures within 1e-9 of their largest) or different.
        same_setting: whether version and platform are those of the turn.
        differences: what is not the same, a phrase each.
    """

    turn: StoredTurn
    decision: Decision
    verdict: Verdict
    same_setting: bool
    differences: tuple[str, ...]

    @property
    def summary(self) -> str:
        """The verdict in a sentence."""
        where = "the same version and platform" if self.same_setting else "another version or platform"
        said = {
            "identical": "the same decision bit for bit",
            "close": "the same decision within 1e-9",
            "different": "another decision",
        }[self.verdict]
        return f"{said}, on {where}"


def replay(store: Store, turn: StoredTurn) -> Replay:
    """Repair and decide again as the turn did.

    Raises:
        InputError: nothing was decided in the turn, or a plug-in that it used is not installed.
        StoreError: the turn or the channel that it saw is not what was recorded.
    """
    turn = turn.whole()
    if turn.observation is None or turn.estimate is None:
        raise InputError(f"turn {turn.number} decided nothing ({turn.stage}), so there is nothing to replay")
    observation = observation_of(store.content(turn.observation))
    estimate = chain.repair(observation, turn.repairer["name"], **turn.repairer["options"])
    decision = chain.decide(
        estimate, problem_of(turn, estimate.user_names), cell_of(turn), turn.method["name"], **_options(turn)
    )
    found: list[_Difference] = []
    if estimate_content(estimate).hash != turn.estimate:
        before = estimate_of(store.content(turn.estimate))
        found = [
            *_differences("estimated gain", before.gain, estimate.gain),
            *_differences("its variance", before.gain_variance, estimate.gain_variance),
        ]
    found += _compared(turn, decision_columns(decision))
    return Replay(
        turn=turn,
        decision=decision,
        verdict=_verdict(found),
        same_setting=turn.version == __version__
        and {"kernels": "compiled", **turn.platform} == {**this_platform(), "kernels": ran(estimate, decision)},
        differences=tuple(str(difference) for difference in found),
    )


def _options(turn: StoredTurn) -> dict[str, Any]:
    """The method's options, with what a deadline left time for in its place: restarts, and steps of the search.

    Turns of earlier versions did not count the steps; a thorough search of theirs keeps its deadline.
    """
    options = dict(turn.method["options"])
    counted = "steps" in turn.certificate
    if not counted and options.get("effort", "fast") != "fast":
        return options
    deadlines = [options.pop(name) for name in ("deadline_s", "deadline_ms") if name in options]
    known = {option.name for option in plugins.plugin("method", turn.method["name"]).options}
    for name in ("restarts", "steps"):
        if deadlines and name in known and name in turn.certificate:
            options[name] = turn.certificate[name]
    return options


@dataclass(frozen=True)
class _Difference:
    """By how much one figure is off, relative to the largest of its kind; infinite where that means nothing."""

    name: str
    relative: float

    def __str__(self) -> str:
        return f"{self.name} differs" + (f" by {self.relative:.2g}" if math.isfinite(self.relative) else "")


def _verdict(found: list[_Difference]) -> Verdict:
    if not found:
        return "identical"
    return "close" if all(one.relative <= TOLERANCE for one in found) else "different"


def _compared(turn: StoredTurn, now: Mapping[str, Any]) -> list[_Difference]:
    """How the columns of a decision differ."""
    return [one for name, value in now.items() for one in _differences(name, getattr(turn, name), value)]


def _differences(name: str, before: Any, now: Any) -> Iterator[_Difference]:
    stored, made = (cast("Mapping[str, Any]", one) if isinstance(one, Mapping) else None for one in (before, now))
    if stored is not None and made is not None:
        for key in (*stored, *(key for key in made if key not in stored)):
            yield from _differences(key if name in ("allocation", "certificate") else f"{name}.{key}",
                                    stored.get(key), made.get(key))  # fmt: skip
    elif canonical(before) != canonical(now):
        yield _Difference(name, _relative(name, before, now))


def _relative(name: str, before: Any, now: Any) -> float:
    """The largest difference of numbers over the largest of them; a gap is relative as it is."""
    try:
        one, other = np.array(before, dtype=np.float64), np.array(now, dtype=np.float64)
    except (TypeError, ValueError):
        return math.inf
    if name == "owner" or one.shape != other.shape or not one.size:
        return math.inf
    same = (one == other) | (np.isnan(one) & np.isnan(other))
    off = float(np.max(np.where(same, 0.0, np.abs(one - other))))
    largest = 1.0 if name == "gap" else float(np.max(np.abs([one, other])))
    return off / largest if math.isfinite(off) and largest > 0 else math.inf
