"""What the operator reads of what was understood: restatements with figures and units, and specific questions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from wirelessagent.language.intent import CONSTRAINTS, Constraint, Intent, IntentKind
from wirelessagent.language.restating import limits_in_words, users_in_words
from wirelessagent.telling.catalogue import has_message, message


class Voice:
    """Replies in one language, about the objectives that are on offer.

    Attributes:
        language: the operator's.
        labels: what each registered objective is called, in the order in which they are offered.
    """

    def __init__(self, language: str, labels: Mapping[str, str]) -> None:
        self.language, self.labels = language, labels

    def say(self, key: str, **places: str) -> str:
        """The reply of this key with its places filled in; {choices} and {offers} list what is on offer."""
        offers = message(self.language, "reply.offers", choices=self.choices("either"))
        given = {
            "choices": self.choices(),
            "offers": offers,
            "help": message(self.language, "reply.help", offers=offers),
        }
        return message(self.language, f"reply.{key}", **(given | places))

    def choices(self, last: str = "or", *, without: str = "") -> str:
        """The objectives on offer, "a, b or c"."""
        return self.both([name for name in self.labels if name != without], last)

    def label(self, objective: str) -> str:
        key = f"goal.{objective}"
        return message(self.language, key) if has_message(self.language, key) else self.labels.get(objective, objective)

    def both(self, objectives: Sequence[str], last: str = "and") -> str:
        return self._listed([self.label(name) for name in objectives], last)

    def constraints(self, values: Mapping[str, Constraint]) -> str:
        """The constraints with figures and units, "at least 1 Mbit/s for each user, at most 10 W …"."""
        return limits_in_words(values, self.language)

    def user(self, reference: str) -> str:
        """What to call a user: "user 3" for "3", "everyone else" for everybody who is not named."""
        return users_in_words((reference,), self.language)

    def users(self, references: Sequence[str]) -> str:
        """Several users in one list."""
        return users_in_words(references, self.language)

    def amended(self, values: Mapping[str, Constraint], dropped: Sequence[str]) -> str:
        """What changes in the current request, as one sentence; "" where no figure of it is known yet."""
        gone = [message(self.language, f"dropped.{name}") for name in dropped if name not in values]
        parts = [self.constraints(values)] if values else []
        if gone:
            parts.append(self.say("taken_off", text=self._listed(gone, "and")))
        said = message(self.language, "text.comma").join(parts)
        return message(self.language, "text.sentence", line=said[:1].upper() + said[1:]) if said else ""

    def changed(
        self, aims: Sequence[str], values: Mapping[str, Constraint], dropped: Sequence[str],
        lost: Mapping[str, Constraint],
    ) -> str:  # fmt: skip
        """What becomes of a request, as one sentence: another aim, limits, and those that hold no longer."""
        gone = message(self.language, "request.no_longer", limits=self.constraints(lost)) if lost else ""
        parts = [*aims, self.amended(values, dropped), gone]
        said = [f"{part[:1].lower()}{part[1:]}".rstrip(" .。") for part in parts if part]
        return message(self.language, "text.sentence", line=message(self.language, "text.comma").join(said))

    def restated(self, objective: str, values: Mapping[str, Constraint], not_used: Sequence[str]) -> str:
        """What was understood, as one sentence."""
        label, limits = self.label(objective), self.constraints(values)
        key = "request.understood" if limits else "request.aim_alone"
        sentence = message(self.language, key, goal=label[:1].upper() + label[1:], limits=limits)
        return sentence + (self.say("not_used", text=self._listed(list(not_used), "and")) if not_used else "")

    def _listed(self, items: Sequence[str], last: str) -> str:
        if len(items) < 2:
            return "".join(items)
        comma = message(self.language, "text.comma")
        return comma.join(items[:-1]) + message(self.language, f"text.{last}") + items[-1]


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
