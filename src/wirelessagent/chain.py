"""Sense, repair and decide on Python objects: the chain's stages with plug-ins looked up by name."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, TypeVar, cast

import numpy as np

from wirelessagent import kernels, plugins
from wirelessagent.deciding.expected import counted_on
from wirelessagent.deciding.method import Method
from wirelessagent.deciding.soundness import checked
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.batch_decision import BatchDecision
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError, UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.given import given_cell, given_estimate, given_observation, given_problem
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.problem import Problem
from wirelessagent.model.scene import Scene
from wirelessagent.repairing.repairer import Repairer
from wirelessagent.sensing.source import ChannelSource

DEFAULT_REPAIRER, DEFAULT_WITH_HISTORY = "kriging", "predictor"


def simulate(source: str | ChannelSource, cell: Cell | None = None, *, seed: int = 0, **options: Any) -> Scene:
    """A scene from a channel source, named with its options or given; the same seed gives the same scene."""
    chosen = chosen_plugin("channel_source", source, options, ChannelSource, beside=("cell", "seed"))
    return chosen.observe(given_cell(cell), seed=seed)


def repair(
    observation: ChannelObservation,
    method: str | Repairer | None = None,
    *,
    at_s: float | None = None,
    **options: Any,
) -> ChannelEstimate:
    """The current slot's gains, complete. Where nothing is missing, the observation itself and method "none".

    Where no method is named it is kriging or, with history, the predictor.
    The method is "earlier repair" where the observation is complete because gains were repaired before.
    """
    observation = given_observation(observation)
    complete = not observation.missing.any() and at_s is None
    if complete and method is None and not options:
        return _as_observed(observation)
    named = default_repairer(observation) if method is None else method
    chosen = chosen_plugin("repairer", named, options, Repairer, beside=("method", "at_s"))
    if complete:
        return _as_observed(observation)
    with kernels.work_on(observation.gain.size) as work:
        estimate = chosen.repair(observation, at_s=at_s)
    return estimate.computed(work.ran)


def _as_observed(observation: ChannelObservation) -> ChannelEstimate:
    """The estimate where there is nothing to repair."""
    return ChannelEstimate.completing(
        observation,
        gain=observation.current,
        gain_variance=observation.current_noise_variance,
        method="none" if observation.measured[-1].all() else "earlier repair",
    )


def default_repairer(observation: ChannelObservation) -> str:
    """The repairer used when none is named: one that uses all that was observed."""
    return DEFAULT_REPAIRER if observation.num_slots == 1 else DEFAULT_WITH_HISTORY


def perfect(scene: Scene) -> ChannelEstimate:
    """The estimate of somebody who knows the truth: the yardstick for what repair costs."""
    truth = scene.current_truth
    if truth is None:
        raise InputError("the true channel of this scene is not known, so there is no perfect estimate")
    return certain(truth, scene.sensed.user_names)


def certain(gain: FloatArray, user_names: tuple[str, ...]) -> ChannelEstimate:
    """The estimate of somebody who knows each gain (user, subcarrier)."""
    return ChannelEstimate(
        gain=gain,
        gain_variance=np.zeros(gain.shape),
        repaired=np.zeros(gain.shape, dtype=bool),
        unobserved_users=np.zeros(len(gain), dtype=bool),
        user_names=user_names,
        method="perfect",
    )


def resolve(problem: Problem) -> Problem:
    """The problem with its objective looked up, if it was only named."""
    problem = given_problem(problem)
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

    Where nothing is promised, uncertain gains count by the mean rate that they carry
    (:mod:`wirelessagent.deciding.expected`). With an outage probability the rates are promised, and the certificate
    holds, under the estimate's posterior (:mod:`wirelessagent.deciding.outage`). Both hold for every method.

    ``after`` is an earlier decision for the same users, such as the previous slot's, whose prices the search starts
    from. It changes nothing where nothing is searched (the most rate or efficiency without further limits is a closed
    form) or where the earlier one found no prices (``after.prices`` is None).

    Raises:
        UnsupportedProblemError: the method does not solve such problems; the message names those that do.
        InputError: the method does not start from earlier decisions, ``after`` is for other users, a constraint does
            not fit the channel, or an argument is not of its type.
    """
    estimate, cell = given_estimate(estimate), given_cell(cell)
    resolved = resolve(problem).for_users(estimate.user_names)
    named = default_method(resolved) if method is None else method
    chosen = chosen_plugin("method", named, options, Method, beside=("method", "after", "cell"))
    _check(resolved, type(chosen))
    if after is not None:
        _check_start(chosen, estimate, after)
    with kernels.work_on(estimate.gain.size) as work:
        decision = _decided(chosen, estimate, resolved, cell, after)
    return decision.knowing(estimate, work.ran)


def _decided(
    chosen: Method, estimate: ChannelEstimate, problem: Problem, cell: Cell, after: Decision | None
) -> Decision:
    if problem.outage_probability is not None and "outage_probability" not in chosen.constraints:
        from wirelessagent.deciding.outage import decide_with_outage

        return checked(decide_with_outage(chosen, estimate, problem, cell, after), estimate, type(chosen))
    channel = estimate if problem.outage_probability is not None else counted_on(estimate, problem, cell)
    start: dict[str, Any] = {} if after is None else {"after": after}
    with chosen.limited():
        decision = cast(Decision, cast(Any, chosen).solve(channel, problem, cell, **start))
    return checked(decision, channel, type(chosen))


def _check_start(chosen: Method, estimate: ChannelEstimate, after: Decision) -> None:
    """Refuse an earlier decision that is no start for the method on this estimate."""
    if not chosen.warm_starts:
        raise InputError(f"method {chosen.name!r} does not start from an earlier decision: leave out after=…")
    if after.rate_bps.size != estimate.num_users:
        raise InputError(
            f"after=… is a decision for {after.rate_bps.size} users, and the estimate has {estimate.num_users}: "
            "prices of other users are no start, leave it out"
        )


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
    with kernels.work_on(np.size(gain)):
        return decide_all(Dual(restarts=restarts, seed=seed), gain, resolved, given_cell(cell), workers=workers)


_Tool = TypeVar("_Tool", Method, Repairer, ChannelSource)


def chosen_plugin(
    kind: plugins.Kind,
    named: str | _Tool,
    options: Mapping[str, Any],
    base: type[_Tool],
    *,
    beside: tuple[str, ...] = (),
) -> _Tool:
    """A plug-in by its name with its options, or itself; ``beside`` are arguments that the caller takes itself.

    Raises:
        InputError: it is neither, or options were given to one that is made already.
    """
    if isinstance(named, str):
        return cast("_Tool", plugins.create(kind, named, options, beside=beside))
    what = kind.replace("_", " ")
    if not isinstance(cast(object, named), base):
        how = f"a {what} of your own is given as {named.__name__}(…)" if isinstance(named, type) else "name one"
        raise InputError(f"{what} must be a registered name or a wa.{base.__name__}; got {named!r:.80}: {how}")
    if options:
        raise InputError(f"options go to a {what} by name; {type(named).__name__}({', '.join(options)}=…) has its own")
    return named


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
    """Why a method does not solve such problems; empty if it does.

    An outage probability is no reason: for a method that knows of none, :func:`decide` takes care of it.
    """
    if problem.outage_probability is not None and "outage_probability" not in method.constraints:
        problem = dataclasses.replace(problem, outage_probability=None)
    try:
        method.objective_of(problem)
    except UnsupportedProblemError as refusal:
        return str(refusal)
    return ""
