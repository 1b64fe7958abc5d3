"""A user's account in words."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.units import human, percent
from wirelessagent.telling.catalogue import called, joined, message
from wirelessagent.telling.facts.accounts import PROMISE_BPS, Account, Loss, share
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.parts import place, value_name
from wirelessagent.telling.reasons import reason_in_words
from wirelessagent.telling.step_effects import change_in_words

_TIE_DB = 0.05
_KNOWN_DB = 0.1
_STEP_BPS = 100e3
_FACTOR = 1.0005


def user_answer(case: Case, found: Account, language: str) -> str:
    """What a user has and why, in a paragraph."""
    name = called(language, case.estimate.user_names[found.user])
    said = [_head(case, found, name, language)]
    if found.standing == "served":
        said += _served(case, found, language)
    if found.losses:
        said += _loss(case, found.losses[0], language)
    said += _promise(case, found, language)
    return joined(language, said)


def share_answer(case: Case, user: int, language: str) -> str:
    """What a user has, in a few sentences."""
    found = share(case, user)
    said = [_head(case, found, called(language, case.estimate.user_names[user]), language)]
    return joined(language, [*said, *(_served(case, found, language) if found.standing == "served" else [])])


def newcomer_answer(case: Case, found: Account | None, language: str) -> str:
    """What one more user would bring: the one of those left out with whom the value is best."""
    if found is None:
        return message(language, "account.all_served", users=case.num_users)
    return _head(case, found, called(language, case.estimate.user_names[found.user]), language)


def _head(case: Case, found: Account, name: str, language: str) -> str:
    decision = case.decision
    total = decision.total_power_w
    said = message(
        language,
        f"account.{found.standing}",
        name=name,
        rate=_rate(case, found, language),
        power=human(found.power_w, "W"),
        share=percent(found.power_w / total if total > 0 else 0.0),
        count=found.subcarriers,
        total=decision.owner.size,
        reason=reason_in_words(decision, language),
        places=case.form.start.size - 1,
        users=int(np.count_nonzero(case.form.weight > 0)),
    )
    if found.included is None:
        return said
    return joined(language, [said, _included(case, found, language)])


def _included(case: Case, found: Account, language: str) -> str:
    included = found.included
    assert included is not None
    if not included.is_usable:
        return message(language, "account.included_none", reason=reason_in_words(included, language))
    power = float(included.power_w[included.owner == found.user].sum())
    return message(
        language,
        "account.included",
        rate=human(float(included.rate_bps[found.user]), "bit/s"),
        power=human(power, "W"),
        figure=value_name(case.decision, language),
        value=human(included.value, included.unit),
        before=human(case.decision.value, case.decision.unit),
    )


def _rate(case: Case, found: Account, language: str) -> str:
    """What a user gets, as what it must get where it is no more than that."""
    rate = human(found.rate_bps, "bit/s")
    due = found.promised_bps > 0 and _exactly(found)
    return message(language, f"account.exactly_{case.problem.firmness}", rate=rate) if due else rate


def _exactly(found: Account) -> bool:
    return not found.rate_bps > found.promised_bps * _FACTOR


def _served(case: Case, found: Account, language: str) -> list[str]:
    said: list[str] = []
    forecast, user = case.decision.forecast, found.user
    if forecast is not None and forecast.high_bps[user] > forecast.low_bps[user] * _FACTOR:
        low, high = (human(float(one[user]), "bit/s") for one in (forecast.low_bps, forecast.high_bps))
        said += [message(language, "account.band", low=low, high=high)] if low != high else []
    if found.promised_bps > 0:
        price = found.price_per_bps * _STEP_BPS
        key = "account.beyond" if not price > 0 else "account.binds" if _exactly(found) else "account.above"
        promised, cost = human(found.promised_bps, "bit/s"), human(price, case.decision.unit)
        due = message(language, f"account.due_{case.problem.firmness}", promised=promised)
        said.append(message(language, key, due=due, price=cost))
    key = "account.resting" if found.resting else "account.resting_none" if found.repaired else "account.measured"
    rest = {
        "repaired": found.repaired, "entries": found.entries, "resting": found.resting,
        "count": found.subcarriers,
    }  # fmt: skip
    return [*said, message(language, key, **rest)]


def _loss(case: Case, loss: Loss, language: str) -> list[str]:
    key = "account.tie" if abs(loss.behind_db) < _TIE_DB else "account.behind" if loss.behind_db > 0 else "account.more"
    where, winner = place(loss.first, loss.last, language), called(language, case.estimate.user_names[loss.winner])
    said: list[str] = [message(language, key, behind=abs(loss.behind_db), place=where, winner=winner)]
    if key != "account.behind":
        return said
    if np.isnan(loss.chance):
        return [*said, message(language, "account.gain_measured")]
    if loss.repaired and max(abs(loss.low_db), abs(loss.high_db)) < _KNOWN_DB:
        return [*said, message(language, "account.gain_close")]
    kind = "account.gain_repaired" if loss.repaired else "account.gain_noisy"
    chance = percent(loss.chance) if loss.chance > 0 else "< 0.1 %"
    return [*said, message(language, kind, low=loss.low_db, high=loss.high_db, chance=chance)]


def _promise(case: Case, found: Account, language: str) -> list[str]:
    step = found.promise
    if step is None:
        return []
    rate = human(PROMISE_BPS, "bit/s")
    if not step.after.is_usable:
        return [message(language, "account.promise_none", rate=rate, reason=reason_in_words(step.after, language))]
    count = int(((step.after.owner == found.user) & (step.after.power_w > 0)).sum())
    total, change = step.after.owner.size, change_in_words(case, step, language)
    return [message(language, "account.promise", rate=rate, count=count, total=total, change=change)]
