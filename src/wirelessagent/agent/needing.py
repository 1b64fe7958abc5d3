"""What power promised rates take, and whether a power that is asked about is needed or enough."""

from __future__ import annotations

import dataclasses
from typing import cast

from wirelessagent.agent import answers, supposing
from wirelessagent.agent.dialogue import Request
from wirelessagent.agent.noting import notes
from wirelessagent.agent.site import Site
from wirelessagent.agent.state import Reply, State
from wirelessagent.agent.turn import Run
from wirelessagent.language.intent import Constraint, Intent
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import joined, message
from wirelessagent.telling.facts.nearest import more_power
from wirelessagent.telling.reasons import BEYOND_W, reason_in_words

_OTHER_AIMS = ("weights", "max_rate_bps", "max_power_w")
"""What the least power knows nothing of, or is asked for instead of."""


def needed(site: Site, state: State, intent: Intent) -> Reply:
    """The least power that the promised rates take; a what-if of the limit where nothing is promised."""
    language, enough_w = intent.language, intent.details.get("enough_w")
    request = supposing.supposed(state, intent)
    promises = "min_rate_bps" in request.constraints or request.objective == "min_power"
    if not promises and isinstance(enough_w, float):
        return supposing.what_if(site, state, _limited(intent, enough_w))
    if not promises:
        return Reply(text=message(language, "needs.nothing"))
    limits: dict[str, Constraint] = {k: v for k, v in request.constraints.items() if k not in _OTHER_AIMS}
    run = site.plan(intent, Request(objective="min_power", constraints=limits))
    power_w = _power(run)
    said = [*notes(run, noted=state.noted), _taken(run, power_w, language)]
    if isinstance(enough_w, float):
        said.append(_judged(run, power_w, enough_w, str(intent.details.get("judged")), language))
        said += _of_the_aim(site, state, request, intent, enough_w, power_w)
    return Reply(text=joined(language, [*said, message(language, "plan.nothing_changed")]), run=run)


def _power(run: Run) -> float | None:
    """The power that was found to do; None where none was."""
    if run.decision.is_usable:
        return run.decision.total_power_w
    more = more_power(answers.case_of(run))
    return None if more is None or more.power_w > BEYOND_W else more.power_w


def _least(run: Run) -> float:
    """The power that is proven to be needed; 0 where nothing is."""
    decision, need = run.decision, run.decision.needed_power_w
    known = decision.bound if decision.is_usable else None if need is None else need.at_least
    return known if known is not None and known == known else 0.0


def _taken(run: Run, power_w: float | None, language: str) -> str:
    if power_w is None:
        return message(language, "needs.too_much", reason=reason_in_words(run.decision, language))
    power, least = human(power_w, "W"), human(_least(run), "W")
    said = message(language, "needs.exactly" if power == least else "needs.takes", power=power, least=least)
    limit = run.decision.cell.max_power_w
    return (
        said
        if power_w <= limit
        else joined(language, [said, message(language, "needs.beyond_limit", limit=human(limit, "W"))])
    )


def _judged(run: Run, power_w: float | None, enough_w: float, asked: str, language: str) -> str:
    """Whether a power does."""
    if power_w is not None and enough_w >= power_w:
        return message(language, f"needs.{asked}_enough", enough=human(enough_w, "W"), power=human(power_w, "W"))
    key = "needs.not_enough" if enough_w < _least(run) or power_w is None else "needs.perhaps_enough"
    return message(language, key, enough=human(enough_w, "W"))


def _of_the_aim(
    site: Site, state: State, request: Request, intent: Intent, enough_w: float, power_w: float | None
) -> list[str]:
    """What such a limit makes of an aim that more power serves."""
    if request.objective == "min_power" or power_w is None or enough_w < power_w:
        return []
    asked = supposing.what_if(site, state, _limited(intent, enough_w))
    return [] if asked.run is None else [supposing.outcome_beside(state, asked.run, intent.language)]


def _limited(intent: Intent, power_w: float) -> Intent:
    """The what-if of a budget beside what else is asked about."""
    held = cast("dict[str, Constraint]", intent.details.get("constraints") or {})
    return dataclasses.replace(intent, details={"constraints": {**held, "max_power_w": power_w}})
