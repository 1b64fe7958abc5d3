"""The intents that the offline recogniser hands back, with the reply in the operator's language."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from wirelessagent.language.intent import CONSTRAINTS, Constraint, Intent, IntentKind
from wirelessagent.language.replies import Voice


class Answer:
    """Intents of one recogniser in one operator's language."""

    def __init__(self, voice: Voice, language: str, recogniser: str) -> None:
        self.voice, self.language, self.recogniser = voice, language, recogniser

    def ask(
        self, key: str, confidence: float = 0.5, pending: Mapping[str, Constraint] | None = None,
        offered: str | None = None, **names: str,
    ) -> Intent:  # fmt: skip
        """A question back: ``pending`` was understood already, ``offered`` is what a plain yes means."""
        return self._intent(
            kind="clarify", confidence=confidence, reply=self.voice.say(key, **names), pending=pending or {},
            offered=offered, asks=key,
        )  # fmt: skip

    def tell(self, kind: IntentKind, key: str, confidence: float, **names: str) -> Intent:
        """A question, a command or something out of scope, with the sentence of a key."""
        return self._intent(kind=kind, confidence=confidence, reply=self.voice.say(key, **names))

    def allocate(
        self,
        objective: str,
        values: Mapping[str, Constraint],
        evidence: Mapping[str, str],
        reply: str,
        confidence: float,
    ) -> Intent:
        """A request: an objective with constraints, and the words that each came from."""
        ordered = {name: values[name] for name in CONSTRAINTS if name in values}
        kept = {name: words for name, words in evidence.items() if name not in CONSTRAINTS or name in ordered}
        return self._intent(
            kind="allocate", objective=objective, constraints=ordered, confidence=confidence, reply=reply, evidence=kept
        )

    def _intent(self, **fields: Any) -> Intent:
        blank: dict[str, Any] = {"objective": None, "constraints": {}, "evidence": {}}
        return Intent(language=self.language, recogniser=self.recogniser, **(blank | fields))
