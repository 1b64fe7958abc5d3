"""The words of a line that leans on its conversation: figures, users, and words of closed classes, or no such line.

The classes are data by language (``fragment_words/<language>.toml``).
"""

from __future__ import annotations

import dataclasses
import functools
import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

from wirelessagent.language.acts import Act, Drop, Everybody, LeaveOut, Limit, Named, Others, Scale, Serve, Whom
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.intent import EVERYBODY, Constraint, Detail, Intent
from wirelessagent.language.mentions import mentions
from wirelessagent.language.numerals import factors, numbers
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.text import CJK, languages_of, normalise, unaccented
from wirelessagent.language.word_tables import table

UNITS: Mapping[str, tuple[str, ...]] = {
    "power": ("max_power_w", "subcarrier_max_power_w", "circuit_power_w"),
    "rate": ("min_rate_bps", "max_rate_bps"),
    "ratio": ("outage_probability",),
}
"""Limits that a figure with such a unit may be."""

NOUNS: Mapping[str, tuple[str, ...]] = {
    "power": ("max_power_w",),
    "limit": ("max_power_w", "max_rate_bps", "subcarrier_max_power_w"),
    "rate": ("min_rate_bps", "max_rate_bps"),
    "promise": ("min_rate_bps",),
    "weight": ("weights",),
    "certainty": ("outage_probability",),
    "circuit": ("circuit_power_w",),
    "subcarrier": ("subcarrier_max_power_w",),
    "group": ("resource_block_group_size",),
    "rate_limit": ("max_rate_bps",),
}
"""Limits that a noun may name."""

_LIFTED: Mapping[str, str] = {
    "go": "remove", "gone": "remove", "max_power_w": "power", "min_rate_bps": "promise", "max_rate_bps": "rate_limit",
    "subcarrier_max_power_w": "subcarrier", "outage_probability": "certainty", "weights": "weight",
    "circuit_power_w": "circuit",
}  # fmt: skip
"""The class that words for limits that go are in."""
_ENDINGS = ("", "s", "n", "en", "e")

_CLASS = {"power": "figure", "rate": "figure"}
"""What a figure with a unit is called, beside nouns."""

_SPACE = re.compile(r"[\s,，.。!！?？;；:：'\"“”()（）…=>→-]+")
_PREFIXED = re.compile(r"[0-9]\s?[kMG]$")
_SCALE = re.compile(r"[kKMG](?![^\W_])")
_SCALES = {"": 1.0, "K": 1e3, "M": 1e6, "G": 1e9}
_WORD = re.compile(r"[^\W\d_]+")
_ONES = frozenset(
    {
        "one", "a", "an", "un", "uno", "una", "une", "ein", "eine", "einen", "eins", "一", "两", "half", "demi",
        "medio", "halb",
    }
)  # fmt: skip
"""Number words that mostly count nothing."""


@dataclass(frozen=True)
class Token:
    """A word, a figure or users, and the classes that it is in."""

    classes: frozenset[str]
    figure: Quantity | None = None
    users: tuple[str, ...] = ()
    factor: float | None = None


def words_of(line: Line) -> Iterator[Words]:
    """The line word by word in each language that it may be in and that knows all of its words."""
    spoken = [line.context.language] if line.context.language else []
    for language in dict.fromkeys([*spoken, *languages_of(line.text)]):
        tokens = tokens_of(line, language)
        if tokens:
            yield Words(line, tokens, language)


def speaks_of_one(plain: str, of: str = "pronoun") -> bool:
    """Whether a pronoun, or a word of another class, is among the words."""
    words = set(_WORD.findall(_unmarked(plain.lower())))
    return any(
        word in words if word.isascii() else word in plain
        for language in languages_of(plain)
        for word, token in _table(language)[0].items()
        if of in token.classes and " " not in word
    )


def own_users(held: Constraint | None) -> tuple[str, ...]:
    """Users with a figure of their own in a limit that holds."""
    return tuple(user for user in held if user != EVERYBODY) if isinstance(held, Mapping) else ()


def tokens_of(line: Line, language: str) -> list[Token] | None:
    """The line as words that are known here; None where one is not."""
    marked = normalise(line.text)
    plain = _unmarked(marked.lower())
    figures = [
        dataclasses.replace(figure, kind="rate") if figure.kind == "bare" and figure.value >= 1e3 else figure  # "400k"
        for figure in parse_quantities(line.text)
        if figure.kind not in ("bare", "other") or _PREFIXED.search(figure.text)
    ]
    taken = [(figure.start, figure.end) for figure in figures]
    found = mentions(marked, line.context.user_names, taken)
    named = [each for each in found if each.role == "named"]
    spans: dict[int, tuple[int, Token]] = {
        each.start: (each.end, Token(frozenset({"users"}), users=each.users)) for each in named
    }
    taken += [(each.start, each.end) for each in named]
    for number in numbers(plain):
        clear = not any(start < number.end and number.start < end for start, end in taken)
        text = plain[number.start : number.end]
        if number.value is None or not clear or text in _ONES:
            continue
        if number.value < 1 and not text[0].isdigit():  # "a quarter"
            spans[number.start] = (number.end, Token(frozenset({"factor"}), factor=float(number.value)))
        else:
            scale = _SCALE.match(marked, number.end)  # "250k is enough"
            end = number.end if scale is None else scale.end()
            figures.append(Quantity(
                value=float(number.value) * _SCALES[scale[0].upper() if scale else ""],
                kind="bare" if scale is None else "rate", text=marked[number.start : end], start=number.start, end=end,
                phrase_start=number.start, phrase_end=end,
            ))  # fmt: skip
    for factor in factors(plain):
        if plain[factor.start : factor.end].strip()[0] in "x0123456789" and factor.value is not None:  # "x2", "2x"
            figures = [figure for figure in figures if not factor.start <= figure.start < factor.end]
            spans[factor.start] = (factor.end, Token(frozenset({"factor"}), factor=float(factor.value)))
    for figure in figures:
        spans[figure.start] = (figure.end, Token(frozenset({_CLASS.get(figure.kind, figure.kind)}), figure=figure))
    return _segmented(plain, spans, language)


def _segmented(plain: str, spans: Mapping[int, tuple[int, Token]], language: str) -> list[Token] | None:
    found: list[Token] = []
    words, longest = _table(language)
    place = 0
    while place < len(plain):
        space = _SPACE.match(plain, place)
        if space is not None:
            place = space.end()
        else:
            ends = range(min(len(plain), place + longest), place, -1)
            end = next((end for end in ends if plain[place:end] in words and _is_whole(plain, place, end)), None)
            if place in spans and (end is None or words[plain[place:end]].factor is None or end <= spans[place][0]):
                place, token = spans[place]
                found.append(token)
                continue
            if end is None:
                return None
            inside = place not in spans and any(place < start < end for start in spans)
            if inside and words[plain[place:end]].factor is None:
                return None
            found.append(words[plain[place:end]])
            place = end
    return found


def _unmarked(text: str) -> str:
    """The text without marks on its letters; as many letters as before."""
    return "".join(unaccented(letter)[:1] or letter for letter in text)


def _is_whole(plain: str, start: int, end: int) -> bool:
    """Whether no word goes on at either end; in Chinese words are not parted."""
    if re.match(f"[{CJK}]", plain[end - 1]):
        return True
    return not (end < len(plain) and plain[end].isalnum() and not re.match(f"[{CJK}]", plain[end]))


@functools.cache
def _table(language: str) -> tuple[Mapping[str, Token], int]:
    """The words of a language with their classes, and the length of the longest."""
    listed = table("fragment_words", language)
    factors = cast("dict[str, float]", listed["factors"])
    classes: dict[str, set[str]] = {}
    lifted = cast("Mapping[str, list[str]]", table("figures", language)["lifted"])
    of_classes = [(name, word) for name in listed.keys() - {"factors"} for word in cast("list[str]", listed[name])]
    of_classes += [(name, word) for limit, name in _LIFTED.items() for word in lifted.get(limit, ())]
    for name, word in of_classes:
        for ending in _ENDINGS if "*" in word else ("",):
            classes.setdefault(_unmarked(word.replace("*", ending)), set()).add(name)
    factors = {_unmarked(word): factor for word, factor in factors.items()}
    for word in factors:
        classes.setdefault(word, set()).add("factor")
    tokens = {word: Token(frozenset(names), factor=factors.get(word)) for word, names in classes.items()}
    return tokens, max(map(len, tokens))


def _without_what_goes(tokens: Sequence[Token]) -> tuple[list[Token], Quantity | None]:
    """The tokens without the figure that another replaces ("300 rather than 200", "500 was too much, 400"), and it.

    What holds was too much in "too much, make it 9", which says nothing more.
    """
    kept = list(tokens)
    said = [token for token in kept if not token.classes <= {"skip"} or token.figure]
    replaced: Quantity | None = None
    for token, behind in itertools.pairwise(said):
        gone = behind if "instead" in token.classes else token if "too_much" in behind.classes else None
        counted = [each for each in kept if each.figure or each.factor]
        if gone is not None and gone in counted and len(counted) > 1:
            kept, replaced = [each for each in kept if each is not token and each is not behind], gone.figure
    first = next((place for place, token in enumerate(kept) if token.figure is not None), 0)
    return [token for token in kept[:first] if "too_much" not in token.classes] + kept[first:], replaced


def _with_whose(tokens: Sequence[Token], num_users: int) -> list[Token]:
    """The tokens with bare numbers behind "for" as users whose another figure or share is: "triple for 5 and 6"."""
    changed = list(tokens)
    for place, (ahead, token) in enumerate(itertools.pairwise(tokens), start=1):
        others = any(each.figure or each.factor for each in tokens if each is not token)
        figure = token.figure
        counts = figure is not None and figure.kind == "bare" and figure.value in range(1, num_users + 1)
        listed = "lead" in ahead.classes and bool(changed[place - 2].users)
        if counts and others and ("whose" in ahead.classes or listed) and not any(each.users for each in tokens):
            assert figure is not None
            changed[place] = Token(frozenset({"users"}), users=(f"{figure.value:g}",))
    return changed


class Words:
    """The tokens of a line in its conversation."""

    def __init__(self, line: Line, tokens: Sequence[Token], language: str) -> None:
        self.line, self.language = line, language
        self.was_too_much = any("too_much" in token.classes for token in tokens)
        kept, self.replaced = _without_what_goes(tokens)
        self.tokens = tokens = _with_whose(kept, len(line.context.user_names))
        self.figures = [token.figure for token in tokens if token.figure is not None]
        self.users = tuple(dict.fromkeys(user for token in tokens for user in token.users))
        self.held = line.context.constraints

    def has(self, *names: str) -> bool:
        """Whether a word is in one of these classes."""
        return any(token.classes.intersection(names) for token in self.tokens)

    @property
    def is_read(self) -> bool:
        """Whether recognisers read whole sentences of the language well, so that those are theirs."""
        return self.language in ("en", "zh")

    def only(self, *names: str) -> bool:
        """Whether every token is in one of these classes, or says nothing."""
        allowed = {"skip", *names}
        return all(token.classes & allowed for token in self.tokens)

    def named_kinds(self) -> list[str]:
        """Limits that the nouns of the line name together."""
        sets = [NOUNS[name] for name in NOUNS if self.has(name)]
        return [kind for kind in dict.fromkeys(sets[0]) if all(kind in kinds for kinds in sets)] if sets else []

    def counted(self) -> tuple[str, ...]:
        """Users named by their number alone: "and 3 too"."""
        found = [token.figure for token in self.tokens if "bare" in token.classes and token.figure is not None]
        names = {str(number) for number in range(1, len(self.line.context.user_names) + 1)}
        users = tuple(f"{figure.value:g}" for figure in found)
        if not users or len(found) != len(self.figures) or not set(users) <= names:
            return ()
        named = any(isinstance(act.whom, Named) for act in self.last(Limit, Drop, LeaveOut, Serve, Scale))
        return users if named or self.has("leave", "serve") else ()

    def listed(self, name: str) -> tuple[str, ...]:
        """The users whom the request serves alone ("users") or leaves out; nobody where it says nothing of that."""
        return cast("tuple[str, ...]", self.held.get(name, ()))

    @property
    def taken_off(self) -> Mapping[str, Mapping[str, float]]:
        """The figures of users that the last change took off."""
        return {
            kind: stated
            for kind, stated in self.line.context.stated.items()
            if isinstance(stated, Mapping) and EVERYBODY not in stated
            and isinstance(held := self.held.get(kind, {}), Mapping) and not any(held.get(user) for user in stated)
        }  # fmt: skip

    def whom(self) -> Whom | None:
        if self.users:
            return Named(self.users)
        if self.has("others"):
            return Others()
        if self.spoken_of is not None:
            return self.spoken_of
        if self.has("pronoun") and isinstance(self.last_whom(), Named):
            return self.last_whom()
        return Everybody() if self.has("every") else None

    @property
    def spoken_of(self) -> Named | None:
        """The one user who was spoken of before, where a pronoun stands for somebody."""
        users = self.line.context.spoken_of
        return Named(users) if len(users) == 1 and (self.has("pronoun", "one")) else None

    def last_whom(self) -> Whom:
        last = self.last(Limit, Scale, Drop)
        return last[-1].whom if last else Everybody()

    def last(self, *kinds: type[Any]) -> list[Any]:
        return [act for act in self.line.context.acts if isinstance(act, kinds)]

    def acts(self, acts: Sequence[Act], details: Mapping[str, Detail] | None = None) -> Intent:
        """A change of the request by these acts."""
        stated: dict[str, Constraint] = {}
        for act in acts:
            if isinstance(act, Limit):
                named = act.whom.users if isinstance(act.whom, Named) else None
                stated[act.kind] = act.value if named is None else dict.fromkeys(named, act.value)
            elif isinstance(act, LeaveOut) and isinstance(act.whom, Named):
                stated["leave_out"] = act.whom.users
        dropped = tuple(act.kind for act in acts if isinstance(act, Drop))
        intent = self.line.amend(stated, dropped=dropped, details=details)
        return dataclasses.replace(intent, acts=tuple(acts))
