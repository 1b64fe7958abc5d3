"""Who is spoken of: named users, everybody, and the others, in every language that the recogniser reads.

A reference is what the operator says: "3" for "user 3", "users 1 to 3" are ("1", "2", "3"). Names of the channel's own
users count as they are. Whether a user is to be served, left out or promised something is not decided here.

A user or a figure that the next words take back ("for user 3, sorry, user 5", "at least 1, no, 2 Mbit/s") is blanked
before anybody reads the sentence; everything else stays where it stands, but a unit that the next figure borrows.
"""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from wirelessagent.language.number_words import cardinals, listed, tens_and_ones, whole
from wirelessagent.language.numerals import TIGHT_LIST, chinese_value
from wirelessagent.language.text import AND, Phrases, clause_start, is_chinese, overlaps
from wirelessagent.language.units import unit_at
from wirelessagent.language.word_tables import any_word, deferred, either, words_of

Role: TypeAlias = Literal["named", "everybody", "others", "pronoun"]

ORDINALS = {word: str(place) for word, place in listed("ordinals").items()}
_NUMBER_WORDS = {word: value for word, value in cardinals(1, 20).items() if word != "once"} | {"un": 1}

NOUN, _EACH = any_word("figures", "users", "nouns", "things"), any_word("figures", "users", "each")
_ORDINAL = f"(?:{'|'.join(sorted(ORDINALS, key=len, reverse=True))})"
WORD_NUMBER = f"(?:{tens_and_ones()}|{'|'.join(sorted(_NUMBER_WORDS, key=len, reverse=True))})"
JOINT_WORDS, ARTICLES = (either("figures", "users", name) for name in ("joins", "articles"))
GIVEN_TO = rf"(?:{either('figures', 'users', 'given_to')}|{ARTICLES})"
_AND = rf"(?:\s*(?:,|&|\+|/)\s*(?:(?:{AND}|or)\s+)?|\s+(?:{JOINT_WORDS})\s+(?:(?:{ARTICLES})\s+)?)"
_TO = rf"(?:\s*(?:-|–|~|\.{{2,3}}|…)\s*|\s+{any_word('figures', 'users', 'to', 'as_far_as')}\s+)"
# "6 for user 2, 3 for user 3": no list of users, as "1 and 5 to have …", "1 to 4 for now" are
_OF_ITS_OWN = rf"(?!\s+{either('figures', 'users', 'of_its_own')}\s)"
_NUMBER_NOUN = any_word("figures", "users", "number")
_NO = rf"(?:(?:no|nr|num|núm)\.?|n[°º]|#|{_NUMBER_NOUN})"
_DIGITS = r"[0-9]{1,4}(?!(?!\.\.)[0-9.,]*[0-9%]|[A-Za-z])"
_WORD_LIST = rf"{WORD_NUMBER}\b(?:(?:{_AND}|{_TO}){WORD_NUMBER}\b)*"
_SPACED = (  # "users 1 2 3", and nothing that is counted behind
    rf"(?<=s )[0-9]{{1,2}}(?:\s+[0-9]{{1,2}}){{1,11}}(?:\s+{AND}\s+[0-9]{{1,2}})?(?![0-9.,]*[0-9%]|\s+[0-9])"
    rf"(?!\s*(?!{any_word('figures', 'users', 'goes_on')}\b)[A-Za-zμ%×*^/])"
)
_ENDS_THERE = rf"(?!\s+(?:{'|'.join(listed('scales'))}|point|and\s+an?\s|coma|y\s+medi|virgule|et\s+demi|komma)\b)"
"""Behind a number in words that does not go on."""
_SPACED_WORDS = (  # "users one three and four", and no number goes on behind
    rf"(?:(?<=s )|(?<=utzer )){WORD_NUMBER}(?:\s+{WORD_NUMBER})+(?:\s+{AND}\s+{WORD_NUMBER})?\b{_ENDS_THERE}"
)
_LIST = (
    rf"(?:{_SPACED}|{_SPACED_WORDS}|"
    rf"(?:{TIGHT_LIST}|{_DIGITS})(?:(?:{_AND}|{_TO})(?:{_NO}\s*)?{_DIGITS}{_OF_ITS_OWN})*|{_WORD_LIST})"
)
_OPENS = rf"\s*(?::\s*(?={_DIGITS}{_AND}{_DIGITS})|[\[({{{{]\s*(?=[0-9]))"  # "users: 1, 2", "users {{1, 2}}"
_ONE_USER = "|".join(f"(?<= {word} )|(?<=^{word} )" for word in words_of("figures", "users", "before_one"))
"""Articles ahead of "un" or "uno" where that can only be user 1: "le un et le six", "al uno"."""
_BOUND = r"(?:≥|≤|>=?|<=?|=|min\.?|max\.?|at (?:least|most))"
_NAMED = Phrases(
    rf"(?<![A-Za-z0-9]){NOUN}(?:[\s_]*|-|\s-\s)(?:ids?\s*|{_NO}\s*|(?:del?|from|von)\s+(?=[0-9]{{1,3}}{_TO})|{_OPENS})?\s*(?P<list>{_LIST})"
    rf"|(?:(?<=[,;])|(?<=[,;] ))(?P<colon>{_DIGITS}(?:(?:{_AND}|{_TO}){_DIGITS})*)(?=\s?:\s*(?:{_BOUND}\s*)?[0-9])"
    rf"|(?<![A-Za-z0-9])(?:u|ue|n(?=[1-9](?:\s*(?:[:=≥≤<>]|,\s*n[1-9]|(?:und|je)\b)|\s+[0-9])))(?P<short>[0-9]{{1,4}})(?![A-Za-z0-9])"
    rf"|(?<![A-Za-z])[RrWw]_?\{{?(?P<symbol>[0-9]{{1,2}})\}}?(?=\s*(?:[=≥≤<>∈]|\.\.))"
    rf"|(?<![A-Za-z0-9])r(?P<rate_of>[0-9]{{1,2}})(?![A-Za-z0-9.])|"
    rf"#\s?(?P<hash>[0-9]{{1,4}}(?:{_AND}#?\s?[0-9]{{1,4}})*)"
    rf"|(?<![A-Za-z])(?:{_NUMBER_NOUN}|no\.)\s+(?P<number>{_LIST})"
    rf"|(?<![A-Za-z])(?P<ordinal>{_ORDINAL})\s+{NOUN}(?![A-Za-z])"
    rf"|(?:{_ONE_USER})(?P<one>uno?|eins)"
    r"(?!\w|\s+(?:por|pour|de|virgule|komma|coma|punto|point|et demi|y medio)\b|\s*%)"
)
_ZH_NUMBER = r"(?:[0-9]{1,4}|[一二三四五六七八九十]{1,3})"
ZH_NOUN = r"(?:用户|終端|终端|用戶|UE|ue|客户|客戶|订户|设备|手机|节点)"
ANY_NOUN = rf"(?:{NOUN}|{ZH_NOUN})"


_ZH_JOINT = r"\s*号?\s*(?:、|,|\uff0c|和|与|跟|及|以及|到|至|-|~)\s*|\s+(?=[0-9]{1,2}(?:\s+[0-9]{1,2})*\s*号)"
_ZH_LIST = "[0-9]{3,4}|" + "|".join(
    rf"{number}(?:(?:{_ZH_JOINT}){number}|\s*号\s*{number}(?=\s*号))*"
    for number in ("[0-9]{1,2}(?![0-9])", "[一二三四五六七八九十]{1,7}")
)
_ZH = deferred(
    rf"(?<!其他)(?<!其它)(?<!其余)(?:{ZH_NOUN}\s*(?P<after>{_ZH_LIST})(?!\s*[个名位台户兆瓦百千点起样直定边次共切致]|下(?!限))号?)"
    rf"|(?<![权重乘取为=.0-9月])(?!(?:(?<=[设是给算为])|(?<=[是为] ))[0-9]{{1,4}}\s*[,\uff0c]|"
    rf"(?<=[第之]){_ZH_NUMBER}\s*[,\uff0c、])(?P<hao>{_ZH_LIST})\s*[号號](?!线|楼|院|机房|站|小区|基站|人|桌|门|馆|店|厅|早|晚)\s*{ZH_NOUN}?"
    rf"|(?<!倒数)第\s*(?P<nth>{_ZH_NUMBER})\s*[个位名]\s*{ZH_NOUN}"
    r"|(?<![零〇一二两三四五六七八九十百千万亿点0-9])(?![一二三四五六七八九]*?(?P<again>[一二三四五六七八九])[一二三四五六七八九]*(?P=again))(?P<run>[一二三四五六七八九]{3,8})号?"
    r"(?![零〇一二两三四五六七八九十百千万亿点半兆瓦毫kKM0-9]|[个位名])"  # 三四六八 is no number
)
_OTHERS = Phrases(
    either("figures", "users", "others"),
    marks="else other rest remain those otr demás qued autre ander übrig verbleib 其 剩 余 另 别 旁",
)
_EVERYBODY = Phrases(
    rf"{either('figures', 'users', 'everybody')}|"
    rf"\b(?:(?:per|(?<!is )(?<!as )(?<!was )a|/)\s?(?:{_EACH}|capita)|{any_word('figures', 'users', 'by')} {_EACH})\b"
)
_PRONOUN = Phrases(either("figures", "users", "pronouns"))
_FEW = rf"(?:[0-9]{{1,2}}|{WORD_NUMBER}|beiden)"
_ON = either("figures", "users", "from_on")
_ENDS = {name: f"(?:{either('figures', 'users', name)})" for name in ("first", "last")}
_UNIT = r"%|(?:[kmg]|mega|kilo|giga)?(?:bit|bps|b/s)|[km]\b|m?w\b|(?:milli)?watt|db|megs?\b|兆|瓦"
_COUNTS_OTHERS = (
    rf"\s+(?:{any_word('figures', 'grouped', 'carriers', 'groups')}|{any_word('figures', 'times', 'units')}|"
    rf"{either('figures', 'users', 'more')})(?!\w)"
)
COUNTS_OTHERS = deferred(f"(?i){_COUNTS_OTHERS}")
"""What is behind a number that counts something else: "user 3 and 4 subcarriers per block"."""
PLACED = {
    "noun": NOUN, "ordinal": _ORDINAL,
    "digits": rf"[0-9]{{1,3}}(?![0-9.,]*[0-9]|\s?(?:{_UNIT}))",
}  # fmt: skip
"""What stands in the places of lists of users: nouns, ordinals, and numbers with no unit behind."""
BY_PLACE = Phrases(
    "|".join(
        [
            *(
                f"(?P<{name}>{either('figures', 'users', name, **PLACED)})"
                for name in ("odd", "even", "nth", "from_here", "past", "up_to", "before")
            ),
            *(f"(?P<{name}_>{either('figures', 'users', f'{name}_too')})" for name in ("odd", "even")),
            rf"(?P<all_of>{either('figures', 'users', 'all_of', few=_FEW)})(?!\s*(?:{_UNIT}|{NOUN})|{_COUNTS_OTHERS})",
            *(
                rf"(?:{end}\s+(?P<{name}>{_FEW})|\b(?P<{name}_>{_FEW})\s+{end})\s+{NOUN}(?![A-Za-z])|"
                rf"{end}\s*(?P<{name}__>[0-9]{{1,2}}|[一二两三四五六七八九十])\s*[个位名]\s*{ZH_NOUN}|"
                rf"(?P<{name}___>{either('figures', 'users', f'{name}_few', few=_FEW)})"
                for name, end in _ENDS.items()
            ),
            rf"(?:(?<![A-Za-z0-9]){NOUN}|{ZH_NOUN})\s*(?P<from>[0-9]{{1,3}})\s*(?:{_ON}|\+(?!\s*(?:[0-9]|{NOUN})))",
        ]
    )
)
"""Users by where they stand among all; which ones they are, the cell's size says."""
_TOO = {"odd_": "even", "even_": "odd"}
"""Odd or even ones that only others make users: "odd users at most 2 Mbit/s, even at most 1"."""
JOINT = deferred(
    rf"(?i)\s*(?:,|、|\uff0c|&|/|和|与|跟|及|以及|{JOINT_WORDS}|\s)+\s*(?:(?:also|{ARTICLES})\s+)?(?:l'|à\s+l')?"
)
LISTED = deferred(  # between the figures of a list
    rf"(?i)\s*(?:[,;、\uff0c]|{JOINT.pattern.removeprefix('(?i)')}|,?\s*(?:and then|beziehungsweise|bzw\.?|"
    r"respectively))\s*"
)
_OUT_OF, _AMONG, _RANGED, _INCLUDED, _EXCEPT, _BUT, _EXCEPTED_BEHIND = (
    f"(?:{either('figures', 'users', name)})"
    for name in ("out_of", "among", "ranged", "included", "excepted", "but", "excepted_behind")
)
_OUT_OF_THOSE, _RANGED_AHEAD = deferred(rf"(?i)\s*(?:{_OUT_OF}|{_AMONG})'?\s*"), deferred(rf"(?i){_RANGED}'?\s*$")
_FROM_ONE_TO = deferred(rf"(?i)\s*(?!{_OUT_OF}){_AMONG}")
EXCEPTED = deferred(rf"(?i)(?:{_EXCEPT}|{_BUT})\s*(?:{GIVEN_TO}\s*)*(?:l')?$")
SOMEBODY, _OTHER = (
    rf"\s*(?:{GIVEN_TO}\s*)*(?:l')?(?:{ANY_NOUN}\s*)?(?:{_NO}\s*)?(?P<{name}>{_LIST}|{_ZH_LIST})\s*号?"
    for name in ("one", "other")
)
_BUT_FOR = deferred(
    rf"(?i)\s*号?\s*[,(\uff0c]?\s*(?:(?:{_EXCEPT}){SOMEBODY}|{_OTHER}\s*{_EXCEPTED_BEHIND})\s*(?:外|\))?"
)
_ALL_BUT = deferred(rf"(?i)(?:{_EXCEPT})(?P<other>){SOMEBODY}(?:以?外|之外)?\s*[,\uff0c的]?\s*(?:{GIVEN_TO}\s*)*$")
WHO = deferred(
    rf"(?i)\s*(?:{_EXCEPTED_BEHIND})?\s*[,(\uff0c]?\s*(?:{either('figures', 'users', 'relative')})[^,;.()\uff0c；。]*"
)
"""What more is said of somebody excepted: "all but user 5, who needs 1 Mbit/s, …"."""
NOBODY = Phrases(either("figures", "users", "nobody"))
_INCLUSIVE = deferred(rf"(?i)(?:\s*[,(\uff0c]?\s*{_INCLUDED}\s*\)?,?)?\s*")
_BEFORE_EACH = deferred(rf"{_INCLUSIVE.pattern},?\s*(?:(?:{either('figures', 'users', 'takes')})\s+)?")
_EACH_OF = deferred(rf"(?i)(?:{either('figures', 'users', 'each_of')})\s*{ANY_NOUN}?\s*(?:from|de|von|entre)?\s*$")
_LONGEST_RANGE, _NEAR, MOST_USERS = 100, 25, 100
"""How many users a range may have, how near what leaves out stands, and how small the number of a user is."""
_UP_TO = deferred(rf"(?i)\s*号?(?:{_TO}(?:l')?(?:{_NO}\s*)?|\s*[到至]\s*)")
_ITEM = deferred(rf"(?i)[0-9]+|\b{_ORDINAL}\b|\b{WORD_NUMBER}\b|[一二三四五六七八九十]+")
_AND_BETWEEN = deferred(r"(?i)[a-z和与跟及&/、]")
_LAST_COMMA = deferred(rf"(?i)\s*[,\uff0c]\s*(?:(?:{AND}|e)\s+)?(?=[^,\uff0c]*$)")
WITHOUT = Phrases(either("figures", "users", "without"))
_GOES_ON = deferred(rf"(?i)\s*(?:$|[=≥≤<>:,.;!?、\uff0c。；]|(?:{AND}|or)\b|和)")


@dataclass(frozen=True, kw_only=True)
class Mention:
    """Somebody named at characters [start, end); ``users`` as the operator refers to them, () unless named."""

    role: Role
    users: tuple[str, ...]
    start: int
    end: int


def mentions(plain: str, names: Sequence[str] = (), taken: Sequence[tuple[int, int]] = ()) -> list[Mention]:
    """Everybody spoken of in a normalised sentence, from left to right, where no ``taken`` span is.

    >>> [(m.role, m.users) for m in mentions("user 3 and user 5 get 1 Mbit/s, everyone else less")]
    [('named', ('3', '5')), ('others', ())]
    """
    found: list[Mention] = []
    spoken_of = _spoken_of(plain)
    for mention in [*_own_names(plain, names), *_placed(plain, len(names), spoken_of), *spoken_of]:
        if not overlaps((mention.start, mention.end), [*taken, *((other.start, other.end) for other in found)]):
            found.append(mention)
    return merged(plain, sorted(found, key=lambda mention: mention.start))


def _placed(plain: str, count: int, spoken_of: Sequence[Mention]) -> Iterator[Mention]:
    """Users by their place, with the list of the same behind: "the odd-numbered users 1, 3, 5 and 7"."""
    for each in _by_place(plain, count):
        lists = (other for other in spoken_of if {*other.users} == {*each.users} and each.start < other.end)
        near = (other for other in lists if other.start <= each.end or not plain[each.end : other.start].strip())
        yield replace(each, end=max((other.end for other in near), default=each.end))


def _own_names(plain: str, names: Sequence[str]) -> Iterator[Mention]:
    for name in sorted(names, key=len, reverse=True):
        if re.fullmatch(r"(?i)(?:user|ue)?[\s_-]*[0-9]+", name) or len(name) < 2:
            continue  # "user 3" is read as any other number
        for match in re.finditer(rf"(?i)(?<![^\W_]){re.escape(name)}(?![^\W_])", plain):
            yield Mention(role="named", users=(name,), start=match.start(), end=match.end())


@functools.lru_cache(maxsize=64)
def _by_place(plain: str, count: int) -> tuple[Mention, ...]:
    """Users by an odd or an even number, every second, the first or the last few, and from one on or up to one.

    Most need to be counted.
    """
    matches, found = list(BY_PLACE.finditer(plain)), list[Mention]()
    for match in matches:
        group, words = next((name, words) for name, words in match.groupdict().items() if words)
        if group in _TOO and not any(other[_TOO[group]] for other in matches):
            continue
        if group.endswith("___") and any(len(each.users) > 1 and each.end <= match.start() for each in named(plain)):
            continue  # "users 5 to 8, the first two at 1 Mbit/s"
        said = [number for part in _ITEM.finditer(words) if (number := _number(part.group())) is not None]
        number = max(said, default=2)
        first, last, step = {
            "odd": (1, count, 2), "even": (2, count, 2), "nth": (max(number, 2), count, max(number, 2)),
            "first": (1, number, 1), "all_of": (1, count if number == count else 0, 1),
            "last": (count - number + 1, count, 1), "up_to": (1, number, 1),
            "before": (1, number - 1, 1), "past": (number + 1, count, 1), "from": (number, count, 1),
            "from_here": (number, count, 1),
        }[group.rstrip("_")]  # fmt: skip
        if 0 < first <= last <= max(count, number):
            users = tuple(str(user) for user in range(first, last + 1, step))
            found.append(Mention(role="named", users=users, start=match.start(), end=match.end()))
    return tuple(found)


@functools.lru_cache(maxsize=64)
def _spoken_of(plain: str) -> tuple[Mention, ...]:
    """Everybody spoken of but by the channel's own names, as the patterns find them; they may overlap."""
    roles: Mapping[Role, Phrases] = {"others": _OTHERS, "everybody": _EVERYBODY, "pronoun": _PRONOUN}
    collective = (
        Mention(role=role, users=(), start=match.start(), end=match.end())
        for role, pattern in roles.items()
        for match in pattern.finditer(plain)
    )
    return (*named(plain), *collective)


def named(plain: str) -> Iterator[Mention]:
    """Everybody named by a number, as the patterns find them; they may overlap."""
    for match in (*_NAMED.finditer(plain), *_ZH.finditer(plain)):
        group = match.lastgroup or ""
        if group == "rate_of" and plain[match.start()] != "R":
            continue
        end = _without_quantity(plain, match, group)
        users = listed_users(plain[match.start(group) : min(end, match.end(group))])
        if users:
            yield Mention(role="named", users=users, start=match.start(), end=end)


def _without_quantity(plain: str, match: re.Match[str], group: str) -> int:
    """Where the list ends when its last number is no user: "users 1 and 2, 10 W"."""
    if group in ("ordinal", "short", "symbol", "rate_of", "nth"):
        return match.end()
    offset = match.start(group)
    parts = [
        (_number(part[0]) or 0, offset + part.start(), offset + part.end()) for part in _ITEM.finditer(match[group])
    ]
    for (one, _, end), (other, start, _) in itertools.pairwise(parts):  # "4, 6 and 7 to 1, 2 and 5 Mbit/s"
        if other < one and _UP_TO.fullmatch(plain, end, start):
            return end
    last = parts[-2][2] if len(parts) > 1 else offset  # where the list ends without its last number
    others = len(parts) > 1 and COUNTS_OTHERS.match(plain, parts[-1][2])  # "user 3 and 4 subcarriers per block"
    return last if others or unit_at(plain, parts[-1][2]) is not None else match.end()


def is_of_each(plain: str, start: int) -> bool:
    """Whether what begins here is said of each user: "each user 1 to 5 Mbit/s" names nobody."""
    return _EACH_OF.search(plain, max(0, start - 40), start) is not None


def listed_users(text: str) -> tuple[str, ...]:
    """The users of a list such as "1, 2 and 5" or "1 to 4"."""
    users: list[int] = []
    end = 0
    for part in _ITEM.finditer(text):
        word = part.group()
        user = _number(word)
        if user is None and is_chinese(word[0]):  # 一二七号
            *more, user = (int(chinese_value(digit) or 0) for digit in word)
            users.extend(more)
        if user is None:
            continue
        spans = users and _UP_TO.fullmatch(text, end, part.start())
        if spans and users[-1] < user < users[-1] + _LONGEST_RANGE:
            users.extend(range(users[-1] + 1, user))
        users.append(user)
        end = part.end()
    return tuple(dict.fromkeys(map(str, users)))


def _number(word: str) -> int | None:
    word = word.lower()
    if word.isdigit():
        return int(word)
    known = ORDINALS.get(word) or _NUMBER_WORDS.get(word)
    value = known or (chinese_value(word) if is_chinese(word[0]) else whole(word))
    return None if value is None else int(value)


_NOT = either("moods", "negation", "clause")
_OWN_BOUND = deferred(
    rf"(?i)\s+(?:{any_word('figures', 'bounds', 'at_least', 'at_most')}|"
    rf"(?:{_NOT})\s+{any_word('figures', 'bounds', 'above', 'below')})(?!\w)"
)
_OWN_WORDS = deferred(rf"(?i)[0-9]|(?:{either('figures', 'users', 'leaving')})\s*(?:{GIVEN_TO}\s*)*$")
_COUNTED_AGAIN = deferred(rf"号?这?(?P<count>[两二三四五六七八九十])[个位名](?:{ZH_NOUN})?")


def merged(plain: str, found: Sequence[Mention]) -> list[Mention]:
    """Neighbours that an "and" or a "to" joins made one: "user 3 and user 5", "UE 1 to UE 4"."""
    merged: list[Mention] = []
    for mention in found:
        last = merged[-1] if merged else mention
        between: list[str] | None = None
        again = {*mention.users} <= {*last.users}  # "to 1 and 6, 1 at least …"
        if merged and last.role == mention.role == "named" and not again and not _has_its_own(plain, last, mention):
            if _UP_TO.fullmatch(plain, last.end, mention.start):
                between = [*listed_users(f"{last.users[-1]} to {mention.users[0]}")]
            elif JOINT.fullmatch(plain, last.end, mention.start) and (
                _AND_BETWEEN.search(plain, last.end, mention.start) or _GOES_ON.match(plain, mention.end)
            ):  # a comma joins only where the list goes on
                between = []
        if between is None:
            merged.append(mention)
        else:
            users = tuple(dict.fromkeys([*last.users, *between, *mention.users]))
            merged[-1] = Mention(role="named", users=users, start=last.start, end=mention.end)
    parted = [_counted(plain, part) for mention in merged for part in _parted(plain, mention)]
    return _but_for(plain, _distributed(plain, parted))


def _has_its_own(plain: str, one: Mention, other: Mention) -> bool:
    """Whether a bound is of the second alone, and the first is out or has a figure.

    "1 Mbit/s for user 4, and user 8 at most 2", "leave out user 6 and user 4 at least 1 Mbit/s".
    """
    ahead = plain[clause_start(plain, one.start) : one.start]
    return _OWN_BOUND.match(plain, other.end) is not None and _OWN_WORDS.search(ahead) is not None


def _counted(plain: str, mention: Mention) -> Mention:
    """Somebody with the words that count them once more: "3、5、6三个用户"."""
    again = _COUNTED_AGAIN.match(plain, mention.end) if len(mention.users) > 1 else None
    as_many = again is not None and _number(again["count"]) == len(mention.users)
    return replace(mention, end=again.end()) if again is not None and as_many else mention


def _but_for(plain: str, found: Sequence[Mention]) -> list[Mention]:
    """Groups without those of them who are excepted, who are mentioned still where more is said of them.

    "users 1 to 6 except user 3", "双号用户(4号除外)", "users 1 to 6 except user 3, who …".
    """
    kept: list[Mention] = []
    for each in found:
        if kept and each.start < kept[-1].end:  # "odd users other than 7"
            continue
        several = len(each.users) > 1
        behind = _BUT_FOR.match(plain, each.end) if several else None
        said = behind or (_ALL_BUT.search(plain, 0, each.start) if several else None)
        without = listed_users(said["one"] or said["other"]) if said and unit_at(plain, said.end()) is None else ()
        if said and without and {*without} < {*each.users}:
            users = tuple(user for user in each.users if user not in without)
            end = each.end if WHO.match(plain, said.end()) else max(each.end, said.end())
            each = replace(each, users=users, start=min(each.start, said.start()), end=end)
            kept = [other for other in kept if other.end <= each.start]
        kept.append(each)
    return kept


def _distributed(plain: str, found: Sequence[Mention]) -> list[Mention]:
    """Users who are named with the words beside that only say "each of them": these are no mention of everybody.

    "each of users 1 to 4", "everyone from user 3 to user 6", "from user 2 to user 7 inclusive everyone".
    """
    kept: list[Mention] = []
    for mention in found:
        last, between = (kept[-1], plain[kept[-1].end : mention.start]) if kept else (mention, ".")
        several = len(last.users) > 1 and _INCLUSIVE.fullmatch(between) is not None
        ranged = len(last.users) > 1 and _BEFORE_EACH.fullmatch(between) and _RANGED_AHEAD.search(plain, 0, last.start)
        ranged = ranged and not EXCEPTED.search(plain, 0, last.start)  # "apart from users 3 and 4 everybody …"
        again = {*mention.users} < {*last.users} and bool(between.strip(" ,("))  # "users 2 to 5 (5 included)"
        if (mention.role in ("everybody", "pronoun") and ranged) or (again and several):
            kept[-1] = replace(last, end=mention.end)
            continue
        while len(mention.users) > 1 and kept and kept[-1].role == "everybody":
            each = kept[-1]
            if _OUT_OF_THOSE.fullmatch(plain, each.end, mention.start) is None:
                break
            mention = replace(mention, start=kept.pop().start)
            if len(mention.users) == 2 and _FROM_ONE_TO.match(plain, each.end):  # "everybody between user 2 and user 5"
                mention = replace(mention, users=listed_users(" to ".join(mention.users)))
        kept.append(mention)
    return kept


def _parted(plain: str, mention: Mention) -> tuple[Mention, ...]:
    """Whoever is named ahead of a comma and again behind, or is left out while those behind have something else.

    "3号和8号，3号至少1兆", "sin el 7, el 4 con 1 Mbit/s".
    """
    comma = _LAST_COMMA.search(plain, mention.start, mention.end)
    if comma is None:
        return (mention,)
    first, last = listed_users(plain[mention.start : comma.start()]), listed_users(plain[comma.end() : mention.end])
    ahead = plain[max(clause_start(plain, mention.start), mention.start - _NEAR) : mention.start]
    own = not plain[comma.end()].isdigit() or plain[comma.start() - 1] in "号號"  # "el 4", "8号"
    apart = own and len(last) == 1 and WITHOUT.search(ahead) is not None and not _GOES_ON.match(plain, mention.end)
    if not last or not ({*last} <= {*first} or (apart and (*first, *last) == mention.users)):
        return (mention,)
    return (
        Mention(role="named", users=first, start=mention.start, end=comma.start()),
        Mention(role="named", users=last, start=comma.end(), end=mention.end),
    )
