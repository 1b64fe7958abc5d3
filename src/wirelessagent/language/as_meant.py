"""A sentence as it is meant: spelt as it was said, its shares worked out, without what it takes back.

Dictation misspells: "thirty dee bee em" is dBm, "twenty what's" are watts, "user to gets" is user 2. Which words are
heard for which is data (``figures/<language>.toml``, ``[heard]``): anywhere, right behind a number, ahead of a unit,
and right behind a noun of users. A figure or a user that the next words take back is blanked, and so is what a figure
was before, "from 1 to 2 Mbit/s".
"""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from wirelessagent.language.comparators import WITH
from wirelessagent.language.mentions import (
    ANY_NOUN,
    GIVEN_TO,
    JOINT_WORDS,
    MOST_USERS,
    WORD_NUMBER,
)
from wirelessagent.language.numerals import NUMBERED, factors, numbers
from wirelessagent.language.quantities import Measure, measures
from wirelessagent.language.shares import worked_out
from wirelessagent.language.text import (
    AND,
    WORD,
    Span,
    clause_end,
    clause_start,
    normalise,
    overlaps,
    replaced,
    written_over,
)
from wirelessagent.language.units import Unit, unit_at
from wirelessagent.language.vocabulary import language_of
from wirelessagent.language.word_tables import any_word, deferred, either, table


def as_meant(text: str) -> str:
    """The sentence as it is meant: spelt as it was said, with what its shares come to, without what it takes back.

    Everything else stays at its place.
    """
    return without_corrected(worked_out(heard(text)))


def heard(text: str) -> str:
    """The sentence spelt as it was said.

    >>> " ".join(heard("stay below thirty dee bee em and leave out user ate").split())
    'stay below thirty dBm and leave out user 8'
    """
    language = language_of(text)
    for name, words in table("figures", language).get("heard", {}).items():
        plain, spans = normalise(text), list[tuple[int, int, str]]()
        for match in _misheard(name, language).finditer(plain):
            start, end = match.span("said")
            instead = words.get(match["said"].lower())  # none for letters such as "İ", which are an "i" to patterns
            if instead and _fits(name, plain, start, end):
                spans.append((start, end, instead.ljust(end - start)))
        text = replaced(text, spans)
    return text


def _fits(name: str, plain: str, start: int, end: int) -> bool:
    """Whether what stands at a place may be what is only heard "behind_numbers" or "ahead_of_units"."""
    if name == "ahead_of_units":
        return unit_at(plain, end) is not None
    return name != "behind_numbers" or len(plain[:start].rstrip()) in {number.end for number in numbers(plain)}


@functools.cache
def _misheard(name: str, language: str) -> re.Pattern[str]:
    words: Mapping[str, str] = table("figures", language)["heard"][name]
    said = rf"(?P<said>{'|'.join(sorted(map(re.escape, words), key=len, reverse=True))})(?![A-Za-zÀ-ÿ0-9'-])"
    if name == "behind_nouns":
        return deferred(rf"(?i)(?<![A-Za-zÀ-ÿ]){ANY_NOUN}\s*+{said}")
    return deferred(rf"(?i)(?<![A-Za-zÀ-ÿ'])(?:{said})")


_DIGIT = "一二两三四五六七八九十"
_NUMBER = rf"(?:(?<![A-Za-z0-9.,])[0-9]+(?:[.,][0-9]+)?|\b{WORD_NUMBER}\b|(?<![{_DIGIT}])[{_DIGIT}]{{1,3}}+)"
_BREAK = r"\s*+(?:[,;\uff0c；、啊哎哦唉]|[-–—…]++|\.{2,3}+)\s*+"
_CORRECTS, _MEANS, _WAITS = (either("figures", "one", name) for name in ("corrects", "means", "waits"))
_JOINT = rf"(?:{JOINT_WORDS}|\b{any_word('figures', 'users', 'to')}\b|[~/&+、到至和与]|(?<=[0-9])[-–](?=[0-9]))"
_FILLED = either("figures", "one", "fillers")
_TOKEN = rf"(?>{WORD})"
_PAUSE = rf"(?:(?:{_FILLED})\s*+|{_BREAK})"
_BACK = rf"(?P<pause>{_PAUSE}*+)(?P<said>{_MEANS}|{_CORRECTS})(?P<more>(?:\s*+(?:{_PAUSE}|{_CORRECTS}|{_MEANS}|是))*+)"
_RETURN = deferred(  # what stands between a figure and the one that takes its place: words of either, what takes back
    rf"(?i)(?P<tail>(?:\s*+{_TOKEN}){{0,4}}?)\s*+(?P<back>{_BACK}\s*+)(?P<head>(?:{_TOKEN}\s*+){{0,5}}?)"
)
_TAKES_BACK = deferred(rf"(?i){_BACK}")
_HESITATES = deferred(rf"(?i)(?<![A-Za-zÀ-ÿ'])(?:{_FILLED})(?![A-Za-zÀ-ÿ'])\s*,?(?=\s*(?P<item>{_NUMBER}))")
_ITEM = deferred(rf"(?i)\s*{_NUMBER}")
_AND_AHEAD = deferred(rf"(?i)(?:\b(?:{AND})|[和与跟及])\s*$")
_INSTEAD = deferred(
    rf"(?i)(?:\s*{_TOKEN}){{0,3}}?\s*[,\uff0c]?\s*(?P<instead>(?:{either('figures', 'one', 'instead_of')})\s*)"
)
_BOUND_BEHIND = "|".join(either("figures", "bounds", name) for name in ("at_least_behind", "at_most_behind"))
_ENDED = deferred(r"\s*(?:$|[,.;:!?)\uff0c\uff1b。、](?![0-9]))")
_GOES_ON = deferred(rf"(?i){_ENDED.pattern}|\s+(?:{AND})\b(?!\s*{_NUMBER})")
_DENIES = ("no", "non", "不", "不是")
"""Words that deny what follows as often as they take back what stands before, when they stand alone."""
_GOES_ELSEWHERE = deferred(rf"(?i)\s*(?:给|对|(?!(?:{AND})\b|{_BOUND_BEHIND})[A-Za-zÀ-ÿ])")
_GIVEN_AHEAD = deferred(rf"(?i)(?:\s*{GIVEN_TO})+\s*$")
_LIST_AHEAD = deferred(rf"(?i){_NUMBER}\s*号?\s*(?:,\s*)?(?:{_JOINT}|,)\s*(?:{GIVEN_TO}\s*)?(?:{ANY_NOUN}\s*)?$")
_LIST_BEHIND = deferred(rf"(?i)\s*号?\s*{_JOINT}\s*(?:{GIVEN_TO}\s*)?(?:{ANY_NOUN}\s*)?{_NUMBER}")
_FROM, _FROM_OR_OF, RAISES, _LOWERS, _OTHERWISE = (
    either("figures", "becoming", name) for name in ("from", "from_or_of", "raises", "lowers", "changes")
)
CHANGES = f"{RAISES}|{_LOWERS}|{_OTHERWISE}"
LEADS = rf"(?<![A-Za-zÀ-ÿ]){any_word('figures', 'becoming', 'words')}(?![A-Za-zÀ-ÿ])"
_WAYS, _STOOD, _MAKES, _REPLACES, _BY, _AHEAD_INSTEAD = (
    either("figures", "becoming", name) for name in ("ways", "stood", "makes", "replaces", "by", "ahead_instead")
)
_LED = deferred(rf"(?i)(?:\s*(?:{CHANGES}|{_WAYS}))*\s*{LEADS}\s*")
_IN_ITS_PLACE = (  # what stands ahead of a figure that gives way, and between it and the one in its place
    (
        deferred(rf"(?i)(?P<gone>(?:{_STOOD})\s*)$"),
        deferred(rf"(?i)(?P<kept>)(?:\s+\w+){{0,2}}?\s*[,;:.\uff0c；。]\s*(?:(?:{AND}|but|aber)\s+)?(?:{_MAKES})\s*"),
    ),
    (
        deferred(rf"(?i)(?:{_REPLACES})(?:\s+(?!{AND})\w+){{0,3}}?\s*(?P<gone>)$"),
        deferred(rf"(?i)(?P<kept>(?:\s+\w+){{0,4}}?\s*)(?:{_BY})\s*"),
    ),
    (
        deferred(rf"(?i)(?:^|[,;:.\uff0c；。])\s*(?P<gone>(?:{_AHEAD_INSTEAD})\s*)$"),
        deferred(r"(?i)(?P<kept>[^.;!?。；]*)"),
    ),
)
_LED_AHEAD = deferred(rf"(?i){LEADS}\s*$")
_WAS = deferred(rf"(?i)\s*(?:{_FROM}|(?P<of>{_FROM_OR_OF}))\s*$")
_CHANGED = deferred(rf"(?i)(?P<up>{RAISES})|(?P<down>{_LOWERS})|{_OTHERWISE}")
_LEADS_ON = deferred(rf"(?i){LEADS}|{WITH}|{either('figures', 'becoming', 'may')}")


def without_corrected(text: str) -> str:
    """The sentence without what it takes back, all else at its place.

    >>> " ".join(without_corrected("user 6 at least 1, no, 2 Mbit/s").split())
    'user 6 at least 2 Mbit/s'
    >>> " ".join(without_corrected("for user 3 - sorry, I mean user 5 - 1 Mbit/s").split())
    'for user 5 - 1 Mbit/s'
    """
    done = list[Span]()
    plain = normalise(text)
    for start, end, instead in (*_taken_back(plain), *_not_meant(plain), *_given_way(plain), *_was_before(plain)):
        if not overlaps((start, end), done):  # "14 watts uh no 13 watts": one is taken back, and not the other, too
            text = written_over(text, start, end, instead)
            done.append((start, end))
    plain = normalise(text)
    for match in _HESITATES.finditer(plain):  # "users 3 and, uh, 4", "10 W, uh, 5 W for the circuits"
        if unit_at(plain, match.end("item")) or _AND_AHEAD.search(plain[: match.start()].rstrip(" ,\uff0c")):
            text = written_over(text, *match.span(), "")
    return text


def taking_back(plain: str, *, figures: bool = False) -> Iterator[Span]:
    """Where words stand that take back what was said: "no wait", "不对"; a lone "no" denies, "uh" fills a pause.

    Between ``figures`` a "no" without a pause takes back, too: "3 watts no half a watt".

    >>> list(taking_back("least power, no, wait, max rate, no user 3, uh"))
    [(11, 23)]
    """
    for match in _TAKES_BACK.finditer(plain):
        said, filled = match["said"].casefold(), any(map(str.isalpha, match["pause"]))  # "euh non"
        more = match["more"].strip(" ,;\uff0c；、-–—….")
        if more.casefold().endswith(_DENIES) or (re.fullmatch(_WAITS, said) and not more):
            continue  # "sorry, no min power", "max rate, wait, least power matters, too"
        parted = match["pause"].strip() and match["more"].strip()  # "…, no, …"
        between = figures and not match["pause"].strip() and _ITEM.match(plain, match.end())
        if filled or more or parted or between or said not in _DENIES:
            yield match.span()


def hesitating(plain: str) -> Iterator[Span]:
    """Where a pause stands between two numbers, and the second may take the place of the first.

    >>> list(hesitating("30 W, uh, 32"))
    [(6, 9)]
    """
    ends = {each.end for each in measures(plain)}
    for match in _HESITATES.finditer(plain):
        if len(plain[: match.start()].rstrip(" ,.\uff0c…")) in ends:
            yield match.span()


def _alike(plain: str) -> Iterator[tuple[Measure, Measure, Unit, int]]:
    """Figures side by side of one kind, of which one may lack the unit, with it, and where the one before them ends."""
    before = 0
    for one, other in itertools.pairwise(measures(plain)):
        units = [each.unit for each in (one, other) if each.unit is not None]
        if len({unit.kind for unit in units}) == 1:
            yield one, other, units[0], before
        before = one.end


def _not_meant(plain: str) -> Iterator[tuple[int, int, str]]:
    """Figures that others are said to stand for: "15 W, and not 14", "11 W statt 10 W", "to 2 Mbit/s from 1 Mbit/s"."""
    for one, other, *_ in _alike(plain):
        if one.unit is None:
            continue
        said, was = (pattern.fullmatch(plain, one.end, other.start) for pattern in (_INSTEAD, _WAS))
        if said is not None and _GOES_ON.match(plain, other.end):
            if said["instead"].strip() not in _DENIES or {",", "，"} & {*said[0]}:  # "100 mW no 90 mW" corrects
                yield said.start("instead"), other.end, ""
        elif was is not None and other.unit is not None and _LED_AHEAD.search(plain, 0, one.start):
            yield one.end, other.end, ""


def _given_way(plain: str) -> Iterator[tuple[int, int, str]]:
    """Figures with a unit in whose place others stand: "it was 8 W, make it 6.5", "replace 13 W by 8 W"."""
    for one, other, *_ in _alike(plain):
        for ahead, between in _IN_ITS_PLACE if one.unit is not None else ():
            gone, kept = ahead.search(plain, 0, one.start), between.fullmatch(plain, one.end, other.start)
            if gone is not None and kept is not None:
                yield from _moved(plain, gone.start("gone"), kept["kept"], one, other)
                break


def _was_before(plain: str) -> Iterator[tuple[int, int, str]]:
    """What a figure is changed from: "raise the floor from 1 to 2 Mbit/s".

    Behind a word for "of", too, the first number of a clause may be a user: "die Rate von 3 auf 2 Mbit/s".
    """
    for one, other, unit, before in _alike(plain):
        start = clause_start(plain, one.start)
        was, led = _WAS.search(plain, start, one.start), _LED.fullmatch(plain, one.end, other.start)
        verb = _CHANGED.search(plain, start, clause_end(plain, other.end))
        if was is None or led is None or verb is None:
            continue
        old, new = (replace(each, unit=unit).value for each in (one, other))
        fits = {"up": old < new, "down": old > new}.get(verb.lastgroup or "", True)
        user = before <= start and one.unit is None and unit.kind == "rate" and (one.number.value or 0) < MOST_USERS
        ranged = _LEADS_ON.search(plain, max(before, verb.end()), was.start())
        if fits and not ranged and not (was["of"] and (user or other.unit is None)):
            yield from _moved(plain, was.start(), led[0], one, other)


def _moved(plain: str, start: int, kept: str, one: Measure, other: Measure) -> Iterator[tuple[int, int, str]]:
    """The second figure in the place of the first, behind words that are kept; one without a unit gets it."""
    if other.unit is not None:
        yield start, other.end, kept + plain[other.start : other.end]
    elif _ENDED.match(plain, other.end):
        yield start, other.end, kept + plain[other.start : other.end] + plain[one.number.end : one.end]


def _taken_back(plain: str) -> Iterator[tuple[int, int, str]]:
    """The spans of numbers in whose place the next one stands, with the words that say so, and what is to stand there.

    Words between stand ahead of the first as well, or behind the second: "at least 4 Mbit/s each, no, 5 Mbit/s each".
    A figure without a unit in the place of one that has it gets the unit, where it is nobody's number. What of a list
    is taken back, nobody knows: "users 1 and 2, no, 3".
    """
    times = [*factors(plain)]
    for wrong, right in (*itertools.pairwise(numbers(plain)), *itertools.pairwise(times)):
        its, other = (unit_at(plain, each.end) if each.form != "times" else None for each in (wrong, right))
        said = _RETURN.fullmatch(plain, its.end if its else wrong.end, right.start)
        listed = (other is None and _LIST_AHEAD.search(plain, 0, wrong.start)) or _LIST_BEHIND.match(plain, right.end)
        if said is None or wrong.value == right.value or listed:
            continue
        small = (wrong.value or 0) < MOST_USERS
        if its is other and small and (right.value or 0) >= MOST_USERS:  # "for 2, no, 700 for 2"
            continue
        user = small and NUMBERED.search(plain, 0, wrong.start) is not None
        if other and not its and user:  # "for user 2, no, 3 Mbit/s"
            continue
        doubled = any(map(str.isalpha, said["pause"] + said["more"]))
        parted = said["pause"].strip() and said["more"].strip()
        if not (doubled or parted) and said["said"].casefold() in _DENIES:
            continue  # "no service to 6, no service to 7", "con 10 W, no 20 W"
        given = other and not its and _GIVEN_AHEAD.search(plain, 0, wrong.start)
        if given and not doubled and re.fullmatch(_WAITS, said["said"].casefold()):
            continue  # "2 Mbit/s pour 4, enfin 10 W"
        ahead, behind = plain[: wrong.start].casefold().rstrip(), plain[other.end if other else right.end :].casefold()
        head, tail = said["head"].casefold().strip(), said["tail"].casefold().strip()
        if its is not None and other is None:
            if not head and _ENDED.match(plain, right.end):
                unit = plain[wrong.end : said.start("back")].rstrip()
                yield wrong.start, right.end, plain[right.start : right.end] + unit
        elif its and other and its.kind == other.kind and tail and not head and _GOES_ON.match(behind):
            yield wrong.start, other.end, f"{plain[right.start : other.end]}{said['tail']}"  # "5 W more, no, wait, 6 W"
        elif its and other:  # else two figures of one thing are found to be so by whoever reads them
            if its.kind == other.kind and ahead.endswith(head) and not (tail or _GOES_ELSEWHERE.match(behind)):
                yield wrong.start, right.start, ""
        elif ahead.endswith(head) and behind.lstrip().startswith(tail):
            yield wrong.start, right.start, ""  # "without 3, uh, without 4", "2, no, 3 Mbit/s"
