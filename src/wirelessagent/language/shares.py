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

from wirelessagent.language.mentions import GIVEN_TO, named
from wirelessagent.language.moods import named_in
from wirelessagent.language.numerals import factors
from wirelessagent.language.quantities import measures
from wirelessagent.language.stated import CARRIERS
from wirelessagent.language.text import clause_end, clause_start, normalise, overlaps, written_over
from wirelessagent.language.word_tables import any_word, deferred, either, words_of

_OF, _BETWEEN, _WHICH, _MORE, _LESS, _THAN = (
    rf"(?<!\w){any_word('figures', 'shares_of', name)}(?!\w)"
    for name in ("of", "between", "of_which", "more", "less", "than")
)
_BELOW, _MINUS = (any_word("figures", "shares_of", name) for name in ("below", "minus"))
_OF_IT = any_word("figures", "shares_of", "of_it")
_INSIDE, _PURPOSES, _IT_AHEAD, _POWER_AHEAD, _MORE_AHEAD, _LESS_AHEAD, _WEIGHED = (
    f"(?:{either('figures', 'shares_of', name)})"
    for name in ("inside", "purposes", "of_it_ahead", "of_power_ahead", "more_ahead", "less_ahead", "counts")
)
_WHOSE = rf"(?:\s*{_BETWEEN})*\s*"
_LESS_THAN = deferred(rf"(?i)\s*(?:{_BELOW})(?:\s*{_BETWEEN})+\s*")
_TAKEN_OFF = deferred(rf"(?i)\s*{_MINUS}\s*")
_PURPOSE = deferred(rf"(?i)\s*(?:{GIVEN_TO}|{_OF}|{_PURPOSES})")
_JOINED = deferred(rf"(?i)\s*{_OF}{_WHOSE}")
_ALL_THERE_IS = deferred(rf"(?i)\s*,?\s*(?:{either('figures', 'shares_of', 'all_there_is')})")
_BEHIND = deferred(rf"\s*{_INSIDE}\s*")
_ARTICLE = deferred(rf"(?i)\b{any_word('figures', 'users', 'articles')}\s+$")
_ALL_OF = deferred(rf"(?i)(?:^|[,;:.(\uff0c；：。])\s*(?P<of>{_OF}{_WHOSE})$")
_ON = r"(?:[^\W\d]+\s+){0,6}"
_UP_TO_SHARE, _OF_WHICH = (
    deferred(rf"(?i)\s*{_ON}"),
    deferred(rf"(?i)\s*(?:\w+\s*)?[,\uff0c]?\s*(?P<which>{_WHICH}\s+{_ON})"),
)
_OF_IT_BEHIND = deferred(
    rf"(?i)\s*(?:{_OF_IT}|{any_word('figures', 'shares_of', 'of_it_as')}"
    rf"(?!\s+{any_word('figures', 'shares_of', 'likened')}(?!\w)))(?!\w)"
)
_OF_IT_AHEAD = deferred(rf"{_IT_AHEAD}\s*$")
_OF_POWER = deferred(rf"(?i)\s*{any_word('figures', 'shares_of', 'of_power')}(?!\w)")
_OF_POWER_AHEAD = deferred(rf"{_POWER_AHEAD}\s*$")
_AGAIN = deferred(rf"(?i)[^,;.]*\b(?:{any_word('figures', 'shares_of', 'again')})\b")
_CHANGED = deferred(rf"(?i)\s*(?:(?P<more>{_MORE})|(?P<less>{_LESS}))(?:\s+{_THAN})?")
_CHANGED_AHEAD = deferred(rf"(?:(?P<more>{_MORE_AHEAD})|(?P<less>{_LESS_AHEAD}))\s*$")
_DENIED = deferred(rf"(?i){either('moods', 'negation', 'clause')}")
_MORE_THAN_IT = deferred(
    rf"(?i)\s*(?:(?P<more>{_MORE})|(?P<less>{_LESS}))\s+{any_word('figures', 'shares_of', 'than_it')}(?!\w)"
)
_THAN_IT_AHEAD = deferred(rf"(?:{either('figures', 'shares_of', 'than_it_ahead')}){_CHANGED_AHEAD.pattern}")
_COUNTS = deferred(rf"(?i)\b{any_word('figures', 'users', 'weighs')}\b(?!\s+on\b)|{_WEIGHED}")
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
        start = article.start() if article and instead.endswith(("W", "bps")) else start
        room = end - start - text[start - 1 : start].isdigit()
        instead = instead if len(instead) <= room else instead.removesuffix("bps")  # "600k", as Chinese writes it
        if len(instead) <= room:
            text = written_over(text, start, end, instead)
    return text


def _come_to(plain: str) -> Iterator[tuple[int, int, str]]:
    """The spans of shares, each with its figure where that is only what it is a share of, and what they come to."""
    figures = list(_figures(plain))
    for one, other in itertools.pairwise(figures):
        than, apart = _MORE_THAN_IT.match(plain, other.end), _THAN_IT_AHEAD.search(plain, one.end, other.start)
        changed = than or apart  # "user 4 100 kbit/s more than that", 用户4比这多100k
        if changed and one.kind == other.kind and (changed["more"] or other.value < one.value):
            start, end = (other.start, than.end()) if than else (changed.start(), other.end)
            if _DENIED.search(plain, one.end, start):  # "user 5 not 1 Mbit/s more than that"
                continue
            yield start, end, _written(one, 1 + (1 if changed["more"] else -1) * other.value / one.value)
            continue
        below, off = (pattern.fullmatch(plain, one.end, other.start) for pattern in (_LESS_THAN, _TAKEN_OFF))
        less, most = (other, one) if off else (one, other)
        able = one.kind == other.kind and less.value < most.value and (below or off)
        if able and _PURPOSE.match(plain, other.end) is None:  # no "20 W less 5 W for the electronics"
            yield one.start, other.end, _written(most, 1 - less.value / most.value)
    for share in sorted(_shares(plain), key=lambda each: each.start):
        ahead = [figure for figure in figures if figure.end <= share.start]
        behind = [figure for figure in figures if figure.start >= share.end]
        of_power, power = _OF_POWER.match(plain, share.end), _OF_POWER_AHEAD.search(plain, 0, share.start)
        budgets = (each for each in reversed(ahead) if each.kind == "power" and not _is_of_a_part(plain, each))
        budget = next(budgets, None) if of_power or power else None
        if budget is not None:  # "each subcarrier at most 2 % of the total power"
            start, end = power.start() if power else share.start, of_power.end() if of_power else share.end
            yield start, end, _written(budget, share.value)
            continue
        base = ahead[-1] if ahead and _AGAIN.match(plain, share.end) is None else None
        if _counts(plain, share.start):  # "counts 50 % more"
            yield from _weighed(plain, share)
        elif behind and _is_part(share) and _JOINED.fullmatch(plain, share.end, behind[0].start):  # "80 % of 25 W"
            whole = _ALL_THERE_IS.match(plain, behind[0].end)
            yield share.start, whole.end() if whole else behind[0].end, _written(behind[0], share.value)
        elif base is not None and -1 < share.value < 0 and not plain[base.end : share.start].strip():
            yield base.start, share.end, _written(base, 1 + share.value)  # "10 W minus 10 %"
        elif base is not None and share.value > 0:
            again = bool(behind) and math.isclose(behind[0].value, base.value * share.value, rel_tol=1e-3)
            for start, end, worth in _of_one_ahead(plain, share, base):  # "twice that, namely 1.5 Mbit/s"
                yield start, end, "" if again else worth


def _is_of_a_part(plain: str, power: _Figure) -> bool:
    """Whether a power is said to be one of the circuits, or of each subcarrier."""
    clause = plain[clause_start(plain, power.start) : clause_end(plain, power.end)]
    circuits = any(name == "circuit_power_w" for _, name in named_in(clause))
    return circuits or CARRIERS.search(clause) is not None


def _is_part(share: _Figure) -> bool:
    return share.kind != "ratio" or _RARELY < share.value < _USUALLY


def _of_one_ahead(plain: str, share: _Figure, base: _Figure) -> Iterator[tuple[int, int, str]]:
    """A share of a figure that stands before it."""
    worth = _written(base, share.value)
    of_all = _ALL_OF.search(plain, 0, base.start)
    it, its = _OF_IT_BEHIND.match(plain, share.end), _OF_IT_AHEAD.search(plain, base.end, share.start)
    of_which = _OF_WHICH.fullmatch(plain, base.end, share.start)
    if of_which is not None:
        start = share.start
        if share.end - start < len(worth):  # in the place of the bound, too: whatever power is said is a ceiling
            start = max(plain.rfind(" ", 0, start - 1) + 1, of_which.start("which"))
        yield start, share.end, worth
    elif its is not None:
        yield its.start(), share.end, worth
    elif not _is_part(share):
        return
    elif _BEHIND.fullmatch(plain, base.end, share.start):  # 30W的六成
        yield base.start, share.end, worth
    elif of_all is not None and _UP_TO_SHARE.fullmatch(plain, base.end, share.start):  # "of our 40 W at most a quarter"
        if CARRIERS.search(plain, share.end, clause_end(plain, share.end)) is None:
            yield of_all.start("of"), base.end, ""
        yield share.start, share.end, worth
    elif it is not None:
        yield share.start, it.end(), worth


def _weighed(plain: str, share: _Figure) -> Iterator[tuple[int, int, str]]:
    """By how much more somebody counts, as how many times."""
    ahead, behind = _CHANGED_AHEAD.search(plain, 0, share.start), _CHANGED.match(plain, share.end)
    found = ahead or behind
    if found is not None and share.kind == "ratio":
        times = 1 + share.value if found["more"] else 1 - share.value
        start, end = (ahead.start(), share.end) if ahead else (share.start, found.end())
        yield start, end, f"{times:.4g}x"


def _counts(plain: str, place: int) -> bool:
    """Whether somebody counts, or weighs, in the clause of a place."""
    start = clause_start(plain, place)
    return _COUNTS.search(plain, start, place) is not None and any(start <= each.start < place for each in named(plain))


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
