"""A decision in words, every figure computed from the decision itself: its certificate, how sure it is, and why.

The certificate is told in a line, a sentence or a paragraph.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.decision import OPTIMAL_GAP, Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.units import db, human, percent, probability, reliability
from wirelessagent.telling import parts
from wirelessagent.telling.catalogue import Said, goal_named, message
from wirelessagent.telling.facts.case import Case, Certainty, Certificate, certainty, certificate, measured
from wirelessagent.telling.parts import Teller
from wirelessagent.telling.report import Report

_HARDLY_ANY = 0.05
"""So few of all rates that are expected to fail are none."""
_SURE = 0.95
"""The probability from which a promise without an outage probability goes without a warning."""
_ALL_BUT_CERTAIN = 0.999
"""A probability beyond which nobody counts."""
_NO_REGRET = 5e-4
"""A share of the rate that nobody would miss."""


def certificate_line(decision: Decision, language: str = "en") -> str:
    """What was decided, and how sure it is that nothing does better, in one line."""
    if not decision.is_usable:
        status, why = message(language, f"status.{decision.status}"), parts.reason_in_words(decision, language)
        return message(language, "certificate.unusable", status=status, reason=why)
    outage, bound = decision.problem.outage_probability, human(decision.bound, decision.unit)
    figures = {"value": parts.outcome_in_words(decision, language), "bound": bound, "gap": percent(decision.gap)}
    best = decision.status == "optimal" or figures["gap"] == percent(0.0)
    close = bound == human(decision.value, decision.unit)
    proof = "no_bound" if np.isnan(decision.gap) else "best" if best else "close" if close else "line"
    key = f"certificate.{proof}" if outage is None else f"certificate.{proof}_outage"
    line = message(language, key, **figures, sure=reliability(outage or 0.0))
    left_out = parts.cannot_be_served(decision, language)
    return message(language, "certificate.noted", line=line, note=left_out) if left_out else line


def summary_line(decision: Decision, language: str = "en") -> str:
    """The same with the status and the method in front, for those who look at methods."""
    line = certificate_line(decision, language)
    return f"{decided_line(decision, language)}: {line}" if decision.is_usable else line


def decided_line(decision: Decision, language: str = "en") -> str:
    """The status of a decision and what made it."""
    status = message(language, f"status.{decision.status}")
    return message(language, "certificate.decided", status=status, method=decision.method)


def _how_far(decision: Decision, language: str) -> str:
    """How far a decision is from the best, in one sentence."""
    if np.isnan(decision.gap):
        return message(language, "certificate.without", method=decision.method)
    outage = "_outage" if decision.expected_rate_bps.size else ""
    if decision.status == "optimal" and decision.gap <= OPTIMAL_GAP:
        return message(language, f"certificate.optimal{outage}")
    if np.isinf(decision.gap):
        return message(language, "certificate.zero_bound")
    bound = human(decision.bound, decision.unit)
    if decision.gap > 1.0 and decision.value * decision.bound > 0:  # percents beyond 100 tell nothing
        return message(language, "certificate.times", bound=bound, times=decision.value / decision.bound)
    return message(language, f"certificate.gap{outage}", bound=bound, gap=percent(decision.gap))


def rests_on(objective: Objective, language: str) -> str:
    """What of the objective a bound rests on: that more rate is worth no less, the power law that it declares, or its
    conjugate, never values of its utility that somebody asked for; empty where it is the promised rates alone.
    """
    if objective.measure == "power":
        return ""
    on = "levels" if objective.joined == "min" else "conjugate" if objective.power_law() is None else "law"
    alpha = objective.power_law() or 0.0
    law = {0.0: "r", 1.0: "ln r"}.get(alpha, f"r^(1 − α)/(1 − α) with α = {alpha:g}")
    named = goal_named(objective.name, objective.name, language)
    return message(language, f"proof.rests_on_{on}", objective=named, law=law)


class Proofs(Teller):
    """What is proven of a decision, and how sure it is of what it rests on."""

    def proof(self) -> str:
        """What is proven, how, and what it leaves open."""
        decision, found, repaired = self.case.decision, certificate(self.case), self.case.estimate.repaired
        if found.proof in ("nothing", "infeasible", "undecided"):
            return self.say(f"proof.{found.proof}", method=decision.method, reason=self.why(decision))
        value, left = self.worth(decision.value), self.worth(found.left)
        key = "proof.value_least" if self.case.falls else "proof.value"
        reached = decision.status == "optimal" or found.gap <= 0
        left = self.say("proof.reached") if reached else self.say(key, value=value, left=left, gap=percent(found.gap))
        estimated = self.say("proof.estimated", repaired=int(repaired.sum()), entries=repaired.size)
        return self.joined(self._bound(found), left, estimated if repaired.any() else "")

    def _bound(self, found: Certificate) -> str:
        case, bound, outage = self.case, self.worth(found.bound), self.case.problem.outage_probability
        if found.proof == "closed_form":
            return self.say("proof.closed_form", bound=bound)
        of = "outage" if outage is not None and case.decision.expected_rate_bps.size else "channel"
        key = f"proof.{of}_{'least' if case.falls else 'most'}"
        said = self.say(key, bound=bound, sure=reliability(outage or 0.0))
        by_dual = "" if found.by == case.decision.method else self.say("proof.by_dual", method=case.decision.method)
        return self.joined(said, rests_on(case.objective, self.language), by_dual)

    def certainty(self) -> str:
        """What was missing, what it was repaired by, and how sure the decision is."""
        found = certainty(self.case)
        if not found.repaired and not found.noisy:
            return self.say("certainty.all_known")
        unseen = [user for user in found.unseen if self.case.served[user]]
        rests_on_none = self.case.decision.is_usable and found.least_sure is None
        said = self.say("certainty.rests_on_none") if rests_on_none else ""
        return self.joined(*self._measured(found, unseen, noisy=found.noisy), said, *self._sure(found))

    def _measured(self, found: Certainty, unseen: Sequence[int], **noisy: int) -> list[str]:
        """How many gains were not measured, or not exactly, and what was made of them."""
        said = self.say(
            "certainty.repaired" if found.repaired else "certainty.noisy",
            repaired=found.repaired, entries=found.entries, method=found.method, **noisy,
            share=percent(found.repaired / found.entries), resting=found.resting, used=found.used,
        )  # fmt: skip
        return [said, self.say("certainty.unseen", names=self.names(unseen)) if unseen else ""]

    def _sure(self, found: Certainty) -> list[str]:
        """How sure the rates are, and the gain that is known least."""
        if found.least_sure is None or found.widest is None:
            return []
        (user, subcarrier), outage = found.widest, self.case.problem.outage_probability
        low, high = human(found.low_bps, "bit/s"), human(found.high_bps, "bit/s")
        told = {"user": self.name(found.least_sure), "kept": probability(found.least_kept)}
        key = "promise" if outage is not None else "holds" if found.expected_missed < _HARDLY_ANY else "may_fail"
        served, sure = int((self.case.decision.committed_bps > 0).sum()), reliability(outage or 0.0)
        asked = outage is None and self.case.problem.promises_rates
        at = {"user": self.case.estimate.user_names[user], "place": self.place(subcarrier, subcarrier)}
        return [
            self.say("certainty.band", low=low, high=high) if low != high else "",
            self.say(f"certainty.{key}", served=served, sure=sure, **told, missed=found.expected_missed),
            self.say("certainty.asked") if asked else "",
            self.say("certainty.widest", **at, low=found.widest_low_db, high=found.widest_high_db),
        ]


def explain(estimate: ChannelEstimate, report: Report, *, language: str = "en") -> list[str]:
    """Why the decision is what it is, in the operator's language, one sentence per item."""
    return _Explanation(Case(decision=report.decision, estimate=estimate), language, report).sentences()


@dataclass(frozen=True)
class _Explanation(Proofs):
    """One decision on its way into words; what there is nothing to say of is empty."""

    report: Report

    def sentences(self) -> list[str]:
        decision, objective = self.case.decision, self.case.objective
        if not decision.is_usable:
            return [self._told(decision.status, reason=self.why(decision))]
        if objective.measure == "power" and decision.problem.min_rate_bps is None and not decision.power_w.any():
            return [self._told("no_promise")]
        allocation = self._told(
            "allocation", used=self.case.used.size, total=decision.owner.size, users=self.case.num_users,
            served=int(np.count_nonzero(decision.rate_bps > 0)), power=self.spent, budget=self.budget,
        )  # fmt: skip
        proven = not objective.is_built_in and not np.isnan(decision.gap)
        because = decision.reason and not parts.cannot_be_served(decision)
        known = measured(self.case)
        said = [
            self.joined(allocation, _how_far(decision, self.language)),
            *self._goal(),
            rests_on(objective, self.language) if proven else "",
            *self._forecast(),
            self._groups(),
            self.say("text.sentence", line=self.why(decision)) if because else "",
            self._idle_users(),
            self.joined(*self._measured(known, known.unseen)) if known.repaired else self._told("complete"),
            self._outcome(),
            self._regret(),
        ]
        return [one for one in said if one]

    def _told(self, key: str, **places: object) -> Said:
        return self.say(f"decision.{key}", **places)

    @property
    def _own_figure(self) -> str:
        """What the value is called; empty where its unit says it all."""
        return parts.name_of_figure(self.case.decision, self.language)

    def _forecast(self) -> list[str]:
        """What is promised and how surely, what is expected of the true channel where that is not sure, and what is
        planned or asked for on it.
        """
        decision, forecast, said = self.case.decision, self.case.decision.forecast, list[str]()
        if decision.problem.outage_probability is not None and decision.expected_rate_bps.size:
            sure = reliability(decision.problem.outage_probability)
            said.append(self._told("outage", sure=sure, promised=human(float(decision.rate_bps.sum()), "bit/s")))
        if forecast is None:
            return said
        mean, low, high = float(forecast.mean_bps.sum()), forecast.sum_low_bps, forecast.sum_high_bps
        shown = {name: human(rate, "bit/s") for name, rate in (("mean", mean), ("low", low), ("high", high))}
        said += [] if shown["low"] == shown["high"] else [self._told("forecast", **shown)]
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
        size, figure = self.case.problem.resource_block_group_size, self._own_figure or self.say("text.value")
        return self._told("groups", size=size, cost=percent(cost), figure=figure, bound=self.worth(bound))

    def _goal(self) -> list[str]:
        """What the value is, where its unit does not say it, and how the users count in it."""
        said: list[str] = []
        decision, figure = self.case.decision, self._own_figure
        if figure:
            said.append(self._told("figure", figure=figure, value=self.worth(decision.value)))
            starved = np.flatnonzero(parts.without_rate(decision)).tolist()
            if starved and decision.value == 0:
                said.append(self._told("starved", names=self.names(starved), figure=figure))
        weight = decision.problem.weights_of(self.case.num_users)[decision.served]
        if np.ptp(weight) > 0:
            key = "shares" if self.case.objective.joined == "min" else "weights"
            said.append(self._told(key, least=weight.min(), most=weight.max(), figure=figure))
        return said

    def _idle_users(self) -> str:
        """Who of those who count gets nothing, and by what margin the closest of them was beaten."""
        idle = np.flatnonzero(parts.without_rate(self.case.decision))
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
            figure = self._own_figure or self.say("text.value")
            return self._told("regret_max", figure=figure, perfect=perfect, cost=cost)
        goodput, in_all = human(achieved.goodput_bps, "bit/s"), percent(report.goodput_regret)
        return self._told("regret_goodput", perfect=perfect, goodput=goodput, cost=in_all, choice=cost)
