"""Whether what an LLM says of a sentence can be so: the same for every LLM, and independent of what it was told.

The rules read the sentence as well. Where they read a figure, the LLM must read the same; where they are in doubt about
one, the operator is asked; and nobody but the operator, in plain words, applies an allocation.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from wirelessagent.language.intent import (
    COMMANDS,
    EVERYBODY,
    FIGURES_OF_USERS,
    LISTS_OF_USERS,
    QUESTIONS,
    Constraint,
    Detail,
    Intent,
    checked_constraints,
)
from wirelessagent.language.llm_figures import DETAIL_KINDS, KINDS, Figure, FigureKind, figures_of, matching
from wirelessagent.language.llm_held import Held, by_user, same
from wirelessagent.language.llm_meaning import Meaning, Reference, Stated
from wirelessagent.language.llm_questions import question_back
from wirelessagent.language.llm_reasons import Objection
from wirelessagent.language.llm_wishes import Wishes
from wirelessagent.language.recogniser import Context
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.text import normalise
from wirelessagent.language.vocabulary import OwnWords
from wirelessagent.model.errors import InputError

ACTING = ("apply", "confirm")
"""Commands that only the operator's plain words may give."""

CHANGING = ("undo", "reset")
"""Commands that change the cell, and that the sentence must hold a word for."""


@dataclass(frozen=True, kw_only=True)
class Read:
    """A meaning that holds, in the terms of an intent."""

    kind: str
    objective: str | None = None
    constraints: Mapping[str, Constraint] = field(default_factory=dict[str, Constraint])
    evidence: Mapping[str, str] = field(default_factory=dict[str, str])
    dropped: tuple[str, ...] = ()
    amends: bool = False
    topic: str | None = None
    details: Mapping[str, Detail] = field(default_factory=dict[str, Detail])
    question: str = ""
    language: str = "en"


class Case:
    """One sentence in its conversation, as the rules read it, beside which an LLM's meaning is held."""

    def __init__(self, text: str, context: Context, offline: Intent, own: Sequence[OwnWords] | None = None) -> None:
        self.text, self.context, self.offline = text, context, offline
        self.figures: tuple[Figure, ...] = figures_of(text, context, offline)
        registered = own_words()
        sentence = Sentence(text, registered, names=context.user_names, max_power_w=context.max_power_w)
        self._held = Held(sentence, context, offline)
        self._wishes = Wishes(sentence, offline, registered if own is None else own)

    def read(self, meaning: Meaning) -> Read:
        """The meaning in the terms of an intent.

        Raises:
            Objection: it cannot be what the sentence says.
        """
        if meaning.kind == "allocate":
            return self._allocation(meaning)
        if meaning.kind == "clarify":
            return self._question_back(meaning)
        if meaning.kind == "out_of_scope":
            return Read(kind="out_of_scope", language=meaning.language)
        return self._about(meaning)

    def _allocation(self, meaning: Meaning) -> Read:
        objective = meaning.objective or (self.context.objective if meaning.amends else None)
        if objective is None:
            raise Objection("no_objective", "kind allocate needs an objective; use clarify if it is not clear")
        if meaning.topic is not None:
            raise Objection("mixed", "kind allocate has no topic")
        if meaning.amends and self.context.objective is None:
            raise Objection("no_request", "there is no current request to amend")
        self._held.amends(meaning.amends)
        lost = [name for name in meaning.drops if name not in self.context.constraints]
        if lost or (meaning.drops and not meaning.amends):
            raise Objection("no_request", f"drops: the current request to amend has no {lost}")
        self._held.drops(meaning.drops)
        words = self._quoted(meaning, objective)
        constraints, evidence = self._constraints(meaning)
        new = any(not self._held.holds(name, value) for name, value in constraints.items())
        changes = not words and objective == self.context.objective and bool(new or meaning.drops)
        self._wishes.request(objective, words, changes=changes)
        self._nothing_lost(meaning)
        self._agrees(constraints)
        return Read(
            kind="allocate", objective=objective, constraints=constraints, dropped=tuple(meaning.drops),
            evidence=({"objective": words} if words else {}) | evidence, amends=meaning.amends,
            language=meaning.language,
        )  # fmt: skip

    def _quoted(self, meaning: Meaning, objective: str) -> str:
        """The operator's words for the objective, as they stand in the sentence."""
        if not meaning.objective_words.strip():
            known = (self.context.objective if meaning.amends else None, self.offline.objective)
            if objective in known:
                return ""
            raise Objection("not_quoted", "copy the operator's words into objective_words")
        place = _place(self.text, meaning.objective_words)
        if place is None:
            raise Objection(
                "misquoted",
                "objective_words must be copied from the sentence exactly, in one piece",
            )
        return self.text[slice(*place)]

    def _constraints(self, meaning: Meaning) -> tuple[Mapping[str, Constraint], dict[str, str]]:
        """The constraints and the words that each came from."""
        by_user: dict[str, dict[str, float]] = {}
        evidence: dict[str, list[str]] = {}
        for stated in meaning.constraints:
            figure = self._figure(stated)
            values = by_user.setdefault(stated.constraint, {})
            for user in self._users(stated.users) or [EVERYBODY]:
                if user in values:
                    raise Objection("twice", f"{stated.constraint} is given twice for {user!r}")
                values[user] = self._value(stated.constraint, figure)
            evidence.setdefault(stated.constraint, []).append(figure.words)
        found: dict[str, Constraint] = {}
        for name, values in by_user.items():
            alone = set(values) == {EVERYBODY}
            if not alone and name not in FIGURES_OF_USERS:
                raise Objection("cells_own", f"{name} cannot differ from user to user")
            found[name] = values[EVERYBODY] if alone else values
        for name in LISTS_OF_USERS:
            users = self._users(getattr(meaning, name))
            if users:
                found[name] = tuple(users)
                evidence[name] = [self.offline.evidence.get(name) or ", ".join(users)]
        try:
            checked = checked_constraints(found)
        except InputError as error:
            raise Objection("impossible", str(error)) from error
        self._uncrossed(checked)
        return checked, {name: " … ".join(dict.fromkeys(words)) for name, words in evidence.items()}

    def _figure(self, stated: Stated) -> Figure:
        figure = self._known(stated.figure, stated.constraint, KINDS[stated.constraint])
        floor = stated.constraint == "min_rate_bps"
        against = "at_most" if floor else "at_least"
        if figure.comparator == against and KINDS[stated.constraint] in ("power", "rate"):
            raise Objection(
                "turned",
                f"the sentence bounds {figure.words!r} as {against}, unlike {stated.constraint}",
            )
        return figure

    def _known(self, given: Reference, name: str, kind: FigureKind) -> Figure:
        """The figure of this kind that is referred to for a constraint or a detail."""
        figure = matching(self.figures, given, kind, name if name in KINDS else "")
        if figure is None:
            labels = ", ".join(figure.label for figure in self.figures if figure.kind == kind)
            raise Objection(
                "invented",
                f"{name}: {str(given)[:40]!r} is no {kind} of this sentence or conversation; there are "
                f"{labels or 'none: use clarify if one is needed'}",
            )
        return figure

    def _meant(self, stated: Stated) -> Figure | None:
        return matching(self.figures, stated.figure, KINDS[stated.constraint], stated.constraint)

    @staticmethod
    def _value(name: str, figure: Figure) -> float:
        """A figure's value; more than half is a reliability, of which the outage is what it leaves."""
        reliable = name == "outage_probability" and 0.5 <= figure.value < 1
        return round(1 - figure.value, 12) if reliable else figure.value

    def _users(self, said: Sequence[str]) -> list[str]:
        """Users by what the operator calls them."""
        return list(dict.fromkeys(map(self._held.user, said)))

    @staticmethod
    def _uncrossed(constraints: Mapping[str, Constraint]) -> None:
        low, high = (by_user(constraints.get(name, {})) for name in ("min_rate_bps", "max_rate_bps"))
        for user in {*low, *high}:
            least, most = low.get(user, low.get(EVERYBODY, 0.0)), high.get(user, high.get(EVERYBODY, math.inf))
            if least > most:
                raise Objection("crossed", f"at least {least:g} and at most {most:g} bit/s")

    def _nothing_lost(self, meaning: Meaning) -> None:
        """Every figure of the sentence is used or set aside, and none that raises a question is passed over."""
        aside = {label.strip().casefold() for label in meaning.set_aside}
        used = {figure.parent for stated in meaning.constraints if (figure := self._meant(stated)) is not None}
        named = {
            user
            for users in (meaning.users, meaning.leave_out, *(s.users for s in meaning.constraints))
            for user in users
        }
        for figure in self.figures:
            if not figure.quantity or figure.label in used:
                continue
            if figure.kind == "unusable" and f"{figure.value:g}" in named:
                continue  # "users 1, 2 and 4": a number that names
            if figure.label.casefold() not in aside:
                raise Objection("left_out", f"{figure.label} ({figure.words!r}) is neither used nor in set_aside")
            if figure.kind == "unusable" and self.offline.kind != "allocate":
                raise Objection(
                    "passed_over",
                    f"{figure.label} ({figure.words!r}) cannot be used as it stands: use clarify",
                )

    def _agrees(self, constraints: Mapping[str, Constraint]) -> None:
        """The rules read the same, wherever they read anything; what they did not read is as the session holds it."""
        rules = self._held.rules
        for name, value in rules.items():
            if name not in constraints or not same(constraints[name], value):
                words = self.offline.evidence.get(name, "") or "the sentence"
                raise Objection(
                    "otherwise",
                    f"{words!r} says {name} = {_told(value)}; say so too, or use clarify",
                )
        for name, value in constraints.items():
            exact = name == "max_rate_bps" and same(value, rules.get("min_rate_bps", ()))
            if name in rules or exact or name == "weights" or self._held.holds(name, value):
                continue
            raise Objection(
                "doubtful",
                f"the sentence is not plain about {name} = {_told(value)}: use clarify",
            )

    def _question_back(self, meaning: Meaning) -> Read:
        known = [figure.value for figure in self.figures if figure.kind in ("power", "rate")]
        return Read(kind="clarify", question=question_back(meaning.question, known), language=meaning.language)

    def _about(self, meaning: Meaning) -> Read:
        """A question or a command."""
        known = COMMANDS if meaning.kind == "command" else QUESTIONS
        if meaning.topic is not None and meaning.topic not in known:
            raise Objection("mixed", f"topics of a {meaning.kind} are {', '.join(known)}")
        plainly = (self.offline.kind, self.offline.topic) == ("command", meaning.topic)
        awaited = meaning.topic != "confirm" or self.context.awaits == "confirmation"
        if meaning.topic in ACTING and not (plainly and awaited):
            raise Objection("go_ahead", f"the operator did not plainly say {meaning.topic}: use clarify")
        if meaning.kind == "command" and meaning.topic in CHANGING:
            self._wishes.command(meaning.topic)
        details = {**self._details(meaning), **self._supposed(meaning)}
        return Read(kind=meaning.kind, topic=meaning.topic, details=details, language=meaning.language)

    def _details(self, meaning: Meaning) -> dict[str, Detail]:
        given = meaning.details
        details: dict[str, Detail] = {}
        if given.user is not None:
            details["user"] = self._held.user(given.user)
        if given.compared_with is not None:
            details["with"] = given.compared_with
        if given.format is not None:
            details["format"] = given.format
        for name, kind in DETAIL_KINDS.items():
            reference = getattr(given, name)
            if reference is not None:
                details[name] = self._known(reference, name, kind).value
        return details

    def _supposed(self, meaning: Meaning) -> dict[str, Detail]:
        """What a what-if question supposes."""
        if meaning.topic != "what_if":
            return {}
        constraints, _ = self._constraints(meaning)
        supposed: dict[str, Detail] = {"constraints": constraints} if constraints else {}
        return supposed | ({"objective": meaning.objective} if meaning.objective else {})


def _place(text: str, quote: str) -> tuple[int, int] | None:
    """Where a quotation stands in a text; capitals and runs of spaces may differ."""
    words = [re.escape(word) for word in normalise(quote).split()]
    match = re.search(r"\s+".join(words), normalise(text), re.IGNORECASE) if words else None
    return None if match is None else match.span()


def _told(value: Constraint) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{user}: {each:g}" for user, each in value.items())
    return ", ".join(value) if isinstance(value, tuple) else f"{value:g}"
