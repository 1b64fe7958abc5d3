"""What a request says and no standard has a place for, as named remarks; and what it would take where it cannot be."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from wirelessagent.model.decision import Bracket
from wirelessagent.model.units import human
from wirelessagent.standards.subject import Subject

Relation: TypeAlias = Literal["equal", "at most", "within", "all of"]
Value: TypeAlias = bool | int | float | str | list[float] | list[str]


@dataclass(frozen=True)
class Remark:
    """A named figure beside what the standard knows; the unit is part of the name."""

    name: str
    relation: Relation
    value: Value


def remarks(subject: Subject) -> list[Remark]:
    """What holds for the whole request: the objective by name, and limits that the standards do not have."""
    problem, cell, decision = subject.decision.problem, subject.cell, subject.decision
    found = [
        Remark("Objective", "equal", subject.objective.name),
        Remark("ObservationPeriodInSeconds", "equal", subject.observation_period_s),
        Remark("CircuitPowerInW", "equal", cell.circuit_power_w),
        Remark("AmplifierEfficiency", "equal", cell.amplifier_efficiency),
    ]
    if problem.max_power_w is not None:
        found.append(Remark("RadiatedPowerInW", "at most", problem.max_power_w))
    if problem.outage_probability is not None:
        found.append(Remark("OutageProbability", "at most", problem.outage_probability))
    if problem.users is not None:
        served = [decision.user_names[user] for user in np.flatnonzero(subject.served)]
        found.append(Remark("ServedUEs", "all of", served))
    most = problem.max_rates_bps(decision.rate_bps.size)
    if np.isfinite(most).any():
        limited = np.flatnonzero(np.isfinite(most))
        found.append(Remark("UEsOfLimitedDemand", "all of", [decision.user_names[user] for user in limited]))
        found.append(Remark("DemandInKbps", "at most", (most[limited] / 1e3).tolist()))
    if problem.weights is not None:
        found.append(Remark("UEs", "all of", list(decision.user_names)))
        found.append(Remark("UEWeights", "equal", problem.weights_of(decision.rate_bps.size).tolist()))
    if problem.subcarrier_max_power_w is not None:
        caps = np.broadcast_to(np.asarray(problem.subcarrier_max_power_w), decision.owner.shape)
        lowest = np.where(np.isfinite(caps), caps, cell.max_power_w)
        found.append(Remark("SubcarrierPowerInW", "at most", lowest.tolist()))
    if problem.resource_block_group_size > 1:
        found.append(Remark("ResourceBlockGroupSize", "equal", problem.resource_block_group_size))
    if problem.forbidden is not None:
        pairs = [
            f"{decision.user_names[user]}: {tone}" for user, tone in zip(*np.nonzero(problem.forbidden), strict=True)
        ]
        found.append(Remark("ForbiddenUESubcarriers", "all of", pairs))
    return found


def needs(subject: Subject) -> list[tuple[Remark, str]]:
    """What a request that cannot be kept would take, each from both sides, with a sentence on it."""
    found: list[tuple[Remark, str]] = []
    if subject.needed_power_w is not None:
        need = subject.needed_power_w
        told = f"the promised rates need {_between(need, 'W')} of radiated power"
        found += [(remark, told) for remark in _bracket("NeededRadiatedPowerInW", need)]
    if subject.rate_scaling is not None:
        scaling = subject.rate_scaling
        told = f"the budget carries {_between(scaling, '')} times the promised rates"
        found += [(remark, told) for remark in _bracket("PromisedRateScaling", scaling)]
    return found


def _bracket(name: str, bracket: Bracket) -> list[Remark]:
    sides = (bracket.at_least, bracket.at_most)
    if all(np.isfinite(sides)):
        return [Remark(name, "within", [float(side) for side in sides])]
    known = [(end, side) for end, side in zip(("Least", "Most"), sides, strict=True) if np.isfinite(side)]
    return [Remark(name + end, "equal", float(side)) for end, side in known]


def _between(bracket: Bracket, unit: str) -> str:
    least, most = human(bracket.at_least, unit), human(bracket.at_most, unit)
    if not np.isfinite(bracket.at_most):
        return f"at least {least}"
    if not bracket.at_least > 0:
        return f"at most {most}"
    return f"{least} to {most}" if least != most else least
