"""Questions about a decision, answered by what :mod:`wirelessagent.telling` computes."""

from __future__ import annotations

import numpy as np

from wirelessagent.agent.posing import UnknownUserError, user_number
from wirelessagent.agent.turn import Run
from wirelessagent.language.intent import Intent
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import called, message
from wirelessagent.telling.explanation import explain
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.glossary import explained
from wirelessagent.telling.prices import limits_answer
from wirelessagent.telling.questions import answered
from wirelessagent.telling.roster import gain_answer, owner_answer, rank_answer, subcarriers_answer
from wirelessagent.telling.tables import user_table
from wirelessagent.telling.text_table import Table


def explanation(run: Run, language: str) -> str:
    """Why the decision is what it is."""
    return "\n".join(explain(run.estimate, run.report, language=language))


def concept(text: str, language: str) -> str:
    """What the terms in a question mean; empty where none is known."""
    return explained(text, language)


def case_of(run: Run) -> Case:
    """A run's decision with what it was made from."""
    return Case(decision=run.decision, estimate=run.estimate, method=run.tools.method, options=run.tools.method_options)


def answer(run: Run, intent: Intent, user_names: tuple[str, ...]) -> tuple[str, tuple[Table, ...]]:
    """The answer to a question about a decision, and its tables; the explanation where there is no closer one.

    Raises:
        UnclearRequestError: it is about a user who is not there, or does not say which; the message asks back.
    """
    case = case_of(run)
    topic, details = intent.topic or "", intent.details
    figures = {name: float(value) for name, value in details.items() if isinstance(value, int | float)}
    if topic == "users" and "asked" not in details and run.decision.is_usable:
        listed = _of_users(case, intent, user_names)
        if listed:
            return listed, (user_table(run.report, run.estimate, intent.language),)
    if "asked" in details and (run.decision.is_usable or details["asked"] != "limits"):
        return _looked_up(case, intent, user_names), ()
    found = answered(
        case, run.report, topic, intent.language, user=_user(intent, user_names), figures=figures
    )  # fmt: skip
    if found is None:
        return explanation(run, intent.language), ()
    text, tables = found
    return text or explain(run.estimate, run.report, language=intent.language)[0], tables


def _looked_up(case: Case, intent: Intent, user_names: tuple[str, ...]) -> str:
    """What was measured, how long it took, or what holds the result back."""
    language, place = intent.language, intent.details.get("subcarrier")
    if intent.details["asked"] == "limits":
        return limits_answer(case, language)
    if intent.details["asked"] == "duration":
        return message(language, "about.no_duration", method=called(language, case.decision.method))
    return gain_answer(case, _user(intent, user_names), int(place) if isinstance(place, float) else None, language)


def _of_users(case: Case, intent: Intent, user_names: tuple[str, ...]) -> str:
    """Who gets the least or the most, or who has which subcarriers, where that is asked; else empty."""
    details, language = intent.details, intent.language
    if "rank" in details:
        return rank_answer(case, str(details["rank"]), str(details.get("of", "rate")), language)
    if details.get("listed") == "dearest":
        return _dearest(case, language)
    if "listed" in details:
        return subcarriers_answer(case, _user(intent, user_names), language)
    place = details.get("subcarrier")
    return owner_answer(case, int(place), language) if isinstance(place, float) else ""


def _dearest(case: Case, language: str) -> str:
    """Who takes the most power for a rate, which says whom to leave out if anybody; empty where nobody gets any."""
    decision = case.decision
    used = decision.power_w > 0
    power_w = np.bincount(decision.owner[used], weights=decision.power_w[used], minlength=case.num_users)
    rated = np.flatnonzero(decision.rate_bps > 0)
    if not rated.size:
        return ""
    user = int(rated[np.argmax(power_w[rated] / decision.rate_bps[rated])])
    rate, power = human(float(decision.rate_bps[user]), "bit/s"), human(float(power_w[user]), "W")
    return message(language, "about.dearest", user=called(language, decision.user_names[user]), rate=rate, power=power)


def _user(intent: Intent, user_names: tuple[str, ...]) -> int | None:
    """The number of the user that a question is about; None for nobody."""
    reference = intent.details.get("user")
    if isinstance(reference, str):
        return user_number(reference, user_names, intent.language)[0]
    if intent.topic == "why_user":
        raise UnknownUserError("", user_names, intent.language)
    return None
