"""A turn as it is in the store."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from wirelessagent.model.errors import InputError, StoreError
from wirelessagent.store.plain import fingerprint, plain


class Unreadable:
    """What a column holds that is none of the plain data that was put there."""

    def __init__(self, held: object) -> None:
        self._held = held

    def __str__(self) -> str:
        return str(self._held)


@dataclass(frozen=True, kw_only=True)
class StoredTurn:
    """A row: its fields are the columns of :data:`wirelessagent.store.schema.TURN`, JSON as plain data.

    Attributes:
        number: of the turn in the store, from 1 without gaps.
        session, turn: the conversation, and the turn's number in it.
        at_utc: when, ISO 8601.
        text, intent, recogniser, reply, stage: what was said, understood (by whom) and answered, and what came of it.
        seed, version, platform: what figures depend on beside their input.
        objective: by its registered name; None where none was named.
        facts: what was known of the scene.
        observation, estimate: hashes of their contents; None, as all that follows, where nothing was decided.
        repairer, method: name and options.
        problem, cell: what was to be solved, with every figure.
        status, value, bound, gap, unit: the certificate's main figures.
        allocation: owner, power and rates.
        certificate: prices, brackets, iterations and restarts.
        applied: what the base station had afterwards, as it was read back; None where nothing was applied.
        restored: likewise, after the last good allocation was put back.
        notes, explanation: what was assumed, and the decision in words.
        previous: the hash of the turn before in the same session, "" for its first.
        hash: SHA-256 of all the other fields.
    """

    number: int
    session: str
    turn: int
    at_utc: str
    text: str
    intent: Mapping[str, Any]
    recogniser: str
    reply: str
    stage: str
    seed: int
    version: str
    platform: Mapping[str, str]
    objective: str | None
    facts: Mapping[str, str] | None
    observation: str | None
    repairer: Mapping[str, Any]
    estimate: str | None
    problem: Mapping[str, Any]
    cell: Mapping[str, Any]
    method: Mapping[str, Any]
    status: str | None
    value: float | None
    bound: float | None
    gap: float | None
    unit: str | None
    allocation: Mapping[str, Any]
    certificate: Mapping[str, Any]
    applied: Mapping[str, Any] | None
    restored: Mapping[str, Any] | None
    notes: list[str] | None
    explanation: list[str] | None
    previous: str
    hash: str

    @property
    def decided(self) -> bool:
        """Whether the turn made a decision, which can be made again."""
        return self.status is not None

    @property
    def is_whole(self) -> bool:
        """Whether the fields are those that were hashed; a database may hold anything by now."""
        try:
            return sealed(vars(self)) == self.hash
        except (InputError, RecursionError):
            return False

    def whole(self) -> StoredTurn:
        """The turn, where it can be relied on.

        Raises:
            StoreError: it was changed since it was recorded.
        """
        if not self.is_whole:
            raise StoreError(f"turn {self.number} was changed since it was recorded; history show says what is there")
        return self

    def held(self) -> dict[str, Any]:
        """The columns as plain data, whatever they hold."""
        return {name: _held(value) for name, value in vars(self).items()}


def number_of(held: object) -> int | None:
    """The whole number in a column; None where it holds anything else by now."""
    return held if isinstance(held, int) else None


def _held(value: object) -> Any:
    try:
        return plain(value)
    except (InputError, RecursionError):
        return str(value)


def sealed(row: Mapping[str, Any]) -> str:
    """The hash of a row: of the canonical text of its columns but the hash itself, null ones left out."""
    return fingerprint({name: value for name, value in row.items() if name != "hash" and value is not None})
