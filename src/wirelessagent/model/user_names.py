"""How users are called, and who is meant: requests name users, arrays hold one row a user, and here the two meet.

People count users from 1 and arrays from 0, so that a bare number in a request would mean one user to its writer and
another to the program. Requests therefore name users; what comes out is indices from 0 into the channel's names.
"""

from __future__ import annotations

from collections.abc import Iterable

from wirelessagent.model.arrays import shown
from wirelessagent.model.errors import InputError

_SHOWN = 12


def numbered(num_users: int) -> tuple[str, ...]:
    """What users are called who have no names of their own: "user 1" and so on."""
    return tuple(f"user {number}" for number in range(1, num_users + 1))


def index_of(name: str, user_names: tuple[str, ...], what: str = "users") -> int:
    """The index from 0 of the user of this name, or an error that says who is there; ``what`` is the field it is in.

    >>> index_of("user 3", numbered(4))
    2
    """
    if name in user_names:
        return user_names.index(name)
    full = f"user {name.strip()}"
    meant = f"; {full!r} is the whole name of one" if full in user_names else ""
    more = f" and {len(user_names) - _SHOWN} more" if len(user_names) > _SHOWN else ""
    raise InputError(
        f"{what}: no user is called {name!r}{meant}; the channel has {', '.join(user_names[:_SHOWN])}{more}"
    )


def by_name(name: str, users: Iterable[str]) -> tuple[str, ...]:
    """The users that a field names, all different, or an error that shows how to name them.

    Raises:
        InputError: one is given by number, which can be read in two ways; one is named twice, or nobody is.
    """
    if isinstance(users, str) or not isinstance(users, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"{name} must be several, as in {name}=('user 3',); got {shown(users)}")
    found = tuple(users)
    for user in found:
        if not isinstance(user, str):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(_two_readings(name, user))
    if not found or len(set(found)) != len(found):
        raise InputError(f"{name} must name different users, as in {name}=('user 1', 'user 3'); got {shown(users)}")
    return found


def _two_readings(name: str, user: object) -> str:
    try:
        number = int(str(user))
    except ValueError:
        return f"{name} must name users, as in {name}=('user 3',); got {shown(user)}"
    return (
        f"{name} must name users; got {number}, which can be read in two ways: 'user {number}', as people count, or "
        f"the one at index {number} of the arrays, from 0, who is called 'user {number + 1}' unless the channel has "
        f"other names. Give the name, as in {name}=('user {max(number, 1)}',)"
    )
