"""A request as one sentence, with figures and units, for the operator to check."""

from __future__ import annotations

from wirelessagent import plugins
from wirelessagent.agent.dialogue import Request
from wirelessagent.agent.turn_words import told
from wirelessagent.explain.labels import called
from wirelessagent.language.replies import GOALS
from wirelessagent.language.restating import limits_in_words


def restated(request: Request, language: str = "en") -> str:
    """What is asked for, in one sentence.

    >>> restated(Request(objective="max_rate", constraints={"max_power_w": 10.0, "leave_out": ("3",)}))
    'The highest total rate: at most 10 W of radiated power, without user 3.'
    """
    goal, limits = goal_words(request.objective, language), limits_in_words(request.constraints, language)
    said = goal[:1].upper() + goal[1:]
    if request.method is not None:
        by = told(language, "by_method", method=called(language, request.method))
        limits = f"{limits}{told(language, 'between')}{by}" if limits else by
    if language == "zh":
        return f"{said}：{limits}。" if limits else f"{said}。"
    return f"{said}: {limits}." if limits else f"{said}."


def goal_words(objective: str, language: str) -> str:
    """What an objective is called: in the built-in words, else by its own first phrase."""
    own = plugins.objective(objective).phrases
    spoken = own.get(language) or own.get("en") or next(iter(own.values()), (objective.replace("_", " "),))
    return GOALS.get(language, GOALS["en"]).get(objective) or spoken[0]
