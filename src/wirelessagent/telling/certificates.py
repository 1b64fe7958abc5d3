"""The certificate of a decision, in a line, a sentence or a paragraph; and how sure it is of what it rests on."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.decision import OPTIMAL_GAP, Decision
from wirelessagent.model.objective import Objective
from wirelessagent.model.units import human, percent, probability, reliability
from wirelessagent.telling.catalogue import message
from wirelessagent.telling.facts.proof import Certainty, Certificate, certainty, certificate
from wirelessagent.telling.parts import Teller, cannot_be_served, goal_named, outcome_in_words, place
from wirelessagent.telling.reasons import reason_in_words

_HARDLY_ANY = 0.05
"""So few of all rates that are expected to fail are none."""


def certificate_line(decision: Decision, language: str = "en") -> str:
    """What was decided, and how sure it is that nothing does better, in one line."""
    if not decision.is_usable:
        status = message(language, f"status.{decision.status}")
        return message(language, "certificate.unusable", status=status, reason=reason_in_words(decision, language))
    outage, bound = decision.problem.outage_probability, human(decision.bound, decision.unit)
    figures = {"value": outcome_in_words(decision, language), "bound": bound, "gap": percent(decision.gap)}
    best = decision.status == "optimal" or figures["gap"] == percent(0.0)
    close = bound == human(decision.value, decision.unit)
    proof = "no_bound" if np.isnan(decision.gap) else "best" if best else "close" if close else "line"
    key = f"certificate.{proof}" if outage is None else f"certificate.{proof}_outage"
    line = message(language, key, **figures, sure=reliability(outage or 0.0))
    left_out = cannot_be_served(decision, language)
    return message(language, "certificate.noted", line=line, note=left_out) if left_out else line


def summary_line(decision: Decision, language: str = "en") -> str:
    """The same with the status and the method in front, for those who look at methods."""
    line = certificate_line(decision, language)
    return f"{decided_line(decision, language)}: {line}" if decision.is_usable else line


def decided_line(decision: Decision, language: str = "en") -> str:
    """The status of a decision and what made it."""
    status = message(language, f"status.{decision.status}")
    return message(language, "certificate.decided", status=status, method=decision.method)


def certificate_sentence(decision: Decision, language: str) -> str:
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
            reason = reason_in_words(decision, self.language)
            return self.say(f"proof.{found.proof}", method=decision.method, reason=reason)
        said = [self._bound(found), self._left(found)]
        if repaired.any():
            said.append(self.say("proof.estimated", repaired=int(repaired.sum()), entries=repaired.size))
        return self.joined(said)

    def _bound(self, found: Certificate) -> str:
        case, bound, outage = self.case, self.worth(found.bound), self.case.problem.outage_probability
        if found.proof == "closed_form":
            return self.say("proof.closed_form", bound=bound)
        of = "outage" if outage is not None and case.decision.expected_rate_bps.size else "channel"
        key = f"proof.{of}_{'least' if case.falls else 'most'}"
        said = [self.say(key, bound=bound, sure=reliability(outage or 0.0)), rests_on(case.objective, self.language)]
        if found.by != case.decision.method:
            said.append(self.say("proof.by_dual", method=case.decision.method))
        return self.joined(said)

    def _left(self, found: Certificate) -> str:
        if self.case.decision.status == "optimal" or found.gap <= 0:
            return self.say("proof.reached")
        value, left = self.worth(self.case.decision.value), self.worth(found.left)
        key = "proof.value_least" if self.case.falls else "proof.value"
        return self.say(key, value=value, left=left, gap=percent(found.gap))

    def certainty(self) -> str:
        """What was missing, what it was repaired by, and how sure the decision is."""
        found = certainty(self.case)
        if not found.repaired and not found.noisy:
            return self.say("certainty.all_known")
        said: list[str] = [
            self.say(
                "certainty.repaired" if found.repaired else "certainty.noisy",
                repaired=found.repaired, entries=found.entries, noisy=found.noisy, method=found.method,
                share=percent(found.repaired / found.entries), resting=found.resting, used=found.used,
            )
        ]  # fmt: skip
        unseen = [user for user in found.unseen if self.case.served[user]]
        if unseen:
            said.append(self.say("certainty.unseen", names=self.names(unseen)))
        if self.case.decision.is_usable and found.least_sure is None:
            said.append(self.say("certainty.rests_on_none"))
        return self.joined([*said, *self._sure(found)])

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
        return [
            self.say("certainty.band", low=low, high=high) if low != high else "",
            self.say(f"certainty.{key}", served=served, sure=sure, **told, missed=found.expected_missed),
            self.say("certainty.asked") if asked else "",
            self.say(
                "certainty.widest", user=self.case.estimate.user_names[user],
                place=place(subcarrier, subcarrier, self.language),
                low=found.widest_low_db, high=found.widest_high_db,
            ),
        ]  # fmt: skip
