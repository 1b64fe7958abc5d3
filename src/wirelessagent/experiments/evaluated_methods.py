"""The repairers of an evaluation by name: every registered one, the competitors and the oracle."""

from __future__ import annotations

import functools
import time
from collections.abc import Iterable, Sequence
from typing import cast

from wirelessagent import chain, plugins
from wirelessagent.experiments.competitors import COMPETITORS, NEED_SKLEARN
from wirelessagent.experiments.evaluated_channels import Drawn
from wirelessagent.experiments.repair_error import comparable_repairers
from wirelessagent.experiments.sklearn_adapter import has_sklearn, require_sklearn
from wirelessagent.model.errors import InputError, UnknownNameError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.repairer import Repairer

ORACLE = "oracle"
BASELINE = "user_mean"


def all_methods() -> tuple[str, ...]:
    """Every method that can be evaluated: registered, competitors, oracle."""
    return (*comparable_repairers(), *COMPETITORS, ORACLE)


def installed_methods() -> tuple[str, ...]:
    """Those of them whose packages are there."""
    return tuple(name for name in all_methods() if name not in NEED_SKLEARN or has_sklearn())


def check_methods(names: Sequence[str]) -> tuple[str, ...]:
    """The names, each once, if all can be evaluated.

    Raises:
        UnknownNameError: nothing of that name.
        MissingDependencyError: the competitor's package is not installed; the message names the extra.
        InputError: no names.
    """
    if not names:
        raise InputError(f"name at least one method to evaluate, of {', '.join(all_methods())}")
    for name in names:
        if name not in all_methods():
            raise UnknownNameError("method", name, all_methods())
        if name in NEED_SKLEARN:
            require_sklearn(f"the competitor {name!r}")
    return tuple(dict.fromkeys(names))


def states_uncertainty(name: str) -> bool:
    """Whether a method says how sure it is."""
    return name not in COMPETITORS


def repaired(name: str, drawn: Drawn, observation: ChannelObservation) -> tuple[ChannelEstimate, float]:
    """A method's estimate and the seconds it took; the call that compiles for a process is not the one timed."""
    repairer = drawn.oracle if name == ORACLE else COMPETITORS.get(name) or _registered(name)
    assert repairer is not None, "channels without an oracle are not asked for one"
    if name not in _warm:
        chain.repair(observation, repairer)
        _warm.add(name)
    start = time.perf_counter()
    estimate = chain.repair(observation, repairer)
    return estimate, time.perf_counter() - start


_warm: set[str] = set()


@functools.cache
def _registered(name: str) -> Repairer:
    return cast(Repairer, plugins.create("repairer", name))


def first_known(names: Iterable[str], wanted: Sequence[str]) -> str:
    """The first of the ``wanted`` names that is there, else the first name."""
    there = tuple(names)
    return next((name for name in wanted if name in there), there[0])
