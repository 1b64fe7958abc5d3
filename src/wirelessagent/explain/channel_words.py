"""The gain and the SNR of a user, on a subcarrier or over all of them, in words."""

from __future__ import annotations

import numpy as np

from wirelessagent.explain.case import Case
from wirelessagent.explain.lexicon import Lexicon, paragraph
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.units import db, human
from wirelessagent.telling.catalogue import called

_SHOWN_DB = 0.1
"""A band that shows in one decimal."""

WORDS = Lexicon(
    english={
        "no_such": "There is no subcarrier {place}; there are 1 to {total}.",
        "at": "The gain of {name} on subcarrier {place} is {gain:.1f} dB{how}.",
        "none_at": "{name} has no gain on subcarrier {place}.",
        "measured_close": ", measured",
        "noisy_close": ", measured with little noise",
        "repaired_close": ", not measured but filled by {method}, to less than 0.1 dB",
        "noisy": ", measured with noise: from {low:.1f} to {high:.1f} dB with a probability of 90 %",
        "repaired": ", not measured but filled by {method}: from {low:.1f} to {high:.1f} dB with a probability of 90 %",
        "carries": "It goes to {owner}: an SNR of {snr:.1f} dB with {power}.",
        "idle": "It is not used: 1 W there would make an SNR of {snr:.1f} dB.",
        "over_all": "The gain of {name} is {low:.1f} to {high:.1f} dB over {total} subcarriers, {mean:.1f} dB in the "
        "mean; {missing} of them were not measured.",
        "nothing": "{name} has no gain on any subcarrier.",
        "snr": "On the {count} that it has, the SNR is {low:.1f} to {high:.1f} dB with {power}.",
        "snr_one": "On the one that it has, the SNR is {low:.1f} dB with {power}.",
        "snr_none": "It has none of them; 1 W on the best would make an SNR of {best:.1f} dB.",
    },
    chinese={
        "no_such": "没有第 {place} 个子载波；有第 1 至 {total} 个。",
        "at": "{name}在第 {place} 个子载波上的增益为 {gain:.1f} dB{how}。",
        "none_at": "{name}在第 {place} 个子载波上没有增益。",
        "measured_close": "（测得）",
        "noisy_close": "（测得，噪声很小）",
        "repaired_close": "（未测得，由{method}填补，误差小于 0.1 dB）",
        "noisy": "（带噪声测得，90 % 的概率在 {low:.1f} 至 {high:.1f} dB 之间）",
        "repaired": "（未测得，由{method}填补，90 % 的概率在 {low:.1f} 至 {high:.1f} dB 之间）",
        "carries": "该子载波属于{owner}：功率 {power}，信噪比 {snr:.1f} dB。",
        "idle": "该子载波未使用：若用 1 W，信噪比为 {snr:.1f} dB。",
        "over_all": "{name}在 {total} 个子载波上的增益为 {low:.1f} 至 {high:.1f} dB，平均 {mean:.1f} dB；"
        "其中 {missing} 个没有测得。",
        "nothing": "{name}在任何子载波上都没有增益。",
        "snr": "在其 {count} 个子载波上，信噪比为 {low:.1f} 至 {high:.1f} dB，功率共 {power}。",
        "snr_one": "在其唯一的子载波上，信噪比为 {low:.1f} dB，功率 {power}。",
        "snr_none": "它没有子载波；在最好的一个上用 1 W，信噪比为 {best:.1f} dB。",
    },
)


def gain_answer(case: Case, user: int | None, place: int | None, language: str) -> str:
    """The gain of a user, else of the owner, on the subcarrier ``place`` (from 1), or of a user over all of them."""
    decision, total = case.decision, case.estimate.num_subcarriers
    if place is not None and not 1 <= place <= total:
        return WORDS.say(language, "no_such", place=place, total=total)
    if user is None and place is not None:
        user = int(decision.owner[place - 1]) if decision.is_usable else -1
        user = user if user >= 0 else int(case.estimate.gain[:, place - 1].argmax())
    assert user is not None
    return _over_all(case, user, language) if place is None else _at(case, user, place, language)


def _at(case: Case, user: int, place: int, language: str) -> str:
    estimate, name = case.estimate, called(language, case.estimate.user_names[user])
    gain = float(estimate.gain[user, place - 1])
    if gain <= 0:
        return WORDS.say(language, "none_at", name=name, place=place)
    low, high = (float(db(estimate.posterior.quantile(each)[user, place - 1], floor_db=-200)) for each in (0.05, 0.95))
    key = "repaired" if estimate.repaired[user, place - 1] else "noisy"
    key = key if estimate.gain_variance[user, place - 1] > 0 else "measured"
    key = key if high - low >= _SHOWN_DB else f"{key}_close"
    how = WORDS.say(language, key, low=low, high=high, method=called(language, estimate.method))
    said = WORDS.say(language, "at", name=name, place=place, gain=float(db(gain)), how=how)
    return paragraph([said, *_owner(case, user, place, language)], language)


def _owner(case: Case, user: int, place: int, language: str) -> list[str]:
    """Who has the subcarrier, with which SNR there."""
    decision, estimate = case.decision, case.estimate
    if not decision.is_usable:
        return []
    owner, power = int(decision.owner[place - 1]), float(decision.power_w[place - 1])
    if owner < 0 or power <= 0:
        return [WORDS.say(language, "idle", snr=_snr_db(case, estimate.gain[user, place - 1], 1.0))]
    snr = _snr_db(case, estimate.gain[owner, place - 1], power)
    name = called(language, estimate.user_names[owner])
    return [WORDS.say(language, "carries", owner=name, snr=snr, power=human(power, "W"))]


def _over_all(case: Case, user: int, language: str) -> str:
    estimate, decision = case.estimate, case.decision
    gain, name = estimate.gain[user], called(language, estimate.user_names[user])
    if not gain.max() > 0:
        return WORDS.say(language, "nothing", name=name)
    low, high, mean = (float(db(each)) for each in (gain[gain > 0].min(), gain.max(), gain.mean()))
    missing = int(estimate.repaired[user].sum())
    said = [WORDS.say(language, "over_all", name=name, low=low, high=high, mean=mean, missing=missing, total=gain.size)]
    if not decision.is_usable:
        return paragraph(said, language)
    own: IntArray = np.flatnonzero((decision.owner == user) & (decision.power_w > 0))
    if not own.size:
        return paragraph([*said, WORDS.say(language, "snr_none", best=_snr_db(case, gain.max(), 1.0))], language)
    snr: FloatArray = np.array([_snr_db(case, gain[each], float(decision.power_w[each])) for each in own])
    power = human(float(decision.power_w[own].sum()), "W")
    key = "snr_one" if own.size == 1 else "snr"
    figures = {"low": float(snr.min()), "high": float(snr.max()), "count": own.size, "power": power}
    return paragraph([*said, WORDS.say(language, key, **figures)], language)


def _snr_db(case: Case, gain: float, power_w: float) -> float:
    """p g/(N0 B) in dB, before the coding gap."""
    return float(db(power_w * gain / case.cell.noise_power_w, floor_db=-200))
