"""What is answered about a cell that is served to callers elsewhere. None of this needs an array."""

from __future__ import annotations

from typing import Literal

from wirelessagent.language.acts import Press
from wirelessagent.operations.record import GapMatrix, Matrix, Record, SwitchMatrix, Vector
from wirelessagent.operations.turn_record import TurnRecord

__all__ = ["CellFacts", "ChannelAnswer", "HostedTurn", "Press", "SeenAnswer", "TradeOffAnswer", "TradeOffPoint"]


class CellFacts(Record):
    """What a cell is, for people to choose among several."""

    facts: dict[str, str]
    user_names: list[str]
    num_subcarriers: int
    base_station: str | None
    max_power_w: float


class ChannelAnswer(Record):
    """What is known of a channel, linear power gains: as it was sensed, and repaired with standard deviations."""

    user_names: list[str]
    frequencies_hz: Vector | None
    observed_gain: GapMatrix
    gain: Matrix
    gain_sd: GapMatrix
    repaired: SwitchMatrix


class SeenAnswer(Record):
    """What was understood of a file with gains; ``gain`` is the current slot."""

    facts: dict[str, str]
    user_names: list[str]
    num_users: int
    num_subcarriers: int
    num_slots: int
    missing: int
    gain: GapMatrix


class TradeOffPoint(Record):
    """The best that was found at one place of a curve."""

    at: float
    status: str
    value: float | None
    bound: float | None
    total_power_w: float | None
    total_rate_bps: float
    lowest_rate_bps: float


class TradeOffAnswer(Record):
    """The curve that a decision lies on: over the power budget in W, or over all promises by a common factor."""

    varies: Literal["max_power_w", "promises"]
    here: float
    objective: str
    unit: str
    points: list[TradeOffPoint]


class HostedTurn(Record):
    """A turn with what holds after it.

    Attributes:
        in_effect: the turn whose allocation is in effect; None where none is, or where that is not known.
        waits: whether a plan waits to be applied.
    """

    record: TurnRecord
    language: str
    by: str
    in_effect: int | None
    waits: bool
