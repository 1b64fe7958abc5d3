"""Promised rates that no power carries: too few subcarriers, or limits on each subcarrier that leave too little.

Each of these is a proof by counting on the best channel that may be hoped for, the same that the methods use, in terms
that can be told in any language.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.outage_channel import UncertainChannel
from wirelessagent.deciding.core.rate_proof import ceilings, one_each, usable_groups
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.model.decision import Decision
from wirelessagent.telling.facts.case import Case

Kind: TypeAlias = Literal["no_subcarrier", "too_few", "one_user", "together", "places"]
"""A user can use no subcarrier; there are too few for all users; one user's subcarriers carry too little; all together
do; or the rates take more subcarriers than there are."""

_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True)
class Shortage:
    """Why no power is enough.

    Attributes:
        kind: see :data:`Kind`.
        user: whom it is about, from 0; −1 for all.
        users, served: how many are promised a rate, and how many can have a group of subcarriers of their own.
        places, needed: groups of subcarriers that can be used, and that the rates take at least.
        promised_bps, most_bps: what is promised, and the most that can be carried; 0 where that is not the matter.
    """

    kind: Kind
    user: int = -1
    users: int = 0
    served: int = 0
    places: int = 0
    needed: int = 0
    promised_bps: float = 0.0
    most_bps: float = 0.0


def shortage_of(decision: Decision) -> Shortage | None:
    """Why no power carries what an infeasible decision was to promise; None where some power may."""
    if decision.estimate is None or decision.status != "infeasible":
        return None
    case = Case(decision=decision, estimate=decision.estimate)
    outage, channel = case.problem.outage_probability, case.counted
    if outage is not None and (case.estimate.gain_variance > 0).any():
        channel = UncertainChannel.of(case.estimate, outage).hoped_for()
    return _shortage(NormalForm.of(Dual(), channel, case.plain, case.cell))


def _shortage(form: NormalForm) -> Shortage | None:
    users = np.flatnonzero(form.promised_nats > 0)
    if not users.size:
        return None
    usable = usable_groups(form)[users]
    places = int(np.count_nonzero(usable.any(axis=0)))
    served = int(np.count_nonzero(one_each(usable) >= 0))
    if served < users.size:
        kind: Kind = "no_subcarrier" if users.size == 1 else "too_few"
        return Shortage(kind=kind, user=int(users[0]), users=users.size, served=served, places=places)
    snr, nats = form.snr_per_w[users], form.promised_nats[users]
    most = np.add.reduceat(ceilings(form, snr), form.start[:-1], axis=1)  # of each group
    own, best = most.sum(axis=1), float(most.max(axis=0).sum())
    worst = int((own / nats).argmin())
    if own[worst] < nats[worst] * (1.0 - _ROUNDING):
        promised, carried = float(nats[worst]), float(own[worst])
        return _rates(form, "one_user", promised, carried, int(users[worst]))
    if best < nats.sum() * (1.0 - _ROUNDING):
        return _rates(form, "together", float(nats.sum()), best)
    needed = int(np.ceil(nats / most.max(axis=1) * (1.0 - _ROUNDING)).sum())
    return Shortage(kind="places", users=users.size, places=places, needed=needed) if needed > places else None


def _rates(form: NormalForm, kind: Kind, promised: float, most: float, user: int = -1) -> Shortage:
    """One that is a matter of rates, in nats."""
    scale = form.bps_per_nat
    return Shortage(kind=kind, user=user, promised_bps=promised * scale, most_bps=most * scale)
