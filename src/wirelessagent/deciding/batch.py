"""The method ``dual`` on many channels at once, shared out over threads.

The kernels are those of one problem in a loop (:mod:`.core.batch_kernel`), and the rest is done for a whole chunk of
problems at a time, so the answers are those of one by one. Problems that need more than one search (promised rates
that were not kept, users who cannot all be served, restarts in rounds) are handed to the method one by one.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wirelessagent.deciding.core.batch_search import Searches, search_objectives, search_promises
from wirelessagent.deciding.core.certificate import judged
from wirelessagent.deciding.core.closed_form import closed_allocations, nats_worth
from wirelessagent.deciding.core.dual_search import Effort
from wirelessagent.deciding.core.exact_powers import to_the_last_bit
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import LEAST_POWER, Program, Programs
from wirelessagent.deciding.core.unserved import needy_users
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray, whole
from wirelessagent.model.batch_decision import BatchDecision
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.given import given_gains
from wirelessagent.model.observation import check_gain
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import user_rate_bps
from wirelessagent.model.user_names import numbered

_LARGEST_CHUNK = 256
_CHUNKS_PER_WORKER = 4


def decide_all(
    method: Dual, gain: FloatArray, problem: Problem, cell: Cell, *, workers: int | None = None
) -> BatchDecision:
    """The decision of ``method`` for each channel of ``gain`` (…, user, subcarrier), by ``workers`` threads.

    Raises:
        UnsupportedProblemError, InputError: as for one problem.
    """
    gain = given_gains(gain)
    problem = problem.for_users(numbered(gain.shape[-2]))
    leading = gain.shape[:-2]
    flat = np.ascontiguousarray(gain.reshape(math.prod(leading), *gain.shape[-2:]))
    check_gain(flat)
    if np.isnan(flat).any():
        raise InputError("the gains of a batch must be complete: repair the missing ones (NaN) first")
    workers = (os.cpu_count() or 1) if workers is None else whole("workers", workers)
    results = _Results.empty(*flat.shape)
    size = max(1, min(_LARGEST_CHUNK, math.ceil(len(flat) / (workers * _CHUNKS_PER_WORKER))))
    chunks = [slice(first, first + size) for first in range(0, len(flat), size)]
    decide = _decider(method, flat, problem, cell, results)
    if workers == 1 or len(chunks) <= 1:
        for chunk in chunks:
            decide(chunk)
    else:
        with ThreadPoolExecutor(workers) as pool:
            runs = [pool.submit(copy_context().run, decide, chunk) for chunk in chunks]
        for run in runs:
            run.result()  # which raises what a thread has raised
    return results.of_shape(leading, method.objective_of(problem).unit, problem, cell)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Results:
    """Where the threads write to, one row per problem; named as in :class:`BatchDecision`."""

    owner: IntArray
    power_w: FloatArray
    rate_bps: FloatArray
    status: NDArray[np.str_]
    value: FloatArray
    bound: FloatArray
    gap: FloatArray

    @classmethod
    def empty(cls, batch: int, users: int, subcarriers: int) -> _Results:
        return cls(
            owner=np.empty((batch, subcarriers), dtype=np.int64),
            power_w=np.empty((batch, subcarriers)),
            rate_bps=np.empty((batch, users)),
            status=np.empty(batch, dtype="<U10"),
            value=np.empty(batch),
            bound=np.empty(batch),
            gap=np.empty(batch),
        )

    def of_shape(self, leading: tuple[int, ...], unit: str, problem: Problem, cell: Cell) -> BatchDecision:
        shaped = {name: part.reshape((*leading, *part.shape[1:])) for name, part in vars(self).items()}
        return BatchDecision(**shaped, unit=unit, problem=problem, cell=cell)


def _decider(
    method: Dual, gain: FloatArray, problem: Problem, cell: Cell, results: _Results
) -> Callable[[slice], None]:
    """A function that decides on one chunk of the channels."""
    single = NormalForm.of(method, _estimate(np.zeros(gain.shape[1:])), problem, cell)
    needy, effort = needy_users(single, Program.of(single)), method.plan.effort_for(single)
    in_rounds = method.restarts is not None and method.restarts > effort.restarts

    def decide(chunk: slice) -> None:
        form = single.on(gain[chunk])
        found, doubtful = _solve(form, gain[chunk], effort, needy, in_rounds=in_rounds)
        power_w = to_the_last_bit(form, gain[chunk], found.owner, found.power_w)
        rate = user_rate_bps(gain[chunk], found.owner, power_w, cell)
        weight = problem.weights_of(single.weight.size)
        value = form.objective.values(rate, power_w.sum(axis=-1), cell, weight)
        results.owner[chunk], results.power_w[chunk], results.rate_bps[chunk] = found.owner, power_w, rate
        results.value[chunk] = value
        for row in np.flatnonzero(~doubtful):
            verdict = judged(form.objective, float(value[row]), float(found.bound[row]), method.name)
            number = row + chunk.start
            results.bound[number], results.gap[number], results.status[number] = verdict
        for number in np.flatnonzero(doubtful) + chunk.start:
            decision = method.solve(_estimate(gain[number]), problem, cell)
            for name, column in vars(results).items():
                column[number] = getattr(decision, name)

    return decide


def _solve(
    form: NormalForm, gain: FloatArray, effort: Effort, needy: BoolArray, *, in_rounds: bool
) -> tuple[Searches, BoolArray]:
    """What is found for each channel, and where one search is not enough, shape (batch,)."""
    batch, subcarriers = len(form.snr_per_w), form.snr_per_w.shape[-1]
    certain, worth = np.zeros(batch, dtype=bool), nats_worth(form)
    if worth is not None:
        closed = closed_allocations(form, worth)
        return Searches.finished(closed.owner, closed.power_w, closed.bound), certain
    programs, promised = Programs.of(form), bool(form.promised_nats.any())
    if programs.goal == LEAST_POWER and not promised:
        nobody = np.full((batch, subcarriers), -1, dtype=np.int64)
        return Searches.finished(nobody, np.zeros((batch, subcarriers)), np.zeros(batch)), certain
    doubtful, known = np.full(batch, in_rounds), None
    if promised:
        wanted = programs.goal == LEAST_POWER
        least = search_promises(form, effort if wanted else Effort(restarts=0, seed=0))
        doubtful = doubtful | ~least.fits(form)
        if wanted:
            return least, doubtful
        known = least.owner
    found = search_objectives(form, gain, programs, effort, known)
    doubtful = doubtful | ~found.kept
    if needy.any():
        from wirelessagent.deciding.core.batch_kernel import all_servable

        doubtful = doubtful | ~all_servable(form.snr_per_w, form.start, needy | (form.promised_nats > 0))
    return found, doubtful


def _estimate(gain: FloatArray) -> ChannelEstimate:
    """The estimate of somebody who takes the gains (user, subcarrier) for the truth."""
    users = len(gain)
    return ChannelEstimate(
        gain=gain,
        gain_variance=np.zeros(gain.shape),
        repaired=np.zeros(gain.shape, dtype=bool),
        unobserved_users=np.zeros(users, dtype=bool),
        user_names=numbered(users),
        method="none",
    )
