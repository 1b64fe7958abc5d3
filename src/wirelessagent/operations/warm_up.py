"""warm-up: make the machine code of all kernels, for images, CI, and the background process that small work starts.

What others missed is compiled first; then the rest of the set, by doing a little of everything that there is: each
repairer, each method on each objective it solves, plain and with limits, and what explanations and batches add.
Plug-ins of other packages are exercised in the same way, so that their kernels are compiled, too.
"""

from __future__ import annotations

import itertools
import multiprocessing
import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from multiprocessing.sharedctypes import Synchronized
from typing import Any

import numpy as np
from pydantic import Field

from wirelessagent import chain, plugins
from wirelessagent.kernels import background, supply
from wirelessagent.model.batch_decision import BatchDecision
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import WirelessAgentError
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.problem import Problem
from wirelessagent.operations.operation import Event, Operation, Progress, Request, silent
from wirelessagent.operations.record import Block, Conclusion, Record
from wirelessagent.sensing.loss import random

LIMITS: dict[str, dict[str, Any]] = {
    "plain": {},
    "promised rates": {"min_rate_bps": 200e3},
    "capped": {"max_rate_bps": 2e6, "max_power_w": 5.0, "min_rate_bps": 50e3},
    "uncertain": {"min_rate_bps": 100e3, "outage_probability": 0.05},
    "in groups": {"min_rate_bps": 100e3, "resource_block_group_size": 2, "subcarrier_max_power_w": 2.0},
    "far too much": {"min_rate_bps": 100e6},
}  # fmt: skip
"""Limits that reach kernels which others do not."""


class WarmUpRequest(Request):
    panel = "Options"

    background: bool = Field(
        False, description="give way to other work, and do nothing where another process compiles already"
    )


class WarmUpRecord(Record):
    """What there is now: how many kernels have machine code, of how many, and where it lies."""

    kernels: int
    of: int
    folder: str | None
    time_s: float

    @property
    def conclusion(self) -> Conclusion:
        return "failed" if self.folder is None else "done"

    def blocks(self) -> list[Block]:
        if self.folder is None:
            return ["Nothing was kept: the cache folder cannot be written or trusted."]
        return [f"Machine code of {self.kernels} of {self.of} kernels is in {self.folder} ({self.time_s:.0f} s)."]


@dataclass(frozen=True)
class Exercise:
    """A little work that needs kernels."""

    name: str
    work: Callable[[], object]


def run(request: WarmUpRequest, progress: Progress) -> WarmUpRecord:
    started = time.monotonic()
    if request.background and hasattr(os, "nice"):
        os.nice(19)
    with background.sole_compiler(wait=not request.background) as mine:
        if mine:
            _compile(progress, beside=not request.background)
    now = background.made()
    time_s = time.monotonic() - started
    return WarmUpRecord(kernels=now.done, of=now.total, folder=now.folder and str(now.folder), time_s=time_s)


def _compile(progress: Progress, *, beside: bool) -> None:
    """Do all exercises, with a second process ``beside`` this one that begins at the end; their code has one cache."""
    if beside:
        spawn = multiprocessing.get_context("spawn")
        begin = partial(_begin, spawn.Value("i", 0))
        second = spawn.Process(target=_exercise, args=(begin, silent, True), daemon=True)
        second.start()
        total = _exercise(begin, progress)
        second.join()
    else:
        total = _exercise(itertools.count().__next__, progress)
    progress(Event(stage="compile", message="done", done=total, total=total))


def _begin(begun: Synchronized[int]) -> int:
    """How many exercises had begun before this one."""
    with begun:
        begun.value += 1
        return begun.value - 1


def _exercise(begin: Callable[[], int], progress: Progress, from_the_end: bool = False) -> int:
    """Do exercises until as many have begun, here and elsewhere, as there are; how many that is."""
    work = tuple(exercises())
    with supply.foreground():
        for exercise in reversed(work) if from_the_end else work:
            if (done := begin()) >= len(work):
                break
            progress(Event(stage="compile", message=exercise.name, done=done, total=len(work)))
            background.compile_requests()
            try:
                exercise.work()
            except WirelessAgentError:  # a problem that a method does not solve
                continue
            except Exception as error:  # noqa: BLE001  # a stranger's plug-in must not stop the rest
                background.log.info("%s cannot be compiled: %r", exercise.name, error)
    return len(work)


def exercises() -> Iterator[Exercise]:
    """A little of everything that needs kernels, what is asked for most first."""
    now, past, alike = _observed(num_slots=1), _observed(num_slots=6), _observed(num_slots=1, user_correlation=0.9)
    problems = [
        (f"{objective}, {name}", Problem(objective, **limits))
        for (name, limits), objective in itertools.product(LIMITS.items(), plugins.names("objective"))
    ]
    yield Exercise("repair", lambda: chain.repair(now))
    for name, problem in problems:
        yield Exercise(name, partial(_decide, now, problem))
    for repairer, seen in itertools.product(plugins.names("repairer"), (now, past, alike)):
        yield Exercise(f"repair by {repairer}", partial(chain.repair, seen, repairer))
    yield Exercise("prediction", partial(chain.repair, past, at_s=1.0))
    for method, (name, problem) in itertools.product(plugins.names("method"), problems):
        yield Exercise(f"{name}, by {method}", partial(_decide, now, problem, method))
    for name, problem in problems:
        yield Exercise(f"{name}, thoroughly", partial(_decide, now, problem, "dual", effort="thorough"))
        yield Exercise(f"{name}, in a batch", partial(_decide_batch, now, problem))


def _observed(**how: Any) -> ChannelObservation:
    scene = chain.simulate("rayleigh", seed=1, num_users=4, num_subcarriers=12, snr_db=20.0, **how)
    return scene.observe(random(0.2), seed=1)


def _decide(seen: ChannelObservation, problem: Problem, method: str | None = None, **options: Any) -> Decision:
    return chain.decide(chain.repair(seen), problem, method=method, **options)


def _decide_batch(seen: ChannelObservation, problem: Problem) -> BatchDecision:
    gain = chain.repair(seen).gain
    return chain.decide_batch(np.stack([gain, gain]), problem)


WARM_UP = Operation(
    name="warm-up",
    request=WarmUpRequest,
    record=WarmUpRecord,
    local=True,
    run=run,
    examples=("warm-up",),
)
