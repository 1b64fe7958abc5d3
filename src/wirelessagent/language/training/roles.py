"""Make the model of roles anew: ``python -m wirelessagent.language.training.roles [FILE]``.

Each sentence with its constraints shows what its figures and users are: a power that is the wanted circuit power has
that role, a user who is wanted left out is named to be left out. A sentence whose wanted figures were not all read
shows nothing about figures of their kind.

More of them are said shorter with the same meaning: "3 gets 2 Mbit/s, 5 gets 1 Mbit/s" and "user 3 gets 2 Mbit/s,
user 5 gets 1"; people shorten so, and few who write sentences down do. People and things are called by a name in
``named/<language>.txt``: a name that stands for a user is marked, "[the camera]{name} can wait"; other nouns are
nobody's. Beside them count those that have a meaning, as they are, and with names in the places of those whom they name
by number.
"""

from __future__ import annotations

import itertools
import random
import re
import zlib
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import optimize

from wirelessagent.language.as_meant import as_meant
from wirelessagent.language.figure_roles import BUCKETS, LABELS, ROLES_FILE, View, hashed
from wirelessagent.language.intent import EVERYBODY, RATES
from wirelessagent.language.mentions import Mention, mentions
from wirelessagent.language.number_roles import BORROWING, Look, first_look, second_look
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import measures, parse_quantities
from wirelessagent.language.shares import worked_out
from wirelessagent.language.text import USER_NOUN, Span, normalise, overlaps, replaced
from wirelessagent.language.training.examples import FILLED, FILLINGS, OBJECTIVES, framed, lines_of, spoken
from wirelessagent.language.training.fit import matrix_of, rounded, write
from wirelessagent.language.training.meant import Marked, Meant, antecedent, marked, sentences, unmarked
from wirelessagent.language.training.talk_notation import talks
from wirelessagent.language.vocabulary import language_of
from wirelessagent.language.word_tables import table

NAMED = Path(__file__).with_name("named")
_COUNT = 3
"""How often a marked sentence counts, beside one that has a meaning."""

_SHARE, _MISSPELT = 0.8, 0.4
"""How many of the others count, and in how many of all a word is misspelt: no name either."""

_OF_TALKS = 3
"""One of so many lines of a talk that do something; those that do nothing may speak of anybody."""

_LONG_WORD = re.compile(r"[^\W\d_\u3400-\u9fff]{5,}")

_ARTICLES: Mapping[str, str] = table(FILLINGS, "fr")["articles"]
_ARTICLE = "|".join(_ARTICLES).replace(" ", r"\s+")
_NOUN = re.compile(rf"(?i)(\b(?:{_ARTICLE}))?{USER_NOUN}\s+(?=[0-9])")
_MAY_FOLLOW = re.compile(r"\s*(?:$|[^\W\d_]|[,.;:!?)\uff0c。；、](?!\s*[0-9]))")


def shortened(text: str) -> Iterator[str]:
    """The shorter ways to say a sentence, none where there is nothing to leave out."""
    for shorter in (without_nouns(text), without_units(text), with_one_unit(text)):
        if shorter != text:
            yield shorter


def without_nouns(text: str) -> str:
    """The sentence with users called by their numbers alone.

    >>> without_nouns("let user 3 have 1 Mbit/s and drop users 5 and 7")
    'let 3 have 1 Mbit/s and drop 5 and 7'
    """
    plain, nouns, place = normalise(text), list[tuple[int, int, str]](), 0
    for mention in mentions(plain, (), [(q.start, q.end) for q in parse_quantities(text)]):
        noun = _NOUN.search(plain, max(place, mention.start - 5), mention.end)
        if mention.role == "named" and noun is not None and _MAY_FOLLOW.match(plain, mention.end) is not None:
            article = " ".join((noun[1] or "").lower().split())
            nouns.append((noun.start(), noun.end(), _ARTICLES.get(article, "")))
            place = noun.end()
    return replaced(text, nouns)


def without_units(text: str) -> str:
    """The sentence with a unit only where it is not that of the figure before.

    >>> without_units("user 3 gets 2 Mbit/s, the others 1 Mbit/s")
    'user 3 gets 2 Mbit/s, the others 1'
    """
    said, again = dict[str, str](), list[tuple[int, int, str]]()
    for number, kind, unit, span in _units(text):
        if unit and number.value is not None:
            if unit.lower() == said.get(kind):
                again.append((*span, ""))
            said[kind] = unit.lower()
    return replaced(text, again)


def with_one_unit(text: str) -> str:
    """The sentence with the unit of its rates said once for all of them, ahead or behind.

    >>> with_one_unit("user 3 gets 2 Mbit/s, user 5 gets 1 Mbit/s")
    'user 3 gets 2, user 5 gets 1, in Mbit/s'
    """
    rates = [(unit, span) for _, kind, unit, span in _units(text) if kind == "rate"]
    units = {unit for unit, _ in rates}
    if len(rates) < 2 or len(units) > 1 or units <= {"", "k", "K", "M"}:
        return text
    ways = table(FILLINGS, language_of(text))["words"]["one_unit"]
    bare = replaced(text, ((*span, "") for _, span in rates)).rstrip(" .!。")
    return str(ways[zlib.crc32(text.encode()) % len(ways)]).format(text=bare, unit=units.pop())


def _units(text: str) -> Iterator[tuple[Number, str, str, Span]]:
    """Each number with a unit: the unit's kind, its words, none where more of the figure follows, and their place."""
    plain = normalise(text)
    for measure in measures(plain):
        unit, start = measure.unit, measure.number.end
        if unit is not None and unit.kind != "ratio":
            words = plain[start : unit.end].strip() if unit.end == measure.end else ""
            yield measure.number, unit.kind, words, (start, unit.end)


def named() -> Iterator[tuple[str, int]]:
    """Sentences with the names in them marked, and how often each counts."""
    chance, names = random.Random(1), defaultdict[str, list[str]](list)
    for language, line in lines_of(NAMED):
        text, marks = unmarked(line)
        names[language] += [text[start:end] for start, end, _ in marks]
        yield line, _COUNT
    for text in _without_names():
        turn = chance.random()
        if turn < _SHARE:
            yield misspelt(text, chance) if turn < _MISSPELT else text, 1
            swapped = with_names(text, names[language_of(text)], chance)
            if swapped != normalise(text):
                yield swapped, 1


def with_names(text: str, names: Sequence[str], chance: random.Random) -> str:
    """A sentence with marked names in the places of those whom it names by number."""
    plain = normalise(text)
    found = (each for each in first_look(plain, parse_quantities(text)).mentions if each.role == "named")
    return replaced(plain, ((each.start, each.end, f"[{chance.choice(names)}]{{name}}") for each in found))


def misspelt(text: str, chance: random.Random) -> str:
    """A sentence in which one of the longer words lacks a letter."""
    words = list(_LONG_WORD.finditer(text))
    if not words:
        return text
    start, end = chance.choice(words).span()
    place = chance.randrange(start + 1, end)
    return text[:place] + text[place + 1 :]


def _without_names() -> Iterator[str]:
    """Sentences that call nobody by a name."""
    yield from (text for text, _ in sentences())
    wordless = (each for each in spoken() if each.constraints is None)
    yield from (each.text for each in wordless if each.label in OBJECTIVES or each.label.startswith("command"))
    yield from (text for text, *_ in itertools.islice(framed(), 0, None, FILLED))
    yield from (text for _, lines, _ in talks() for text, does in lines[::_OF_TALKS] if does != "nothing")


_RIDGE = 1e-6
_STEPS = 200
_BALANCE = 0.3
_SMALL = 4
_SHORTENED = ("number", "user", "link")  # what is learned from sentences said shorter
_MARKED_COUNT = 2
"""How often a marked sentence counts, beside one with its meaning."""

_FAINT = 3
"""Weights of so many 127ths of the largest cost half of the file and change nothing."""


@dataclass(frozen=True, kw_only=True)
class Example:
    """One figure or user: the buckets of each answer and which answers are right.

    For a question with labels there is one row of buckets, for "link" one for each candidate.
    """

    question: str
    rows: tuple[npt.NDArray[np.int64], ...]
    right: tuple[bool, ...]


def _look(text: str) -> Look:
    """What a sentence holds, without what it takes back, before anybody asks what its numbers are."""
    said = as_meant(text)
    return first_look(normalise(said), parse_quantities(said))


def examples(text: str, constraints: Mapping[str, Any]) -> Iterator[Example]:
    """What a sentence with its meaning shows."""
    look = _look(text)
    yield from _shown(look, Meant(constraints, look))


def shown_by(line: str) -> Iterator[Example]:
    """What a sentence shows whose figures and users are marked."""
    marked_one = Marked(line)
    if worked_out(marked_one.text) == marked_one.text:  # what is worked out stands there no longer
        yield from _shown(_look(marked_one.text), marked_one)


def named_in(line: str) -> Iterator[Example]:
    """What a sentence shows of words that are somebody's name, as those that are marked are, and of others.

    The small words of a name show nothing: "my", "on the".
    """
    text, marks = unmarked(line)
    look = _look(text)
    plain, view = look.plain, look.view()
    for place in view.words:
        start, end = view.span(place)
        name = overlaps((start, end), ((first, last) for first, last, _ in marks))
        if not (name and end - start < _SMALL and plain[start].islower() and plain[start].isascii()):
            yield from _example("word", view.word(place), {"somebody" if name else "nobody"})


def _shown(look: Look, wanted: Meant | Marked) -> Iterator[Example]:
    numbers = [(number, wanted.of_number(number)) for number in (*look.loose, *look.ones)]
    view = look.view()
    for number, roles in numbers:
        yield from _example("number", view.number(number, look.bound(number)), roles)
    only = {number: next(iter(roles)) for number, roles in numbers if len(roles) == 1}
    users = [number for number, role in only.items() if role == "user"]
    look = second_look(look, users, {number: role for number, role in only.items() if role in BORROWING})
    view, found = look.view(), look.mentions
    for mention in found:
        if mention.role in ("named", "pronoun"):
            yield from _example("user", view.user(mention), wanted.of_user(mention, found))
    for index, figure in enumerate(look.figures):
        yield from _example(figure.kind, view.figure(index), wanted.of_figure(figure))
        if figure.kind == "rate":
            yield from _link(view, figure.start, found, wanted.owners(figure.value, *RATES))
    for number, role in only.items():
        if role == "weight" and number.value is not None:
            yield from _link(view, number.start, found, wanted.owners(float(number.value), "weights"))


def _example(question: str, features: set[str], roles: set[str]) -> Iterator[Example]:
    right = tuple(label in roles for label in LABELS[question])
    if any(right):
        yield Example(question=question, rows=(hashed(question, features),), right=right)


def _link(view: View, start: int, found: Sequence[Mention], owners: set[str]) -> Iterator[Example]:
    candidates: list[Mention | None] = [*found, None]
    right = [_is_for(mention, found, owners) for mention in candidates]
    if EVERYBODY in owners and any(mention.role == "others" for mention in found):
        alone = [ok and m is not None and m.role != "everybody" for ok, m in zip(right, candidates, strict=True)]
        right = alone if any(alone) else right
    if any(right):
        rows = [hashed("link", each) for each in view.owners(start, candidates)]
        yield Example(question="link", rows=tuple(rows), right=tuple(right))


def _is_for(mention: Mention | None, found: Sequence[Mention], owners: set[str]) -> bool:
    if mention is None or mention.role in ("others", "everybody"):
        return EVERYBODY in owners
    somebody = antecedent(mention, found) if mention.role == "pronoun" else mention
    return somebody is not None and owners.issuperset(somebody.users)


def fit(question: str, shown: Sequence[Example], ridge: float = _RIDGE) -> npt.NDArray[np.float32]:
    """Weights (bucket, label) that make the right answers likeliest, with a ridge."""
    classes = len(LABELS[question])
    rows = [row for example in shown for row in example.rows]
    matrix = matrix_of(rows, BUCKETS)
    # Row i of ``group`` belongs to sentence ``owner[i]``: answers of one example compete with each other.
    counts = [len(example.rows) for example in shown]
    owner, begins = np.repeat(np.arange(len(shown)), counts), np.cumsum([0, *counts[:-1]])
    right = np.array([each for example in shown for each in example.right], dtype=bool).reshape(len(rows), classes)
    columns = matrix.T.tocsr()
    # Rare answers count more, though not equally.
    rare = np.where(right, np.maximum(right.mean(axis=0), 1e-9) ** -_BALANCE, 0).max(axis=1)
    importance = np.maximum.reduceat(rare, begins) if classes > 1 else np.ones(len(shown))
    importance /= importance.sum()

    def loss(flat: npt.NDArray[np.float64]) -> tuple[float, npt.NDArray[np.float64]]:
        weights = flat.reshape(BUCKETS, classes)
        score = np.asarray(matrix @ weights)
        score -= np.maximum.reduceat(score.max(axis=1), begins)[owner][:, None]
        likely = np.exp(score)
        likely /= np.bincount(owner, likely.sum(axis=1), len(shown))[owner][:, None]
        chosen = likely * right
        total = np.bincount(owner, chosen.sum(axis=1), len(shown)) + 1e-300
        slope = (likely - chosen / total[owner][:, None]) * importance[owner][:, None]
        value = -float(importance @ np.log(total)) + ridge * float((weights**2).sum())
        return value, (np.asarray(columns @ slope) + 2 * ridge * weights).ravel()

    found = optimize.minimize(
        loss, np.zeros(BUCKETS * classes), jac=True, method="L-BFGS-B", options={"maxiter": _STEPS, "maxcor": 5}
    )
    return np.asarray(found.x, dtype=np.float32).reshape(BUCKETS, classes)


def trained(sentences: Iterable[tuple[str, Mapping[str, Any]]]) -> dict[str, npt.NDArray[np.float32]]:
    """The weights of each question, from sentences with their constraints."""
    shown: dict[str, list[Example]] = {question: [] for question in LABELS}
    for text, constraints in sentences:
        for example in examples(text, constraints):
            shown[example.question].append(example)
        for example in itertools.chain.from_iterable(examples(words, constraints) for words in shortened(text)):
            if example.question in _SHORTENED:
                shown[example.question].append(example)
    for line in marked():
        for example in shown_by(line):
            shown[example.question] += [example] * _MARKED_COUNT
    for line, count in named():
        for example in named_in(line):
            shown["word"] += [example] * count
    return {question: fit(question, each) for question, each in shown.items()}


def save(path: Path, found: Mapping[str, npt.NDArray[np.float32]]) -> None:
    """Write the model."""
    arrays: dict[str, npt.NDArray[Any]] = {}
    for question, weights in found.items():
        arrays[f"{question}_weights"], arrays[f"{question}_scales"] = rounded(weights, _FAINT)
    np.savez_compressed(path, allow_pickle=False, **arrays)


if __name__ == "__main__":
    write(ROLES_FILE, lambda path: save(path, trained(sentences())))
