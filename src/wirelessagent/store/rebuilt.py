"""What a row says, as the chain's own types again: intent, cell, problem, decision, outcome."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

import numpy as np

from wirelessagent import plugins
from wirelessagent.language.acts import act_of
from wirelessagent.language.intent import Intent, acts_of
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Bracket, Decision, Prices
from wirelessagent.model.forecast import Forecast
from wirelessagent.model.metrics import LinkMetrics
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.problem import Problem
from wirelessagent.store.record_of import CONSTRAINTS, FIGURES
from wirelessagent.store.stored import StoredTurn

_ARRAYS = ("weights", "min_rate_bps", "max_rate_bps", "subcarrier_max_power_w")


def intent_of(turn: StoredTurn) -> Intent | None:
    """What was understood, as it was; None of a row of before acts were written whole."""
    return _intent(turn.intent) if turn.intent.get("schema", 0) >= 4 else None


def _intent(said: Mapping[str, Any]) -> Intent:
    found: dict[str, Any] = {field.name: _tuples(said[field.name]) for field in dataclasses.fields(Intent)}
    guess, acts = said["guess"], tuple(map(act_of, said["acts"]))
    found.update(acts=(), guess=guess and _intent(guess))
    intent = Intent(**found)
    return intent if acts == acts_of(intent) else dataclasses.replace(intent, acts=acts)


def _tuples(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {name: _tuples(each) for name, each in cast("Mapping[str, Any]", value).items()}
    return tuple(cast("list[Any]", value)) if isinstance(value, list) else value


def cell_of(turn: StoredTurn) -> Cell:
    return Cell(**turn.cell)


def problem_of(turn: StoredTurn, user_names: tuple[str, ...]) -> Problem:
    """The problem that was decided on, every figure as it was, for a channel of these users.

    Raises:
        InputError: its objective is not installed, or has other options by now.
    """
    named = turn.problem["objective"]
    stated = {name: turn.problem[name] for name in CONSTRAINTS if turn.problem[name] is not None}
    for name in _ARRAYS:
        if name in stated:
            stated[name] = _floats(stated[name])
    if "users" in stated:
        recorded: list[int | str] = stated["users"]  # version 0.1 recorded indices
        stated["users"] = tuple(user if isinstance(user, str) else user_names[user] for user in recorded)
    return Problem(plugins.objective(named["name"], named["options"]), **stated).for_users(user_names)


def decision_of(turn: StoredTurn, user_names: tuple[str, ...]) -> Decision:
    """The decision as it was made, with its forecast, for a channel of these users."""
    allocation, certificate = turn.allocation, dict(turn.certificate)
    brackets = {name: _bracket(certificate.pop(name)) for name in ("needed_power_w", "rate_scaling")}
    prices, forecast = certificate.pop("prices"), certificate.pop("forecast")
    arrays = {name: _floats(certificate.pop(name)) for name in ("price_of_rate", "expected_rate_bps", "outage")}
    decision = Decision(
        owner=np.array(allocation["owner"], dtype=np.int64),
        power_w=_floats(allocation["power_w"]),
        rate_bps=_floats(allocation["rate_bps"]),
        **{name: _figure(getattr(turn, name)) for name in FIGURES},
        status=turn.status,  # pyright: ignore[reportArgumentType]  # as it came from a decision
        unit=turn.unit or "",
        method=turn.method["name"],
        problem=problem_of(turn, user_names),
        cell=cell_of(turn),
        user_names=user_names,
        price_of_power=float(certificate.pop("price_of_power")),
        prices=None if prices is None else Prices(log_rate=_floats(prices["log_rate"]),
                                                  log_power=float(prices["log_power"])),
        **brackets,
        **arrays,
        **certificate,
    )  # fmt: skip
    vars(decision)["forecast"] = None if forecast is None else Forecast(**_arrays_and_figures(forecast))
    return decision


def outcome_of(turn: StoredTurn) -> Outcome | None:
    """What the base station did, as it was read back."""
    if turn.applied is None:
        return None
    found = dict(turn.applied)
    achieved = found["achieved"]
    return Outcome(
        base_station=found["base_station"],
        owner=np.array(found["owner"], dtype=np.int64),
        power_w=_floats(found["power_w"]),
        promised_bps=_floats(found["promised_bps"]),
        achieved=None if achieved is None else _metrics(achieved),
        written_to=None if found["written_to"] is None else Path(found["written_to"]),
        slack_bps=None if found.get("slack_bps") is None else _floats(found["slack_bps"]),  # version 0.1 had none
    )


def _metrics(stored: dict[str, Any]) -> LinkMetrics:
    return LinkMetrics(**_arrays_and_figures(stored))


def _arrays_and_figures(stored: dict[str, Any]) -> dict[str, Any]:
    return {name: _floats(value) if isinstance(value, list) else float(value) for name, value in stored.items()}


def _bracket(stored: dict[str, Any] | None) -> Bracket | None:
    return None if stored is None else Bracket(**{side: float(figure) for side, figure in stored.items()})


def _figure(stored: float | None) -> float:
    return math.nan if stored is None else float(stored)


def _floats(stored: Any) -> Any:
    """Numbers, also those that JSON has as text, as an array."""
    return np.array(stored, dtype=np.float64)
