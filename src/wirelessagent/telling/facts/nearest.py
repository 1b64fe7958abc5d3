"""Why a request cannot be met, and the nearest ones that can: more power, lower rates, fewer users; each solved for.

Promised rates that no power carries are too many for the subcarriers, or for the limits on each of them: a proof by
counting on the best channel that may be hoped for, the same that the methods use, in terms that can be told in any
language.

With the objective put aside, promised rates need a least power. These ways lead back to something feasible:

- the same rates with the power that they are found to need, whether the cell may radiate it or not;
- the same request without one of its limits: on each subcarrier, of groups, or of how surely promises are kept;
- every promised rate times one factor, the largest that the budget carries;
- the same rates for fewer users. Those who cost most at the prices, λ_k R_k, are left out first, until the rest fits;
  then everybody who fits after all is taken back. Where there are few combinations all smaller ones are tried too.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.outage_channel import UncertainChannel
from wirelessagent.deciding.core.rate_proof import ceilings, one_each, usable_groups
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.model.decision import Decision
from wirelessagent.telling.facts.case import Case

_SAFE = 1.0 - 1e-7
"""Part of the largest factor found that is asked for, so that rounding does not decide."""
_CLOSE, _SEARCHED_S = 1.02, 1.0
"""A factor that is known less closely is searched for, so long."""
_FIRST_STEP, _LEAST_FACTOR = 0.98, 1e-6
"""A factor that no bound comes near is searched for downwards, each step the square of the one before."""
_HALVINGS, _CLOSE_ENOUGH = 8, 1.005
"""Then between what is carried and what is not, so often or until they are so close."""
_MARGINS = (1.0, 1.002, 1.01, 1.05, 1.2)
"""Of the least power, until an objective keeps its promises too: some are only found with a little to spare."""
_AMPLE = 1e6
"""Budget in budgets for which the dearest users are looked for."""
_MOST_SETS = 150
"""Sets of users to leave out that are tried to prove that fewer do not help."""


Kind: TypeAlias = Literal["no_subcarrier", "too_few", "one_user", "together", "places"]
"""A user can use no subcarrier; there are too few for all users; one user's subcarriers carry too little; all together
do; or the rates take more subcarriers than there are."""

_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True)
class MorePower:
    """The same request with more power: solved, and whether the cell may radiate that."""

    power_w: float
    decision: Decision
    within_limit: bool


@dataclass(frozen=True, kw_only=True)
class WithoutLimit:
    """The same request without the limit of that name, a field of the problem: solved."""

    limit: str
    decision: Decision


@dataclass(frozen=True, kw_only=True)
class LowerRates:
    """The same request with every promised rate times a factor: solved, and a factor that is proven to be too much."""

    factor: float
    at_most: float
    decision: Decision


@dataclass(frozen=True, kw_only=True)
class FewerUsers:
    """The same request without some users: solved, and whether no fewer would do.

    Attributes:
        left_out: numbers of the users.
        decision: for the rest.
        is_fewest: whether leaving out any fewer is proven infeasible.
    """

    left_out: tuple[int, ...]
    decision: Decision
    is_fewest: bool


Way: TypeAlias = MorePower | WithoutLimit | LowerRates | FewerUsers


@dataclass(frozen=True, kw_only=True)
class Nearest:
    """The nearest requests that can be met, each verified; None where there is none of a kind."""

    more_power: MorePower | None
    without_limits: tuple[WithoutLimit, ...]
    lower_rates: LowerRates | None
    fewer_users: FewerUsers | None

    @property
    def ways(self) -> tuple[Way, ...]:
        """What can be met within the cell's limit, in the order in which it is told."""
        power = self.more_power if self.more_power is not None and self.more_power.within_limit else None
        limits = (one for one in self.without_limits if one.limit != "outage_probability")  # no request can say that
        found = (power, self.lower_rates, self.fewer_users, *limits)
        return tuple(way for way in found if way is not None)


def nearest(case: Case) -> Nearest:
    """The nearest feasible requests for a case whose decision found nothing."""
    return Nearest(
        more_power=more_power(case), without_limits=without_limits(case),
        lower_rates=lower_rates(case), fewer_users=fewer_users(case),
    )  # fmt: skip


def more_power(case: Case) -> MorePower | None:
    """The least power that the same rates were found to be carried with."""
    found = _least_power(case)
    if not found.is_usable:
        return None
    for margin in _MARGINS:
        power = found.total_power_w / _SAFE * margin
        decision = case.otherwise(case.but(max_power_w=power), case.radiating(power))
        if decision.is_usable:
            return MorePower(power_w=power, decision=decision, within_limit=power <= case.cell.max_power_w)
    return None


def without_limits(case: Case) -> tuple[WithoutLimit, ...]:
    """The limits without one of which the request can be met."""
    without = {"subcarrier_max_power_w": None, "resource_block_group_size": 1, "outage_probability": None}
    stated = [limit for limit in without if limit in case.problem.constraints()]
    loose = {limit: case.otherwise(case.but(**{limit: without[limit]})) for limit in stated}
    return tuple(WithoutLimit(limit=limit, decision=one) for limit, one in loose.items() if one.is_usable)


def lower_rates(case: Case) -> LowerRates | None:
    """The largest common factor on the promised rates for which an allocation was found."""
    known = case.decision.rate_scaling
    if known is None or not case.promised_bps.any():
        return None
    searched = known
    if case.problem.outage_probability is None and known.at_most > known.at_least * _CLOSE:
        searched = case.otherwise(case.problem, effort="thorough", deadline_s=_SEARCHED_S).rate_scaling or known
    most, factor = min(known.at_most, searched.at_most, 1.0), max(known.at_least, searched.at_least) * _SAFE
    while factor > 0:
        decision = _scaled(case, factor)
        if decision.is_usable:
            return LowerRates(factor=factor, at_most=most, decision=decision)
        carried = 0.0 if decision.rate_scaling is None else decision.rate_scaling.at_least
        factor = factor * min(carried, 0.95) * _SAFE if carried > 0 else 0.0
    return _searched_for(case, most)


def _searched_for(case: Case, most: float) -> LowerRates | None:
    """:func:`lower_rates` where no factor is known to be carried: by trying, from ``most`` downwards."""
    if not most > 0:
        return None
    low = high = most * _SAFE
    step, decision = _FIRST_STEP, _scaled(case, low)
    while not decision.is_usable:
        low, high, step = low * step, low, step * step
        if low <= most * _LEAST_FACTOR:
            return None
        decision = _scaled(case, low)
    for _ in range(_HALVINGS):
        if high <= low * _CLOSE_ENOUGH:
            break
        middle = math.sqrt(low * high)
        tried = _scaled(case, middle)
        if tried.is_usable:
            low, decision = middle, tried
        else:
            high = middle
    return LowerRates(factor=low, at_most=most, decision=decision)


def _scaled(case: Case, factor: float) -> Decision:
    """The decision with every promised rate times a factor."""
    return case.otherwise(case.but(min_rate_bps=case.promised_bps * factor))


def fewer_users(case: Case) -> FewerUsers | None:
    """The users to leave out so that the rest gets its rates."""
    bearing = [int(user) for user in np.flatnonzero(case.served) if case.promised_bps[user] > 0]
    left, decision = _dearest_first(case, bearing)
    proven = case.decision.status == "infeasible"
    for size in range(1, len(left) if decision else len(bearing)):
        if math.comb(len(bearing), size) > _MOST_SETS:
            proven = False
            break
        for some in itertools.combinations(bearing, size):
            found = _without(case, some)
            if found.is_usable:
                return FewerUsers(left_out=some, decision=found, is_fewest=proven)
            proven = proven and found.status == "infeasible"
    return FewerUsers(left_out=tuple(sorted(left)), decision=decision, is_fewest=proven) if decision else None


def _dearest_first(case: Case, bearing: list[int]) -> tuple[list[int], Decision | None]:
    """Users left out until the rest fits, without those who fit after all; no decision where it never does."""
    left: list[int] = []
    decision = case.decision
    while not decision.is_usable:
        rest = [user for user in bearing if user not in left]
        if len(rest) < 2:
            return left, None
        left.append(_dearest(case, rest, left))
        decision = _without(case, left)
    for user in left[:-1]:
        fewer = [one for one in left if one != user]
        again = _without(case, fewer)
        if again.is_usable:
            left, decision = fewer, again
    return left, decision


def _dearest(case: Case, rest: list[int], left: list[int]) -> int:
    """Who of ``rest`` costs most at the prices without those who are ``left`` out already."""
    price = _without(case, left).price_of_rate if left else case.decision.price_of_rate
    if not price.size:
        price = _least_power(case, users=_rest(case, left)).price_of_rate
    if not price.size or not np.isfinite(price[rest]).any():
        return max(rest, key=lambda user: float(case.promised_bps[user] / max(case.counted.gain[user].max(), 1e-300)))
    return max(rest, key=lambda user: float(np.nan_to_num(price[user], nan=0.0) * case.promised_bps[user]))


def _without(case: Case, left: Sequence[int]) -> Decision:
    return case.otherwise(case.but(users=_rest(case, left)))


def _rest(case: Case, left: Sequence[int]) -> tuple[str, ...]:
    """Who is served, without some."""
    return case.named(user for user in np.flatnonzero(case.served).tolist() if user not in left)


def _least_power(case: Case, **changes: Any) -> Decision:
    """The least power that the promised rates take, where there is more than enough of it."""
    least = case.but(objective="min_power", weights=None, max_power_w=None, **changes)
    return case.otherwise(least, case.radiating(case.cell.max_power_w * _AMPLE))


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
    form = NormalForm.of(Dual(), channel, case.plain, case.cell)
    users = np.flatnonzero(form.promised_nats > 0)
    if not users.size:
        return None
    usable = usable_groups(form)[users]
    places = int(np.count_nonzero(usable.any(axis=0)))
    served = int(np.count_nonzero(one_each(usable) >= 0))
    if served < users.size:
        kind: Kind = "no_subcarrier" if users.size == 1 else "too_few"
        return Shortage(kind=kind, user=int(users[0]), users=users.size, served=served, places=places)
    snr, nats, scale = form.snr_per_w[users], form.promised_nats[users], form.bps_per_nat
    most = np.add.reduceat(ceilings(form, snr), form.start[:-1], axis=1)  # of each group
    own, best = most.sum(axis=1), float(most.max(axis=0).sum())
    worst = int((own / nats).argmin())
    if own[worst] < nats[worst] * (1.0 - _ROUNDING):
        promised, carried = float(nats[worst]) * scale, float(own[worst]) * scale
        return Shortage(kind="one_user", user=int(users[worst]), promised_bps=promised, most_bps=carried)
    if best < nats.sum() * (1.0 - _ROUNDING):
        return Shortage(kind="together", promised_bps=float(nats.sum()) * scale, most_bps=best * scale)
    needed = int(np.ceil(nats / most.max(axis=1) * (1.0 - _ROUNDING)).sum())
    return Shortage(kind="places", users=users.size, places=places, needed=needed) if needed > places else None
