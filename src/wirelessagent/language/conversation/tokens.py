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
from wirelessagent.language.text import CJK, has_chinese, languages_of, normalise, unaccented
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

_SPACE = re.compile(r"[\s,，、.。!！?？¿¡;；:：'\"“”„«»()（）…=>→+&/–—-]+")
_PREFIXED = re.compile(r"[0-9]\s?[kMG]$")
_SCALE = re.compile(r"[kKMG](?![^\W_])")
_SCALES = {"": 1.0, "K": 1e3, "M": 1e6, "G": 1e9}
_WORD = re.compile(r"[^\W\d_]+")
_OF_A_USER = re.compile(r"(?i)(?:^\s*|\b(?:el|al|la|le|du|au|der|die|den|dem|number)\s)(\d{1,3})\s*(?=$|[^\W\d_])")
NUMBER = re.compile(r"(?<![A-Za-z\d.])\d++(?:\.\d+)?+(?![A-Za-z])")
"""A number in digits: "7", and no "4K"."""
ONES = frozenset(
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


def words_of(line: Line, *, lenient: bool = False) -> Iterator[Words]:
    """The line word by word in each language that it may be in and that knows all of its words, or is ``lenient``."""
    spoken = [line.context.language] if line.context.language else []
    for language in dict.fromkeys([*spoken, *languages_of(line.text)]):
        tokens = tokens_of(line, language, lenient=lenient)
        if tokens:
            yield Words(line, tokens, language)


def speaks_of_one(plain: str, of: str = "pronoun") -> bool:
    """Whether a pronoun, or words of another class, are in the text."""
    low = plain.lower()
    said = f" {' '.join(_WORD.findall(low))} {' '.join(_WORD.findall(_unmarked(low)))} "
    return any(
        f" {' '.join(_WORD.findall(word))} " in said if word.isascii() else word in low
        for language in languages_of(plain)
        for word, token in _table(language)[0].items()
        if of in token.classes
    )


def numbered(line: Line) -> tuple[str, ...]:
    """The user whom the one number of a line is said of, behind an article: "le 3 a payé", "den bei der 4 deckeln"."""
    said = _OF_A_USER.search(line.text) if len(NUMBER.findall(line.text)) == 1 and not line.figures else None
    return (said[1],) if said and int(said[1]) in range(1, len(line.context.user_names) + 1) else ()


def own_users(held: Constraint | None) -> tuple[str, ...]:
    """Users with a figure of their own in a limit that holds."""
    return tuple(user for user in held if user != EVERYBODY) if isinstance(held, Mapping) else ()


def tokens_of(line: Line, language: str, *, lenient: bool = False) -> list[Token] | None:
    """The line as words that are known here; None where one is not, unless it is told of who is meant instead."""
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
    for number in numbers(plain, language):
        clear = not any(start < number.end and number.start < end for start, end in taken)
        text = plain[number.start : number.end]
        if number.value is None or not clear or text in ONES:
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
    known = _segmented(marked.lower(), spans, language, lenient=False)
    return _segmented(marked.lower(), spans, language, lenient=True) if known is None and lenient else known


def _segmented(
    marked: str, spans: Mapping[int, tuple[int, Token]], language: str, *, lenient: bool
) -> list[Token] | None:
    """The tokens of a text from end to end, the longest words first; None where no words cover it."""
    words, longest = _table(language)

    @functools.cache
    def behind(place: int) -> list[Token] | None:
        space = _SPACE.match(marked, place)
        if space is not None:
            place = space.end()
        if place == len(marked):
            return []
        for end, token in found(place):
            rest = behind(end)
            if rest is not None:
                return [token, *rest]
        return None

    def found(place: int) -> Iterator[tuple[int, Token]]:
        inside = [(start, last) for start, (last, _) in spans.items() if place < start]
        for end in range(min(len(marked), place + longest), place, -1):
            word = words.get(marked[place:end])
            cut = any(start < end < last for start, last in inside) and word and not word.factor
            of_a_figure = place in spans and not (word and word.factor and end > spans[place][0])
            if word and not cut and not of_a_figure and _is_whole(marked, place, end):
                yield end, word
        if place in spans:
            yield spans[place]
        unknown = _WORD.match(marked, place) if lenient else None
        if unknown is not None:
            yield (place + 1 if has_chinese(unknown[0]) else unknown.end()), _UNKNOWN

    return behind(0)


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
    spelt = {word for _, word in of_classes} | factors.keys()
    for name, word in of_classes:
        for own in {word, *({_unmarked(word)} - spelt)}:  # "maximo" is "máximo", and "él" is no "el"
            for ending in _ENDINGS if "*" in word else ("",):
                classes.setdefault(own.replace("*", ending), set()).add(name)
    factors = {own: factor for word, factor in factors.items() for own in (word, _unmarked(word))}
    for word in factors:
        classes.setdefault(word, set()).add("factor")
    tokens = {word: Token(frozenset(names), factor=factors.get(word)) for word, names in classes.items()}
    return tokens, max(map(len, tokens))


_COUNTED = frozenset({"figure", "bare", "ratio", "factor", "vague"})
_NO_USER = frozenset({"make", "to", "by", "more", "less", "revise", "at_most", "instead", "undo", "change_noun"})
_UNKNOWN = Token(frozenset({"unknown", "skip"}))
_CORRECTED = Token(frozenset({"correct", "skip"}))
"""What stays in the place of what a line denies."""


def _without_what_goes(tokens: Sequence[Token]) -> tuple[list[Token], list[Token]]:
    """The tokens without what others replace, and that: "300 rather than 200", "500 was too much, 400", "not user 3".

    What holds was too much in "too much, make it 9", which says nothing more.
    """
    kept, gone = list(tokens), list[Token]()
    said = [token for token in kept if not token.classes <= {"skip"} or token.figure]
    for token, behind in itertools.pairwise(said):
        over = behind if "instead" in token.classes else token if "too_much" in behind.classes else None
        counted = [each for each in kept if each.figure or each.factor or each.users]
        if over is not None and any(over is each for each in counted) and len(counted) > 1:
            stays = [_CORRECTED] if over is behind else []
            kept = [*(each for each in kept if each is not token and each is not behind), *stays]
            gone.append(over)
    first = next((place for place, token in enumerate(kept) if token.figure or token.factor), 0)
    return [token for token in kept[:first] if "too_much" not in token.classes] + kept[first:], gone


def _corrected_at_once(tokens: Sequence[Token]) -> tuple[list[Token], list[Token]]:
    """The tokens with what stands behind a correction in the place of what it corrects, and what that was.

    "A bit less... no, a third", "I said 5 but meant 6".
    """
    corrects = (each is not _CORRECTED and {*each.classes} & {"correct", "instead"} == {"correct"} for each in tokens)
    places = [at for at, it_does in enumerate(corrects) if it_does]
    ahead, behind = (tokens[: places[-1]], tokens[places[-1] + 1 :]) if places else ((), tokens)
    users, figures = any(token.users for token in behind), any(token.figure or token.factor for token in behind)
    gone = {*(("users",) if users else ()), *(_COUNTED if figures else ())}
    over = [token for token in ahead if token.classes & gone]
    said = over and any(token.classes - {"skip", "correct", "lead"} for token in ahead)
    return ([token for token in ahead if not token.classes & gone] + [*behind], over) if said else ([*tokens], [])


def _with_whose(tokens: Sequence[Token], num_users: int) -> list[Token]:
    """The tokens with bare numbers as users where they are whose another figure or share is: "triple for 5 and 6"."""
    changed, nobody = list(tokens), Token(frozenset())
    shared = any(token.factor or "equal" in token.classes for token in tokens)
    shared = shared and not any(token.classes & {"figure", "ratio"} for token in tokens)
    several = any(token.users for token in tokens)
    for place, token in enumerate(tokens):
        ahead, behind = tokens[place - 1] if place else nobody, [*tokens, nobody][place + 1]
        figure, others = token.figure, shared or any(each.figure for each in tokens if each is not token)
        if figure is None or figure.kind != "bare" or figure.value not in range(1, num_users + 1):
            continue
        listed = "lead" in ahead.classes and place > 1 and bool(changed[place - 2].users)
        whose = not several and (bool(ahead.classes & {"whose", "except"}) or listed)
        clear = "possessed" in behind.classes or (shared and not ahead.classes & _NO_USER)
        several_of = "plural" in ahead.classes and not figure.text[:1].isdigit()  # "all three"
        if others and (whose or clear) and not several_of and "change_noun" not in behind.classes:
            changed[place] = Token(frozenset({"users"}), users=(f"{figure.value:g}",))
            if place:  # "al 4 un 20 % más"
                changed[place - 1] = dataclasses.replace(ahead, classes=ahead.classes - {"to"})
    return changed


class Words:
    """The tokens of a line in its conversation."""

    def __init__(self, line: Line, tokens: Sequence[Token], language: str) -> None:
        self.line, self.language = line, language
        self.was_too_much = any("too_much" in token.classes for token in tokens)
        kept, gone = _without_what_goes(tokens)
        kept, corrected = _corrected_at_once(_with_whose(kept, len(line.context.user_names)))
        self.replaced = next((token.figure for token in gone if token.figure is not None), None)
        self.corrected = next((token.figure for token in corrected if token.figure is not None), None)
        numbers = [token.figure for token in (*gone, *corrected) if token.figure and token.figure.kind == "bare"]
        self.denied = {user for token in (*gone, *corrected) for user in token.users}
        self.denies_users = any(token.users for token in gone)
        self.denied |= {f"{figure.value:g}" for figure in numbers}
        self.tokens = tokens = kept
        self.figures = [token.figure for token in tokens if token.figure is not None]
        self.users = tuple(dict.fromkeys(user for token in tokens for user in token.users))
        self.held = line.context.constraints
        self.users = self.users or self._all_of_them()
        self.about: tuple[str, ...] = ()
        """The users of whom a clause before this one tells."""
        self.is_told = False
        self.is_unsure = any(token is _UNKNOWN for token in tokens)

    def _all_of_them(self) -> tuple[str, ...]:
        """ "All three of those": the users with figures of their own, where they are so many."""
        last = {act.kind for act in self.last(Limit, Scale)}
        for at, token in enumerate(self.tokens):
            ahead, figure = self.tokens[at - 1].classes if at else frozenset[str](), token.figure
            counted = figure is not None and "plural" in ahead and not figure.text[:1].isdigit()
            count = 2 if "both" in token.classes else figure.value if figure is not None and counted else 0
            own = {kind: held if isinstance(held, tuple) else own_users(held) for kind, held in self.held.items()}
            several = {kind: users for kind, users in own.items() if len(users) == count}
            back = {several["leave_out"]} if "leave_out" in several and self.has("serve") else set[tuple[str, ...]]()
            them = back or {users for kind, users in several.items() if kind in last} or {*several.values()}
            if count and len(them) == 1:
                self.figures = [each for each in self.figures if each is not figure]
                users, start = them.pop(), at - 1 if counted else at
                together = Token(token.classes - {"bare"} | {"users"}, users=users)
                self.tokens = [*self.tokens[:start], together, *self.tokens[at + 1 :]]
                return users
        return ()

    def has(self, *names: str) -> bool:
        """Whether a word is in one of these classes."""
        return any(token.classes.intersection(names) for token in self.tokens)

    def has_another(self, name: str, beside: str) -> bool:
        """Whether a word is in this class, and says neither nothing nor what the other class does."""
        return any(name in token.classes and not token.classes & {beside, "skip", "lead"} for token in self.tokens)

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
        acts = self.last(Limit, Drop, LeaveOut, Serve, Scale)
        named = any(isinstance(act.whom, Named) for act in acts) or bool(self.denied)
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
        if self.has("every") and self.has("remove"):  # "forget the weights, they all count the same"
            return Everybody()
        if self.spoken_of is not None:
            return self.spoken_of
        if self.has("pronoun") and isinstance(self.last_whom(), Named):
            return self.last_whom()
        return Everybody() if self.has("every") else None

    @property
    def spoken_of(self) -> Named | None:
        """The one user who was spoken of before, where a pronoun stands for somebody."""
        users, last = self.line.context.spoken_of, self.last_whom()
        users = users or (last.users if isinstance(last, Named) else ())
        return Named(users) if len(users) == 1 and (self.has("pronoun", "one")) else None

    def last_whom(self) -> Whom:
        last = self.last(Limit, Scale, Drop)
        return last[-1].whom if last else Everybody()

    def last(self, *kinds: type[Any]) -> list[Any]:
        return [act for act in self.line.context.acts if isinstance(act, kinds)]

    def acts(self, acts: Sequence[Act], details: Mapping[str, Detail] | None = None) -> Intent:
        return self.line.changed_by(acts, details)
