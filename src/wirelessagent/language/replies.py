"""What the operator reads of what was understood: restatements with figures and units, and specific questions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from wirelessagent.language.intent import Constraint
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
