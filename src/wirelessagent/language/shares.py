"""What a sentence leaves to be worked out, put in its words: "80 % of 25 W", "half of that", "5 W below our 20 W".

A share or a multiple of a figure that the sentence says, or so much less than it, becomes what it comes to, at the
place where it stands, so that everything behind reads one figure: "user 8 half of that" is "user 8 1Mbps". Which words
join a share to its figure is data (``figures/<language>.toml``, ``[shares_of]``). A share of what holds, and not of
what is said, is none of these.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator
from typing import NamedTuple

from wirelessagent.language.mentions import SOMEBODY
from wirelessagent.language.moods import named_in
from wirelessagent.language.numerals import factors
from wirelessagent.language.quantities import measures
from wirelessagent.language.text import Beside, clause_start, normalise, overlaps, written_over
from wirelessagent.language.word_tables import any_word, deferred, either, words_of

_OF, _BETWEEN = (rf"(?<!\w){any_word('figures', 'shares_of', name)}(?!\w)" for name in ("of", "between"))
_BELOW, _OF_IT = (any_word("figures", "shares_of", name) for name in ("below", "of_it"))
_INSIDE, _IT_AHEAD = (f"(?:{either('figures', 'shares_of', name)})" for name in ("inside", "of_it_ahead"))
_USING = either("figures", "shares_of", "uses")
_USES = deferred(rf"(?i)(?<![A-Za-zÀ-ÿ])(?:{_USING})(?![A-Za-zÀ-ÿ])")
_USES_BEHIND = deferred(
    rf"(?i)\s*(?:(?P<uses>{_USING})|{either('figures', 'bounds', 'at_most_behind')})?\s*(?:$|[,.;:!?\uff0c\uff1b。])"
)
_WHOSE = rf"(?:\s*{_BETWEEN})*\s*"
_LESS_THAN = deferred(rf"(?i)\s*(?:{_BELOW})(?:\s*{_BETWEEN})+\s*")
_JOINED = deferred(rf"(?i)\s*{_OF}{_WHOSE}")
_ALL_THERE_IS = deferred(rf"(?i)\s*,?\s*(?:{either('figures', 'shares_of', 'all_there_is')})")
_BEHIND = deferred(rf"\s*{_INSIDE}\s*")
_ARTICLE = deferred(rf"(?i)\b{any_word('figures', 'users', 'articles')}\s+$")
_OF_IT_BEHIND = deferred(
    rf"(?i)\s*(?:{_OF_IT}|{any_word('figures', 'shares_of', 'of_it_as')}"
    rf"(?!\s+{any_word('figures', 'shares_of', 'likened')}(?!\w)))(?!\w)"
)
_OF_IT_AHEAD = deferred(rf"{_IT_AHEAD}\s*$")
_THAN = either("figures", "shares_of", "than")
OF_SOMEBODY = Beside(deferred(rf"(?i){SOMEBODY}\s*的\w{{0,4}}$"), deferred(rf"(?i)\s*(?:{_THAN})[' ]?{SOMEBODY}"))
"""What makes a multiple one of another user's rate: "as much as user 1", 用户1的."""
_NO_SHARE = words_of("figures", "shares_of", "no_share")
_RARELY, _USUALLY = 0.1, 0.9
"""Up to and from where on a percentage of a figure may as well be how often it is to be kept, or missed."""
_STEPS = {"power": ("W", ((1.0, "W"), (1e-3, "mW"), (1e-6, "μW"))),
          "rate": ("bps", ((1e6, "Mbps"), (1e3, "kbps"), (1.0, "bps")))}  # fmt: skip


class _Figure(NamedTuple):
    kind: str
    value: float
    start: int
    end: int


def worked_out(text: str) -> str:
    """The sentence with what its shares come to, all else at its place.

    >>> " ".join(worked_out("max rate at 80 % of 25 W, user 8 at least 2 Mbit/s, user 7 half of that").split())
    'max rate at 20W, user 8 at least 2 Mbit/s, user 7 1Mbps'
    """
    for start, end, instead in _come_to(normalise(text)):
        article = _ARTICLE.search(text, 0, start)
        start = article.start() if article and instead else start
        if len(instead) <= end - start - text[start - 1 : start].isdigit():
            text = written_over(text, start, end, instead)
    return text


def _come_to(plain: str) -> Iterator[tuple[int, int, str]]:
    """The spans of shares, each with its figure where that is only what it is a share of, and what they come to."""
    figures = list(_figures(plain))
    for one, other in itertools.pairwise(figures):
        below = _LESS_THAN.fullmatch(plain, one.end, other.start)
        if below and one.kind == other.kind and one.value < other.value:
            yield one.start, other.end, _written(other, 1 - one.value / other.value)
    for share in sorted(_shares(plain), key=lambda each: each.start):
        ahead = [figure for figure in figures if figure.end <= share.start]
        behind = [figure for figure in figures if figure.start >= share.end]
        if behind and _is_part(share) and _JOINED.fullmatch(plain, share.end, behind[0].start):  # "80 % of 25 W"
            whole = _ALL_THERE_IS.match(plain, behind[0].end)
            yield share.start, whole.end() if whole else behind[0].end, _written(behind[0], share.value)
        elif ahead:
            yield from _of_one_ahead(plain, share, ahead[-1])


def _is_part(share: _Figure) -> bool:
    return share.kind != "ratio" or _RARELY < share.value < _USUALLY


def _of_one_ahead(plain: str, share: _Figure, base: _Figure) -> Iterator[tuple[int, int, str]]:
    """A share of a figure that stands before it."""
    worth = _written(base, share.value)
    if OF_SOMEBODY.behind.match(plain, share.end):  # "twice that of user 1"
        return
    it, its = _OF_IT_BEHIND.match(plain, share.end), _OF_IT_AHEAD.search(plain, base.end, share.start)
    if its is not None:
        yield its.start(), share.end, worth
    elif not _is_part(share):
        return
    elif _BEHIND.fullmatch(plain, base.end, share.start):  # 30W的六成
        yield base.start, share.end, worth
    elif it is not None:
        yield share.start, it.end(), worth
    elif base.kind == "power" and _is_used(plain, share):  # "it can do 40 W, use a quarter at most"
        yield base.start, base.end, ""
        yield share.start, share.end, worth


def _is_used(plain: str, share: _Figure) -> bool:
    """Whether a clause uses a share, and says no more of it: none of the users, no promise, none of the circuits."""
    clause = plain[clause_start(plain, share.start) : share.start]
    other = any(name in ("outage_probability", "circuit_power_w") for _, name in named_in(clause))
    behind = _USES_BEHIND.match(plain, share.end)
    return behind is not None and not other and (_USES.search(clause) is not None or behind["uses"] is not None)


def _shares(plain: str) -> Iterator[_Figure]:
    """Percentages, fractions and multiples."""
    times = [_Figure("times", float(each.value), each.start, each.end) for each in factors(plain) if each.value]
    yield from times
    for each in measures(plain):
        known = overlaps((each.start, each.end), [(one.start, one.end) for one in times])
        if known or each.number.value is None or plain[each.start : each.end].lower().endswith(_NO_SHARE):
            continue
        if each.unit is not None and each.unit.kind == "ratio":
            yield _Figure("ratio", each.value, each.start, each.end)
        elif each.unit is None and each.factor == 1 and 0 < each.number.value < 1:
            yield _Figure("part", float(each.number.value), each.start, each.end)


def _figures(plain: str) -> Iterator[_Figure]:
    """Powers and rates, "700k" among them."""
    for each in measures(plain):
        kind = each.unit.kind if each.unit is not None else "rate" if each.factor > 1 else "ratio"
        if kind != "ratio" and 0 < each.value < math.inf:
            yield _Figure(kind, each.value, each.start, each.end)


def _written(base: _Figure, share: float) -> str:
    """What a share of a figure comes to, with no three digits behind a point, which may part thousands."""
    value = base.value * share
    unit, steps = _STEPS[base.kind]
    for step, name in steps:
        said = f"{value / step:.6g}"
        if value >= step and re.search(r"\.\d{3}$|e", said) is None:
            return said + name
    return f"{value:.0f}{unit}"
