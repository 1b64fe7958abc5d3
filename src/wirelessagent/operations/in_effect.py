"""What is in effect after each recorded turn of a session, and whose request it is."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from wirelessagent.model.outcome import Outcome
from wirelessagent.store.rebuilt import outcome_of
from wirelessagent.store.stored import StoredTurn

_ROUNDING = 1e-6
"""Share of the power by which two allocations may differ and be the same."""


@dataclass(frozen=True, kw_only=True)
class Effect:
    """An allocation that is in effect.

    Attributes:
        allocation: as it was decided, or as it was read back where it was no turn's.
        applied: the turn that applied it first; None where none did.
        request: the last turn whose request it is; ``applied``, or one that found it in effect already.
        outcome: what was read back of it last.
        at_utc: when that was.
        before: what was in effect before the request; None where that is not known.
    """

    allocation: Mapping[str, Any]
    applied: StoredTurn | None
    request: StoredTurn | None
    outcome: Outcome | None
    at_utc: str
    before: Outcome | None


@dataclass(frozen=True, kw_only=True)
class Followed:
    """A turn, the one whose words its request is in, and what was in effect before and after it."""

    turn: StoredTurn
    asked: StoredTurn
    before: Effect | None
    after: Effect | None


def followed(turns: Iterable[StoredTurn]) -> Iterator[Followed]:
    """The turns of one session from its first on.

    Raises:
        StoreError: one was changed since it was recorded.
    """
    done: list[StoredTurn] = []
    effects: list[Effect] = []
    effect: Effect | None = None
    for turn in turns:
        turn.whole()
        after = _after(turn, effect, effects)
        yield Followed(turn=turn, asked=_asked(turn, done), before=effect, after=after)
        done.append(turn)
        if after is not None and after is not effect:
            effects.append(after)
        effect = after


def is_request(turn: StoredTurn) -> bool:
    """Whether a turn decided on something that was to be in effect, as no what-if and no undo does."""
    return turn.decided and turn.stage not in ("answered", "asked", "undone")


def _after(turn: StoredTurn, effect: Effect | None, effects: list[Effect]) -> Effect | None:
    """What is in effect after a turn, from what was before it, and all that ever was."""
    if turn.restored is not None:
        return _put_back(turn, effect, effects)
    if turn.stage == "applied":
        before = None if effect is None else effect.outcome
        return Effect(
            allocation=turn.allocation, applied=turn, request=turn, outcome=outcome_of(turn), at_utc=turn.at_utc,
            before=before,
        )  # fmt: skip
    if turn.stage == "undone" and effect is not None:
        return dataclasses.replace(effect, request=effect.applied)
    if turn.stage != "nothing" or turn.status not in ("optimal", "feasible"):
        return effect
    if effect is None or not _same(turn.allocation, effect.allocation):
        return None  # the base station failed, and what it does now is not known
    return dataclasses.replace(effect, request=turn, before=effect.outcome)


def _put_back(turn: StoredTurn, effect: Effect | None, effects: list[Effect]) -> Effect | None:
    """What was restored, and whose request it is: that of an earlier turn with the same allocation, if any."""
    restored, allocation = outcome_of(dataclasses.replace(turn, applied=turn.restored)), turn.restored or {}
    known = [effect] if effect is not None and turn.stage == "reverted" else effects
    for one in reversed(known):
        if _same(allocation, one.allocation):
            return dataclasses.replace(one, outcome=restored, at_utc=turn.at_utc)
    return Effect(allocation=allocation, applied=None, request=None, outcome=restored, at_utc=turn.at_utc, before=None)


def _asked(turn: StoredTurn, done: list[StoredTurn]) -> StoredTurn:
    """The turn in whose words the request of a turn is: an earlier one where this one only says yes to it."""
    if turn.intent["kind"] == "allocate":
        return turn
    for one in reversed(done):
        asks = is_request(one) and one.intent["kind"] == "allocate"
        if asks and one.problem == turn.problem and _same(one.allocation, turn.allocation):
            return one
    return turn


def _same(one: Any, other: Any) -> bool:
    """Whether two stored allocations are the same, within rounding."""
    power_w, other_w = (np.asarray(each["power_w"], dtype=np.float64) for each in (one, other))
    if power_w.shape != other_w.shape:
        return False
    near = np.allclose(power_w, other_w, rtol=0.0, atol=_ROUNDING * float(other_w.sum()))
    used = other_w > 0
    return near and np.array_equal(np.asarray(one["owner"])[used], np.asarray(other["owner"])[used])
