"""The certificate of a decision, in a line, a sentence or a paragraph; and how sure it is of what it rests on."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.decision import OPTIMAL_GAP, Decision
from wirelessagent.model.objective import Objective
from wirelessagent.model.units import human, percent, probability, reliability
from wirelessagent.telling.catalogue import called, joined, listed, message
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.proof import Certainty, Certificate, basis, certainty, certificate
from wirelessagent.telling.parts import cannot_be_served, goal_named, outcome_in_words, place
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


def certificate_answer(case: Case, language: str) -> str:
    """What is proven, how, and what it leaves open."""
    decision, found = case.decision, certificate(case)
    if found.proof in ("nothing", "infeasible", "undecided"):
        reason = reason_in_words(decision, language)
        return message(language, f"proof.{found.proof}", method=decision.method, reason=reason)
    said = [_bound(case, found, language), _left(case, found, language)]
    repaired, entries = int(case.estimate.repaired.sum()), case.estimate.repaired.size
    if repaired:
        said.append(message(language, "proof.estimated", repaired=repaired, entries=entries))
    return joined(language, said)


def _bound(case: Case, found: Certificate, language: str) -> str:
    bound, outage = human(found.bound, case.decision.unit), case.problem.outage_probability
    if found.proof == "closed_form":
        return message(language, "proof.closed_form", bound=bound)
    of = "outage" if outage is not None and case.decision.expected_rate_bps.size else "channel"
    least = "least" if case.objective.direction == "min" else "most"
    said: list[str] = [message(language, f"proof.{of}_{least}", bound=bound, sure=reliability(outage or 0.0))]
    said.append(rests_on(case.objective, language))
    if found.by != case.decision.method:
        said.append(message(language, "proof.by_dual", method=case.decision.method))
    return joined(language, said)


def rests_on(objective: Objective, language: str) -> str:
    """What of the objective the bound rests on; empty where it is the promised rates alone."""
    on = basis(objective)
    if on == "promises":
        return ""
    alpha = objective.power_law() or 0.0
    law = {0.0: "r", 1.0: "ln r"}.get(alpha, f"r^(1 − α)/(1 − α) with α = {alpha:g}")
    named = goal_named(objective.name, objective.name, language)
    return message(language, f"proof.rests_on_{on}", objective=named, law=law)


def _left(case: Case, found: Certificate, language: str) -> str:
    if case.decision.status == "optimal" or found.gap <= 0:
        return message(language, "proof.reached")
    unit = case.decision.unit
    value, left = human(case.decision.value, unit), human(found.left, unit)
    key = "proof.value_least" if case.objective.direction == "min" else "proof.value"
    return message(language, key, value=value, left=left, gap=percent(found.gap))


def uncertainty_answer(case: Case, language: str) -> str:
    """What was missing, what it was repaired by, and how sure the decision is."""
    found = certainty(case)
    if not found.repaired and not found.noisy:
        return message(language, "certainty.all_known")
    share = percent(found.repaired / found.entries)
    figures = {
        "repaired": found.repaired,
        "entries": found.entries,
        "noisy": found.noisy,
        "method": found.method,
    }
    key = "certainty.repaired" if found.repaired else "certainty.noisy"
    said = [message(language, key, **figures, share=share, resting=found.resting, used=found.used)]
    if found.unseen:
        unseen = listed(language, case.named(found.unseen))
        said.append(message(language, "certainty.unseen", names=unseen))
    if case.decision.is_usable and found.least_sure is None:
        said.append(message(language, "certainty.rests_on_none"))
    return joined(language, [*said, *_sure(case, found, language)])


def _sure(case: Case, found: Certainty, language: str) -> list[str]:
    """How sure the rates are, and the gain that is known least."""
    if found.least_sure is None or found.widest is None:
        return []
    names, outage = case.estimate.user_names, case.problem.outage_probability
    user, subcarrier = found.widest
    low, high = human(found.low_bps, "bit/s"), human(found.high_bps, "bit/s")
    key = "holds" if found.expected_missed < _HARDLY_ANY else "may_fail"
    told = {
        "user": called(language, names[found.least_sure]),
        "kept": probability(found.least_kept),
        "missed": found.expected_missed,
    }
    served, sure = int((case.decision.committed_bps > 0).sum()), reliability(outage or 0.0)
    asked = outage is None and case.problem.promises_rates
    return [
        message(language, "certainty.band", low=low, high=high) if low != high else "",
        message(language, f"certainty.{key if outage is None else 'promise'}", served=served, sure=sure, **told),
        message(language, "certainty.asked") if asked else "",
        message(
            language, "certainty.widest", user=names[user], place=place(subcarrier, subcarrier, language),
            low=found.widest_low_db, high=found.widest_high_db,
        ),
    ]  # fmt: skip
