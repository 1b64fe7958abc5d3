"""A sentence as it is meant: spelt as it was said, its shares worked out, without what it takes back.

Dictation misspells: "thirty dee bee em" is dBm, "twenty what's" are watts, "user to gets" is user 2. Which words are
heard for which is data (``figures/<language>.toml``, ``[heard]``): anywhere, right behind a number, ahead of a unit,
right behind a noun of users, and there only where no more names them: "each user to", "limit user to 2 Mbit/s" are
none. What is taken back is blanked, as is what says nothing: what fills a pause, a word or a figure said again.
"""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Iterator, Mapping
from decimal import Decimal

from wirelessagent.language.mentions import (
    ANY_NOUN,
    GIVEN_TO,
    JOINT_WORDS,
    MOST_USERS,
    WORD_NUMBER,
    is_of_each,
    mentions,
    named,
)
from wirelessagent.language.number_words import whole
from wirelessagent.language.numerals import NUMBERED, Number, factors, numbers
from wirelessagent.language.shares import worked_out
from wirelessagent.language.text import AND, WORD, Span, clause_start, normalise, overlaps, replaced, written_over
from wirelessagent.language.units import unit_at
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
    """Whether what stands at a place may be what is only heard "behind_numbers", "ahead_of_units" or "in_lists"."""
    if name == "ahead_of_units":
        return unit_at(plain, end) is not None or _CARRIER_BEHIND.match(plain, end) is not None
    if name == "in_lists":
        more, last = _ITEM_BEHIND.match(plain, end), _JOINS.match(plain, start)
        listed = last or (more and unit_at(plain, more.end()) is None)
        return bool(listed and _ITEMS_AHEAD.search(plain, 0, start))
    return name != "behind_numbers" or len(plain[:start].rstrip()) in {number.end for number in numbers(plain)}


@functools.cache
def _misheard(name: str, language: str) -> re.Pattern[str]:
    words: Mapping[str, str] = table("figures", language)["heard"][name]
    said = rf"(?P<said>{'|'.join(sorted(map(re.escape, words), key=len, reverse=True))})(?![A-Za-zÀ-ÿ0-9'])"
    if name == "behind_nouns":
        return deferred(rf"(?i)(?<![A-Za-zÀ-ÿ]){ANY_NOUN}\s*+{said}")
    if name != "behind_users":
        return deferred(rf"(?i)(?<![A-Za-zÀ-ÿ'])(?:{said})")
    ahead = "|".join(table("figures", language)["users"]["heard_ahead"])
    behind, bound = ("|".join(table("figures", language)["users"][f"heard_{name}"]) for name in ("behind", "bound"))
    follows = rf"(?=\s+(?:{behind})\b|\s*(?:$|[,;.])|(?<!to)(?<!too)\s+(?:{bound})\b)"  # "limit user to at most"
    return deferred(rf"(?i)(?:^|[,;.]\s*|\b(?:{ahead})\s+)user\s+{said}{follows}")


_DIGIT = "一二两三四五六七八九十"
_NUMBER = rf"(?:(?<![A-Za-z0-9.,])[0-9]+(?:[.,][0-9]+)?|\b{WORD_NUMBER}\b|(?<![{_DIGIT}])[{_DIGIT}]{{1,3}}+)"
_BREAK = r"\s*+(?:[,;\uff0c；、啊哎哦唉]|[-–—…]++|\.{2,3}+)\s*+"
_CARRIER_BEHIND = deferred(rf"(?i)\s*{any_word('figures', 'grouped', 'carriers')}\b")
_ITEMS_AHEAD = deferred(rf"(?i){ANY_NOUN}\s+{_NUMBER}(?:\s*,?\s*{_NUMBER})*\s*,?\s*$")
_JOINS = deferred(rf"(?i)(?:{AND})\b")
_ITEM_BEHIND = deferred(rf"(?i)\s*,?\s*(?:(?:{AND})\s+)?{_NUMBER}")
_CORRECTS, _MEANS, _PREFERS, _WAITS = (
    either("figures", "one", name) for name in ("corrects", "means", "prefers", "waits")
)
_JOINT = rf"(?:{JOINT_WORDS}|\b{any_word('figures', 'users', 'to')}\b|[~/&+、到至和与]|(?<=[0-9])[-–](?=[0-9]))"
_FILLED, _CONFIRMS = (either("figures", "one", name, number=WORD_NUMBER) for name in ("fillers", "confirms"))
_TOKEN = rf"(?>{WORD})"
_PAUSE = rf"(?:(?:{_FILLED})\s*+|{_BREAK})"
_RETURN = deferred(  # what stands between a figure and the one that takes its place: words of either, what takes back
    rf"(?i)(?P<tail>(?:\s*+{_TOKEN}){{0,4}}?)\s*+(?P<back>(?P<pause>{_PAUSE}*+)(?P<said>(?P<means>{_MEANS})|{_CORRECTS})"
    rf"(?P<more>(?:\s*+(?:{_PAUSE}|{_CORRECTS}|{_MEANS}|是))*+)\s*+)(?P<head>(?:{_TOKEN}\s*+){{0,5}}?)"
)
_AGAIN = deferred(  # what stands between a figure and the same figure: "fourteen watts yes fourteen"
    rf"(?i)\s*+号?(?:\s*+(?:{_PAUSE}|(?P<yes>{_CONFIRMS})))*+\s*+(?P<head>(?:{_TOKEN}\s*+){{0,3}}?)"
)
_BACK = deferred(
    rf"(?i)(?:\s*+{_TOKEN}){{0,3}}?\s*+{_PAUSE}*+(?P<said>{_CORRECTS})(?P<more>(?:\s*+(?:{_PAUSE}|{_CORRECTS}|{_MEANS}|是))*+)"
)
_TAKES_BACK = deferred(
    rf"(?i){_PAUSE}*+(?P<said>{_MEANS}|{_CORRECTS})(?P<more>(?:\s*+(?:{_PAUSE}|{_CORRECTS}|{_MEANS}|是))*+)"
)
_BREAK_BEHIND = deferred(_BREAK)
_INSTEAD = deferred(
    rf"(?i)(?:\s*{_TOKEN}){{0,3}}?\s*[,\uff0c]?\s*(?P<instead>(?:{either('figures', 'one', 'instead_of')})\s*)"
)
_BOUND_BEHIND = "|".join(either("figures", "bounds", name) for name in ("at_least_behind", "at_most_behind"))
_WEIGHT_AHEAD = deferred(rf"(?i)(?:{either('figures', 'users', 'weighs')})\s*$")
_ENDED = deferred(r"\s*(?:$|[,.;:!?)\uff0c\uff1b。、](?![0-9]))")
_GOES_ON = deferred(rf"(?i){_ENDED.pattern}|\s+(?:{AND})\b(?!\s*{_NUMBER})")
_ENDS = deferred(rf"(?i)(?:\s*(?:{_FILLED}))*(?:{_GOES_ON.pattern.removeprefix('(?i)')})")
_NOT_AHEAD = deferred(
    rf"(?i)(?:^|[\s,;:.\uff0c。；])(?P<denies>(?:{either('figures', 'one', 'not_who')})\s*(?:{GIVEN_TO}\s*)*)$"
)
_BUT_BEHIND = deferred(
    rf"(?i)\s*号?(?P<but>{either('figures', 'one', 'but_who')})\s*(?:{GIVEN_TO}\s*)*(?:{ANY_NOUN}\s*)?"
    rf"(?:[0-9]+(?![0-9.,]*[0-9]|\s*%)|{WORD_NUMBER}\b)(?!\s*\w*(?:carrier|träger|portadora|porteuse))"
)
_SURELY_A_RATE, _DENIES = 20, ("no", "non", "不", "不是")
"""From where on a whole number without a unit is nobody's, and words that deny what follows as often as they take back
what stands before, when they stand alone."""
_GOES_ELSEWHERE = deferred(rf"(?i)\s*(?:给|对|(?!(?:{AND})\b|{_BOUND_BEHIND})[A-Za-zÀ-ÿ])")
_ANOTHER_USER = deferred(rf"(?i){ANY_NOUN}")
_OF_USERS = deferred(rf"{NUMBERED.pattern}|{GIVEN_TO}\s*$")
_GIVEN_AHEAD = deferred(rf"(?i)(?:\s*{GIVEN_TO})+\s*$")
_LIST_AHEAD = deferred(rf"(?i){_NUMBER}\s*号?\s*(?:,\s*)?(?:{_JOINT}|,)\s*(?:{GIVEN_TO}\s*)?(?:{ANY_NOUN}\s*)?$")
_LIST_BEHIND = deferred(rf"(?i)\s*号?\s*{_JOINT}\s*(?:{GIVEN_TO}\s*)?(?:{ANY_NOUN}\s*)?{_NUMBER}")


def without_corrected(text: str) -> str:
    """The sentence without what it takes back, all else at its place.

    >>> " ".join(without_corrected("user 6 at least 1, no, 2 Mbit/s").split())
    'user 6 at least 2 Mbit/s'
    >>> " ".join(without_corrected("for user 3 - sorry, I mean user 5 - 1 Mbit/s").split())
    'for user 5 - 1 Mbit/s'
    """
    plain = normalise(text)
    done = list[tuple[int, int]]()
    for start, end, instead in (change for rule in _RULES for change in rule(plain)):
        if not overlaps((start, end), done):  # "14 watts uh no 13 watts": one is taken back, and not the other, too
            text = written_over(text, start, end, instead)
            done.append((start, end))
    left = _fillers(language_of(text)).sub(lambda match: " " * len(match[0]), text)
    return text if left.isspace() else left


def taking_back(plain: str) -> Iterator[Span]:
    """Where words stand that take back what is no figure: "no wait", "不对"; a lone "no" denies, "uh" fills a pause.

    >>> list(taking_back("least power, no, wait, max rate, no user 3, uh"))
    [(11, 23)]
    """
    for match in _TAKES_BACK.finditer(plain):
        said, filled = match["said"].casefold(), plain.endswith("   ", 0, match.start("said"))  # "euh non"
        more = match["more"].strip(" ,;\uff0c；、-–—….")
        if re.fullmatch(_PREFERS, said) and not plain[match.start() : match.start("said")].strip():
            continue  # "el mejor caudal"
        if more.casefold().endswith(_DENIES) or (re.fullmatch(_WAITS, said) and not more):
            continue  # "sorry, no min power", "max rate, wait, least power matters, too"
        loose = said.split()[0] not in _DENIES and not said.startswith("不")
        broken = match["more"].strip() or _BREAK_BEHIND.match(plain, match.end())
        if loose and not broken:
            continue  # "scrap that least power setting"
        if filled or more or (said not in _DENIES and not re.fullmatch(_FILLED, said)):
            yield match.span()


@functools.cache
def _fillers(language: str) -> re.Pattern[str]:
    """What fills a pause in a language and says nothing, with a comma behind, and the first of a word said twice."""
    words, twice = ("|".join(table("figures", language)["one"].get(name, ["(?!)"])) for name in ("fillers", "twice"))
    words = words.replace("{number}", WORD_NUMBER)
    return deferred(
        rf"(?i)(?<![A-Za-zÀ-ÿ'])(?:(?:{words})(?![A-Za-zÀ-ÿ'])(?:\s*[,\uff0c])?|(?P<twice>{twice})(?=\s+(?P=twice)(?![\w'])))"
    )


def _confirmed(plain: str) -> Iterator[tuple[int, int, str]]:
    """What is only said once more, with the words that say so: "14 W, yes, 14", "fourteen, yes, fourteen watts"."""
    for one, other in itertools.pairwise(numbers(plain)):
        its, unit = unit_at(plain, one.end), unit_at(plain, other.end)
        end, last = (its.end if its else one.end), (unit.end if unit else other.end)
        again = _AGAIN.fullmatch(plain, end, other.start) if one.value == other.value is not None else None
        if again is None or (its is not None and unit is not None and its.kind != unit.kind):
            continue
        head = again["head"].casefold().strip()
        elsewhere = _ENDS.match(plain, last) is None  # "2 W, yes, 2 W for the circuits"
        counted = unit is None and _ANOTHER_USER.match(plain[last:].lstrip()) is not None  # "yes 2 users are out"
        alone = its is not None is not unit and not head  # "14 watts 14 watts"
        if elsewhere or counted or not (again["yes"] or alone):
            continue
        user = its is unit is None and _OF_USERS.search(plain, 0, one.start) and _ANOTHER_USER.fullmatch(head or "user")
        if (its is not None and not head) or user:
            yield end, last, ""


def _said_again(plain: str) -> Iterator[tuple[int, int, str]]:
    """What is said of one user and then of another instead: "2 Mbit/s for user 4, no, wait, 2 Mbit/s for user 7"."""
    measured = [(number, unit) for number in numbers(plain) if (unit := unit_at(plain, number.end))]
    users = list(named(plain)) if len(measured) > 1 else []
    for (one, its), (other, unit) in itertools.pairwise(measured):
        again = _BACK.match(plain, its.end) if one.value == other.value and its.kind == unit.kind else None
        if again is None or (not again["more"] and again["said"].casefold() in _DENIES):
            continue
        ahead = [each for each in users if clause_start(plain, one.start) <= each.start < one.start]
        behind = [each for each in users if again.end() <= each.start < other.start]
        if len(behind) == 1 and ahead:
            before, between = plain[again.end() : behind[0].start], plain[behind[0].end : other.start]
            same = behind[0].users == ahead[-1].users  # "user 8 at least, no wait, user 8 at most 1 Mbit/s"
            alike = same or between.split() == plain[ahead[-1].end : one.start].split()
            if alike and plain[: ahead[-1].start].casefold().rstrip().endswith(before.casefold().strip()):
                yield ahead[-1].start, again.end(), ""


def _not_meant(plain: str) -> Iterator[tuple[int, int, str]]:
    """Figures that others are said to stand for: "15 W, and not 14", "11 W statt 10 W"."""
    for one, other in itertools.pairwise(numbers(plain)):
        its, unit = unit_at(plain, one.end), unit_at(plain, other.end)
        said = _INSTEAD.fullmatch(plain, its.end, other.start) if its is not None else None
        end = other.end if unit is None else unit.end
        alike = its is not None and (unit is None or unit.kind == its.kind)
        if said is not None and alike and _GOES_ON.match(plain, end):
            yield said.start("instead"), end, ""


def _not_who(plain: str) -> Iterator[tuple[int, int, str]]:
    """Users whom others are said to stand for, before more is said: "not user 3 but user 2 …", "不是用户5，是用户6…".

    Where everybody was named before, it is an exception.
    """
    for each in named(plain):
        ahead, behind = _NOT_AHEAD.search(plain, 0, each.start), _BUT_BEHIND.match(plain, each.end)
        if ahead is None or behind is None or unit_at(plain, behind.end()) is not None:
            continue
        goes_on = any(map(str.isalpha, plain[behind.end() :]))
        if goes_on and not any(m.role == "everybody" and m.end <= each.start for m in mentions(plain)):
            yield ahead.start("denies"), behind.end("but"), ""


def _is_users(plain: str, number: Number, *, measured: bool) -> bool:
    """Whether a number may be a user's; where one with a unit takes its place, only what has just been given one is."""
    if (number.value or 0) >= MOST_USERS or is_of_each(plain, number.start):
        return False
    given = _GIVEN_AHEAD.search(plain, 0, number.start)
    to_whom = given is not None and (
        not measured or any((unit := unit_at(plain, each.end)) and unit.end == given.start() for each in numbers(plain))
    )
    return to_whom or NUMBERED.search(plain, 0, number.start) is not None


def _is_a_figure(number: Number) -> bool:
    """Whether a number without a unit is surely nobody's: "four hundred", "one point five"."""
    value = number.value or 0
    return value != int(value) or value >= _SURELY_A_RATE


def _counted(plain: str) -> list[Number]:
    """The numbers of a text, and the users whom an article names: "sans l'utilisateur un"."""
    found = list(numbers(plain))
    for each in named(plain):
        start = each.end - len(plain[each.start : each.end].split()[-1])
        by_word = len(each.users) == 1 and str(whole(plain[start : each.end])) == each.users[0]
        if by_word and not overlaps((start, each.end), ((number.start, number.end) for number in found)):
            found.append(Number(value=Decimal(each.users[0]), start=start, end=each.end, form="foreign"))
    return sorted(found, key=lambda number: number.start)


def _taken_back(plain: str) -> Iterator[tuple[int, int, str]]:
    """The spans of numbers in whose place the next one stands, with the words that say so, and what is to stand there.

    Words between stand ahead of the first as well, or behind the second: "at least 4 Mbit/s each, no, 5 Mbit/s each".
    A figure without a unit in the place of one that has it gets the unit, where it is nobody's number. What of a list
    is taken back, nobody knows: "users 1 and 2, no, 3".
    """
    times = list(factors(plain))
    spans = [(each.start, each.end) for each in times]
    all_said = _counted(plain)
    counted = (each for each in all_said if not overlaps((each.start, each.end), spans))
    multiples = itertools.pairwise(sorted((*times, *counted), key=lambda each: each.start))
    pairs = [*itertools.pairwise(all_said), *((a, b) for a, b in multiples if a.form == b.form == "times")]
    for wrong, right in pairs:
        its, other = (unit_at(plain, each.end) if each.form != "times" else None for each in (wrong, right))
        said = _RETURN.fullmatch(plain, its.end if its else wrong.end, right.start)
        listed = _LIST_AHEAD.search(plain, 0, wrong.start) if other is None or not (said and said["head"]) else None
        if said is None or wrong.value == right.value or listed is not None:
            continue
        ahead, behind = plain[: wrong.start].casefold().rstrip(), plain[other.end if other else right.end :].casefold()
        head, tail = said["head"].casefold().strip(), said["tail"].casefold().strip()
        user = plain[wrong.end : wrong.end + 1] in ("号", "號") or _is_users(plain, wrong, measured=other is not None)
        repeated = ahead.endswith(head) or (user and _ANOTHER_USER.fullmatch(head) is not None)
        doubled = any(map(str.isalpha, said["pause"] + said["more"]))
        figure = (
            its is None
            and other is not None
            and not user
            and not said["pause"].strip()
            and (repeated if head else _is_a_figure(wrong))
        )
        if not (doubled or said["more"] or figure) and said["said"].casefold() in _DENIES:
            continue  # "no service to 6, no service to 7", "con 10 W, no 20 W", but "four hundred no five hundred kbps"
        if its is not None and other is None:
            value = right.value or 0
            if not head and (value != int(value) or value >= _SURELY_A_RATE) and _ENDED.match(plain, right.end):
                unit = plain[wrong.end : said.start("back")].rstrip()
                yield wrong.start, right.end, plain[right.start : right.end] + unit
        elif its and other and its.kind == other.kind and tail and not head and _GOES_ON.match(behind):
            yield wrong.start, other.end, f"{plain[right.start : other.end]}{said['tail']}"  # "1 W each, no, wait, 2 W"
        elif repeated and behind.lstrip().startswith(tail):
            # "without 3, uh, without 4", "al 3 no, al 8"
            counts = head and said["said"].casefold() not in _DENIES and not re.fullmatch(_FILLED, said["said"])
            weighed = its is other is None and not user and _WEIGHT_AHEAD.search(plain, 0, wrong.start) is not None
            paused = said["pause"] or said["means"] or doubled or counts or (wrong.value or 0) >= MOST_USERS or weighed
            measured = other is not None and not user and (its is None or its.kind == other.kind)
            measured |= wrong.form == right.form == "times"
            if measured and its is not None and not tail:
                # "1 Mbit/s each, rather 2 Mbit/s for user 3", "10 W, hold on, 8 W is the circuit power"
                measured = _GOES_ELSEWHERE.match(behind) is None
            able = not user or head or (right.value or 0) < MOST_USERS
            alike = its is other and able and paused and (head or tail or weighed or not said["means"])
            if measured or (alike and _LIST_BEHIND.match(plain, right.end) is None):
                denied = _NOT_AHEAD.search(plain, 0, wrong.start) if measured else None  # "not 15 W, I mean 13 W"
                yield denied.start("denies") if denied else wrong.start, right.start, ""


_RULES = (_said_again, _taken_back, _confirmed, _not_meant, _not_who)
