"""What each figure, number and user of a sentence is there for, as a small linear model judges by the words beside it.

Seven questions, each with its own labels: what a power, a rate, a ratio, a bare number and a named user are, whose a
rate or a weight is, and whether a word calls somebody by a name that no user has. The model says how likely each
answer is; what is done with it is decided in ``constraints``.
Trained by :mod:`wirelessagent.language.training.roles` on sentences with their meanings.

It sees the words around a figure or a user as hashed features. Figures and users are placeholders, so that it knows no
numbers. What lies beyond the end of a clause counts apart from what is near; letters within words catch compounds such
as "Ruheverbrauch".
"""

from __future__ import annotations

import functools
import itertools
import math
import zlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from wirelessagent.language.mentions import NOUN, ZH_NOUN, Mention
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.text import CJK, clause_end, clause_start, is_chinese, unaccented
from wirelessagent.language.vocabulary import based, is_listed, language_of
from wirelessagent.language.word_tables import deferred

BUCKETS = 1 << 16
_REACH = 12
_PAIRED = 5
_BASE_REACH, _BASE_NEAR = 8, 3
_TOKEN = deferred(rf"[{CJK}]|(?:(?![{CJK}])[^\W\d_])+(?:'(?=[^\W\d_]))?|[0-9]+|\S")
_CLAUSE_ENDS = frozenset(",;!?.。，；！？…—\n")


class Token(NamedTuple):
    """A word, a Chinese character, a mark or a placeholder ("@rate") at characters [start, end) of a sentence."""

    word: str
    start: int
    end: int = -1


def tokens_of(plain: str, placed: Iterable[Token]) -> list[Token]:
    """The tokens of a normalised sentence from left to right, those among them that are ``placed`` already."""
    found, place = list[Token](), 0
    end = Token("", len(plain))
    for token in (*sorted(placed, key=lambda each: (each.start, -each.end)), end):
        if token.start >= place:
            words = _TOKEN.finditer(plain, place, token.start)
            found += [*(Token(_simple(match.group()), *match.span()) for match in words), token]
            place = token.end
    return found[:-1]


@functools.lru_cache(maxsize=4096)
def _simple(word: str) -> str:
    """Lower case without accents."""
    return unaccented(word.lower()) or word


def in_base_words(tokens: Sequence[Token], language: str) -> list[Token]:
    """The same with base words, which five languages share, in place of words; placeholders stay what they are."""
    found: list[Token] = []
    for is_placed, run in itertools.groupby(tokens, key=lambda token: token.word[0] == "@"):
        said = list(run)
        found += said if is_placed else [Token(word, -1) for word in based([each.word for each in said], language)]
    return found


def around_base(tokens: Sequence[Token], place: int) -> set[str]:
    """The features of the base words about the token at ``place``."""
    found: set[str] = set()
    near: list[str] = []
    for side, words in _sides(tokens, place, _BASE_REACH):
        end = _end_of_clause(words)
        near += [f"{side}{word}" for word in words[: min(end, _PAIRED)]]
        for place, (previous, word) in enumerate(itertools.pairwise(["", *words])):
            where = f"base {side}{int(place > end)}"
            found |= {f"{where}{word}", f"{where}{previous} {word}"}
            if place < _BASE_NEAR:
                found |= {f"{where}~{word}", f"base {word}"}
    found.update(f"pair {one} {other}" for one, other in itertools.combinations(sorted(set(near)), 2))
    return found


def around(tokens: Sequence[Token], place: int, known: Sequence[str] = ()) -> set[str]:
    """The features of the token at ``place``; ``known`` are things that the rules say of it."""
    found = {"bias", *known}
    found.update([f"{one}&{other}" for index, one in enumerate(known) for other in known[index + 1 :]])
    for side, words in _sides(tokens, place, _REACH):
        _add_words(found, side, words)
        _add_near(found, side, words)
    left = tokens[place - 1].word if place else "<"
    right = tokens[place + 1].word if place + 1 < len(tokens) else ">"
    found.add(f"M{left} {right}")
    return found


def _sides(tokens: Sequence[Token], place: int, reach: int) -> tuple[tuple[str, list[str]], tuple[str, list[str]]]:
    """The words on the left and on the right of a token, the nearest first, as far as they may count."""
    left = [token.word for token in tokens[max(0, place - reach) : place]]
    return ("L", left[::-1]), ("R", [token.word for token in tokens[place + 1 : place + 1 + reach]])


def _end_of_clause(words: Sequence[str]) -> int:
    return next((place for place, word in enumerate(words) if word in _CLAUSE_ENDS), len(words))


def _add_words(found: set[str], side: str, words: Sequence[str]) -> None:
    """Single words, pairs and triples of one side, by how many clauses lie between."""
    clauses, before, previous = 0, "", ""
    for place, word in enumerate(words):
        where = f"{side}{min(clauses, 2)}"
        found.add(f"{where}{word}")
        if place:
            found.add(f"{where}{previous} {word}")
        if 1 < place < 6:
            found.add(f"{where}{before} {previous} {word}")
        if place < 4:
            found.add(f"{where}{'~' if place else '='}{word}")
        clauses += word in _CLAUSE_ENDS
        before, previous = previous, word
    if len(words) < _REACH:
        found.add(f"{side}{min(clauses, 1)}end{min(len(words) + 1, 3)}")


def _add_near(found: set[str], side: str, words: Sequence[str]) -> None:
    """The words of the same clause on one side whatever their order, with their letters, and the next placeholder."""
    end = _end_of_clause(words)
    known = next((place for place, word in enumerate(words) if word[0] == "@"), len(words))
    if known < len(words):
        found.add(f"{side}next{known > end}{words[known]}")
    for place, word in enumerate(words[: end + 1]):
        if place != known:
            found.add(f"near {word}")
            found.update(_letters(word) if len(word) > 4 else ())


@functools.lru_cache(maxsize=4096)
def _letters(word: str) -> tuple[str, ...]:
    padded = f"^{word[:20]}$"
    return tuple(f"letters {padded[start : start + 4]}" for start in range(len(padded) - 3))


def hashed(question: str, features: Iterable[str]) -> npt.NDArray[np.int64]:
    """The distinct buckets of features, ascending; each question has its own hash."""
    seed = zlib.crc32(question.encode())
    found = {zlib.crc32(each.encode("utf-8", "replace"), seed) % BUCKETS for each in features}
    buckets = np.fromiter(found, dtype=np.int64, count=len(found))
    buckets.sort()
    return buckets


ROLES_FILE = Path(__file__).with_name("roles.npz")
LABELS: Mapping[str, tuple[str, ...]] = {
    "power": (
        "max_power_w", "circuit_power_w", "subcarrier_max_power_w", "none", "stale", "refused", "change", "part",
        "floor", "per_user", "unclear",
    ),
    "rate": ("min_rate_bps", "max_rate_bps", "both", "none", "stale", "refused", "change", "part", "total", "unclear"),
    "ratio": ("outage", "reliability", "missing", "none", "change", "share"),
    "number": (
        "user", "weight", "rate", "power", "multiple", "outage", "reliability", "harmless", "limit", "group", "share",
    ),
    "user": ("leave_out", "users", "back", "exempt", "kept", "given", "stale", "unclear"),
    "link": ("link",),
    "word": ("somebody", "nobody"),
}  # fmt: skip
"""What each may be there for.

A figure that is "none" is told and limits nothing, one that is "stale" is corrected by the next, "refused" is called
too much or too little; "change" is an amount to add or to save, "part" is calculated with, "unclear" is one of two, a
reserve or another device's, a "share" is one of the cell's power, a "group" how many subcarriers go together. Whoever
is "exempt" is promised nothing of what all get, "kept" is only spoken of, "given" has a figure of their own, "back" is
taken in again.
"""

_PLACEHOLDERS = {"named": "@user", "others": "@others", "everybody": "@all", "pronoun": "@them"}
_EACH = deferred(r"(?i)(?:each|apiece|je|jeweils|cada un[oa]|chacune?|各)(?!\w)")  # of all, or of those just named
_NOBODY = deferred(r"(?i)no|nadie|ning|personne|aucun|niemand|kein|[谁没无]")
_PEOPLE = (*_PLACEHOLDERS.values(), "@each", "@nobody", "@weighed")
Answer = TypeVar("Answer")
_SIZES = {"part": 1 - 1e-9, "small": 20, "some": 99, "large": math.inf}  # of numbers, up to
SCALED = deferred(r"\s?(?:[kKM]|(?<![2-6])(?<![2-6] )G)(?![^\W\d_])")  # "5G" may be a network
_FAR = 8
_USERS = deferred(rf"(?i){NOUN}|[位个名]?{ZH_NOUN}")  # which is nobody's name
_SURE_OF_A_NAME, _PART_OF_A_NAME, _SHORTEST_NAME = 0.6, 0.2, 2
_MOST_TELLING, _TELLS, _NEARLY, _TINY = 3, 1.0, 0.85, 1e-6
_JOINT = deferred(r"(?i)\b(?:and|then|y|et|und)\b")
_WORD = deferred(rf"[{CJK}]|(?:(?![{CJK}])[\w'’-])+")


@dataclass(frozen=True, kw_only=True)
class RoleModel:
    """Weights (bucket, label) as int8, a scale and an intercept per label, for each question."""

    weights: Mapping[str, npt.NDArray[np.int8]]
    scales: Mapping[str, npt.NDArray[np.float32]]

    def scores(self, question: str, features: set[str]) -> npt.NDArray[np.float64]:
        """How strongly the features speak for each label of the question."""
        found = hashed(question, features)
        total = np.add.reduce(self.weights[question].take(found, axis=0), axis=0, dtype=np.int32)
        return self.scales[question] * total / math.sqrt(len(found))


@functools.cache
def shipped_roles() -> RoleModel:
    """The model of this release."""
    with np.load(ROLES_FILE) as arrays:
        return RoleModel(
            weights={question: arrays[f"{question}_weights"] for question in LABELS},
            scales={question: arrays[f"{question}_scales"] for question in LABELS},
        )


@dataclass(frozen=True, kw_only=True)
class Look:
    """What a sentence holds: figures with a unit, everybody mentioned, the numbers that are neither.

    ``ones`` are words such as "one", which are figures or nothing; ``unread`` bounds whose unit nobody knows.
    """

    plain: str
    quantities: Sequence[Quantity]
    figures: list[Quantity]
    unread: list[Quantity]
    mentions: list[Mention]
    loose: list[Number]
    ones: list[Number]

    def view(self) -> View:
        return View(self)

    def bound(self, number: Number) -> str:
        """How a number is bounded: "at_most", "None" without a comparator, "" where it is nothing but a number."""
        return next((str(q.comparator) for q in self.quantities if q.start <= number.start < q.end), "")


class View:
    """A look at a sentence as tokens in which figures and users are placeholders, and the features of each.

    ``ones`` that may be a figure stay words.
    """

    def __init__(self, look: Look) -> None:
        placed = [Token(f"@{q.kind}", q.start, q.end) for q in look.figures]
        placed += [Token(_placeholder(look.plain, m), m.start, m.end) for m in look.mentions]
        placed += [Token("@number", n.start, n.end) for n in look.loose]
        self._look, self._plain, self._figures = look, look.plain, look.figures
        self._placed = [token for token in placed if token.word != _PLACEHOLDERS["pronoun"]]
        self._tokens = tokens_of(look.plain, placed)
        starts = {number.start for number in look.ones}
        self._language = language_of(look.plain)
        self._base = in_base_words(self._tokens, self._language)
        self._base_places = {token.start: place for place, token in enumerate(self._base) if token.start >= 0}
        self._places = {
            token.start: place
            for place, token in enumerate(self._tokens)
            if token.word[0] == "@" or token.start in starts
        }
        self._kinds = [token.word for token in self._tokens]
        self._users = {user for mention in look.mentions for user in mention.users}
        self._held = {f"has:{kind}" for kind in self._kinds if kind[0] == "@"}

    def figure(self, index: int) -> set[str]:
        """The features of a power, a rate or a ratio."""
        figure = self._figures[index]
        place = self._places[figure.start]
        alike = [place for place, kind in enumerate(self._kinds) if kind == f"@{figure.kind}"]
        unit = figure.text.lstrip("0123456789.,'’ -").lower()
        size = math.floor(2 * math.log10(figure.value)) if 0 < figure.value < math.inf else 0
        beside = [("previous", other) for other in self._figures[max(0, index - 1) : index]]
        beside += [("next", other) for other in self._figures[index + 1 : index + 2]]
        known = [
            f"is:{figure.comparator}", f"unit:{unit}", f"size:{size}", f"of:{len(alike)}", f"nth:{alike.index(place)}",
            *(f"{name}:{other.comparator}" for name, other in beside if other.kind == figure.kind),
        ]  # fmt: skip
        return self._around(figure.start, known)

    def _around(self, start: int, known: Sequence[str]) -> set[str]:
        """The features of the token at ``start``, of which the rules say what is ``known``."""
        found, place = around(self._tokens, self._places[start], known) | self._held, self._base_places.get(start)
        return found if place is None else found | around_base(self._base, place)

    def user(self, mention: Mention) -> set[str]:
        """The features of somebody named."""
        words = self._plain[mention.start : mention.end].lower()
        known = [f"first:{words.split()[0][:8]}", f"last:{words[-1:]}", f"of:{min(len(mention.users), 3)}"]
        return self._around(mention.start, known)

    def telling(self, mention: Mention, role: str) -> tuple[int, int]:
        """The span of somebody named with the words right beside that speak for ``role``, on either side a few."""
        joints = list(_JOINT.finditer(self._plain))
        ahead = [token.end for token in self._placed if token.end <= mention.start]
        behind = [token.start for token in self._placed if token.start >= mention.end]
        low = max([0, *ahead, *(joint.start() + 1 for joint in joints if joint.start() < mention.start)])
        high = min([len(self._plain), *behind, *(joint.start() for joint in joints if joint.start() >= mention.end)])
        low, high = clause_start(self._plain, mention.start, low), clause_end(self._plain, mention.end, high)
        before = [word.start() for word in _WORD.finditer(self._plain, low, mention.start)]
        after = [word.end() for word in _WORD.finditer(self._plain, mention.end, high)][:_MOST_TELLING]
        end = _first(mention.end, after, lambda place: self._speaks_for(role, mention, mention.start, place))
        latest = before[: -_MOST_TELLING - 1 : -1]
        return _first(mention.start, latest, lambda place: self._speaks_for(role, mention, place, end)), end

    def _speaks_for(self, role: str, mention: Mention, start: int, end: int) -> float:
        """How strongly a sentence without the words from ``start`` to ``end`` beside somebody speaks for a role."""
        plain, blank = self._plain, " " * len(self._plain)
        left = plain[:start] + blank[start : mention.start] + plain[mention.start : mention.end]
        look = replace(self._look, plain=left + blank[mention.end : end] + plain[end:])
        chance = answers("user", look.view().user(mention))[role]
        return math.log((chance + _TINY) / (1 - chance + _TINY))

    def number(self, number: Number, bound: str = "") -> set[str]:
        """The features of a number without a unit; ``bound`` is how it is bounded, "" where it is not."""
        value = number.value
        whole = str(int(value)) if value is not None and value == int(value) else ""
        size = "vague" if value is None else next(name for name, most in _SIZES.items() if value <= most)
        words = self._plain[number.start : number.end].lower()
        scaled = SCALED.match(self._plain, number.end) is not None
        known = [
            f"form:{number.form}", f"{size}:{whole != ''}", f"exact:{words}", f"scaled:{scaled}", f"bound:{bound}",
            f"named:{whole in self._users}:{bool(self._users)}",
        ]  # fmt: skip
        return self._around(number.start, known)

    @property
    def words(self) -> list[int]:
        """The places of the tokens that may be a name, or a part of one; the smallest words are not."""
        return [
            place
            for place, kind in enumerate(self._kinds)
            if kind.isalpha()
            and self._tokens[place].start not in self._places
            and (is_chinese(kind) or (len(kind) > 1 and based([kind], self._language)))
        ]

    def word(self, place: int) -> set[str]:
        """The features of a word that may be somebody's name."""
        word, start = self._kinds[place], self._tokens[place].start
        known = [f"is:{word}", f"new:{not is_listed(word)}"]
        if is_chinese(word):
            around_it = self._kinds[max(0, place - 1) : place + 2]
            known += [f"with:{word}{''.join(around_it[-1:])}", f"behind:{''.join(around_it[:1])}{word}"]
        else:
            first = place == 0 or not self._kinds[place - 1].isalpha()
            large = self._plain[start].isupper() and not self._plain.isupper()  # not in "SAVE POWER"
            known += [f"large:{large}:{first}:{self._language}", f"ends:{word[-3:]}"]
        return around(self._tokens, place, known)

    def strangers(self) -> list[tuple[int, int]]:
        """The spans of what somebody is called who is none of those mentioned; words beside may be a part of it."""
        found: list[tuple[int, int, float]] = []
        for place in self.words:
            chance = answers("word", self.word(place))["somebody"]
            if chance <= _PART_OF_A_NAME:
                continue
            (start, end), beside = self.span(place), found[-1:]
            if beside and not self._plain[beside[0][1] : start].strip(" .-"):
                found[-1] = (beside[0][0], end, max(beside[0][2], chance))
            else:
                found.append((start, end, chance))
        sure = ((start, end) for start, end, chance in found if chance > _SURE_OF_A_NAME)
        return [
            span for span in sure if span[1] - span[0] >= _SHORTEST_NAME and not _USERS.fullmatch(self._plain, *span)
        ]

    def span(self, place: int) -> tuple[int, int]:
        """Where the word of a token stands."""
        token = self._tokens[place]
        return token.start, token.end

    def owners(self, start: int, candidates: Sequence[Mention | None]) -> list[set[str]]:
        """The features of each mention, or of nobody in particular, as the one whom the figure at ``start`` is for."""
        place = self._places[start]
        mentioned = [kind for kind in self._kinds if kind in _PEOPLE]
        nobody = {"bias", "nobody", f"nobody:{len(mentioned)}", *(f"nobody:{kind}" for kind in mentioned)}
        return [nobody if m is None else _between(self._tokens, place, self._places[m.start]) for m in candidates]


def _first(none: int, places: Sequence[int], speaks: Callable[[int], float]) -> int:
    """The first place up to which so much is left out that the rest speaks against it, or that nearly all is lost.

    It is ``none`` where little is lost anywhere.
    """
    said = speaks(none)
    lost = [said - speaks(place) for place in places]
    most = max(lost, default=0.0)
    if most < _TELLS:
        return none
    return next(place for place, each in zip(places, lost, strict=True) if each >= min(said + _TELLS, _NEARLY * most))


def _placeholder(plain: str, mention: Mention) -> str:
    if mention.role == "named" and plain[mention.start] in "wW":
        return "@weighed"  # w3 = 2
    if mention.role == "everybody" and _NOBODY.match(plain, mention.start) is not None:
        return "@nobody"
    each = mention.role == "everybody" and _EACH.fullmatch(plain, mention.start, mention.end) is not None
    return "@each" if each else _PLACEHOLDERS[mention.role]


def _between(tokens: Sequence[Token], figure: int, mention: int) -> set[str]:
    """The features of a figure and a mention as a pair."""
    behind = mention > figure
    inside = [token.word for token in tokens[min(figure, mention) + 1 : max(figure, mention)]]
    alike = sum(word == tokens[figure].word for word in inside)
    crowd = f"{alike}:{sum(word in _PEOPLE for word in inside)}"
    marks = "".join(word for word in inside if word in _CLAUSE_MARKS)[:3]
    distance = f"d{min(len(inside), _FAR)}"

    def said(place: int) -> str:
        return tokens[place].word if 0 <= place < len(tokens) else "end"

    outer, after = f"outer {said(mention + 1 if behind else mention - 1)}", f"after {said(figure + 1)}"
    starts = f"starts {next((t.word for t in tokens if t.word[0] == '@' and t.word != '@power'), '')}"
    seen = [
        sum(word in ("@rate", "@number", "@power", "@ratio") for word in inside), marks, distance, crowd, outer, after,
        starts, f"ahead {said(figure - 1)}",
        *(f"{crowd}:{each}" for each in (marks, distance, outer, after, starts)),
        *(f"in {each}" for each in inside[:6]),
    ]  # fmt: skip
    if len(inside) <= 4:
        seen.append(f"all {' '.join(inside)}")
    if inside:
        at, near = (inside[0], inside[-1]) if behind else (inside[-1], inside[0])
        seen += [f"near {near}", f"at {at}"]
    for name, place in (("m", mention), ("f", figure)):
        steps = (step for step in (-3, -2, -1, 1, 2, 3) if 0 <= place + step < len(tokens))
        seen += [f"{name}{step // abs(step)} {said(place + step)}" for step in steps]
    kind = f"kind:{'behind' if behind else 'before'}{tokens[mention].word}"
    return {"bias", kind, *(f"{kind}:{each}" for each in seen)}


_CLAUSE_MARKS = frozenset(",;:.，。；：、!?！？")


def likely(scores: Sequence[float] | npt.NDArray[np.float64], answers: Sequence[Answer]) -> dict[Answer, float]:
    """Scores as probabilities of the answers."""
    most = max(scores)
    parts = [math.exp(score - most) for score in scores]
    total = sum(parts)
    return {answer: part / total for answer, part in zip(answers, parts, strict=True)}


def answers(question: str, features: set[str]) -> Mapping[str, float]:
    """How likely each answer to a question is, by the model of this release."""
    return likely(shipped_roles().scores(question, features), LABELS[question])
