"""Independent draws, on any executor, with the same result on each.

Every draw has its own seeds, made from the experiment's seed and the draw's number by NumPy's SeedSequence. Neither
the order nor the number of workers matters, and the first draws of a long run are those of a short one.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from wirelessagent import kernels
from wirelessagent.experiments.experiment import Progress
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.errors import InputError

_CHUNK = 20
_GAINS_OF_A_DRAW = 160
"""So many at least: whoever asks for more than a few draws waits for the machine code."""


@dataclass(frozen=True)
class Seeds:
    """The seeds of one draw."""

    channel: int
    loss: int


Draw: TypeAlias = Callable[[Seeds], FloatArray]
"""What one draw measures: an array of the same shape for every draw. To run in other processes it must pickle."""


def run_draws(
    draw: Draw, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
) -> FloatArray:
    """The results of ``draws`` draws, shape (draw, …), in this process or on an executor."""
    if draws < 1:
        raise InputError(f"draws must be 1 or more; got {draws!r}")
    starts = range(0, draws, _CHUNK)
    work = functools.partial(_chunk, draw, seed, draws)
    parts: list[FloatArray] = []
    for part in map(work, starts) if executor is None else executor.map(work, starts):
        parts.append(part)
        if progress is not None:
            progress(min(len(parts) * _CHUNK, draws), draws)
    return np.concatenate(parts)


def seeds_of(seed: int, draw: int) -> Seeds:
    """The seeds of draw number ``draw``, counted from 0."""
    if seed < 0:
        raise InputError(f"seed must be 0 or more; got {seed!r}")
    channel, loss = np.random.SeedSequence(seed, spawn_key=(draw,)).generate_state(2).tolist()
    return Seeds(channel=channel, loss=loss)


def _chunk(draw: Draw, seed: int, draws: int, start: int) -> FloatArray:
    with kernels.work_on(draws * _GAINS_OF_A_DRAW):
        return np.stack([draw(seeds_of(seed, number)) for number in range(start, min(start + _CHUNK, draws))])
