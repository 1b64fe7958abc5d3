"""Where the clauses of a sentence begin and end: at commas, stops and brackets, but not within a figure."""

from __future__ import annotations

import bisect
import functools

from wirelessagent.language.deferred import deferred
from wirelessagent.language.text import CLAUSE_END

_CUT = deferred(CLAUSE_END)


def clause_start(plain: str, place: int, from_: int = 0) -> int:
    """Where the clause that ``place`` lies in begins, no farther ahead than ``from_``.

    >>> clause_start("leave 3 out, max rate", 17)
    12
    """
    if place > from_ and plain[place - 1] == ".":
        return place
    cuts = _cuts(plain)
    before = bisect.bisect_left(cuts, place)
    return cuts[before - 1] + 1 if before and cuts[before - 1] >= from_ else from_


def clause_end(plain: str, place: int, to: int | None = None) -> int:
    """Where the clause that goes on at ``place`` ends, no farther behind than ``to``.

    >>> clause_end("leave 3 out, max rate", 7)
    11
    """
    to = len(plain) if to is None else to
    cuts = _cuts(plain)
    after = bisect.bisect_left(cuts, place)
    if after < len(cuts) and cuts[after] < to:
        return cuts[after]
    return to - 1 if to > place and plain[to - 1] == "." else to


@functools.lru_cache(maxsize=64)
def _cuts(plain: str) -> tuple[int, ...]:
    return tuple(cut.start() for cut in _CUT.finditer(plain))
