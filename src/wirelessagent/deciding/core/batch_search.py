"""The dual core on many problems that differ in their channel alone; :mod:`.dual_search` for each of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.dual_bounds import bounds_of
from wirelessagent.deciding.core.dual_search import CANDIDATES, REFITS, SMALL, WORST, Effort, owners_with_power
from wirelessagent.deciding.core.exact_powers import BUDGET_ROUNDING
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import Programs
from wirelessagent.deciding.core.time_limit import TimeLimit
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.rates import user_rate_bps


@dataclass(frozen=True, kw_only=True, eq=False)
class Searches:
    """What was found for a batch; see :class:`.dual_search.Search`.

    Attributes:
        owner, power_w: shape (batch, subcarrier).
        kept: whether each keeps its limits, shape (batch,).
        bound: in the objective's unit, shape (batch,).
        log_price, log_mu: ln λ and ln μ, shapes (batch, user) and (batch,).
    """

    owner: IntArray
    power_w: FloatArray
    kept: BoolArray
    bound: FloatArray
    log_price: FloatArray
    log_mu: FloatArray

    @classmethod
    def finished(cls, owner: IntArray, power_w: FloatArray, bound: FloatArray) -> Searches:
        """Allocations that no search was needed for."""
        batch = len(owner)
        return cls(
            owner=owner,
            power_w=power_w,
            kept=np.ones(batch, dtype=bool),
            bound=bound,
            log_price=np.zeros((batch, 0)),
            log_mu=np.zeros(batch),
        )

    def fits(self, form: NormalForm) -> BoolArray:
        """Whether each keeps every limit, the budget too, shape (batch,)."""
        return self.kept & (self.power_w.sum(axis=-1) <= form.budget_w * (1.0 + BUDGET_ROUNDING))

    def at(self, chosen: IntArray | BoolArray) -> Searches:
        """Those of the ``chosen`` problems."""
        return Searches(**{name: part[chosen] for name, part in vars(self).items()})

    def improve(self, chosen: IntArray, better: Searches, *, highest: bool) -> None:
        """Put ``better`` in the place of the ``chosen`` ones, with the tighter bound: the highest or the lowest."""
        tighter = (np.maximum if highest else np.minimum)(self.bound[chosen], better.bound)
        for name, part in vars(better).items():
            getattr(self, name)[chosen] = part
        self.bound[chosen] = tighter


def search_promises(form: NormalForm, effort: Effort) -> Searches:
    """The least power of the promised rates for each of the form's channels (batch, user, subcarrier)."""
    return _search(form, Programs.of_promises(form), effort)


def search_objectives(
    form: NormalForm, gain: FloatArray, programs: Programs, effort: Effort, owner: IntArray | None = None
) -> Searches:
    """The problem's objective on ``gain``, its utility asked for again around the rates found wherever it does not fit.

    The form's channels are those of ``gain`` (batch, user, subcarrier); ``owner`` (batch, subcarrier) is where the
    search starts, beside the prices.
    """
    best = _search(form, programs, effort, owner=owner)
    left = np.flatnonzero(best.kept)
    programs = programs.at(left)
    for _ in range(REFITS):
        now = best.at(left)
        nats = user_rate_bps(gain[left], now.owner, now.power_w, form.cell) / form.bps_per_nat
        unmet = ~programs.meet(form, nats)
        left, nats = left[unmet], nats[unmet]
        if not left.size:
            break
        part = form.on(gain[left])
        programs = Programs.of(part, nats)
        again = _search(part, programs, effort, now.at(unmet))
        best.improve(left[again.kept], again.at(again.kept), highest=form.objective.direction == "min")
        left, programs = left[again.kept], programs.at(again.kept)
    return best


def _search(
    form: NormalForm,
    programs: Programs,
    effort: Effort,
    after: Searches | None = None,
    owner: IntArray | None = None,
) -> Searches:
    """Prices, sets and powers for each channel, from those of earlier searches or from ``owner``, if any."""
    from wirelessagent.deciding.core.ask_kernel import Ask
    from wirelessagent.deciding.core.batch_kernel import solve_all

    batch, users, subcarriers = form.snr_per_w.shape
    warm = np.full(batch, fill_value=False)
    log_price, log_mu = np.zeros((batch, users)), np.zeros(batch)
    given = owner is not None or after is not None
    owner = np.full((batch, subcarriers), -1, dtype=np.int64) if owner is None else owner.copy()
    power_w = np.empty((batch, subcarriers))
    if after is not None:
        warm[:] = np.isfinite(after.log_price).all(axis=-1)
        log_price[warm], log_mu[warm], owner = after.log_price[warm], after.log_mu[warm], after.owner.copy()
    rows = np.ascontiguousarray(np.broadcast_to(programs.rows, (batch, users, 6)))
    share = np.ascontiguousarray(np.broadcast_to(programs.share, (batch, users, 3)))
    score = np.empty(batch)
    ask = Ask(
        programs.goal, form.cap_w, float(form.max_nats), form.start, rows[0], share[0], 0.0, float(form.budget_w),
        float(form.circuit_w), TimeLimit().work,
    )  # fmt: skip
    choices = users if users <= SMALL else CANDIDATES
    solve_all(
        form.snr_per_w, ask, rows, share, programs.most_level, choices, effort.restarts, effort.seed, warm,
        given, log_price, log_mu, owner, power_w, score,
    )  # fmt: skip
    return Searches(
        owner=owners_with_power(form, owner, power_w),
        power_w=power_w,
        kept=(score > WORST) & np.isfinite(power_w).all(axis=-1),
        bound=bounds_of(form, programs, log_price, log_mu),
        log_price=log_price,
        log_mu=log_mu,
    )
