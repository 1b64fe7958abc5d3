"""How a decision is proven, by what bound, and what that leaves open; and how sure it is of the channel."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from wirelessagent.deciding.core.closed_form import nats_worth
from wirelessagent.model.decision import OPTIMAL_GAP
from wirelessagent.model.objective import Objective
from wirelessagent.telling.facts.case import Case

Proof: TypeAlias = Literal["closed_form", "bound", "nothing", "infeasible", "undecided"]
"""By a closed form that the bound equals, by a bound alone, not at all, or as something that cannot be, or may be."""

Basis: TypeAlias = Literal["promises", "levels", "law", "conjugate"]
"""What of the objective a bound rests on: nothing but promised rates, that more rate is worth no less, the power law
that the objective declares, or its conjugate. Never on values of its utility that somebody asked for."""


_LEAST, _MOST = 0.05, 0.95
"""The 90 % band of what is uncertain."""


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
        bound, by = case.priced.bound, "dual"
    if not np.isfinite(bound):
        return Certificate(proof="nothing", bound=np.nan, left=np.nan, gap=np.nan, by=by)
    left = abs(bound - decision.value)
    gap = left / abs(bound) if bound else np.nan if left else 0.0
    closed = nats_worth(case.form) is not None and gap <= OPTIMAL_GAP and not decision.outage.size
    return Certificate(proof="closed_form" if closed else "bound", bound=bound, left=left, gap=gap, by=by)


@dataclass(frozen=True, kw_only=True)
class Certainty:
    """How sure a decision is.

    Attributes:
        repaired, entries: gains that were not measured, and all.
        noisy: gains that were measured, but not exactly.
        method: what repaired them.
        used, resting: subcarriers in use, and those of them that rest on a gain that was not measured.
        unseen: users of whom nothing was measured.
        low_bps, high_bps: the 90 % band of the sum rate; NaN where nothing in use is uncertain.
        least_sure: the user whose committed rate is kept with the smallest probability; None likewise.
        least_kept: that probability.
        expected_missed: how many commitments are expected to fail.
        widest: the user and the subcarrier in use whose gain is known least; None likewise.
        widest_low_db, widest_high_db: its 90 % band around what was counted on, in dB.
    """

    repaired: int
    entries: int
    noisy: int
    method: str
    used: int
    resting: int
    unseen: tuple[int, ...]
    low_bps: float = np.nan
    high_bps: float = np.nan
    least_sure: int | None = None
    least_kept: float = np.nan
    expected_missed: float = 0.0
    widest: tuple[int, int] | None = None
    widest_low_db: float = 0.0
    widest_high_db: float = 0.0


def certainty(case: Case) -> Certainty:
    """What is known of the channel that a decision rests on."""
    decision, estimate = case.decision, case.estimate
    used = np.flatnonzero((decision.owner >= 0) & (decision.power_w > 0))
    owner = decision.owner[used]
    known = Certainty(
        repaired=int(estimate.repaired.sum()),
        entries=estimate.repaired.size,
        noisy=int(((estimate.gain_variance > 0) & ~estimate.repaired).sum()),
        method=estimate.method,
        used=used.size,
        resting=int(estimate.repaired[owner, used].sum()),
        unseen=tuple(int(user) for user in np.flatnonzero(estimate.unobserved_users & case.served)),
    )
    forecast = decision.forecast
    if forecast is None:
        return known
    served = np.flatnonzero(decision.committed_bps > 0)
    carried = 1.0 - decision.outage if decision.outage.size else forecast.carried
    unsure = np.flatnonzero(estimate.gain_variance[owner, used] > 0)
    low, high = (estimate.posterior.quantile(one)[owner, used] for one in (_LEAST, _MOST))
    with np.errstate(divide="ignore", invalid="ignore"):
        counted = case.counted.gain[owner, used]
        low_db, high_db = 10 * np.log10(low / counted), 10 * np.log10(high / counted)
    widest = int(unsure[np.argmax((high_db - low_db)[unsure])])
    least = int(served[np.argmin(carried[served])])
    return dataclasses.replace(
        known,
        low_bps=forecast.sum_low_bps,
        high_bps=forecast.sum_high_bps,
        least_sure=least,
        least_kept=float(carried[least]),
        expected_missed=float((1.0 - carried[served]).sum()),
        widest=(int(owner[widest]), int(used[widest])),
        widest_low_db=float(low_db[widest]),
        widest_high_db=float(high_db[widest]),
    )
