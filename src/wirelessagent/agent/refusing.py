"""Why a method does not solve a problem, in the operator's language, and which ones do."""

from __future__ import annotations

from wirelessagent import chain, plugins
from wirelessagent.agent.restating import goal_words
from wirelessagent.agent.turn_words import told
from wirelessagent.agent.words import say
from wirelessagent.explain.labels import called
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.model.problem import Problem


def refused(name: str, problem: Problem, language: str) -> str:
    """Why a method does not solve a problem; empty where it is not for its objective or its limits."""
    method, objective = plugins.load("method", name), problem.objective
    assert not isinstance(objective, str)
    if method.objectives is not None and objective.name not in method.objectives:
        return say(language, "refused_objective", name=name, goal=goal_words(objective.name, language))
    known = {*method.constraints, "max_power_w", "outage_probability"}
    surplus = [limit for limit in problem.constraints() if limit not in known]
    limits = say(language, "comma").join(say(language, f"limit_{limit}") for limit in surplus)
    return say(language, "refused_limits", name=name, limits=limits) if limits else ""


def able(problem: Problem, language: str) -> str:
    """The methods that solve a problem, in a sentence; empty where none does."""
    names = [name for name in plugins.names("method") if _solves(name, problem)]
    listed = say(language, "comma").join(called(language, name) for name in names)
    return told(language, "able", methods=listed) if names else ""


def _solves(name: str, problem: Problem) -> bool:
    try:
        chain.check_solvable(problem, name)
    except UnsupportedProblemError:
        return False
    return True
