"""What a sentence means within a conversation: users who come back, and wishes that keep the limits."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, Constraint
from wirelessagent.language.stated import Reading
from wirelessagent.language.word_tables import either

if TYPE_CHECKING:
    from wirelessagent.language.recogniser import Context

_SAME = deferred(
    rf"(?i)^\s*(?:and|now|but|then|plus|ok,?\s+now|what\s+about|how\s+about)\b|{either('figures', 'kept', 'limits')}"
)


def with_users_back(reading: Reading, context: Context) -> tuple[dict[str, Constraint], tuple[str, ...]]:
    """What a sentence that takes users in again changes: constraints to state, and those to drop before."""
    values, dropped = taken_in(reading.back, context)
    return {**reading.values, **values}, dropped


def taken_in(users: tuple[str, ...], context: Context) -> tuple[dict[str, Constraint], tuple[str, ...]]:
    """What serving these users too changes: constraints to state, and those to drop before; nothing where they are."""
    wanted = numbers_of(users, context.user_names)
    left_out, served = context.constraints.get("leave_out"), context.constraints.get("users")
    values, dropped = dict[str, Constraint](), list[str]()
    if isinstance(left_out, tuple) and wanted & numbers_of(left_out, context.user_names):
        remaining = tuple(user for user in left_out if not wanted & numbers_of((user,), context.user_names))
        dropped.append("leave_out")
        values |= {"leave_out": remaining} if remaining else {}
    if isinstance(served, tuple) and not wanted <= numbers_of(served, context.user_names):
        values["users"] = tuple(dict.fromkeys((*served, *users)))
    return values, tuple(dropped)


def users_in(constraints: Mapping[str, Constraint]) -> list[str]:
    """Everybody whom constraints name, each once, in their order; "all" is nobody's name.

    >>> users_in({"max_power_w": 5.0, "min_rate_bps": {"all": 1e5, "3": 1e6}, "users": ("3", "5")})
    ['3', '5']
    """
    named = (value for value in constraints.values() if isinstance(value, Mapping | tuple))
    return list(dict.fromkeys(user for users in named for user in users if user != EVERYBODY))


def numbers_of(users: Iterable[str], user_names: Sequence[str]) -> set[int | str]:
    """Which users are meant, from 1, so that "2" and "user 2" are the same; a name that nobody has stays itself.

    >>> numbers_of(("2", "Ada"), ("user 1", "user 2", "Ada"))
    {2, 3}
    """
    places: dict[str, int] = {}
    for place, name in enumerate(user_names, start=1):
        places[name.casefold()] = place
        places[name.casefold().removeprefix("user ")] = place
    for place in range(1, len(user_names) + 1):
        places.setdefault(str(place), place)
    return {places.get(user.casefold(), user.casefold()) for user in users}


def keeps_the_limits(plain: str) -> bool:
    """Whether a sentence with a wish changes the request at hand rather than replacing it."""
    return _SAME.search(plain) is not None


def merged(earlier: Mapping[str, Constraint], later: Mapping[str, Constraint]) -> dict[str, Constraint]:
    """Constraints read before, with those of a later line, such as the answer to a question."""
    return {**earlier, **{name: joined(name, earlier.get(name), value) for name, value in later.items()}}


def joined(name: str, held: Constraint | None, stated: Constraint) -> Constraint:
    """One constraint after another statement of it.

    Figures of named users join those that hold; a figure for everybody replaces them all. Users to leave out add up.
    """
    if name == "leave_out" and isinstance(held, tuple) and isinstance(stated, tuple):
        return tuple(dict.fromkeys((*held, *stated)))
    if name not in FIGURES_OF_USERS or held is None or not isinstance(stated, Mapping) or EVERYBODY in stated:
        return stated
    assert not isinstance(held, tuple)
    return {**(held if isinstance(held, Mapping) else {EVERYBODY: held}), **stated}
