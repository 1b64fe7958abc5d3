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


_TURNED_ROUND: dict[Comparator, Comparator] = {"at_least": "at_most", "at_most": "at_least"}
_BOUNDS: tuple[Comparator, ...] = ("at_least", "at_most", "exactly")
_BEHIND: dict[str, Comparator] = {
    word: bound for bound in _BOUNDS for word in words_of("figures", "bounds", f"{bound}_behind")
}
_TURNED = words_of("figures", "bounds", "turned_behind")  # which a word that denies turns round: "1兆以下不行"

_LATIN = deferred(r"[A-Za-z]")


def _any_of(*names: str) -> str:
    """An alternation of lists, longest first, in which spaces match any run and Latin words end at their borders;
    what begins as a group of a regular expression is one.

    The borders stand once around all Latin words: a pattern that repeats them for each word compiles ten times slower.
    """
    latin: list[str] = []
    others: list[str] = []
    for word in words_of("figures", "bounds", *names):
        body = word if word.startswith("(?") else re.escape(word).replace(r"\ ", r"\s+")
        (latin if _LATIN.search(word) else others).append(body)
    bordered = rf"(?<![A-Za-z_])(?:{'|'.join(latin)})(?![A-Za-zÀ-ÿ])"
    return "(?:" + "|".join([bordered, *others]) + ")"


_WORD = deferred(r"[A-Za-zÀ-ÿ]++")
# What may stand between a comparator and its figure.
BETWEEN = frozenset(words_of("figures", "bounds", "between", "power", "rate"))
_SIGNS = "|".join(sorted((word for word in BETWEEN if not _WORD.match(word)), key=len, reverse=True))
_GAP = deferred(rf"(?:\s++|{_WORD.pattern}|{_SIGNS}){{0,16}}$")
_FEW_WORDS = rf"(?:(?!{AND}\s+(?!{USER_NOUN}|[0-9]))[\w'’#-]+\s+){{0,6}}?"


def _capping(language: str) -> str:
    """Verbs that cap somebody at a figure: "cap users at", "limite l'utilisateur 5 à", "limitado a"."""
    bounds = table("figures", language)["bounds"]
    return rf"\b(?:{'|'.join(bounds['caps'])})\w*\s+{_FEW_WORDS}(?:{'|'.join(bounds['caps_at'])})\b"


_BEFORE = Phrases(
    rf"(?P<at_least>{_any_of('at_least')})"
    rf"|(?P<at_most>{'|'.join(map(_capping, ('en', 'es', 'fr', 'de')))}|{_any_of('at_most')})"
    rf"|(?P<exactly>{_any_of('exactly')})|(?P<above>{_any_of('above')})|(?P<below>{_any_of('below')})"
)
_NEGATION = deferred(rf"(?i){either('moods', 'negation', 'clause')}|{either('figures', 'bounds', 'forbids')}")
_NOBODY = words_of("figures", "bounds", "nobody")
_ASIDE = deferred(  # "nobody, and I mean nobody, should fall under 1 Mbit/s"
    rf"(?i)(?:{either('figures', 'users', 'nobody')})(?:\s*[,\uff0c][^,\uff0c.;:!?。]{{1,40}}){{1,2}}[,\uff0c]\s*$"
)
_DENIED_AFTER = deferred(  # "mehr als 24 Watt gibt's nicht", "below 1 Mbit/s nobody may fall"
    rf"(?i)^(?:(?!\b(?:{AND}|aber|but|sonst)\b)[\w\s'’-])*?(?:{either('figures', 'bounds', 'denied_behind')})"
)
_AFTER_RE = deferred(
    rf"(?i)[\s-]*(?:{any_word('figures', 'bounds', 'ahead_of_behind')}\s+){{0,5}}"
    rf"(?P<word>{_any_of('at_least_behind', 'at_most_behind', 'exactly_behind')})"
    r"(?!\s*(?:of\s+|is\s+)?[0-9]|\s+(?:du|des|del|de\s+l))"  # "ajoute 300 kbit/s au minimum du 2"
)
_POLITE = either("talk_forms", "assent", "polite")
_LAST = "|".join(f"(?P<{bound}>{either('figures', 'bounds', f'{bound}_last')})" for bound in reversed(_BOUNDS))
_LAST_WORD = deferred(  # "10 W, no more", "10 kbit/s, no less and no more"
    rf"(?i),?\s*(?:{_LAST})(?=\s*(?:$|[.,;:!?)\uff0c。\uff1b、]|(?:{AND}|{_POLITE})\b))"
)
_SHORTENED = deferred(r"(?i)\b(?:m[aá]x|m[ií]n|mind|höchst)\.")
_LOOSE = deferred(  # "maximum rate at 1 Mbit/s minimum" wishes first and bounds after
    r"(?i)(?:(?:al|au)\s+)?(?:m[aá]x|m[ií]n)(?:im(?:um|o|al))?\b"
)


def speaks_of(plain: str) -> frozenset[str]:
    """Whether a text speaks of "power", of "rate", or of both.

    >>> sorted(speaks_of("double the rates")), sorted(speaks_of("half the power")), sorted(speaks_of("twice that"))
    (['rate'], ['power'], [])
    """
    return frozenset(name for name, noun in (("power", _POWER_RE), ("rate", _RATE_RE)) if noun.search(plain))


def nouns_of(kind: str, plain: str) -> list[tuple[int, int]]:
    """Where words speak of "power" or of "rate"."""
    return [match.span() for match in (_POWER_RE if kind == "power" else _RATE_RE).finditer(plain)]


_POWER_RE, _RATE_RE = (deferred("(?i)" + _any_of(name)) for name in ("power", "rate"))
WITH = r"(?:with|con|avec|mit|bei)\b"
"""Words behind which the noun ahead is one of a wish: "max rate with 1 Mbit/s"."""
_WISH_WITH = deferred(rf"{_RATE_RE.pattern}\s+(?:\w+\s+)?{WITH}")
_MOST_WITH = deferred(rf"(?i)(?<![0-9] )(?:{either('figures', 'bounds', 'the_most')})\s+{WITH}")
_LEAST_WITH = deferred(rf"(?i)(?:{_any_of('at_least')})\s+{WITH}")  # "maximiere die Mindestrate mit 10 W"
_SOMEBODY = deferred(
    rf"(?i){USER_NOUN}|{either('figures', 'users', 'everybody')}|{either('figures', 'users', 'given')}"
)
_CLAUSE = deferred(CLAUSE_END)
_SYMBOL = deferred(r"(?i)\br_?(?P<bound>min|max)\s*[(\[][^()\[\]=]{1,12}[)\]]\s*=\s*$")  # "Rmax(user 8) = 2 Mbit/s"
_CAP = rf"(?:{'|'.join(words_of('figures', 'bounds', 'caps'))}|m[aá]x|{any_word('figures', 'lifted', 'ceilings')})"
_RAISED_UP_TO = deferred(  # "raise user 4 up to 2 Mbit/s", but not "raise the cap up to 2 Mbit/s"
    rf"(?i)(?:{either('figures', 'becoming', 'raises')})(?:(?!\b{_CAP}).)*"
    rf"{any_word('figures', 'users', 'as_far_as')}\s*$"
)


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
    last = _LAST_WORD.match(text, end)
    if found is not None and (behind is None or not _LOOSE.match(text, found[1])):
        return Comparison(comparator=found[0], start=found[1], end=end)
    if last is not None and behind is None:
        said: Comparator = next(bound for bound in _BOUNDS if last[bound])
        return Comparison(comparator=said, start=start, end=last.end())
    others = _RATE_RE if kind == "power" else _POWER_RE  # "max" is not the figure's where "max rate" begins
    if behind is not None and others.match(text[behind.end() : behind.end() + 12].lstrip()) is None:
        word = " ".join(behind["word"].lower().split())
        turned = word in _TURNED and _is_denied_behind(text, behind.end())
        bound = _TURNED_ROUND[_BEHIND[word]] if turned else _BEHIND[word]
        return Comparison(comparator=bound, start=start, end=behind.end())
    return Comparison(comparator=None, start=start, end=end)


@functools.lru_cache(maxsize=16)
def _without_stops(text: str) -> str:
    """A text whose shortened bounds end no clause: "max. 10 W"; same length."""
    return _SHORTENED.sub(lambda short: short[0][:-1] + " ", text)


def _before(text: str, start: int, end: int, *, kind: str, after: int) -> tuple[Comparator, int] | None:
    window_start = max(after, start - 80)
    symbol = _SYMBOL.search(text, window_start, start)
    if symbol is not None:
        return ("at_least" if symbol["bound"].lower() == "min" else "at_most"), symbol.start()
    cuts = (match.end() for match in _CLAUSE.finditer(text, window_start, start) if match.group() != ":")
    clause_start = max(cuts, default=window_start)
    for match in reversed(list(_BEFORE.finditer(text, clause_start, start))):
        gap = text[match.end() : start]
        is_filler = _GAP.match(gap) is not None and all(word.lower() in BETWEEN for word in _WORD.findall(gap))
        # "bits per joule at the maximum with 1 Mbit/s", but not "each at the maximum with 1 Mbit/s"
        most = kind == "rate" and _MOST_WITH.match(text, match.start()) is not None
        wish = most and _SOMEBODY.search(text, clause_start, match.start()) is None
        raised = kind == "rate" and _RAISED_UP_TO.search(text, clause_start, match.end()) is not None
        if not is_filler or wish or raised or _foreign_noun(text[match.start() : start], kind):
            continue
        for bound in _BOUNDS:
            if match[bound]:
                return bound, match.start()
        nobody = _ASIDE.search(text, after, clause_start) is not None
        negated = nobody or _is_denied(text, max(clause_start, match.start() - 60), match.start(), end)
        return ("at_most" if bool(match["above"]) == negated else "at_least"), match.start()
    return None


def _is_denied(text: str, from_: int, start: int, end: int) -> bool:
    """Whether a comparative is turned round, by what stands before it or, as verbs do in German, behind the figure."""
    ahead = _WORD.findall(text[from_:start].lower())
    if _NEGATION.search(text, from_, start) or any(one_edit(word, nobody) for word in ahead for nobody in _NOBODY):
        return True
    return _is_denied_behind(text, end)


def _is_denied_behind(text: str, end: int) -> bool:
    clause = _CLAUSE.search(text, end)
    return _DENIED_AFTER.match(text[end : clause.start() if clause else len(text)]) is not None


def _foreign_noun(said: str, kind: str) -> bool:
    """ "min power 1 Mbit/s", "max rate with 1 Mbit/s each": the word is of a wish, not of the rate that follows."""
    if kind == "rate":
        return _POWER_RE.search(said) is not None or _WISH_WITH.search(said) is not None
    return _RATE_RE.search(said) is not None or _LEAST_WITH.search(said) is not None
