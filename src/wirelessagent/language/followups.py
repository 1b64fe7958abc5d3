"""What a sentence means within a conversation: limits that go, users who come back, wishes that keep the limits."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import CONSTRAINTS, EVERYBODY, FIGURES_OF_USERS, Constraint
from wirelessagent.language.moods import Span, places, without
from wirelessagent.language.stated import Reading
from wirelessagent.language.word_tables import words_of

if TYPE_CHECKING:
    from wirelessagent.language.recogniser import Context

_GENERAL = ("max_power_w", "min_rate_bps", "max_rate_bps", "outage_probability", "subcarrier_max_power_w")
"""What "all limits" are."""

_SAME = deferred(
    r"(?i)\b(?:same|instead|keep(?:ing)?\s+(?:the\s+)?(?:limits?|rest|everything\s+else|constraints?|figures)|"
    r"otherwise|rather|but\s+with|still|also|too|switch|change)\b|"
    r"^\s*(?:and|now|but|then|plus|ok,?\s+now|what\s+about|how\s+about)\b|条件不变|其他不变|其余不变|限制不变|改为|"
    r"改成|改用|换成|换为|换用|切换|(?:同样|相同|一样)的?(?:条件|限制|要求|需求|约束|前提|指标)|(?:要求|需求|约束|指标)(?:都)?不变|"
    r"保持(?:原有|现有|原来)?的?(?:条件|限制|要求|需求|约束)|还是"
)


def dropped_in(plain: str, context: Context | None) -> tuple[tuple[str, ...], tuple[Span, ...]]:
    """The constraints that a sentence lifts, and the spans of the words that say so.

    Words that lift a limit stand ahead of its name or behind it, with no denial beside them; another may follow.

    >>> dropped_in("without the power limit", None)[0], dropped_in("forget the weights, and the power limit", None)[0]
    (('max_power_w',), ('max_power_w', 'weights'))
    """
    named = [(span, name) for name in (*CONSTRAINTS, "all") for span in places(_lifted(name), plain)]
    limits = [(span, name) for span, name in sorted(named) if not any(_is_part(span, other) for other, _ in named)]
    alone = list(places(_lifted("alone"), plain))
    if not limits and not alone:
        return (), ()
    go, gone = (list(places(_lifted(name), plain)) for name in ("go", "gone"))
    denied = list(places(words_of("moods", "negation", "clause"), plain))
    found: dict[str, Span] = {}
    for span, name in limits:
        ahead = [each for each in go if _is_beside(plain, each, span)]
        ahead += [each for each in found.values() if _is_beside(plain, each, span, ",")]
        behind = [each for each in gone if _is_beside(plain, span, each)]
        whole = min([span, *ahead])[0], max([span, *behind])[1]
        denies = any(_is_beside(plain, each, whole) or _is_beside(plain, whole, each) for each in denied)
        if (ahead or behind) and not denies:
            found.setdefault(name, whole)
    if alone or found.keys() == {"all"}:
        held = () if context is None or alone else tuple(context.constraints)
        return tuple(name for name in _GENERAL if name in held) or ("max_power_w",), (*found.values(), *alone)
    return tuple(name for name in CONSTRAINTS if name in found), tuple(found.values())


def _lifted(name: str) -> tuple[str, ...]:
    return words_of("figures", "lifted", name)


def _is_part(span: Span, other: Span) -> bool:
    return other != span and other[0] <= span[0] and span[1] <= other[1]


def _is_beside(plain: str, first: Span, then: Span, joined_by: str = "") -> bool:
    """Whether nothing but small words stands between two places."""
    return first[1] <= then[0] and not without(_lifted("between"), plain[first[1] : then[0]]).strip(joined_by + " ")


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
