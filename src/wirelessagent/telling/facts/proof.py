"""How a decision is proven: by what bound, and what that leaves open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from wirelessagent import chain
from wirelessagent.deciding.core.closed_form import nats_worth
from wirelessagent.model.decision import OPTIMAL_GAP
from wirelessagent.model.objective import Objective
from wirelessagent.telling.facts.case import Case

Proof: TypeAlias = Literal["closed_form", "bound", "nothing", "infeasible", "undecided"]
"""By a closed form that the bound equals, by a bound alone, not at all, or as something that cannot be, or may be."""

Basis: TypeAlias = Literal["promises", "levels", "law", "conjugate"]
"""What of the objective a bound rests on: nothing but promised rates, that more rate is worth no less, the power law
that the objective declares, or its conjugate. Never on values of its utility that somebody asked for."""


@dataclass(frozen=True, kw_only=True)
class Certificate:
    """What is proven of a decision.

    Attributes:
        proof: see :data:`Proof`.
        bound: the best value that any allocation can reach; NaN where none is known.
        left: the most that could still be gained, in the value's unit; NaN likewise.
        gap: the same as a share of the bound.
        by: the method whose bound it is: the dual's where the decision's own method has none.
    """

    proof: Proof
    bound: float
    left: float
    gap: float
    by: str


def basis(objective: Objective) -> Basis:
    """What of ``objective`` the bound of a decision rests on."""
    if objective.measure == "power":
        return "promises"
    if objective.joined == "min":
        return "levels"
    return "conjugate" if objective.power_law() is None else "law"


def certificate(case: Case) -> Certificate:
    """What is proven of a case's decision."""
    decision = case.decision
    if not decision.is_usable:
        proof: Proof = "infeasible" if decision.status == "infeasible" else "undecided"
        return Certificate(proof=proof, bound=np.nan, left=np.nan, gap=np.nan, by=decision.method)
    bound, by = decision.bound, decision.method
    if np.isnan(bound) and case.problem.outage_probability is None:
        bound, by = chain.decide(case.counted, case.plain, case.cell, "dual", restarts=0).bound, "dual"
    if not np.isfinite(bound):
        return Certificate(proof="nothing", bound=np.nan, left=np.nan, gap=np.nan, by=by)
    left = abs(bound - decision.value)
    gap = left / abs(bound) if bound else np.nan if left else 0.0
    closed = nats_worth(case.form) is not None and gap <= OPTIMAL_GAP and not decision.outage.size
    return Certificate(proof="closed_form" if closed else "bound", bound=bound, left=left, gap=gap, by=by)
