"""Who has what: who gets the least or the most, who has which subcarriers, and how good the channel is there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.units import db, human
from wirelessagent.telling.catalogue import called, joined, lines_of, listed, message
from wirelessagent.telling.facts.case import Case

_SAME = 1e-3
"""A share of a figure that does not show in it."""
_SHOWN_DB = 0.1
"""A band that shows in one decimal."""


def rank_answer(case: Case, rank: str, of: str, language: str) -> str:
    """Who of those served gets the "least" or the "most" of "rate", "power" or "subcarriers"."""
    users = np.flatnonzero(case.served)
    size = _sizes(case, of)[users]
    nobody = users[size <= 0]
    if rank == "most" or not nobody.size:
        return joined(language, _ranked(case, users, rank, of, language))
    said: list[str] = [
        message(language, "roster.nothing", names=_names(case, nobody, language), gets=_gets(nobody, language))
    ]
    some = users[size > 0]
    if some.size:
        said.append(_next(case, some[np.argsort(_sizes(case, of)[some], kind="stable")], of, language))
    return joined(language, said)


def _ranked(case: Case, users: IntArray, rank: str, of: str, language: str) -> list[str]:
    """Who of these is first, and who comes next."""
    size = _sizes(case, of)
    order = users[np.argsort(size[users] if rank == "least" else -size[users], kind="stable")]
    first, edge = _alike(order, size), float(size[order[0]])
    if first.size == users.size > 1:
        what = message(language, f"roster.of_{of}")
        return [message(language, "roster.all_same", count=users.size, what=what, size=_size(edge, of))]
    said: list[str] = [
        message(
            language, f"roster.{rank}", names=_names(case, first, language), gets=_gets(first, language),
            size=_size(edge, of), what=message(language, f"roster.of_{of}"),
            further=_further(case, first, of, language),
        )
    ]  # fmt: skip
    rest = order[~np.isin(order, first)]
    if rest.size and size[rest[0]] > 0:
        said.append(_next(case, rest, of, language))
    return said


def _next(case: Case, order: IntArray, of: str, language: str) -> str:
    """Who comes next, at the head of ``order``."""
    size = _sizes(case, of)
    following = _alike(order, size)
    verb = message(language, "roster.is_one" if following.size == 1 else "roster.is_several")
    names, figure = _names(case, following, language), _size(float(size[order[0]]), of)
    return message(language, "roster.next", is_=verb, names=names, size=figure)


def _alike(order: IntArray, size: FloatArray) -> IntArray:
    """The users at the head of ``order`` who have the same, by their numbers."""
    head = float(size[order[0]])
    return np.sort(order[np.abs(size[order] - head) <= _SAME * head])


def _further(case: Case, users: IntArray, of: str, language: str) -> str:
    """What else a user has; nothing more of several."""
    if users.size > 1:
        return message(language, "roster.further_of_each")
    user, decision = int(users[0]), case.decision
    return message(
        language, f"roster.further_{of}", total=decision.owner.size, rate=human(float(case.rate_bps[user]), "bit/s"),
        power=human(float(case.spent_w[user]), "W"), count=int(_sizes(case, "subcarriers")[user]),
    )  # fmt: skip


def subcarriers_answer(case: Case, user: int | None, language: str) -> str:
    """The subcarriers of a user, or of everybody."""
    decision, total = case.decision, case.decision.owner.size
    if user is not None:
        name, own = called(language, case.estimate.user_names[user]), np.flatnonzero(case.own(user))
        key = "roster.has" if own.size else "roster.has_none"
        return message(language, key, name=name, count=own.size, total=total, places=_places(own, language))
    rows = [message(language, "roster.all", total=total)]
    for each in range(case.num_users):
        own, name = np.flatnonzero(case.own(each)), called(language, case.estimate.user_names[each])
        if own.size:
            rows.append(message(language, "roster.row", name=name, places=_places(own, language), count=own.size))
    free = np.flatnonzero(decision.power_w <= 0)
    if free.size:
        rows.append(message(language, "roster.unused", places=_places(free, language), count=free.size))
    return lines_of(rows)


def owner_answer(case: Case, place: int, language: str) -> str:
    """Who has a subcarrier, counted from 1."""
    decision = case.decision
    if not 1 <= place <= decision.owner.size:
        return message(language, "roster.no_such", place=place, total=decision.owner.size)
    power, owner = float(decision.power_w[place - 1]), int(decision.owner[place - 1])
    if owner < 0 or power <= 0:
        return message(language, "roster.no_owner", place=place)
    name = called(language, case.estimate.user_names[owner])
    return message(language, "roster.owner", place=place, name=name, power=human(power, "W"))


def _sizes(case: Case, of: str) -> FloatArray:
    """What each user has, in bit/s, W or subcarriers, shape (user,)."""
    if of == "subcarriers":
        return np.array([np.count_nonzero(case.own(user)) for user in range(case.num_users)], dtype=np.float64)
    return case.rate_bps if of == "rate" else case.spent_w


def _size(value: float, of: str) -> str:
    return f"{value:.0f}" if of == "subcarriers" else human(float(value), "W" if of == "power" else "bit/s")


def _names(case: Case, users: IntArray, language: str) -> str:
    return listed(language, case.named(users.tolist()))


def _gets(users: IntArray, language: str) -> str:
    return message(language, "roster.one" if users.size == 1 else "roster.several")


def _places(subcarriers: Sequence[int] | IntArray, language: str) -> str:
    """Subcarriers counted from 1, neighbours together: "1–3, 7"."""
    runs = np.split(np.asarray(subcarriers), np.flatnonzero(np.diff(subcarriers) > 1) + 1)
    said = [
        str(run[0] + 1) if run.size == 1 else message(language, "roster.range", first=run[0] + 1, last=run[-1] + 1)
        for run in runs
        if run.size
    ]
    return message(language, "text.comma").join(said)


def gain_answer(case: Case, user: int | None, place: int | None, language: str) -> str:
    """The gain of a user, else of the owner, on the subcarrier ``place`` (from 1), or of a user over all of them."""
    decision, total = case.decision, case.estimate.num_subcarriers
    if place is not None and not 1 <= place <= total:
        return message(language, "roster.no_such", place=place, total=total)
    if user is None and place is not None:
        user = int(decision.owner[place - 1]) if decision.is_usable else -1
        user = user if user >= 0 else int(case.estimate.gain[:, place - 1].argmax())
    assert user is not None
    return _over_all(case, user, language) if place is None else _at(case, user, place, language)


def _at(case: Case, user: int, place: int, language: str) -> str:
    estimate, name = case.estimate, called(language, case.estimate.user_names[user])
    gain = float(estimate.gain[user, place - 1])
    if gain <= 0:
        return message(language, "gain.none_at", name=name, place=place)
    low, high = (float(db(estimate.posterior.quantile(each)[user, place - 1], floor_db=-200)) for each in (0.05, 0.95))
    key = "gain.repaired" if estimate.repaired[user, place - 1] else "gain.noisy"
    key = key if estimate.gain_variance[user, place - 1] > 0 else "gain.measured"
    key = key if high - low >= _SHOWN_DB else f"{key}_close"
    how = message(language, key, low=low, high=high, method=called(language, estimate.method))
    said = message(language, "gain.at", name=name, place=place, gain=float(db(gain)), how=how)
    return joined(language, [said, *_owner(case, user, place, language)])


def _owner(case: Case, user: int, place: int, language: str) -> list[str]:
    """Who has the subcarrier, with which SNR there."""
    decision, estimate = case.decision, case.estimate
    if not decision.is_usable:
        return []
    owner, power = int(decision.owner[place - 1]), float(decision.power_w[place - 1])
    if owner < 0 or power <= 0:
        return [message(language, "gain.idle", snr=_snr_db(case, estimate.gain[user, place - 1], 1.0))]
    snr = _snr_db(case, estimate.gain[owner, place - 1], power)
    name = called(language, estimate.user_names[owner])
    return [message(language, "gain.carries", owner=name, snr=snr, power=human(power, "W"))]


def _over_all(case: Case, user: int, language: str) -> str:
    estimate, decision = case.estimate, case.decision
    gain, name = estimate.gain[user], called(language, estimate.user_names[user])
    if not gain.max() > 0:
        return message(language, "gain.nothing", name=name)
    low, high, mean = (float(db(each)) for each in (gain[gain > 0].min(), gain.max(), gain.mean()))
    missing = int(estimate.repaired[user].sum())
    said = [
        message(language, "gain.over_all", name=name, low=low, high=high, mean=mean, missing=missing, total=gain.size)
    ]
    if not decision.is_usable:
        return joined(language, said)
    own: IntArray = np.flatnonzero(case.own(user))
    if not own.size:
        return joined(language, [*said, message(language, "gain.snr_none", best=_snr_db(case, gain.max(), 1.0))])
    snr: FloatArray = np.array([_snr_db(case, gain[each], float(decision.power_w[each])) for each in own])
    power = human(float(decision.power_w[own].sum()), "W")
    key = "gain.snr_one" if own.size == 1 else "gain.snr"
    figures = {"low": float(snr.min()), "high": float(snr.max()), "count": own.size, "power": power}
    return joined(language, [*said, message(language, key, **figures)])


def _snr_db(case: Case, gain: float, power_w: float) -> float:
    """p g/(N0 B) in dB, before the coding gap."""
    return float(db(power_w * gain / case.cell.noise_power_w, floor_db=-200))
