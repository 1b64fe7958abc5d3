"""Parts of sentences: what values, subcarriers, users and results are called, and why there is none.

Where nothing was found that meets a request, that is the limit that is the cause.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from wirelessagent import plugins
from wirelessagent.deciding.core.closed_form import APPROACHED
from wirelessagent.model.arrays import BoolArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.phrases import Phrases
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import Voice, called, goal_named, listed, message
from wirelessagent.telling.facts.case import Case, objective_of
from wirelessagent.telling.facts.nearest import shortage_of

BEYOND_W = 1e6
"""Powers beyond this are not told in figures: no cell radiates them."""
_ROUNDING = 1e-9

_Teller = TypeVar("_Teller", bound="Teller")


@dataclass(frozen=True)
class Teller(Voice):
    """Tells of a decision in the operator's language; what it can tell by topic derives from this."""

    case: Case
    language: str

    def by(self, kind: type[_Teller]) -> _Teller:
        """Another teller of the same decision."""
        return kind(self.case, self.language)

    def name(self, user: int) -> str:
        """What a user is called."""
        return called(self.language, self.case.estimate.user_names[user])

    def names(self, users: Iterable[int]) -> str:
        """What users are called, in a row."""
        return listed(self.language, self.case.named(users))

    def place(self, first: int, last: int) -> str:
        """Subcarriers as people count them, from 1."""
        return self.say("part.one" if first == last else "part.several", first=first + 1, last=last + 1)

    def why(self, decision: Decision) -> str:
        """Why there is no allocation, or what else a decision says of itself."""
        return reason_in_words(decision, self.language)

    @property
    def figure(self) -> str:
        """What the decision's value is called in a sentence."""
        return value_name(self.case.decision, self.language)

    @property
    def budget(self) -> str:
        """The power that may be radiated."""
        return human(self.case.problem.budget_w(self.case.cell), "W")

    @property
    def spent(self) -> str:
        """The power that is radiated."""
        return human(self.case.decision.total_power_w, "W")

    def worth(self, value: float) -> str:
        """A value of the decision's objective with its unit."""
        return human(value, self.case.decision.unit)


def name_of_figure(decision: Decision, language: str = "en") -> str:
    """What the decision's value is called, as in "lowest rate"; empty where its unit says it all."""
    objective = objective_of(decision)
    named = _first_of(objective.figure_name, language)
    if not named and objective.measure == "utility" and decision.unit != "bit/s":
        return message(language, "text.value")
    if named or decision.problem.weights is None:
        return named
    if objective.measure == "efficiency":
        return message(language, "label.weighted_energy_efficiency")
    total = (objective.measure, decision.unit) == ("utility", "bit/s")
    return message(language, "label.weighted_total_rate") if total else ""


def goal_words(objective: str, language: str) -> str:
    """What an objective is called: in the built-in words, else by its own first phrase."""
    spoken = _first_of(plugins.objective(objective).phrases, language)
    return goal_named(objective, spoken or objective.replace("_", " "), language)


def _first_of(phrases: Phrases, language: str) -> str:
    """The first phrase in a language, else in English, else in any; empty where there is none."""
    return next((said[0] for said in (phrases.get(language), phrases.get("en"), *phrases.values()) if said), "")


def value_name(decision: Decision, language: str) -> str:
    """What the value is called in a sentence, as in "total rate"."""
    named, objective = name_of_figure(decision, language), objective_of(decision)
    return named or message(language, "part.rate" if objective.measure == "utility" else f"part.{objective.measure}")


def outcome_in_words(decision: Decision, language: str) -> str:
    """What a decision is worth and takes."""
    key = "part.outcome" if objective_of(decision).measure == "power" else "part.outcome_power"
    value, power = human(decision.value, decision.unit), human(decision.total_power_w, "W")
    return message(language, key, figure=value_name(decision, language), value=value, power=power)


def without_anything(decision: Decision, language: str) -> str:
    """How many users get nothing though they count, where no promise was asked for them; empty where none is."""
    idle, users = _idle(decision)
    if not idle or decision.value == 0 or not decision.is_usable:
        return ""
    return message(language, "decision.without_anything", idle=idle, users=users)


def cannot_be_served(decision: Decision, language: str = "en") -> str:
    """How many users get no rate, where that makes the decision worthless; empty where it does not."""
    starved, users = _idle(decision)
    if not starved or decision.value != 0:
        return ""
    size = decision.problem.resource_block_group_size
    places, kind = -(-decision.owner.size // size), "part.subcarriers" if size == 1 else "part.resource_block_groups"
    key = "decision.cannot_serve_places" if places < users else "decision.cannot_serve"
    return message(language, key, left=starved, users=users, places=places, kind=message(language, kind))


def _idle(decision: Decision) -> tuple[int, int]:
    """How many of those whose rate counts get none, and how many count; none of none where the power is to be least."""
    if objective_of(decision).measure == "power":
        return 0, 0
    counts = decision.problem.weights_of(decision.rate_bps.size) > 0
    return int(np.count_nonzero(without_rate(decision))), int(np.count_nonzero(counts))


def without_rate(decision: Decision) -> BoolArray:
    """True for users whose rate counts, who are served and have a weight, and who get none, shape (user,)."""
    return (decision.rate_bps <= 0) & (decision.problem.weights_of(decision.rate_bps.size) > 0)


def power_in_words(power_w: float, language: str) -> str:
    """A power that rates need; where no cell has it, that instead of its figure."""
    if np.isinf(power_w):
        return message(language, "reason.no_power")
    if power_w > BEYOND_W:
        return message(language, "reason.beyond", beyond=human(BEYOND_W, "W"))
    return human(power_w, "W")


def reason_in_words(decision: Decision, language: str) -> str:
    """Why there is no allocation, or what else a decision says of itself; its own words where nothing is known here."""
    if decision.reason == APPROACHED:
        return message(language, "reason.approached")
    if decision.is_usable or decision.needed_power_w is None:
        return decision.reason
    if decision.status != "infeasible":
        return _open(decision, language)
    return _short(decision, language) or _needs(decision, language)


def _needs(decision: Decision, language: str) -> str:
    """That the promised rates need more power than they may use."""
    need, budget = decision.needed_power_w, decision.problem.budget_w(decision.cell)
    assert need is not None
    told = {"budget": human(budget, "W"), "least": human(need.at_least, "W"), "most": human(need.at_most, "W")}
    cap = decision.problem.subcarrier_max_power_w
    total = np.inf if cap is None else float(np.broadcast_to(cap, decision.owner.shape).sum())
    if total < min(budget, need.at_least * (1.0 - _ROUNDING)):
        return message(language, "reason.capped", limits=_limits(decision, language), total=human(total, "W"))
    if np.isinf(need.at_least):
        return message(language, "reason.needs_nothing")
    if not need.at_least > budget:
        return decision.reason
    if need.at_least > BEYOND_W:
        return message(language, "reason.needs_beyond", beyond=human(BEYOND_W, "W"), **told)
    return message(language, "reason.needs_found" if need.at_most <= BEYOND_W else "reason.needs", **told)


def _short(decision: Decision, language: str) -> str:
    """That no power is enough, and why; empty where some power may be."""
    short = shortage_of(decision)
    if short is None:
        return ""
    size = decision.problem.resource_block_group_size
    return message(
        language, f"reason.{short.kind}", name=called(language, decision.user_names[short.user]),
        users=short.users, served=short.served, places=short.places, needed=short.needed,
        promised=human(short.promised_bps, "bit/s"), most=human(short.most_bps, "bit/s"),
        kind=message(language, "part.subcarriers" if size == 1 else "reason.group", size=size),
        limits=_limits(decision, language),
    )  # fmt: skip


def _open(decision: Decision, language: str) -> str:
    """That nothing was found, how far what was found comes, and what is known of the need."""
    need, scale = decision.needed_power_w, decision.rate_scaling
    assert need is not None
    outage, found = decision.problem.outage_probability, ""
    if np.isfinite(need.at_most):
        found = message(language, "reason.found_power", most=power_in_words(need.at_most, language))
    elif scale is not None and scale.at_least > 0:
        found = message(language, "reason.found_share", share=percent(scale.at_least))
    sure = "" if outage is None else message(language, "reason.sure", sure=reliability(outage))
    budget, least = human(decision.problem.budget_w(decision.cell), "W"), human(need.at_least, "W")
    return message(language, "reason.open", sure=sure, budget=budget, found=found, least=least)


def _limits(decision: Decision, language: str) -> str:
    """The limits on what a subcarrier may carry; empty where there are none."""
    cap, link = decision.problem.subcarrier_max_power_w, decision.cell.max_spectral_efficiency
    limits: list[str] = []
    if cap is not None:
        one = np.ndim(cap) == 0 or np.ptp(cap) == 0
        figure = human(float(np.min(cap)), "W")
        limits.append(message(language, "reason.cap" if one else "reason.caps", cap=figure))
    if np.isfinite(link):
        limits.append(message(language, "reason.link", link=human(link, "bit/s/Hz")))
    return message(language, "reason.both", cap=limits[0], link=limits[1]) if len(limits) > 1 else "".join(limits)
