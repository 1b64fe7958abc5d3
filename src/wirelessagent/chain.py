"""Sense, repair, decide and compare on Python objects: the chain's stages with plug-ins looked up by name."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from wirelessagent import plugins
from wirelessagent.deciding.method import Method
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.batch_decision import BatchDecision
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError, UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.problem import Problem
from wirelessagent.model.scene import Scene
from wirelessagent.repairing.repairer import Repairer
from wirelessagent.sensing.source import ChannelSource

DEFAULT_REPAIRER = "nncf"


def simulate(source: str | ChannelSource, cell: Cell | None = None, *, seed: int = 0, **options: Any) -> Scene:
    """A scene from a channel source, named with its options or given; the same seed gives the same scene."""
    chosen = plugins.create("channel_source", source, options) if isinstance(source, str) else source
    return cast(ChannelSource, chosen).observe(cell or Cell(), seed=seed)


def repair(
    observation: ChannelObservation,
    method: str | Repairer = DEFAULT_REPAIRER,
    *,
    at_s: float | None = None,
    **options: Any,
) -> ChannelEstimate:
    """The current slot's gains, complete. Where nothing is missing, the observation itself and method "none".

    The method is "earlier repair" where the observation is complete because gains were repaired before.
    """
    if not observation.missing.any() and at_s is None:
        return ChannelEstimate.completing(
            observation,
            gain=observation.current,
            gain_variance=observation.current_noise_variance,
            method="none" if observation.measured[-1].all() else "earlier repair",
        )
    chosen = plugins.create("repairer", method, options) if isinstance(method, str) else method
    return cast(Repairer, chosen).repair(observation, at_s=at_s)


def perfect(scene: Scene) -> ChannelEstimate:
    """The estimate of somebody who knows the truth: the yardstick for what repair costs."""
    truth = scene.current_truth
    if truth is None:
        raise InputError("the true channel of this scene is not known, so there is no perfect estimate")
    return ChannelEstimate(
        gain=truth,
        gain_variance=np.zeros(truth.shape),
        repaired=np.zeros(truth.shape, dtype=bool),
        unobserved_users=np.zeros(len(truth), dtype=bool),
        user_names=scene.sensed.user_names,
        method="perfect",
    )


def resolve(problem: Problem) -> Problem:
    """The problem with its objective looked up, if it was only named."""
    if isinstance(problem.objective, str):
        return problem.resolved(plugins.objective(problem.objective))
    return problem


def default_method(problem: Problem) -> str:
    """The method used for a problem when none is named: its objective's own choice."""
    objective = resolve(problem).objective
    assert not isinstance(objective, str)
    return objective.default_method


def decide(
    estimate: ChannelEstimate,
    problem: Problem,
    cell: Cell | None = None,
    method: str | Method | None = None,
    *,
    after: Decision | None = None,
    **options: Any,
) -> Decision:
    """The allocation for ``problem`` on the estimated channel, with its certificate.

    ``after`` is an earlier decision, such as the previous slot's, whose prices the search starts from.

    Raises:
        UnsupportedProblemError: the method does not solve such problems; the message names those that do.
        InputError: the method does not start from earlier decisions, or a constraint does not fit the channel.
    """
    resolved = resolve(problem)
    name = default_method(resolved) if method is None else method
    chosen = cast(Method, plugins.create("method", name, options) if isinstance(name, str) else name)
    _check(resolved, type(chosen))
    if after is None:
        return chosen.solve(estimate, resolved, cell or Cell())
    if not chosen.warm_starts:
        raise InputError(f"method {chosen.name!r} does not start from an earlier decision: leave out after=…")
    return cast(Decision, cast(Any, chosen).solve(estimate, resolved, cell or Cell(), after=after))


def decide_batch(
    gain: FloatArray,
    problem: Problem,
    cell: Cell | None = None,
    *,
    restarts: int | None = None,
    seed: int = 0,
    workers: int | None = None,
) -> BatchDecision:
    """The method dual's decisions for many channels of one cell: slots, draws, or cells that are alike.

    The same decisions as :func:`decide` makes one by one, without its cost per call and on several threads.

    Args:
        gain: complete linear power gains, shape (…, user, subcarrier).
        problem: what to decide on each of them.
        restarts: of the local search; the method's own choice if not given.
        seed: of the restarts.
        workers: threads; as many as there are processors if not given.

    Raises:
        UnsupportedProblemError: the method does not solve such problems.
        InputError: the gains are not complete, or a constraint does not fit them.
    """
    from wirelessagent.deciding.batch import decide_all
    from wirelessagent.deciding.methods.dual import Dual

    resolved = resolve(problem)
    _check(resolved, Dual)
    return decide_all(Dual(restarts=restarts, seed=seed), gain, resolved, cell or Cell(), workers=workers)


def check_solvable(problem: Problem, method: str | None = None) -> None:
    """What :func:`decide` refuses, before there is a channel to decide on.

    Raises:
        UnsupportedProblemError: the method (or the default one) does not solve such problems; the message names those
            that do.
    """
    resolved = resolve(problem)
    _check(resolved, plugins.load("method", method or default_method(resolved)))


def _check(problem: Problem, method: type[Method]) -> None:
    refusal = _refusal(problem, method)
    if refusal:
        able = [one.name for one in plugins.plugins("method") if one.cls and not _refusal(problem, one.cls)]
        raise UnsupportedProblemError(f"{refusal} ({', '.join(able) or 'no installed method does'})")


def _refusal(problem: Problem, method: type[Method]) -> str:
    """Why a method does not solve such problems; empty if it does."""
    try:
        method.objective_of(problem)
    except UnsupportedProblemError as refusal:
        return str(refusal)
    return ""


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """One method's answer beside the others': its decision, or why it has none, and the time it took."""

    method: str
    decision: Decision | None
    refusal: str
    time_s: float


def compare(
    estimate: ChannelEstimate,
    problem: Problem,
    cell: Cell | None = None,
    methods: Iterable[str] | None = None,
) -> list[Comparison]:
    """Each method's decision on the same problem; all methods that solve it if none are named.

    The time is the second call's, so that compiling is not counted. A method that was named and does not solve the
    problem is listed with its refusal; one that was not named is left out.
    """
    resolved = resolve(problem)
    found: list[Comparison] = []
    for name in plugins.names("method") if methods is None else methods:
        try:
            decide(estimate, resolved, cell, name)
        except UnsupportedProblemError as refusal:
            if methods is not None:
                found.append(Comparison(method=name, decision=None, refusal=str(refusal), time_s=np.nan))
            continue
        start = time.perf_counter()
        decision = decide(estimate, resolved, cell, name)
        elapsed = time.perf_counter() - start
        found.append(Comparison(method=name, decision=decision, refusal="", time_s=elapsed))
    return found
