"""A request as one sentence, with figures and units, for the operator to check."""

from __future__ import annotations

from wirelessagent import plugins
from wirelessagent.agent.dialogue import Request
from wirelessagent.language.restating import limits_in_words
from wirelessagent.telling.catalogue import called, has_message, message


def restated(request: Request, language: str = "en") -> str:
    """What is asked for, in one sentence.

    >>> restated(Request(objective="max_rate", constraints={"max_power_w": 10.0, "leave_out": ("3",)}))
    'The highest total rate: at most 10 W of radiated power, without user 3.'
    """
    goal, limits = goal_words(request.objective, language), limits_in_words(request.constraints, language)
    said = goal[:1].upper() + goal[1:]
    if request.method is not None:
        by = message(language, "request.by_method", method=called(language, request.method))
        limits = message(language, "text.between").join(part for part in (limits, by) if part)
    return message(language, "request.whole" if limits else "request.aim_alone", goal=said, limits=limits)


def goal_words(objective: str, language: str) -> str:
    """What an objective is called: in the built-in words, else by its own first phrase."""
    own = plugins.objective(objective).phrases
    spoken = own.get(language) or own.get("en") or next(iter(own.values()), (objective.replace("_", " "),))
    key = f"goal.{objective}"
    return message(language, key) if has_message(language, key) else spoken[0]
