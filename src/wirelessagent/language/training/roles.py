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
import logging
import random
import re
import sys
import time
import zlib
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import optimize, sparse

from wirelessagent.language.dictated import as_meant
from wirelessagent.language.figure_roles import BUCKETS, LABELS, ROLES_FILE, View, hashed
from wirelessagent.language.intent import EVERYBODY
from wirelessagent.language.judged import BORROWING, Look, first_look, second_look
from wirelessagent.language.mentions import Mention, mentions
from wirelessagent.language.quantities import measures, parse_quantities
from wirelessagent.language.text import USER_NOUN, normalise, replaced
from wirelessagent.language.training.examples import FILLED, FILLINGS, OBJECTIVES, framed, spoken
from wirelessagent.language.training.fit import rounded
from wirelessagent.language.training.meant import Marked, Meant, marked, sentences, unmarked
from wirelessagent.language.training.talk_notation import talks
from wirelessagent.language.vocabulary import language_of
from wirelessagent.language.word_tables import table

NAMED = Path(__file__).with_name("named")
Span = tuple[int, int]
_COUNT = 3
"""How often a marked sentence counts, beside one that has a meaning."""

_SHARE, _MISSPELT = 0.8, 0.4
"""How many of the others count, and in how many of all a word is misspelt: no name either."""

_OF_TALKS = 3
"""One of so many lines of a talk that do something; those that do nothing may speak of anybody."""

_LONG_WORD = re.compile(r"[^\W\d_\u3400-\u9fff]{5,}")

_NOUN = re.compile(rf"(?i)(?P<article>\b(?:à\s+l'|de\s+l'|l'))?(?P<noun>{USER_NOUN})\s+(?=[0-9])")
_ARTICLES = {"à l'": "au ", "de l'": "du ", "l'": "le "}
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
    plain = normalise(text)
    spans = [(q.start, q.end) for q in parse_quantities(text)]
    parts, place = list[str](), 0
    for mention in mentions(plain, (), spans):
        noun = _NOUN.search(plain, max(place, mention.start - 5), mention.end)
        if mention.role != "named" or noun is None or _MAY_FOLLOW.match(plain, mention.end) is None:
            continue
        article = _ARTICLES.get(" ".join((noun["article"] or "").lower().split()), "")
        parts += [text[place : noun.start()], article]
        place = noun.end()
    return "".join([*parts, text[place:]])


def without_units(text: str) -> str:
    """The sentence with a unit only where it is not that of the figure before.

    >>> without_units("user 3 gets 2 Mbit/s, the others 1 Mbit/s")
    'user 3 gets 2 Mbit/s, the others 1'
    """
    plain = normalise(text)
    said, parts, place = dict[str, str](), list[str](), 0
    for measure in measures(plain):
        unit = measure.unit
        if unit is None or unit.kind == "ratio" or measure.number.value is None or unit.end != measure.end:
            continue
        words = plain[measure.number.end : unit.end].strip().lower()
        if said.get(unit.kind) == words and words:
            parts.append(text[place : measure.number.end])
            place = unit.end
        said[unit.kind] = words
    return "".join([*parts, text[place:]])


def with_one_unit(text: str) -> str:
    """The sentence with the unit of its rates said once for all of them, ahead or behind.

    >>> with_one_unit("user 3 gets 2 Mbit/s, user 5 gets 1 Mbit/s")
    'user 3 gets 2, user 5 gets 1, in Mbit/s'
    """
    plain = normalise(text)
    rates = [each for each in measures(plain) if each.unit is not None and each.unit.kind == "rate"]
    spans = [(each.number.end, each.end) for each in rates if each.unit is not None and each.unit.end == each.end]
    units = {plain[start:end].strip() for start, end in spans}
    if len(spans) < len(rates) or len(spans) < 2 or len(units) > 1 or units <= {"k", "K", "M"}:
        return text
    ways = table(FILLINGS, language_of(text))["words"]["one_unit"]
    bare = replaced(text, ((start, end, "") for start, end in spans)).rstrip(" .!。")
    return str(ways[zlib.crc32(text.encode()) % len(ways)]).format(text=bare, unit=units.pop())


def named() -> Iterator[tuple[str, list[Span], int]]:
    """Sentences, the names in them, and how often each counts."""
    chance, names = random.Random(1), defaultdict[str, list[str]](list)
    for path in sorted(NAMED.glob("*.txt")):
        for line in path.read_text(encoding="utf-8").splitlines():
            text, marks = unmarked(line)
            spans = [(start, end) for start, end, _ in marks]
            names[path.stem] += [text[start:end] for start, end in spans]
            yield text, spans, _COUNT
    for text in _without_names():
        turn = chance.random()
        if turn < _SHARE:
            yield misspelt(text, chance) if turn < _MISSPELT else text, [], 1
            swapped, spans = with_names(text, names[language_of(text)], chance)
            if spans:
                yield swapped, spans, 1


def with_names(text: str, names: Sequence[str], chance: random.Random) -> tuple[str, list[Span]]:
    """A sentence with names in the places of those whom it names by number, and where they stand."""
    plain, spans, place, found = normalise(text), list[Span](), 0, ""
    for mention in first_look(plain, parse_quantities(text)).mentions:
        if mention.role == "named":
            found, name = found + plain[place : mention.start], chance.choice(names)
            spans.append((len(found), len(found) + len(name)))
            found, place = found + name, mention.end
    return found + plain[place:], spans


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
    yield from _shown(_look(marked_one.text), marked_one)


def named_in(text: str, names: Sequence[tuple[int, int]]) -> Iterator[Example]:
    """What a sentence shows of words that are somebody's name, as those in the spans ``names`` are, and of others.

    The small words of a name show nothing: "my", "on the".
    """
    look = _look(text)
    plain, view = look.plain, look.view()
    for place in view.words:
        start, end = view.span(place)
        name = any(first < end and start < last for first, last in names)
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
    weights = [number for number, role in only.items() if role == "weight"]
    for mention in found:
        if mention.role == "named":
            yield from _example("user", view.user(mention), wanted.of_user(mention, found))
        elif mention.role == "pronoun":
            yield from _example("user", view.user(mention), wanted.of_pronoun(mention, found))
    for index, figure in enumerate(look.figures):
        yield from _example(figure.kind, view.figure(index), wanted.of_figure(figure))
        if figure.kind == "rate":
            yield from _link(view, figure.start, found, wanted.owners(figure))
    for number in weights:
        if number.value is not None:
            yield from _link(view, number.start, found, wanted.weighed(float(number.value)))


def _example(question: str, features: set[str], roles: set[str]) -> Iterator[Example]:
    right = tuple(label in roles for label in LABELS[question])
    if any(right):
        yield Example(question=question, rows=(hashed(question, features),), right=right)


def _link(view: View, start: int, found: Sequence[Mention], owners: set[str]) -> Iterator[Example]:
    candidates: list[Mention | None] = [*found, None]
    right = [_is_for(mention, found, owners) for mention in candidates]
    if EVERYBODY in owners and any(m is not None and m.role == "others" for m in candidates):
        right = [ok and m is not None and m.role != "everybody" for ok, m in zip(right, candidates, strict=True)]
        if not any(right):
            right = [_is_for(mention, found, owners) for mention in candidates]
    if any(right):
        rows = [hashed("link", each) for each in view.owners(start, candidates)]
        yield Example(question="link", rows=tuple(rows), right=tuple(right))


def _is_for(mention: Mention | None, found: Sequence[Mention], owners: set[str]) -> bool:
    if mention is None or mention.role in ("others", "everybody"):
        return EVERYBODY in owners
    if mention.role == "pronoun":
        named = [other for other in found if other.role == "named" and other.end <= mention.start]
        return bool(named) and owners.issuperset(named[-1].users)
    return owners.issuperset(mention.users)


def fit(question: str, shown: Sequence[Example], ridge: float = _RIDGE) -> npt.NDArray[np.float32]:
    """Weights (bucket, label) that make the right answers likeliest, with a ridge."""
    classes = len(LABELS[question])
    rows = [row for example in shown for row in example.rows]
    matrix = _matrix(rows)
    # Row i of ``group`` belongs to sentence ``owner[i]``: answers of one example compete with each other.
    owner = np.repeat(np.arange(len(shown)), [len(example.rows) for example in shown])
    right = np.array([each for example in shown for each in example.right], dtype=bool).reshape(len(rows), classes)
    columns = matrix.T.tocsr()
    importance = _importance(right, owner, len(shown)) if classes > 1 else np.full(len(shown), 1 / len(shown))

    def loss(flat: npt.NDArray[np.float64]) -> tuple[float, npt.NDArray[np.float64]]:
        weights = flat.reshape(BUCKETS, classes)
        score = np.asarray(matrix @ weights)
        score -= _most(score.max(axis=1), owner, len(shown))[owner][:, None]
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


def _importance(right: npt.NDArray[np.bool_], owner: npt.NDArray[np.int64], count: int) -> npt.NDArray[np.float64]:
    """What each example counts: rare answers more, though not equally."""
    share = right.mean(axis=0)
    rows = np.where(right, np.maximum(share, 1e-9) ** -_BALANCE, 0).max(axis=1)
    importance = np.zeros(count)
    np.maximum.at(importance, owner, rows)
    return importance / importance.sum()


def _most(values: npt.NDArray[np.float64], owner: npt.NDArray[np.int64], count: int) -> npt.NDArray[np.float64]:
    most = np.full(count, -np.inf)
    np.maximum.at(most, owner, values)
    return most


def _matrix(rows: Sequence[npt.NDArray[np.int64]]) -> sparse.csr_matrix:
    sizes = np.array([len(row) for row in rows])
    values = np.repeat(1 / np.sqrt(sizes), sizes)
    starts = np.concatenate([[0], np.cumsum(sizes)])
    return sparse.csr_matrix((values, np.concatenate(rows), starts), shape=(len(rows), BUCKETS))


def trained(sentences: Iterable[tuple[str, Mapping[str, Any]]]) -> dict[str, npt.NDArray[np.float32]]:
    """The weights of each question, from sentences with their constraints."""
    shown: dict[str, list[Example]] = {question: [] for question in LABELS}
    for text, constraints in sentences:
        for example in examples(text, constraints):
            shown[example.question].append(example)
        for words in shortened(text):
            for example in examples(words, constraints):
                if example.question in _SHORTENED:
                    shown[example.question].append(example)
    for line in marked():
        for example in shown_by(line):
            shown[example.question] += [example] * _MARKED_COUNT
    for text, names, count in named():
        for example in named_in(text, names):
            shown["word"] += [example] * count
    return {question: fit(question, each) for question, each in shown.items()}


def save(path: Path, found: Mapping[str, npt.NDArray[np.float32]]) -> None:
    """Write the model."""
    arrays: dict[str, npt.NDArray[Any]] = {}
    for question, weights in found.items():
        arrays[f"{question}_weights"], arrays[f"{question}_scales"] = rounded(weights, _FAINT)
    np.savez_compressed(path, allow_pickle=False, **arrays)


def main(path: Path) -> None:
    """Read, fit and write."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    start = time.perf_counter()
    save(path, trained(sentences()))
    seconds = time.perf_counter() - start
    logging.getLogger(__name__).info("%s: %d kB (%.0f s)", path.name, path.stat().st_size // 1000, seconds)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROLES_FILE)
