"""Parts of sentences: what values, subcarriers, users and results are called."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from wirelessagent import plugins
from wirelessagent.model.decision import Decision
from wirelessagent.model.objective import Objective
from wirelessagent.model.phrases import phrases
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import Said, called, has_message, joined, listed, message

if TYPE_CHECKING:
    from wirelessagent.telling.facts.case import Case

_Teller = TypeVar("_Teller", bound="Teller")


@dataclass(frozen=True)
class Teller:
    """Tells of a decision in the operator's language; what it can tell by topic derives from this."""

    case: Case
    language: str

    def by(self, kind: type[_Teller]) -> _Teller:
        """Another teller of the same decision."""
        return kind(self.case, self.language)

    def say(self, key: str, /, **places: object) -> Said:
        """A message in the operator's language."""
        return message(self.language, key, **places)

    def joined(self, sentences: Iterable[str]) -> Said:
        """Sentences one after the other; those that are empty are left out."""
        return joined(self.language, sentences)

    def name(self, user: int) -> str:
        """What a user is called."""
        return called(self.language, self.case.estimate.user_names[user])

    def names(self, users: Iterable[int]) -> str:
        """What users are called, in a row."""
        return listed(self.language, self.case.named(users))

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
    objective, weighted = decision.problem.objective, decision.problem.weights is not None
    names = objective.figure_name if isinstance(objective, Objective) else phrases()
    named = (names.get(language) or names.get("en") or next(iter(names.values()), ("",)))[0]
    if named or not weighted or not isinstance(objective, Objective):
        return named
    if objective.measure == "efficiency":
        return message(language, "label.weighted_energy_efficiency")
    total = (objective.measure, decision.unit) == ("utility", "bit/s")
    return message(language, "label.weighted_total_rate") if total else ""


def goal_words(objective: str, language: str) -> str:
    """What an objective is called: in the built-in words, else by its own first phrase."""
    own = plugins.objective(objective).phrases
    spoken = own.get(language) or own.get("en") or next(iter(own.values()), (objective.replace("_", " "),))
    return goal_named(objective, spoken[0], language)


def goal_named(objective: str, otherwise: str, language: str) -> str:
    """What a built-in objective is called; one of a plug-in is called otherwise."""
    key = f"goal.{objective}"
    return message(language, key) if has_message(language, key) else otherwise


def value_name(decision: Decision, language: str) -> str:
    """What the value is called in a sentence, as in "total rate"."""
    named, objective = name_of_figure(decision, language), decision.problem.objective
    assert isinstance(objective, Objective)
    if named or objective.measure != "utility":
        return named or message(language, f"part.{objective.measure}")
    return message(language, "part.rate" if objective.unit == "bit/s" else "text.value")


def place(first: int, last: int, language: str) -> str:
    """Subcarriers as people count them, from 1."""
    return message(language, "part.one" if first == last else "part.several", first=first + 1, last=last + 1)


def outcome_in_words(decision: Decision, language: str) -> str:
    """What a decision is worth and takes."""
    assert isinstance(decision.problem.objective, Objective)
    key = "part.outcome" if decision.problem.objective.measure == "power" else "part.outcome_power"
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
    objective = decision.problem.objective
    if not isinstance(objective, Objective) or objective.measure == "power":
        return 0, 0
    counts = decision.problem.weights_of(decision.rate_bps.size) > 0
    return int(np.count_nonzero(counts & (decision.rate_bps <= 0))), int(np.count_nonzero(counts))
