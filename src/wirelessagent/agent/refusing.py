"""Why a method does not solve a problem, in the operator's language, and which ones do."""

from __future__ import annotations

from typing import Any

from wirelessagent import chain, plugins
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.model.problem import Problem
from wirelessagent.telling.catalogue import joined, listed, message
from wirelessagent.telling.parts import goal_words


class RefusedError(UnsupportedProblemError):
    """A method does not solve a problem; the message says why and what does, in the operator's language."""

    def __init__(self, refusal: UnsupportedProblemError, problem: Problem, method: str | None, language: str) -> None:
        self.why = refused(method or chain.default_method(problem), problem, language) or str(refusal)
        super().__init__(joined(language, [self.why, able(problem, language)]).strip())


def refused(name: str, problem: Problem, language: str) -> str:
    """Why a method does not solve a problem; empty where it is not for its objective or its limits."""
    method, objective = plugins.load("method", name), problem.objective
    assert not isinstance(objective, str)
    if method.objectives is not None and objective.name not in method.objectives:
        return message(language, "refused.objective", name=name, goal=goal_words(objective.name, language))
    stated: dict[str, Any] = {
        name: value for name, value in problem.constraints().items() if name != "outage_probability"
    }
    surplus = [limit for limit, value in stated.items() if not _solves(name, Problem(objective, **{limit: value}))]
    limits = message(language, "text.comma").join(message(language, f"limit.{limit}") for limit in surplus)
    return message(language, "refused.limits", name=name, limits=limits) if limits else ""


def able(problem: Problem, language: str) -> str:
    """The methods that solve a problem, in a sentence; empty where none does."""
    names = [name for name in plugins.names("method") if _solves(name, problem)]
    return message(language, "refused.able", methods=listed(language, names)) if names else ""


def _solves(name: str, problem: Problem) -> bool:
    try:
        chain.check_solvable(problem, name)
    except UnsupportedProblemError:
        return False
    return True
