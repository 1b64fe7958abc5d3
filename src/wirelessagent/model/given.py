"""What the chain's functions are given, checked by type: a wrong one is answered with the call that was meant."""

from __future__ import annotations

from typing import cast

import numpy as np

from wirelessagent.model.arrays import FloatArray, real_array
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.problem import Problem
from wirelessagent.model.scene import Scene


def given_estimate(value: object) -> ChannelEstimate:
    """``value`` if it is an estimate, else an error that says how to get one from it."""
    if isinstance(value, ChannelEstimate):
        return value
    if isinstance(value, ChannelObservation):
        missing = int(value.missing.sum())
        what = f"an observation with {missing} of {value.missing.size} gains missing"
        how = "repair it first, as in wa.decide(wa.repair(observation), …)"
    elif isinstance(value, Scene):
        what, how = "a scene", "observe and repair it first, as in wa.decide(wa.repair(scene.observe()), …)"
    else:
        what = _described(value)
        how = "gains go in as wa.decide(wa.repair(wa.ChannelObservation(gain=…)), …)"
    raise InputError(f"a decision needs a wa.ChannelEstimate; got {what}: {how}")


def given_observation(value: object) -> ChannelObservation:
    """``value`` if it is an observation, else an error that says how to get one from it."""
    if isinstance(value, ChannelObservation):
        return value
    if isinstance(value, Scene):
        what, how = "a scene", "observe it first, as in wa.repair(scene.observe())"
    else:
        what, how = _described(value), "gains go in as wa.repair(wa.ChannelObservation(gain=…)), missing ones as NaN"
    raise InputError(f"repair needs a wa.ChannelObservation; got {what}: {how}")


def given_problem(value: object) -> Problem:
    """``value`` if it is a problem, else an error that says how to pose it."""
    if isinstance(value, Problem):
        return value
    if isinstance(value, str):
        how = f"wa.Problem({value!r}) poses it"
    else:
        how = "wa.Problem(objective) poses it" if isinstance(value, Objective) else "as in wa.Problem('max_rate')"
    raise InputError(f"problem must be a wa.Problem; got {_described(value)}: {how}")


def given_cell(value: object) -> Cell:
    """``value`` if it is a cell, the default one for None, else an error."""
    if value is None:
        return Cell()
    if isinstance(value, Cell):
        return value
    how = f"a method is named as method={value!r}" if isinstance(value, str) else "as in wa.Cell(max_power_w=20)"
    raise InputError(f"cell must be a wa.Cell; got {_described(value)}: {how}")


def given_gains(value: object) -> FloatArray:
    """``value`` as gains (…, user, subcarrier), else an error that says how to stack what it is."""
    parts = cast("list[object]", value) if isinstance(value, list | tuple) else [value]
    if any(isinstance(part, ChannelEstimate | ChannelObservation | Scene) for part in parts):
        raise InputError(
            "a batch is an array of gains (…, user, subcarrier), not of objects: "
            "stack them, as in wa.decide_batch(np.stack([estimate.gain for estimate in estimates]), …)"
        )
    gain = real_array("gain", cast("FloatArray", value))
    if gain.ndim < 2 or 0 in gain.shape[-2:]:
        raise InputError(f"gain must have the shape (…, user, subcarrier); got {gain.shape}")
    return gain


def _described(value: object) -> str:
    if isinstance(value, np.ndarray):
        return f"an array of shape {cast('FloatArray', value).shape}"
    return repr(value) if isinstance(value, str) else f"an object of type {type(value).__name__}"
