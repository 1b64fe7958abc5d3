"""From a request in the operator's terms to a problem on a channel: users by name, figures as arrays, limits kept.

And why a method does not solve a problem, in the operator's language, and which ones do.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from wirelessagent import chain, plugins
from wirelessagent.language.acts import renamed
from wirelessagent.language.conversation.anchors import Anchored
from wirelessagent.language.conversation.line import Line, is_all
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, LISTS_OF_USERS, Constraint, Intent
from wirelessagent.language.recogniser import Context, Missing
from wirelessagent.language.request import ASSUMED_MIN_RATE_BPS, Diff, Request
from wirelessagent.language.text import normalise
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError, UnclearRequestError, UnsupportedProblemError
from wirelessagent.model.problem import Problem
from wirelessagent.model.units import human, reliability
from wirelessagent.telling.catalogue import Said, Voice, called, joined, listed, message
from wirelessagent.telling.parts import goal_words

ASSUMED_OUTAGE_PROBABILITY = 0.05
"""Accepted where rates are promised and nobody named a probability: promised as estimated, half of them would fail."""

ABOVE_THE_LIMIT = "assumed.above_the_limit"
"""The key of the note that a limit was asked for beyond the cell's own."""

_UNNAMED: Mapping[str, float] = {"min_rate_bps": 0.0, "max_rate_bps": np.inf, "weights": 1.0}
"""What holds for users who are not named in figures by user."""

_NAMES_SHOWN = 12

_LONGEST_NAME = 100
"""Characters of a line that may answer whom it meant."""


@dataclass(frozen=True, kw_only=True)
class Posed:
    """A problem, the cell it is stated for, and what was assumed."""

    problem: Problem
    cell: Cell
    notes: tuple[Said, ...]


class UnknownUserError(UnclearRequestError):
    """Somebody is meant who is not there, or not named at all (""); the message is the question to the operator."""

    def __init__(self, reference: str, user_names: tuple[str, ...], language: str) -> None:
        more = len(user_names) - _NAMES_SHOWN
        names = message(language, "text.comma").join(called(language, name) for name in user_names[:_NAMES_SHOWN])
        known = message(language, "ask_back.names_and_more", names=names, more=more) if more > 0 else names
        user = f"user {reference}" if reference.isdigit() else reference
        super().__init__(
            message(language, "ask_back.unknown_user" if reference else "ask_back.which_user", user=user, known=known)
        )
        self.reference = reference


def pose(request: Request, cell: Cell, user_names: tuple[str, ...], language: str = "en") -> Posed:
    """The problem that a request states on a channel of these users.

    Raises:
        UnclearRequestError: it names a user who is not there, or what cannot hold together; the message is the
            question to the operator, in ``language``.
    """
    return _Posing(request, cell, user_names, language).posed()


class _Posing(Voice):
    """One request on its way to a problem."""

    def __init__(self, request: Request, cell: Cell, user_names: tuple[str, ...], language: str) -> None:
        self._cell, self._names, self.language = cell, user_names, language
        self._given: dict[str, Constraint] = dict(request.constraints)
        self._objective = plugins.objective(request.objective)
        self._notes: dict[Said, None] = {}

    def posed(self) -> Posed:
        circuit_power_w = self._given.pop("circuit_power_w", None)
        if circuit_power_w is not None:
            self._cell = dataclasses.replace(self._cell, circuit_power_w=cast(float, circuit_power_w))
        self._assume()
        some = bool(self._given.keys() & {*LISTS_OF_USERS})
        served = self._served()
        fields: dict[str, Any] = {"users": tuple(self._names[user] for user in served) if some else None}
        self._note_promised(served)
        for name, value in self._given.items():
            fields[name] = self._by_user(name, value) if name in FIGURES_OF_USERS else value
        self._check_order(fields, served)
        size = fields.get("resource_block_group_size", 1)
        if size != int(size):
            raise self._unclear("whole_groups", size=f"{size:g}")
        fields["resource_block_group_size"] = int(size)
        if "weights" in fields and not np.broadcast_to(fields["weights"], len(self._names))[list(served)].any():
            raise self._unclear("no_weight")
        try:
            problem = Problem(self._objective, **fields).for_users(self._names)
            problem.weights_of(len(self._names))
        except InputError as error:
            raise self._unclear("impossible", why=error) from error
        return Posed(problem=problem, cell=self._cell, notes=tuple(self._notes))

    def _note(self, key: str, **names: object) -> None:
        self._notes[self.say(key, **names)] = None

    def _unclear(self, key: str, **places: object) -> UnclearRequestError:
        return UnclearRequestError(self.say(f"ask_back.{key}", **places))

    def _assume(self) -> None:
        """Keep the cell's limit, and fill in what is assumed where nobody named it."""
        given, limit = self._given, self._cell.max_power_w
        asked = cast("float | None", given.get("max_power_w"))
        if asked is not None and asked > limit:
            given["max_power_w"] = limit
            self._note(ABOVE_THE_LIMIT, asked=human(asked, "W"), limit=human(limit, "W"))
        if self._objective.measure == "power" and "min_rate_bps" not in given:
            given["min_rate_bps"] = ASSUMED_MIN_RATE_BPS
            self._note("assumed.rate", rate=human(ASSUMED_MIN_RATE_BPS, "bit/s"))
        if self._objective.measure == "power" and given.pop("weights", None) is not None:
            self._note("assumed.weights_mean_nothing")
        if "min_rate_bps" in given and "outage_probability" not in given:
            given["outage_probability"] = ASSUMED_OUTAGE_PROBABILITY
            self._note("assumed.outage", sure=reliability(ASSUMED_OUTAGE_PROBABILITY))

    def _served(self) -> tuple[int, ...]:
        """The users to serve, as indices."""
        wanted, unwanted = (cast("tuple[str, ...] | None", self._given.pop(name, None)) for name in LISTS_OF_USERS)
        numbers = {*range(len(self._names))} if wanted is None else {self._number(user) for user in wanted}
        numbers -= {self._number(user) for user in unwanted or ()}
        if not numbers:
            raise self._unclear("nobody_left")
        return tuple(sorted(numbers))

    def _number(self, reference: str) -> int:
        number, by_place = user_number(reference, self._names, self.language)
        if by_place:
            self._note("assumed.user_by_place", number=reference, name=self._names[number])
        return number

    def _by_user(self, name: str, value: Constraint) -> float | FloatArray:
        if not isinstance(value, Mapping):
            return cast(float, value)
        figures = np.full(len(self._names), value.get(EVERYBODY, _UNNAMED[name]))
        for reference, figure in value.items():
            if reference != EVERYBODY:
                figures[self._number(reference)] = figure
        return figures

    def _check_order(self, fields: Mapping[str, Any], served: tuple[int, ...]) -> None:
        """Refuse rates of which the least is above the most, for a user who is served."""
        least = np.broadcast_to(fields.get("min_rate_bps", 0.0), len(self._names))
        most = np.broadcast_to(fields.get("max_rate_bps", np.inf), len(self._names))
        for user in served:
            if least[user] > most[user]:
                low, high = (human(float(rate[user]), "bit/s") for rate in (least, most))
                raise self._unclear("rates_crossed", user=self._names[user], low=low, high=high)

    def _note_promised(self, served: tuple[int, ...]) -> None:
        """Say which rates, promised by name to somebody who is not served, rest."""
        promised = self._given.get("min_rate_bps")
        if len(served) == len(self._names) or not isinstance(promised, Mapping):
            return
        for reference, rate in promised.items():
            if rate > 0 and reference != EVERYBODY and self._number(reference) not in served:
                user = called(self.language, self._names[self._number(reference)])
                self._note("assumed.promise_rests", user=user, rate=human(rate, "bit/s"))


def check_promised(request: Request, diff: Diff, user_names: tuple[str, ...], language: str) -> None:
    """Refuse a rate that a line promises by name to somebody who is left out.

    Raises:
        UnclearRequestError: the question which of the two should hold.
    """
    out = {
        user_number(user, user_names, language)[0]
        for user in cast("tuple[str, ...]", request.constraints.get("leave_out", ()))
    }
    for one in diff.changes if out else ():
        if one.kind == "min_rate_bps" and one.user != EVERYBODY and one.after:
            number, _ = user_number(one.user, user_names, language)
            if number in out:
                user, rate = called(language, user_names[number]), human(one.after, "bit/s")
                raise UnclearRequestError(message(language, "ask_back.promised_and_left_out", user=user, rate=rate))


def user_number(reference: str, user_names: tuple[str, ...], language: str) -> tuple[int, bool]:
    """Who is meant, from 0, and whether it had to be taken as a place in the list.

    "3" is the user named "user 3", else the one named "3", else the third one.

    Raises:
        UnknownUserError: nobody can be meant.
    """
    said = " ".join(reference.split()).casefold()
    names = [name.casefold() for name in user_names]
    for name in (f"user {said}", said):
        if name in names:
            return names.index(name), False
    figure = re.fullmatch(r"(?:user\s*)?0*(\d{1,9})", said)
    if figure is not None and f"user {figure[1]}" in names:
        return names.index(f"user {figure[1]}"), False
    if figure is None or not 1 <= int(figure[1]) <= len(names):
        raise UnknownUserError(reference, user_names, language)
    return int(figure[1]) - 1, True


def completed(missing: Missing, said: str, context: Context) -> Intent | None:
    """An intent with the user whom a line names in the place of the one who is not there; None where it names none.

    The one who is there is called so from now on.
    """
    if len(said) > _LONGEST_NAME:
        return None
    named, match = _named_alone(said, context), is_all("whom", normalise(said).lower().strip(" .!。"))
    try:
        meant = named[0] if len(named) == 1 else next(filter(None, match.groups()), "") if match else ""
        number, _ = user_number(meant, context.user_names, context.language or "en")
    except UnknownUserError:
        return None
    intent, reference, name = missing.intent, missing.reference, context.user_names[number]
    details, constraints, pending = (
        {key: renamed(value, reference, name) for key, value in values.items()}
        for values in (intent.details, intent.constraints, intent.pending)
    )
    if not reference:
        details["user"] = name
    elif not any(map(str.isdigit, reference)):
        details["called"] = {reference.lower(): (str(number + 1),)}
    acts = renamed(intent.acts, reference, name)
    return dataclasses.replace(intent, details=details, constraints=constraints, pending=pending, acts=acts)


def _named_alone(said: str, context: Context) -> tuple[str, ...]:
    """The users whom a line names, where it asks for nothing else: "excuse me, I meant user 2"."""
    line = Line.of(said, context)
    anchored = Anchored.of(said, line.voice.language, context.user_names)
    alone = not line.sentence.reading.values and {anchor.kind for anchor in anchored.anchors} <= {"users", "number"}
    return anchored.named(len(context.user_names)) if alone else ()


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
