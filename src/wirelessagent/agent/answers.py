"""Questions about a decision, answered by what :mod:`wirelessagent.explain` computes."""

from __future__ import annotations

from wirelessagent.agent.turn import Run
from wirelessagent.explain.table import Table
from wirelessagent.explain.tables import user_table
from wirelessagent.explain.words import explain
from wirelessagent.language.intent import Intent


def explanation(run: Run, language: str) -> str:
    """Why the decision is what it is."""
    return "\n".join(explain(run.estimate, run.report, language=language))


def concept(text: str, language: str) -> str:
    """What the terms in a question mean; empty where none is known."""
    del text, language
    return ""


def answer(run: Run, intent: Intent, user_names: tuple[str, ...]) -> tuple[str, tuple[Table, ...]]:
    """The answer to a question about a decision, and its tables."""
    del user_names
    tables = (user_table(run.report, run.estimate, intent.language),) if intent.topic == "users" else ()
    return explanation(run, intent.language), tables
