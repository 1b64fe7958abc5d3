"""Why an LLM's answer is not used, in words for the operator."""

from __future__ import annotations

from collections.abc import Mapping

from wirelessagent.telling.catalogue import has_message, message

_KINDS = ("no_answer", "did_not_hold", "not_asked")


class Objection(Exception):
    """Why a meaning cannot be so: ``reason`` for the LLM, and the ``key`` of what the operator is told."""

    def __init__(self, key: str, reason: str) -> None:
        super().__init__(reason)
        self.key, self.reason = key, reason


def told(key: str, language: str, names: Mapping[str, float]) -> str:
    """A reason as one clause, such as "the LLM did not answer: HTTP 500"."""
    kind = next(kind for kind in _KINDS if has_message(language, f"llm.{kind}.{key}"))
    return message(language, f"llm.because_{kind}", reason=message(language, f"llm.{kind}.{key}", **names))


def note(clause: str, language: str) -> str:
    """The sentence that tells the operator who read theirs."""
    return message(language, "llm.note", clause=clause)
