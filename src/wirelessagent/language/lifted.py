"""Limits that go: the words that lift one, by what limits are called (``[lifted]`` in ``figures/<language>.toml``)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wirelessagent.language.intent import CONSTRAINTS
from wirelessagent.language.moods import places, without
from wirelessagent.language.text import Span, is_within
from wirelessagent.language.word_tables import words_of

if TYPE_CHECKING:
    from wirelessagent.language.recogniser import Context

_GENERAL = ("max_power_w", "min_rate_bps", "max_rate_bps", "outage_probability", "subcarrier_max_power_w")
"""What "all limits" are."""


def dropped_in(plain: str, context: Context | None) -> tuple[tuple[str, ...], tuple[Span, ...]]:
    """The constraints that a sentence lifts, and the spans of the words that say so.

    >>> dropped_in("without the power limit", None)[0], dropped_in("forget the weights, and the power limit", None)[0]
    (('max_power_w',), ('max_power_w', 'weights'))
    """
    found, alone = lifted_in(plain), list(places(_lifted("alone"), plain))
    if alone or found.keys() == {"all"}:
        held = () if context is None or alone else tuple(context.constraints)
        return tuple(name for name in _GENERAL if name in held) or ("max_power_w",), (*found.values(), *alone)
    return tuple(name for name in CONSTRAINTS if name in found), tuple(found.values())


def lifted_in(plain: str) -> dict[str, Span]:
    """The limits that a sentence lifts, "all" for any, each with the span of the words that say so.

    Words that lift a limit stand ahead of its name or behind it, with no denial beside them; another may follow.
    """
    limits = named_in(plain)
    if not limits:
        return {}
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
    return found


def is_denied(plain: str) -> bool:
    """Whether a word that lifts a limit is denied.

    >>> is_denied("don't drop user 2's minimum"), is_denied("drop the limit"), is_denied("no limit any more")
    (True, False, False)
    """
    lifts = [*places(_lifted("go"), plain), *places(_lifted("gone"), plain)]
    denials = [*places(words_of("moods", "negation", "clause"), plain)]
    return any(_is_beside(plain, one, other) for one in denials for other in lifts)


def may_lift(name: str, plain: str) -> bool:
    """Whether a sentence names a limit, and has a word that may take it back."""
    back = (*_lifted("go"), *_lifted("gone"), *words_of("moods", "negation", "clause"))
    return any(each == name for _, each in named_in(plain)) and any(places(back, plain))


def named_in(plain: str) -> list[tuple[Span, str]]:
    """Where a sentence names a limit, and which, "all" for any; a name within a longer one is none."""
    named = [(span, name) for name in (*CONSTRAINTS, "all") for span in places(_lifted(name), plain)]
    longer = [other for other, _ in named]
    return [
        each for each in sorted(named) if not any(each[0] != other and is_within(each[0], other) for other in longer)
    ]


def _lifted(name: str) -> tuple[str, ...]:
    return words_of("figures", "lifted", name)


def _is_beside(plain: str, first: Span, then: Span, joined_by: str = "") -> bool:
    """Whether nothing but small words stands between two places."""
    return first[1] <= then[0] and not without(_lifted("between"), plain[first[1] : then[0]]).strip(joined_by + " ")
