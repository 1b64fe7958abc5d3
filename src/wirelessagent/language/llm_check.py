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
from wirelessagent.language.llm_meaning import Meaning, Reference, Stated
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.recogniser import Context
from wirelessagent.language.text import normalise
from wirelessagent.model.errors import InputError

ACTING = ("apply", "confirm")
"""Commands that only the operator's plain words may give."""

_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


class Objection(Exception):
    """Why a meaning cannot be so: ``reason`` for the LLM, and the ``key`` of what the operator is told."""

    def __init__(self, key: str, reason: str) -> None:
        super().__init__(reason)
        self.key, self.reason = key, reason


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

    def __init__(self, text: str, context: Context, offline: Intent) -> None:
        self.text, self.context, self.offline = text, context, offline
        self.figures: tuple[Figure, ...] = figures_of(text, context, offline)
        counted = {f"{figure.value:g}" for figure in self.figures if figure.label.startswith("N")}
        self._spoken = counted | set(re.findall(r"[0-9]+", normalise(text)))
        rules = {**offline.pending, **offline.constraints, **context.pending, **context.constraints}
        self._known_users: set[str] = set()
        for value in rules.values():
            self._known_users.update(value if isinstance(value, tuple) else _by_user(value))
        self._known_users.add(str(offline.details.get("user", EVERYBODY)))

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
        lost = [name for name in meaning.drops if name not in self.context.constraints]
        if lost or (meaning.drops and not meaning.amends):
            raise Objection("no_request", f"drops: the current request to amend has no {lost}")
        words = self._quoted(meaning, objective)
        constraints, evidence = self._constraints(meaning)
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
        figure = matching(self.figures, given, kind)
        if figure is None:
            labels = ", ".join(figure.label for figure in self.figures if figure.kind == kind)
            raise Objection(
                "invented",
                f"{name}: {str(given)[:40]!r} is no {kind} of this sentence or conversation; there are "
                f"{labels or 'none: use clarify if one is needed'}",
            )
        return figure

    @staticmethod
    def _value(name: str, figure: Figure) -> float:
        """A figure's value; more than half is a reliability, of which the outage is what it leaves."""
        reliable = name == "outage_probability" and 0.5 <= figure.value < 1
        return round(1 - figure.value, 12) if reliable else figure.value

    def _users(self, said: Sequence[str]) -> list[str]:
        """Users by what the operator calls them."""
        return list(dict.fromkeys(self._user(name) for name in said))

    def _user(self, said: str) -> str:
        """A user as the operator calls them: by number, or by a name that stands in the sentence."""
        name = said.strip()
        match = re.fullmatch(r"[^0-9]*([0-9]{1,9})[^0-9]*", name)
        number = None if match is None else str(int(match[1]))
        if number is not None and (number in self._spoken or number in self._known_users):
            return number
        if name and (name in self._known_users or normalise(name).casefold() in normalise(self.text).casefold()):
            return name
        raise Objection("no_user", f"the sentence names no user {name[:40]!r}")

    @staticmethod
    def _uncrossed(constraints: Mapping[str, Constraint]) -> None:
        low, high = (_by_user(constraints.get(name, {})) for name in ("min_rate_bps", "max_rate_bps"))
        for user in {*low, *high}:
            least, most = low.get(user, low.get(EVERYBODY, 0.0)), high.get(user, high.get(EVERYBODY, math.inf))
            if least > most:
                raise Objection("crossed", f"at least {least:g} and at most {most:g} bit/s")

    def _nothing_lost(self, meaning: Meaning) -> None:
        """Every figure of the sentence is used or set aside, and none that raises a question is passed over."""
        used = {
            figure.parent
            for stated in meaning.constraints
            if (figure := matching(self.figures, stated.figure, KINDS[stated.constraint])) is not None
        }
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
            if figure.label not in meaning.set_aside:
                raise Objection("left_out", f"{figure.label} ({figure.words!r}) is neither used nor in set_aside")
            if figure.kind == "unusable" and self.offline.kind != "allocate":
                raise Objection(
                    "passed_over",
                    f"{figure.label} ({figure.words!r}) cannot be used as it stands: use clarify",
                )

    def _agrees(self, constraints: Mapping[str, Constraint]) -> None:
        """The rules read the same figures, wherever they read any."""
        rules = {**self.offline.pending, **self.offline.constraints}
        for name, value in rules.items():
            if name not in constraints or not _same(constraints[name], value):
                words = self.offline.evidence.get(name, "") or "the sentence"
                raise Objection(
                    "otherwise",
                    f"{words!r} says {name} = {_told(value)}; say so too, or use clarify",
                )
        if self.offline.kind in ("question", "command", "out_of_scope"):
            return  # the rules saw no request, so they read no figures
        session = [figure for figure in self.figures if figure.label.startswith("S")]
        for name, value in constraints.items():
            kind = KINDS.get(name)
            exact = name == "max_rate_bps" and _same(value, rules.get("min_rate_bps", ()))
            if name in rules or exact or kind is None or kind == "number":
                continue
            told = [matching(session, each, kind) for each in _by_user(value).values()]
            if None in told:
                raise Objection(
                    "doubtful",
                    f"the sentence is not plain about {name} = {_told(value)}: use clarify",
                )

    def _question_back(self, meaning: Meaning) -> Read:
        question = _CONTROL.sub(" ", meaning.question).strip()
        if not question:
            raise Objection("asked_nothing", "kind clarify needs a question to the operator")
        said = [q for q in parse_quantities(question) if q.kind in ("power", "rate")]
        known = [figure.value for figure in self.figures if figure.kind in ("power", "rate")]
        if any(not any(math.isclose(q.value, value, rel_tol=1e-3) for value in known) for q in said):
            raise Objection("invented", "the question may only name listed figures")
        return Read(kind="clarify", question=question, language=meaning.language)

    def _about(self, meaning: Meaning) -> Read:
        """A question or a command."""
        known = COMMANDS if meaning.kind == "command" else QUESTIONS
        if meaning.topic is not None and meaning.topic not in known:
            raise Objection("mixed", f"topics of a {meaning.kind} are {', '.join(known)}")
        plainly = (self.offline.kind, self.offline.topic) == ("command", meaning.topic)
        awaited = meaning.topic != "confirm" or self.context.awaits == "confirmation"
        if meaning.topic in ACTING and not (plainly and awaited):
            raise Objection("go_ahead", f"the operator did not plainly say {meaning.topic}: use clarify")
        details = {**self._details(meaning), **self._supposed(meaning)}
        return Read(kind=meaning.kind, topic=meaning.topic, details=details, language=meaning.language)

    def _details(self, meaning: Meaning) -> dict[str, Detail]:
        given = meaning.details
        details: dict[str, Detail] = {}
        if given.user is not None:
            details["user"] = self._user(given.user)
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


def _by_user(value: Constraint) -> Mapping[str, float]:
    if isinstance(value, Mapping):
        return value
    return {} if isinstance(value, tuple) else {EVERYBODY: value}


def _same(one: Constraint, other: Constraint) -> bool:
    if isinstance(one, tuple) or isinstance(other, tuple):
        return isinstance(one, tuple) and isinstance(other, tuple) and set(one) == set(other)
    a, b = _by_user(one), _by_user(other)
    return set(a) == set(b) and all(math.isclose(a[user], b[user], rel_tol=1e-6) for user in a)


def _told(value: Constraint) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{user}: {each:g}" for user, each in value.items())
    return ", ".join(value) if isinstance(value, tuple) else f"{value:g}"
