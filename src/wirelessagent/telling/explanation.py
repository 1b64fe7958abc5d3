"""A decision in a few sentences, every figure computed from the decision itself."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from wirelessagent.model.arrays import BoolArray
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.units import db, human, percent, reliability
from wirelessagent.telling.catalogue import called, joined, listed, message
from wirelessagent.telling.certificates import certificate_sentence, rests_on
from wirelessagent.telling.parts import cannot_be_served, name_of_figure
from wirelessagent.telling.reasons import reason_in_words
from wirelessagent.telling.report import Report

_SURE = 0.95
"""The probability from which a promise without an outage probability goes without a warning."""

_ALL_BUT_CERTAIN = 0.999
"""A probability beyond which nobody counts."""
_NO_REGRET = 5e-4
"""A share of the rate that nobody would miss."""


def explain(estimate: ChannelEstimate, report: Report, *, language: str = "en") -> list[str]:
    """Why the decision is what it is, in the operator's language, one sentence per item."""
    return _Explanation(estimate, report, language).sentences()


class _Explanation:
    """One decision on its way into words."""

    def __init__(self, estimate: ChannelEstimate, report: Report, language: str) -> None:
        self._estimate, self._report, self._language = estimate, report, language
        self._decision = decision = report.decision
        assert isinstance(decision.problem.objective, Objective)
        self._objective = decision.problem.objective
        self._figure = name_of_figure(decision, language)

    def sentences(self) -> list[str]:
        decision, objective = self._decision, self._objective
        if not decision.is_usable:
            return [self._say(decision.status, reason=reason_in_words(decision, self._language))]
        if objective.measure == "power" and decision.problem.min_rate_bps is None and not decision.power_w.any():
            return [self._say("no_promise")]
        proven = certificate_sentence(decision, self._language)
        said = [joined(self._language, [self._allocation(), proven]), *self._goal()]
        if not objective.is_built_in and not np.isnan(decision.gap):
            said.append(rests_on(objective, self._language))
        said += [*self._promised_at(), *self._forecast(), *self._groups(), *self._remark()]
        return [*said, *self._idle_users(), self._repair(), *self._outcome(), *self._regret()]

    def _say(self, key: str, **places: object) -> str:
        return message(self._language, f"decision.{key}", **places)

    def _worth(self, value: float) -> str:
        return human(value, self._decision.unit)

    def _figure_or_value(self) -> str:
        return self._figure or message(self._language, "text.value")

    def _user(self, user: int | np.integer) -> str:
        return called(self._language, self._decision.user_names[user])

    def _users(self, users: Iterable[int | np.integer]) -> str:
        return listed(self._language, (self._decision.user_names[user] for user in users))

    def _counts(self) -> BoolArray:
        """True for users whose rate counts: those who are served and have a weight."""
        return self._decision.problem.weights_of(self._decision.rate_bps.size) > 0

    def _remark(self) -> list[str]:
        """What else the decision says of itself."""
        if not self._decision.reason or cannot_be_served(self._decision):
            return []
        return [message(self._language, "text.sentence", line=reason_in_words(self._decision, self._language))]

    def _allocation(self) -> str:
        decision = self._decision
        return self._say(
            "allocation",
            used=int(np.count_nonzero(decision.power_w > 0)),
            total=decision.owner.size,
            served=int(np.count_nonzero(decision.rate_bps > 0)),
            users=decision.rate_bps.size,
            power=human(decision.total_power_w, "W"),
            budget=human(decision.problem.budget_w(decision.cell), "W"),
        )

    def _promised_at(self) -> list[str]:
        """With which probability rates are promised, and how much in all."""
        outage = self._decision.problem.outage_probability
        if outage is None or not self._decision.expected_rate_bps.size:
            return []
        promised = human(float(self._decision.rate_bps.sum()), "bit/s")
        return [self._say("outage", sure=reliability(outage), promised=promised)]

    def _forecast(self) -> list[str]:
        """What is expected of the true channel where that is not sure, and what is planned or asked for on it."""
        decision, forecast = self._decision, self._decision.forecast
        if forecast is None:
            return []
        mean, low, high = float(forecast.mean_bps.sum()), forecast.sum_low_bps, forecast.sum_high_bps
        shown = {name: human(rate, "bit/s") for name, rate in (("mean", mean), ("low", low), ("high", high))}
        said = [] if shown["low"] == shown["high"] else [self._say("forecast", **shown)]
        if decision.expected_rate_bps.size:
            return said
        least = int(np.argmin(np.where(decision.committed_bps > 0, forecast.carried, np.inf)))
        sure = f"{100 * min(float(forecast.carried[least]), _ALL_BUT_CERTAIN):.3g} %"
        if not decision.problem.promises_rates:
            planned = human(float(decision.committed_bps.sum()), "bit/s")
            return [*said, self._say("commitment", planned=planned, sure=sure)] if said else []
        if forecast.carried[least] >= _SURE:
            return said
        rate = human(float(decision.committed_bps[least]), "bit/s")
        return [*said, self._say("asked_unsure", name=self._user(least), sure=sure, rate=rate)]

    def _groups(self) -> list[str]:
        """What assigning whole resource-block groups costs at most, by the bound without groups."""
        decision, bound = self._decision, self._report.ungrouped_bound
        if not np.isfinite(bound) or bound == 0.0:
            return []
        falls = self._objective.direction == "min"
        cost = max(decision.value / bound - 1.0 if falls else 1.0 - decision.value / bound, 0.0)
        size, figure = decision.problem.resource_block_group_size, self._figure_or_value()
        return [self._say("groups", size=size, cost=percent(cost), figure=figure, bound=self._worth(bound))]

    def _goal(self) -> list[str]:
        """What the value is, where its unit does not say it, and how the users count in it."""
        said: list[str] = []
        decision, figure = self._decision, self._figure
        if figure:
            said.append(self._say("figure", figure=figure, value=self._worth(decision.value)))
            starved = (decision.rate_bps <= 0) & self._counts() & (decision.value == 0)
            if starved.any():
                said.append(self._say("starved", names=self._users(np.flatnonzero(starved)), figure=figure))
        weight = decision.problem.weights_of(decision.rate_bps.size)[decision.served]
        if np.ptp(weight) > 0:
            key = "shares" if self._objective.joined == "min" else "weights"
            said.append(self._say(key, least=weight.min(), most=weight.max(), figure=figure))
        return said

    def _idle_users(self) -> list[str]:
        """Who of those who count gets nothing, and by what margin the closest of them was beaten."""
        idle = np.flatnonzero((self._decision.rate_bps <= 0) & self._counts())
        if not idle.size or self._decision.problem.min_rate_bps is not None:
            return []
        gain = self._estimate.gain
        with np.errstate(divide="ignore", invalid="ignore"):
            margin_db = db(gain.max(axis=0) / gain[idle]).min(axis=1)
        closest = int(np.argmin(margin_db))
        if not np.isfinite(margin_db[closest]) or margin_db[closest] <= 0:
            return []
        key, margin = "idle_one" if idle.size == 1 else "idle", float(margin_db[closest])
        return [self._say(key, names=self._users(idle), margin=margin, closest=self._user(idle[closest]))]

    def _repair(self) -> str:
        """How many gains were not measured, and what was made of them."""
        decision, repaired, language = self._decision, self._estimate.repaired, self._language
        if not repaired.any():
            return self._say("complete")
        in_use = np.flatnonzero((decision.owner >= 0) & (decision.power_w > 0))
        said = message(
            language, "certainty.repaired", repaired=int(repaired.sum()), entries=repaired.size,
            share=percent(float(repaired.mean())), method=self._estimate.method, used=in_use.size,
            resting=int(repaired[decision.owner[in_use], in_use].sum()),
        )  # fmt: skip
        unseen = np.flatnonzero(self._estimate.unobserved_users)
        guess = message(language, "certainty.unseen", names=self._users(unseen)) if unseen.size else ""
        return joined(language, [said, guess])

    def _outcome(self) -> list[str]:
        achieved, missed = self._report.achieved, list(self._report.missed_users)
        if achieved is None:
            return []
        firmness = self._decision.problem.firmness
        if not missed:
            return [self._say(f"kept_{firmness}")]
        short = float(np.max(1 - achieved.user_rate_bps[missed] / self._decision.committed_bps[missed]))
        return [self._say(f"missed_{firmness}", names=self._users(missed), short=percent(short))]

    def _regret(self) -> list[str]:
        """What not knowing the channel cost, where that is known."""
        report, achieved = self._report, self._report.achieved
        if report.perfect is None or achieved is None or np.isnan(report.regret):
            return []
        perfect, cost = human(report.perfect.value, report.perfect.unit), percent(max(report.regret, 0.0))
        plain = not self._figure and self._decision.problem.weights is None and report.perfect.unit == "bit/s"
        lost = report.goodput_regret if plain else report.regret
        if abs(lost) < _NO_REGRET and not report.missed_users:
            return [self._say("regret_none")]
        if self._objective.measure == "power" and report.regret < 0 and report.missed_users:
            return [self._say("saved", perfect=perfect, cost=percent(-report.regret))]
        if self._objective.measure == "power":
            return [self._say("regret_min", perfect=perfect, cost=cost)]
        if not plain:
            return [self._say("regret_max", figure=self._figure_or_value(), perfect=perfect, cost=cost)]
        goodput, in_all = human(achieved.goodput_bps, "bit/s"), percent(report.goodput_regret)
        return [self._say("regret_goodput", perfect=perfect, goodput=goodput, cost=in_all, choice=cost)]
