"""A decision in a few sentences, every figure computed from the decision itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import BoolArray
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.units import db, human, percent, reliability
from wirelessagent.telling.catalogue import Said
from wirelessagent.telling.certificates import certificate_sentence, rests_on
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.proof import measured
from wirelessagent.telling.parts import Teller, cannot_be_served, name_of_figure
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
    return _Explanation(Case(decision=report.decision, estimate=estimate), language, report).sentences()


@dataclass(frozen=True)
class _Explanation(Teller):
    """One decision on its way into words; what there is nothing to say of is empty."""

    report: Report

    def sentences(self) -> list[str]:
        decision, objective = self.case.decision, self.case.objective
        if not decision.is_usable:
            return [self._told(decision.status, reason=reason_in_words(decision, self.language))]
        if objective.measure == "power" and decision.problem.min_rate_bps is None and not decision.power_w.any():
            return [self._told("no_promise")]
        proven = certificate_sentence(decision, self.language)
        said: list[str] = [self.joined([self._allocation(), proven]), *self._goal()]
        if not objective.is_built_in and not np.isnan(decision.gap):
            said.append(rests_on(objective, self.language))
        said += [self._promised_at(), *self._forecast(), self._groups(), self._remark(), self._idle_users()]
        return [one for one in (*said, self._repair(), self._outcome(), self._regret()) if one]

    def _told(self, key: str, **places: object) -> Said:
        return self.say(f"decision.{key}", **places)

    @property
    def _own_figure(self) -> str:
        """What the value is called; empty where its unit says it all."""
        return name_of_figure(self.case.decision, self.language)

    def _figure_or_value(self) -> str:
        return self._own_figure or self.say("text.value")

    def _counts(self) -> BoolArray:
        """True for users whose rate counts: those who are served and have a weight."""
        return self.case.problem.weights_of(self.case.num_users) > 0

    def _remark(self) -> str:
        """What else the decision says of itself."""
        decision = self.case.decision
        if not decision.reason or cannot_be_served(decision):
            return ""
        return self.say("text.sentence", line=reason_in_words(decision, self.language))

    def _allocation(self) -> str:
        decision, served = self.case.decision, int(np.count_nonzero(self.case.decision.rate_bps > 0))
        return self._told(
            "allocation", used=int(np.count_nonzero(decision.power_w > 0)), total=decision.owner.size,
            served=served, users=self.case.num_users, power=self.spent, budget=self.budget,
        )  # fmt: skip

    def _promised_at(self) -> str:
        """With which probability rates are promised, and how much in all."""
        outage, decision = self.case.problem.outage_probability, self.case.decision
        if outage is None or not decision.expected_rate_bps.size:
            return ""
        promised = human(float(decision.rate_bps.sum()), "bit/s")
        return self._told("outage", sure=reliability(outage), promised=promised)

    def _forecast(self) -> list[str]:
        """What is expected of the true channel where that is not sure, and what is planned or asked for on it."""
        decision, forecast = self.case.decision, self.case.decision.forecast
        if forecast is None:
            return []
        mean, low, high = float(forecast.mean_bps.sum()), forecast.sum_low_bps, forecast.sum_high_bps
        shown = {name: human(rate, "bit/s") for name, rate in (("mean", mean), ("low", low), ("high", high))}
        said: list[str] = [] if shown["low"] == shown["high"] else [self._told("forecast", **shown)]
        if decision.expected_rate_bps.size:
            return said
        least = int(np.argmin(np.where(decision.committed_bps > 0, forecast.carried, np.inf)))
        sure = f"{100 * min(float(forecast.carried[least]), _ALL_BUT_CERTAIN):.3g} %"
        if not decision.problem.promises_rates:
            planned = human(float(decision.committed_bps.sum()), "bit/s")
            return [*said, self._told("commitment", planned=planned, sure=sure)] if said else []
        if forecast.carried[least] >= _SURE:
            return said
        rate = human(float(decision.committed_bps[least]), "bit/s")
        return [*said, self._told("asked_unsure", name=self.name(least), sure=sure, rate=rate)]

    def _groups(self) -> str:
        """What assigning whole resource-block groups costs at most, by the bound without groups."""
        value, bound = self.case.decision.value, self.report.ungrouped_bound
        if not np.isfinite(bound) or bound == 0.0:
            return ""
        cost = max(value / bound - 1.0 if self.case.falls else 1.0 - value / bound, 0.0)
        size, figure = self.case.problem.resource_block_group_size, self._figure_or_value()
        return self._told("groups", size=size, cost=percent(cost), figure=figure, bound=self.worth(bound))

    def _goal(self) -> list[str]:
        """What the value is, where its unit does not say it, and how the users count in it."""
        said: list[str] = []
        decision, figure = self.case.decision, self._own_figure
        if figure:
            said.append(self._told("figure", figure=figure, value=self.worth(decision.value)))
            starved = (decision.rate_bps <= 0) & self._counts() & (decision.value == 0)
            if starved.any():
                said.append(self._told("starved", names=self.names(np.flatnonzero(starved).tolist()), figure=figure))
        weight = decision.problem.weights_of(self.case.num_users)[decision.served]
        if np.ptp(weight) > 0:
            key = "shares" if self.case.objective.joined == "min" else "weights"
            said.append(self._told(key, least=weight.min(), most=weight.max(), figure=figure))
        return said

    def _idle_users(self) -> str:
        """Who of those who count gets nothing, and by what margin the closest of them was beaten."""
        idle = np.flatnonzero((self.case.decision.rate_bps <= 0) & self._counts())
        if not idle.size or self.case.problem.min_rate_bps is not None:
            return ""
        gain = self.case.estimate.gain
        with np.errstate(divide="ignore", invalid="ignore"):
            margin_db = db(gain.max(axis=0) / gain[idle]).min(axis=1)
        closest = int(np.argmin(margin_db))
        if not np.isfinite(margin_db[closest]) or margin_db[closest] <= 0:
            return ""
        names, margin = self.names(idle.tolist()), float(margin_db[closest])
        key = "idle_one" if idle.size == 1 else "idle"
        return self._told(key, names=names, margin=margin, closest=self.name(int(idle[closest])))

    def _repair(self) -> str:
        """How many gains were not measured, and what was made of them."""
        found = measured(self.case)
        if not found.repaired:
            return self._told("complete")
        said = self.say(
            "certainty.repaired", repaired=found.repaired, entries=found.entries, method=found.method,
            share=percent(found.repaired / found.entries), used=found.used, resting=found.resting,
        )  # fmt: skip
        return self.joined([said, self.say("certainty.unseen", names=self.names(found.unseen)) if found.unseen else ""])

    def _outcome(self) -> str:
        """Whether what was promised was kept, where that is known."""
        achieved, missed = self.report.achieved, list(self.report.missed_users)
        if achieved is None:
            return ""
        firmness = self.case.problem.firmness
        if not missed:
            return self._told(f"kept_{firmness}")
        short = float(np.max(1 - achieved.user_rate_bps[missed] / self.case.decision.committed_bps[missed]))
        return self._told(f"missed_{firmness}", names=self.names(missed), short=percent(short))

    def _regret(self) -> str:
        """What not knowing the channel cost, where that is known."""
        report, achieved, of_power = self.report, self.report.achieved, self.case.objective.measure == "power"
        if report.perfect is None or achieved is None or np.isnan(report.regret):
            return ""
        perfect, cost = human(report.perfect.value, report.perfect.unit), percent(max(report.regret, 0.0))
        plain = not self._own_figure and self.case.problem.weights is None and report.perfect.unit == "bit/s"
        lost = report.goodput_regret if plain else report.regret
        if abs(lost) < _NO_REGRET and not report.missed_users:
            return self._told("regret_none")
        if of_power and report.regret < 0 and report.missed_users:
            return self._told("saved", perfect=perfect, cost=percent(-report.regret))
        if of_power:
            return self._told("regret_min", perfect=perfect, cost=cost)
        if not plain:
            return self._told("regret_max", figure=self._figure_or_value(), perfect=perfect, cost=cost)
        goodput, in_all = human(achieved.goodput_bps, "bit/s"), percent(report.goodput_regret)
        return self._told("regret_goodput", perfect=perfect, goodput=goodput, cost=in_all, choice=cost)
