"""One sentence, read once: its figures, its users, its terms, and what the lexicon makes of them."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeVar, cast

from wirelessagent import plugins
from wirelessagent.language import goals
from wirelessagent.language.as_meant import as_meant, hesitating, taking_back
from wirelessagent.language.constraints import read_constraints
from wirelessagent.language.goals import Goal
from wirelessagent.language.mentions import mentions
from wirelessagent.language.moods import classes_in, lifted_in
from wirelessagent.language.numerals import numbers
from wirelessagent.language.order_model import Frame, frame_of, shipped_order_model
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.sentence_model import START, Chances, Word, shipped_sentences
from wirelessagent.language.stated import Reading
from wirelessagent.language.text import (
    AND,
    AND_ALONE,
    USER_NOUN,
    WORD_OR_SIGN,
    Span,
    blanked,
    clause_end,
    clause_start,
    clauses,
    is_chinese,
    normalise,
    overlaps,
    sentences,
    unaccented,
)
from wirelessagent.language.units import unit_at
from wirelessagent.language.vocabulary import (
    Found,
    OwnWords,
    Unit,
    Vocabulary,
    aligned,
    is_listed,
    language_of,
    respelt,
    units_of,
)
from wirelessagent.language.word_tables import deferred, either
from wirelessagent.model.objective import Objective

if TYPE_CHECKING:
    from wirelessagent.language.recogniser import Context

BUILT_IN = ("max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate")
_OF_AIMS = (
    "direct", "up", "down", "rate", "power", "efficiency", "worst", "fair", "fairly", "same", "balance", "performance",
    "waste", "share",
)  # fmt: skip
"""Concepts whose words say what is wanted, and not whether."""
_TELLS, _TELLS_FIGURES = 0.5, 0.2
"""How unlikely a sentence has to order something by itself to be left aside, and one that has figures."""
_HARDLY = 0.12
"""How unlikely a text is to order something as a whole, to be asked about whatever a part of it says."""
_FEWEST_WORDS = 3
"""Beside figures and users, of what tells something by itself."""
_SAME_BUT = deferred(  # and neither "the same but not user 3" nor "keep all but user 2"
    rf"(?i)\s*(?:{either('figures', 'kept', 'same_but')})\s*(?=\w)(?!(?:not|for|pas|no|nicht|{USER_NOUN})\b)"
)
_AND_LAST = deferred(rf"(?i)\b(?:{AND})\s*$")


Placed = TypeVar("Placed", Found, Unit)


class Sentence:
    """What an operator said, with everything that can be read off its words."""

    def __init__(
        self, text: str, own: tuple[OwnWords, ...], *, names: Sequence[str] = (), max_power_w: float = 20.0,
        gone: Sequence[Span] = (),
    ) -> None:  # fmt: skip
        text, said = blanked(text, gone), blanked(as_meant(text), gone)
        self.text, self.plain, self.language, self._gone = text, normalise(said), language_of(text), gone
        self._own, self._names, self._max_power_w, self.quantities = own, names, max_power_w, parse_quantities(said)
        self.reading: Reading = read_constraints(
            said, self.plain, self.quantities, names=names, max_power_w=max_power_w
        )
        self.units: list[Unit] = units_of(respelt(self.plain), self.reading.masked)
        self.found: list[Found] = _vocabulary(own).find(self.units)
        self.concepts = {item.term.concept for item in self.found}
        self._lifted = tuple(lifted_in(self.plain).values())
        self.goal: Goal = goals.goal_of(self.wishing(self.found))

    def wishing(self, items: list[Placed]) -> list[Placed]:
        """Those words that lift no limit: "drop the power limit" wishes for no power."""
        if not self._lifted:
            return items
        return [item for item in items if not overlaps((item.start, item.end), self._lifted)]

    @property
    def worded(self) -> bool:
        """Whether any known word stands beside figures and users, units of measure and single letters being none."""
        beside = units_of(respelt(self.plain), [(start, end) for start, end, _ in self._marked])
        return bool(self.found) or any(map(self._is_known, (*self.units, *beside)))

    def _is_known(self, unit: Unit) -> bool:
        if len(unit.word) == 1 and not is_chinese(unit.word):
            return False
        word = unaccented(unit.word)
        return unit_at(self.plain, unit.start) is None and (is_listed(word) or shipped_sentences().knows(word))

    @functools.cached_property
    def _marked(self) -> list[tuple[int, int, str]]:
        """Where figures and users stand, with the mark that the network sees in their place."""
        figures = [(q.phrase_start, q.phrase_end, f"@{q.kind}") for q in self.quantities]
        found = mentions(self.plain, self._names, [(start, end) for start, end, _ in figures])
        return [*figures, *((m.start, m.end, "@user") for m in found if m.role == "named")]

    @functools.cached_property
    def wished(self) -> list[Span]:
        """Where figures, users and words of an aim stand, from left to right; what complains is no aim."""
        complaints = [(item.start, item.end) for item in self.found if item.term.complaint]
        aims = [(item.start, item.end) for item in self.found if item.term.concept in _OF_AIMS]
        aims = [span for span in (*aims, *self.goal.spans) if not overlaps(span, complaints)]
        marked = {(start, end) for start, end, _ in self._marked}
        return sorted({*marked, *aims, *self.reading.masked})

    @functools.cached_property
    def words(self) -> list[Word]:
        """The words behind the mark of the start, with one mark for each figure and each mention of users.

        The moods of the start say what the lexicon makes of the sentence.
        """
        found, place, plain = list[tuple[str, Span]](), 0, self.plain
        for start, end, mark in [*sorted(self._marked), (len(plain), len(plain), "")]:
            if start >= place:
                words = ((each.group(), each.span()) for each in WORD_OR_SIGN.finditer(plain, place, start))
                found += [(word, span) for said, span in words if (word := unaccented(said.lower()))]
                found += [(mark, (start, end))] if mark else []
                place = end
        terms = _by_place(
            plain, ((item.term.objective or item.term.concept, (item.start, item.end)) for item in self.found)
        )
        roles = _by_place(plain, ((role, (start, end)) for start, end, role in sorted(self.reading.marks)))
        moods, wished = _by_place(plain, classes_in(plain)), _by_place(plain, (("@", span) for span in self.wished))
        goal, bases = self.goal, aligned([said for said, _ in found], self.language)
        aims = dict.fromkeys((goal.objective, *goal.options))
        start = START._replace(moods=(goal.verdict, *(f"{goal.verdict}:{aim}" for aim in aims)))
        return [start] + [
            Word(
                said, base, meant="".join(terms(span)[:1]), moods=moods(span),
                wished=bool(wished((span[0], span[0] + 1))), role="".join(roles(span)[:1]),
            )
            for (said, span), base in zip(found, bases, strict=True)
        ]  # fmt: skip

    def clauses(self) -> Iterator[tuple[Span, Sentence]]:
        """Where each clause with a figure or a user stands, but the first, and what the sentence says from there on.

        A clause of one word beside them is a bare limit: "…, user 4 out".
        """
        marked = [(start, end) for start, end, _ in self._marked]
        words = [each.start() for each in WORD_OR_SIGN.finditer(self.plain)]
        words = [place for place in words if not any(start <= place < end for start, end in marked)]
        for start, end in clauses(self.plain, marked)[1:]:
            beside = sum(start <= place < end for place in words)
            if beside > 1 and any(start <= place < end for place, _ in marked):
                rest = self.text[start:].strip(" ,;:.，；：。、")
                yield (start, end), Sentence(rest, self._own, names=self._names, max_power_w=self._max_power_w)

    def turns_unread(self) -> Iterator[Span]:
        """Where words take back a figure or a user for another one, and nobody knows which."""
        places = [*(start for start, *_ in self._marked), *(number.start for number in numbers(self.plain))]
        yield from hesitating(self.plain)
        for turn in taking_back(self.plain):
            between = any(place < turn[0] for place in places) and any(place >= turn[1] for place in places)
            if between and not overlaps(turn, self.reading.masked):
                yield turn

    def without_aims_taken_back(self) -> Sentence:
        """An order without the aims in whose place it names others: "least power, no, wait, max total rate".

        An aim reaches from the figure, the user, the clause or the "and" ahead of it to the next.
        """
        back, gone = list(taking_back(self.plain)), list[Span]()
        if not back or not self.chances.is_order:
            return self
        marked = sorted([*((start, end) for start, end, _ in self._marked), *self.reading.masked, *back])
        for start, end in back:
            next_ = min([clause_end(self.plain, end), *(begin for begin, _ in marked if begin >= end)])
            meant = self.plain[end:next_]
            denied = any(name.partition(":")[0] in ("negation", "refusal", "contrast") for name, _ in classes_in(meant))
            able = not denied and self._is_aim(_AND_LAST.sub("", meant))
            ends = [start, *(begin for begin, _ in reversed(marked) if begin < start)] if able else []
            for last in ends:
                ahead = max([clause_start(self.plain, last), *(to for _, to in marked if to <= last)])
                ahead = max([ahead, *(match.end() for match in AND_ALONE.finditer(self.plain, ahead, last))])
                if self._is_aim(self.plain[ahead:last]):
                    gone += [(ahead, last), (start, end)]
                    break
        return self._without(gone) if gone else self

    def without_what_it_tells(self) -> Sentence:
        """An order without the sentences ahead that only tell: "Last night user 3 was slow. Max rate."

        It stays whole where the rest is no order, or means something else by itself, as "… Give him 2 Mbit/s"; and
        where it names no aim of its own, or not all figures that are told: "We are granted 12 W. Max rate."
        """
        spans = sentences(self.text)
        if len(spans) < 2 or self.chances.order < _HARDLY:
            return self
        told = {span: part for span in spans for part in [self._part(span)] if part.only_tells}
        after = told.get(spans[-1])  # "Max rate. Disregard what I said.", but "… Yesterday it crawled."
        if not told or (after is not None and not any(name.startswith("past:") for name, _ in classes_in(after.plain))):
            return self
        rest = self._without([*told])
        figures = {each.kind for part in told.values() for each in part.quantities}
        stated = figures <= {each.kind for each in rest.quantities}
        bare = [number.start for number in numbers(self.plain)]
        bare = [place for place in bare if not any(start <= place < end for start, end, _ in self._marked)]
        counted = any(start <= place < end for start, end in told for place in bare)  # "Die 1 ist weg. Lass sie aus."
        others = not {*self.reading.named} <= {*rest.reading.named}  # more are told of, or meant by "him"
        aims = any(part.goal.verdict != "none" for part in told.values())
        refers = others or (counted and not rest.reading.named) or (aims and rest.goal.verdict == "none")
        if refers or not (stated and rest.chances.is_order):
            return self
        rest.reading.not_used += [part.text.strip() for part in told.values() if part.quantities]
        return rest

    def _part(self, span: Span) -> Sentence:
        return Sentence(self.text[slice(*span)], self._own, names=self._names)

    @property
    def only_tells(self) -> bool:
        """Whether it tells of something by itself, and has words enough to say so: "User 7? Not served." has not."""
        wordy = sum(word.said.isalnum() for word in self.words) >= _FEWEST_WORDS
        least = _TELLS_FIGURES if self.quantities else _TELLS
        return wordy and self.chances.order < least and self.chances.is_told

    def _without(self, gone: Sequence[Span]) -> Sentence:
        return Sentence(
            self.text, self._own, names=self._names, max_power_w=self._max_power_w, gone=(*self._gone, *gone)
        )

    def _is_aim(self, words: str) -> bool:
        """Whether some words of the sentence, by themselves, are likely to order an aim."""
        said = Sentence(words, self._own).chances if words.strip() else None
        return said is not None and said.is_order and max(said.kinds[name] for name in BUILT_IN) >= goals.ENOUGH

    @functools.cached_property
    def frame(self) -> Frame:
        """What stands around its wishes."""
        return frame_of(self)

    @functools.cached_property
    def chances(self) -> Chances:
        """What the network makes of it; of whether it orders something now, its frame says as much."""
        return shipped_sentences().chances(self.words, shipped_order_model().score(self.frame))

    @functools.cached_property
    def fidelity(self) -> float:
        """How likely it says what was read of it, and nothing beside; 1 where a word that nobody knows may say it."""
        known = all(shipped_sentences().saw(word.said) for word in self.words if word.said.isalpha())
        return self.chances.faithful if known else 1.0


def _by_place(plain: str, said: Iterable[tuple[str, Span]]) -> Callable[[Span], tuple[str, ...]]:
    """What is said of some characters of a text, in the order of their places, each once."""
    names: list[tuple[str, ...]] = [()] * len(plain)
    for name, (start, end) in said:
        names[start:end] = [(*each, name) for each in names[start:end]]
    return lambda span: tuple(dict.fromkeys(name for each in names[slice(*span)] for name in each))


def beside_the_same(text: str, context: Context | None) -> str:
    """A line behind a request without words that all else holds, "the same but without user 2", the rest in its place.

    >>> beside_the_same("Same but 8 W", None)
    'Same but 8 W'
    """
    same = _SAME_BUT.match(text) if context is not None and context.objective is not None else None
    return text if same is None else blanked(text, [same.span()])


def read_once(text: str, own: tuple[OwnWords, ...], context: Context | None) -> Sentence:
    """A sentence in its conversation, read once however many ask about it one after the other."""
    names, limit = (context.user_names, context.max_power_w) if context is not None else ((), 20.0)
    return _read(beside_the_same(text, context), own, tuple(names), limit)


@functools.lru_cache(maxsize=4)
def _read(text: str, own: tuple[OwnWords, ...], names: tuple[str, ...], max_power_w: float) -> Sentence:
    whole = Sentence(text, own, names=names, max_power_w=max_power_w)
    return whole.without_what_it_tells().without_aims_taken_back()


def own_words() -> tuple[OwnWords, ...]:
    """The words of every objective that loads, the built-in ones first."""
    own: list[OwnWords] = []
    for found in plugins.plugins("objective"):
        if found.cls is None:
            continue
        cls = cast("type[Objective]", found.cls)
        spoken = tuple((language, tuple(words)) for language, words in cls.phrases.items())
        own.append(OwnWords(objective=found.name, names=(found.name, *cls.aliases), phrases=spoken))
    order = {name: place for place, name in enumerate(BUILT_IN)}
    return tuple(sorted(own, key=lambda words: (order.get(words.objective, len(order)), words.objective)))


def labels_of(own: Sequence[OwnWords], language: str) -> Mapping[str, str]:
    """What to call each objective: its first phrase in the language, else in any, else its name."""
    labels: dict[str, str] = {}
    for words in own:
        phrases = dict(words.phrases)
        spoken = phrases.get(language) or phrases.get("en") or next(iter(phrases.values()), ())
        labels[words.objective] = spoken[0] if spoken else words.objective.replace("_", " ")
    return labels


@functools.lru_cache(maxsize=8)
def _vocabulary(own: tuple[OwnWords, ...]) -> Vocabulary:
    return Vocabulary(own)
