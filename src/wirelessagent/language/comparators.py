"""Whether a figure is a floor, a ceiling or exact: the words before or after it.

Comparatives turn round under a negation ("nobody below 1 Mbit/s" is a floor); "at least" does not.
"""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass
from typing import Literal, TypeAlias

from wirelessagent.language.text import AND, CLAUSE_END, USER_NOUN, Phrases
from wirelessagent.language.vocabulary import one_edit
from wirelessagent.language.word_tables import any_word, deferred, either, table, words_of

Comparator: TypeAlias = Literal["at_least", "at_most", "exactly"]


def _words(name: str) -> list[str]:
    return list(words_of("figures", "bounds", name))


# What a list of words cannot say: words that mean a bound only where certain others do not stand before or behind.
_MIN = r"(?<!max[-\s])(?<![A-Za-z])min(?![A-Za-z])"
_LIMITED = r"(?<![门底极无有期权下上时受])限(?:速|制|流)?(?:到|在|为)?"
_CLOSED, _ABOVE_IN_CHINESE = "(?:封(?![顶闭城]))", "(?<=[不别莫勿])超"
_BEHIND: dict[str, Comparator] = {
    **dict.fromkeys(_words("at_least_behind"), "at_least"),
    **dict.fromkeys(_words("at_most_behind"), "at_most"),
    "exactly": "exactly",
}
_TURNED = frozenset(_words("turned_behind"))  # which a word that denies turns round: "1兆以下不行"
_POWER_NOUNS, _RATE_NOUNS = _words("power"), _words("rate")

_LATIN = deferred(r"[A-Za-z]")


def _any_of(words: list[str]) -> str:
    """An alternation, longest first, in which spaces match any run and Latin words end at their borders.

    The borders stand once around all Latin words: a pattern that repeats them for each word compiles ten times slower.
    """
    latin: list[str] = []
    others: list[str] = []
    for word in sorted(words, key=len, reverse=True):
        body = word if word.startswith("(?") else re.escape(word).replace(r"\ ", r"\s+")
        (latin if _LATIN.search(word) else others).append(body)
    bordered = rf"(?<![A-Za-z_])(?:{'|'.join(latin)})(?![A-Za-zÀ-ÿ])"
    return "(?:" + "|".join([bordered, *others]) + ")"


_WORD = deferred(r"[A-Za-zÀ-ÿ]++")
# What may stand between a comparator and its figure.
_BETWEEN = frozenset([*_words("between"), *_POWER_NOUNS, *_RATE_NOUNS])
_SIGNS = "|".join(sorted((word for word in _BETWEEN if not _WORD.match(word)), key=len, reverse=True))
_GAP = deferred(rf"(?:\s++|{_WORD.pattern}|{_SIGNS}){{0,16}}$")
_FEW_WORDS = rf"(?:(?!{AND}\s+(?!{USER_NOUN}|[0-9]))[\w'’#-]+\s+){{0,6}}?"


def _capping(language: str) -> str:
    bounds = table("figures", language)["bounds"]
    return rf"\b(?:{'|'.join(bounds['caps'])})\w*\s+{_FEW_WORDS}(?:{'|'.join(bounds['caps_at'])})\b"


_CAP = (  # "cap users at", "limite l'utilisateur 5 à", "limitado a", "auf … begrenzt" stands behind
    r"\b(?:rate-)?(?:cap|limit|restrict|throttl|clamp|polic|chok|stop|held\s+down|cut\s+off)"
    rf"(?:s|e|es|p?ed|t?ing|ping|ing)?\s+{_FEW_WORDS}(?:at|to)\b|{'|'.join(map(_capping, ('es', 'fr', 'de')))}"
)
_BEFORE = Phrases(
    rf"(?P<at_least>{_any_of([*_words('at_least'), _MIN])})"
    rf"|(?P<at_most>{_CAP}|{_any_of([*_words('at_most'), _LIMITED, _CLOSED])})"
    rf"|(?P<exactly>{_any_of(_words('exactly'))})"
    rf"|(?P<above>{_any_of([*_words('above'), _ABOVE_IN_CHINESE])})|(?P<below>{_any_of(_words('below'))})"
)
_NEGATION = deferred(rf"(?i){either('moods', 'negation', 'clause')}|{either('figures', 'bounds', 'forbids')}")
_NOBODY = _words("nobody")
_ASIDE = deferred(  # "nobody, and I mean nobody, should fall under 1 Mbit/s"
    rf"(?i)(?:{either('figures', 'users', 'nobody')})(?:\s*[,\uff0c][^,\uff0c.;:!?。]{{1,40}}){{1,2}}[,\uff0c]\s*$"
)
_DENIED_AFTER = deferred(  # "mehr als 24 Watt gibt's nicht", "below 1 Mbit/s nobody may fall"
    rf"(?i)^(?:(?!\b(?:{AND}|aber|but|sonst)\b)[\w\s'’-])*?(?:{either('figures', 'bounds', 'denied_behind')})"
)
_AFTER_RE = deferred(
    rf"(?i)[\s-]*(?:{any_word('figures', 'bounds', 'ahead_of_behind')}\s+){{0,5}}"
    rf"(?P<word>{_any_of(list(_BEHIND))})(?!\s*(?:of\s+|is\s+)?[0-9])"
)
_LAST_WORD = deferred(  # "10 W, no more", "10 kbit/s, no less and no more"
    rf"(?i),?\s*(?:(?P<exactly>{either('figures', 'bounds', 'exactly_last')})|"
    rf"(?P<at_most>{either('figures', 'bounds', 'at_most_last')})|"
    rf"(?P<at_least>{either('figures', 'bounds', 'at_least_last')}))(?=\s*(?:$|[.,;:!?)\uff0c。\uff1b、]))"
)
_SHORTENED = deferred(r"(?i)\b(?:m[aá]x|m[ií]n|mind|höchst)\.")
_LOOSE = deferred(r"(?i)(?:max|min)(?:imum)?\b")  # "maximum rate at 1 Mbit/s minimum" wishes first and bounds after


def speaks_of(plain: str) -> frozenset[str]:
    """Whether a text speaks of "power", of "rate", or of both.

    >>> sorted(speaks_of("double the rates")), sorted(speaks_of("half the power")), sorted(speaks_of("twice that"))
    (['rate'], ['power'], [])
    """
    return frozenset(name for name, noun in (("power", _POWER_RE), ("rate", _RATE_RE)) if noun.search(plain))


_POWER_RE = deferred("(?i)" + _any_of(_POWER_NOUNS))
_RATE_RE = deferred("(?i)" + _any_of(_RATE_NOUNS))
_WISH_WITH = deferred("(?i)" + _any_of(_RATE_NOUNS) + r"\s+(?:with|con|avec|mit|bei)\b")
_CLAUSE = deferred(CLAUSE_END)


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """A comparator and the span of words from it to the figure's other side."""

    comparator: Comparator | None
    start: int
    end: int


def comparison(text: str, start: int, end: int, *, kind: str, after: int) -> Comparison:
    """How the figure at [start, end) of a normalised text is bounded; words before ``after`` are another's."""
    text = _without_stops(text)
    found = _before(text, start, end, kind=kind, after=after)
    behind = _AFTER_RE.match(text, end)
    if found is not None and (behind is None or not _LOOSE.match(text, found[1])):
        return Comparison(comparator=found[0], start=found[1], end=end)
    last = _LAST_WORD.match(text, end)
    if last is not None and behind is None:
        word = "exactly" if last["exactly"] else "at_most" if last["at_most"] else "at_least"
        return Comparison(comparator=word, start=start, end=last.end())
    if behind is not None and _takes(kind, text[behind.end() : behind.end() + 12]):
        word = " ".join(behind["word"].lower().split())
        turned = word in _TURNED and _is_denied_behind(text, behind.end())
        bound = _BEHIND[word] if not turned else "at_most" if _BEHIND[word] == "at_least" else "at_least"
        return Comparison(comparator=bound, start=start, end=behind.end())
    return Comparison(comparator=None, start=start, end=end)


@functools.lru_cache(maxsize=16)
def _without_stops(text: str) -> str:
    """A text whose shortened bounds end no clause: "max. 10 W"; same length."""
    return _SHORTENED.sub(lambda short: short[0][:-1] + " ", text)


def _takes(kind: str, rest: str) -> bool:
    """Whether "max" after a figure is its own, and not the beginning of "max rate"."""
    nouns = _RATE_RE if kind == "power" else _POWER_RE
    return nouns.match(rest.lstrip()) is None


def _before(text: str, start: int, end: int, *, kind: str, after: int) -> tuple[Comparator, int] | None:
    window_start = max(after, start - 80)
    cuts = [match.end() for match in _CLAUSE.finditer(text, window_start, start) if match.group() != ":"]
    clause_start = cuts[-1] if cuts else window_start
    matches = list(_BEFORE.finditer(text, clause_start, start))
    for match in reversed(matches):
        gap = text[match.end() : start]
        if not _is_filler(gap) or _foreign_noun(gap, kind):
            continue
        word = match.lastgroup
        if word in ("above", "below"):
            nobody = _ASIDE.search(text, after, clause_start) is not None
            negated = nobody or _is_denied(text, max(clause_start, match.start() - 60), match.start(), end)
            return ("at_most" if (word == "above") == negated else "at_least"), match.start()
        if word == "at_least" or word == "at_most" or word == "exactly":
            return word, match.start()
    return None


def _is_filler(gap: str) -> bool:
    return _GAP.match(gap) is not None and all(word.lower() in _BETWEEN for word in _WORD.findall(gap))


def _is_denied(text: str, from_: int, start: int, end: int) -> bool:
    """Whether a comparative is turned round, by what stands before it or, as verbs do in German, behind the figure."""
    if _NEGATION.search(text, from_, start) is not None or _is_misspelt_nobody(text[from_:start]):
        return True
    return _is_denied_behind(text, end)


def _is_denied_behind(text: str, end: int) -> bool:
    clause = _CLAUSE.search(text, end)
    return _DENIED_AFTER.match(text[end : clause.start() if clause else len(text)]) is not None


def _is_misspelt_nobody(words: str) -> bool:
    return any(one_edit(word, nobody) for word in _WORD.findall(words.lower()) for nobody in _NOBODY)


def _foreign_noun(gap: str, kind: str) -> bool:
    """ "min power 1 Mbit/s", "max rate with 1 Mbit/s each": the word is of a wish, not of the rate that follows."""
    if kind == "rate":
        return _POWER_RE.search(gap) is not None or _WISH_WITH.search(gap) is not None
    return _RATE_RE.search(gap) is not None
