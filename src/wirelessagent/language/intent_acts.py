"""The dialogue acts of an intent: what recognisers print and store as kind, topic and details, as typed acts."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, cast

from wirelessagent.language import acts
from wirelessagent.language.acts import Act, TurnReference
from wirelessagent.language.intent import EVERYBODY, Constraint, Detail, Intent

OWN_CHOICE = "auto"
"""The method for "the usual method"."""

Details = Mapping[str, Detail]


def acts_of(intent: Intent) -> tuple[Act, ...]:
    """What an intent does to a conversation; nothing where it asks back."""
    if intent.acts:
        return intent.acts
    if intent.kind == "allocate":
        return tuple(_changes(intent))
    if intent.kind in ("question", "command"):
        return (_TOPICS.get(intent.topic or "", _result)(intent.details),)
    return ()


def _changes(intent: Intent) -> Iterator[Act]:
    assert intent.objective is not None
    said = intent.evidence
    if not intent.amends:
        yield acts.Forget()
    yield acts.Aim(objective=intent.objective, words=said.get("objective", ""))
    for name in intent.dropped:
        yield acts.Drop(kind=name)
    yield from stated(intent.constraints, said)
    if "method" in intent.details:
        named = str(intent.details["method"])
        yield acts.Prefer(method="" if named == OWN_CHOICE else named)


def stated(constraints: Mapping[str, Constraint], words: Mapping[str, str] | None = None) -> Iterator[Act]:
    """The acts that state constraints, each with its words where they are known."""
    for name, value in constraints.items():
        said = (words or {}).get(name, "")
        if name == "users" and isinstance(value, tuple):
            yield acts.Serve(whom=acts.Named(value), alone=True, words=said)
        elif isinstance(value, tuple):
            yield acts.LeaveOut(whom=acts.Named(value), words=said)
        else:
            by_user = value if isinstance(value, Mapping) else {EVERYBODY: float(value)}
            for user in sorted(by_user, key=lambda user: user != EVERYBODY):  # whose figure takes those of others off
                whom = acts.Everybody() if user == EVERYBODY else acts.Named((user,))
                yield acts.Limit(kind=name, value=by_user[user], whom=whom, words=said)


def _supposed(details: Details) -> Act:
    """What a question would have be so."""
    share, aim = _figure(details, "missing_share"), details.get("objective")
    changes: tuple[Act, ...] = (acts.Aim(objective=aim),) if isinstance(aim, str) else ()
    changes += tuple(acts.Drop(kind=name) for name in str(details.get("dropped", "")).split())
    changes += tuple(stated(_constraints(details)))
    asked = details.get("asked")
    if details.get("of") == "channel":
        return acts.AskOtherChannel()
    if asked == "most":
        return acts.AskMost(acts=changes, user=_user(details))
    if asked == "power":
        judged = "needed" if details.get("judged") == "needed" else "enough"
        return acts.AskPower(acts=changes, enough_w=_figure(details, "enough_w"), judged=judged)
    return acts.Suppose(acts=changes, missing_share=share)


def _wondered(about: Callable[[Details], Act]) -> Callable[[Details], Act]:
    """A question that states limits asks what would be with them: "can user 4 get 3 Mbit/s?"."""

    def act(details: Details) -> Act:
        limits, rate, user = dict(_constraints(details)), _figure(details, "rate_bps"), _user(details)
        if rate is not None:
            limits["min_rate_bps"] = rate if user is None else {user: rate}
        return acts.Suppose(acts=tuple(stated(limits))) if limits else about(details)

    return act


def _step(details: Details) -> Act:
    users = _figure(details, "users")
    return acts.AskStep(
        power_w=_figure(details, "power_w"), rate_bps=_figure(details, "rate_bps"),
        rate_share=_figure(details, "rate_share"), users=None if users is None else int(users),
        each="each" in details, user=_user(details),
    )  # fmt: skip


def _users(details: Details) -> Act:
    place = _figure(details, "subcarrier")
    if details.get("asked") == "gain":
        return acts.AskGain(user=_user(details), subcarrier=None if place is None else int(place))
    if "rank" in details:
        named: dict[str, Any] = {"rank": details["rank"], "of": details.get("of", "rate")}
        return acts.AskRank(**named)
    if "listed" in details:
        return acts.AskDearest() if details["listed"] == "dearest" else acts.AskSubcarriers(user=_user(details))
    return acts.AskUsers(user=_user(details)) if place is None else acts.AskOwner(subcarrier=int(place))


def _result(details: Details) -> Act:
    """Of a result as a whole, and of what made it."""
    asked = details.get("asked")
    if details.get("listed") == "methods":
        return acts.AskMethods()
    if asked == "duration":
        return acts.AskDuration()
    return acts.AskLimits() if asked == "limits" else acts.AskResult()


def _compared(details: Details) -> Act:
    named = [_turn(details, name) for name in ("turn", "beside")]
    turns = tuple(turn for turn in named if turn is not None)
    if turns:
        return acts.CompareTurns(turns=turns)
    figures = [cast("Mapping[str, Constraint]", details[name]) for name in sorted(details) if name.startswith("either")]
    changes = [tuple(stated(each)) for each in figures]
    changes += [(acts.Aim(objective=aim),) for aim in str(details.get("aims", "")).split()]
    if changes:
        return acts.CompareRequests(changes=tuple(changes))
    said = " ".join(str(details.get(name, "")) for name in ("with", "methods", "repairers"))  # the latter of old turns
    names = tuple(name for name in re.split(r"[\s,，、;]+", said) if name not in ("", "last"))
    return acts.CompareTools(names=names) if names else acts.CompareLast()


def _yes(details: Details) -> Act:
    choice = _figure(details, "way")
    return acts.Yes(chooses="way" in details, choice=None if choice is None else int(choice))


def _undone(details: Details) -> Act:
    turn, steps = _turn(details, "turn"), details.get("steps", 1.0)
    if turn is not None:
        return acts.Undo(turn=turn)
    return acts.Undo(steps=int(steps) if isinstance(steps, float) else None)


_TOPICS: Mapping[str, Callable[[Details], Act]] = {
    "apply": lambda details: acts.Apply(),
    "confirm": _yes,
    "reject": lambda details: acts.No(cancels="cancel" in details, stops="stop" in details),
    "undo": _undone,
    "reset": lambda details: acts.Forget(),
    "compare": _compared,
    "explain": lambda details: acts.AskReasons(turn=_turn(details, "turn")),
    "history": lambda details: acts.AskHistory(turn=_turn(details, "turn" if "turn" in details else "number")),
    "status": lambda details: acts.AskStatus(),
    "help": lambda details: acts.AskHelp(),
    "export": lambda details: acts.Export(format=str(details.get("format", "ts28312"))),
    "why_user": _wondered(lambda details: acts.AskWhy(user=_user(details))),
    "why_infeasible": _wondered(lambda details: acts.AskWhyNot()),
    "certificate": _wondered(lambda details: acts.AskProof()),
    "uncertainty": _wondered(lambda details: acts.AskCertainty()),
    "what_if": _supposed,
    "step": _step,
    "prices": _wondered(lambda details: acts.AskPrices(user=_user(details))),
    "users": _wondered(_users),
    "capabilities": lambda details: acts.AskHelp(),
    "concept": lambda details: acts.AskMeaning(),
    "other": _wondered(_result),
}


def _constraints(details: Details) -> Mapping[str, Constraint]:
    return cast("Mapping[str, Constraint]", details.get("constraints") or {})


def _user(details: Details) -> str | None:
    user = details.get("user")
    return user if isinstance(user, str) else None


def _figure(details: Details, name: str) -> float | None:
    value = details.get(name)
    return float(value) if isinstance(value, int | float) else None


def _turn(details: Details, name: str) -> TurnReference | None:
    turn = details.get(name)
    if isinstance(turn, int | float):
        return int(turn) if turn == int(turn) else f"{turn:g}"
    return None if turn is None else str(turn)
