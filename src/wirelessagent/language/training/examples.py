"""The sentences that the network and the judge of orders learn from: what they want, and whether they order it.

They are drawn from templates, written down as people say them, ``spoken/<language>.tsv``, lines of
talks (:mod:`.talk_notation`), and frames that are filled, ``frames/<language>.tsv``.

Each line of the spoken ones is a label, a sentence, and for a request its constraints as JSON in SI units, where they
are known. Labels are objectives, kinds of intents, and topics of questions and commands; "none" is a question, a remark
or a report, all that orders nothing now, and "order" is what orders something that nobody wrote down. They were written
for training, by authors who saw no test set; those in ``<language>_near.tsv`` so that what orders something and what
does not are easily mistaken for each other, those in ``<language>_dictated.tsv`` as well, as they are dictated among
small talk, and those in ``<language>_told.tsv``, beside what is only told; those in ``<language>_turned.tsv`` so that
what means what its figures and users look like and what does not are, too: groups of orders, and between them what has
to be asked about, "clarify" without constraints.

A line of the frames is "order" or "none" and a sentence with ``{}`` in the place of its wish.

Templates are text, ``<language>.txt``: a line ``[label]`` begins the templates of a label, ``= name`` a list that
``<name>`` refers to; ``(a|b|)`` is a choice and ``%`` begins a comment. What ``<power>``, ``<rate>``, ``<ratio>``,
``<bare>`` and ``<user_ref>`` stand for, and what sentences are put together with, is in ``fillings/<language>.toml``.
"""

from __future__ import annotations

import itertools
import json
import math
import random
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from wirelessagent.language.sentence_model import TOLD
from wirelessagent.language.training.talk_notation import talks
from wirelessagent.language.word_tables import deferred, table, words_of
from wirelessagent.model.errors import InputError

Slot: TypeAlias = Callable[[random.Random], str]

OBJECTIVES = ("max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate")
LANGUAGES = ("en", "zh", "es", "fr", "de")
SURROUNDINGS = ("opener", "closer", "neutral", "constraint", "contrast", "wonder")

_FOLDER = Path(__file__).parent
FILLINGS = "training/fillings"
_NOUNS: dict[str, str] = dict(
    zip(OBJECTIVES, ("rate_noun", "power_noun", "ee_noun", "pf_noun", "mm_noun"), strict=True)
)
_RIVALS = (("max_rate", "min_power"), ("max_rate", "max_min_rate"), ("proportional_fairness", "max_min_rate"))
_NUMBERS = ("1", "2", "5", "10", "12", "20", "25", "40", "0.5", "2.5", "300", "100", "1.2")
_TYPOS, _BARE = 0.1, 0.25
_GOES_BACK, _LIMIT_ALONE, _AIM_ALONE = 0.06, 0.25, 0.6
_PER_WISH, _PER_SITUATION, _PER_WORDS, _PER_OTHER = 9.0, 4.0, 12.0, 5.0
"""How often a template is drawn, for each doubling of its variety."""

_SPACES = re.compile(r"\s+")
_PART = re.compile(r"<[^>]*>|[()|]|[^<()|]+")
_TIGHT = re.compile(r"\s+([,.;:!?\uff0c。？])")


def slots(language: str) -> Mapping[str, Slot]:
    """What draws the figures and users of a language's templates."""

    def slot(name: str, choices: list[str]) -> Slot:
        if name in ("power", "rate"):
            return lambda chance: chance.choice(_NUMBERS) + chance.choice(choices)
        return lambda chance: chance.choice(choices)

    return {name: slot(name, choices) for name, choices in table(FILLINGS, language)["slots"].items()}


def sentences(seed: int = 1) -> Iterator[tuple[str, str]]:
    """(sentence, label) for training, the same ones for a seed."""
    chance = random.Random(seed)
    for language in LANGUAGES:
        for text, label in _Maker(language, chance).all():
            yield (mistyped(text, chance) if chance.random() < _TYPOS else text), label


def mistyped(text: str, chance: random.Random) -> str:
    """A sentence with one slip: a letter lost, doubled, or swapped with its neighbour."""
    if len(text) < 6:
        return text
    place = chance.randrange(1, len(text) - 2)
    if not text[place].isalpha() or not text[place + 1].isalpha():
        return text
    a, b = text[place], text[place + 1]
    return text[:place] + chance.choice((b + a, a, a + a + b)) + text[place + 2 :]


@dataclass(frozen=True, kw_only=True)
class Grammar:
    """The templates of one language."""

    language: str
    templates: Mapping[str, Sequence[str]]
    lists: Mapping[str, Sequence[str]]

    @classmethod
    def read(cls, path: Path) -> Grammar:
        templates, lists, into = dict[str, list[str]](), dict[str, list[str]](), list[str]()
        for line in path.read_text(encoding="utf-8").splitlines():
            text = line.strip()
            if text.startswith("["):
                into = templates.setdefault(text.strip("[]"), [])
            elif text.startswith("= "):
                into = lists.setdefault(text[2:].strip(), [])
            elif text and not text.startswith("%"):
                into.append(text)
        return cls(language=path.stem, templates=templates, lists=lists)

    def draw(self, template: str, chance: random.Random, slots: Mapping[str, Slot]) -> str:
        """One of the sentences that a template stands for."""
        choices = [[""]]  # that are open, the innermost last, each with its options so far
        for part in _PART.findall(template):
            if part == "(":
                choices.append([""])
            elif part == "|":
                choices[-1].append("")
            elif part == ")":
                drawn = chance.choice(choices.pop())
                choices[-1][-1] += drawn
            elif part[0] == "<":
                name = part[1:-1]
                listed = None if name in slots else chance.choice(self.lists[name])
                choices[-1][-1] += slots[name](chance) if listed is None else self.draw(listed, chance, slots)
            else:
                choices[-1][-1] += part
        assert [len(options) for options in choices] == [1], f"unbalanced brackets in {template!r}"
        text = choices[0][0]
        text = _SPACES.sub("" if self.language == "zh" and not text.isascii() else " ", text).strip()
        return _TIGHT.sub(r"\1", text)

    def variety(self, template: str) -> int:
        """Roughly how many sentences a template stands for."""
        return (template.count("|") + 1) * (1 + 3 * template.count("<"))


class _Maker:
    """Sentences of one language."""

    def __init__(self, language: str, chance: random.Random) -> None:
        self._grammar, self._chance = Grammar.read(_FOLDER / f"{language}.txt"), chance
        self._slots, self._words_by_use = slots(language), table(FILLINGS, language)["words"]
        self._gap, self._comma = ("", "\uff0c") if language == "zh" else (" ", ", ")

    def wish(self) -> tuple[str, str]:
        """What somebody may want of a cell, with its kind: an aim, a limit, both, and at times to go back."""
        draw = self._chance.random()
        if draw < _GOES_BACK:
            command = self._chance.choice(("command.undo", "command.reset"))
            return self._pick(command), command
        objective = self._chance.choice(OBJECTIVES)
        aim, limit = self._pick(objective), self._pick("constraint")
        if draw < _LIMIT_ALONE:
            return limit, "clarify.limits"
        return (aim if draw < _AIM_ALONE else aim + self._words_by_use["and"][0] + limit), objective

    def all(self) -> Iterator[tuple[str, str]]:
        """Sentences of every template, with their labels."""
        for label, templates in self._grammar.templates.items():
            if label in SURROUNDINGS:
                continue
            kind, _, use = label.partition(".")
            if use == "words":
                make, often, meant = self._words, _PER_WORDS, kind
            elif kind in OBJECTIVES:
                make, often, meant = self._wish, _PER_SITUATION if use else _PER_WISH, kind
            else:
                make, often, meant = self._other, _PER_OTHER, "question.other" if label == "question.fact" else label
            for template in templates:
                for _ in range(round(often * math.log2(1 + self._grammar.variety(template)))):
                    yield make(template, label), meant
        yield from self._turned_round()

    def _turned_round(self) -> Iterator[tuple[str, str]]:
        """Wishes that are wondered about, refused, or at odds with each other."""
        chance = self._chance
        for _ in range(60 if self._grammar.language in ("en", "zh") else 20):
            for objective in OBJECTIVES:
                wish = self._pick(objective)
                wonder = self._pick("wonder", wish=wish)
                yield wonder + ("?" if chance.random() < 0.6 else ""), "question.what_if"
            for rivals in _RIVALS:
                pair = [self._pick(objective) for objective in rivals]
                chance.shuffle(pair)
                yield chance.choice(self._words_by_use["and"]).join(pair), "clarify.rivals"
            refused = chance.choice(self._words_by_use["not"]) + self._pick(chance.choice(OBJECTIVES))
            yield refused, "clarify.negated"

    def _draw(self, template: str, **more: str) -> str:
        """One of the sentences of a template, with ``more`` in the places of their names."""
        given: Mapping[str, Slot] = {name: lambda _, text=text: text for name, text in more.items()}
        return self._grammar.draw(template, self._chance, {**self._slots, **given})

    def _pick(self, name: str, **more: str) -> str:
        return self._draw(self._chance.choice(self._grammar.templates[name]), **more)

    def _wish(self, template: str, label: str) -> str:
        """A wish, or the story of one, among other sentences."""
        chance = self._chance
        objective, _, situation = label.partition(".")
        core = self._draw(template)
        if chance.random() < _BARE:
            return core
        parts = [core]
        if situation and chance.random() < 0.35:
            parts.append(self._pick(objective))
        elif not situation and chance.random() < 0.12:
            parts.insert(chance.randrange(2), self._pick(objective))
        elif not situation and chance.random() < 0.2:
            parts[0] = self._contrasted(core, objective)
        if not situation and chance.random() < 0.07:
            stories = [name for name in self._grammar.templates if name.endswith(".situation")]
            parts.insert(0, self._pick(chance.choice(stories) if stories else "neutral"))  # which the wish overrules
        if chance.random() < 0.3 and not situation:
            parts[0] = self._pick("opener") + self._gap + parts[0]
        for _ in range(chance.choice((0, 0, 0, 1, 1, 2, 3))):
            parts.insert(chance.choice((0, len(parts), len(parts))), self._pick("constraint"))
        if chance.random() < 0.15:
            parts.insert(0, self._pick("neutral"))
        if chance.random() < 0.2:
            parts[-1] += chance.choice((self._gap, self._comma)) + self._pick("closer")
        text = parts[0]
        for part in parts[1:]:
            joints = (self._comma, self._comma, *self._words_by_use["and"], self._gap or self._comma)
            text += chance.choice(joints) + part
        return self._as_question(text)

    def _as_question(self, text: str) -> str:
        """A polite request often ends like a question: "could you …?"."""
        polite = text.lower().startswith(words_of(FILLINGS, "words", "polite")) or text.endswith("吗")
        return text + "?" if polite and self._chance.random() < 0.6 else text

    def _words(self, template: str, label: str) -> str:
        """A few words of an objective among small words, in any order."""
        chance = self._chance
        parts = [self._draw(template)]
        parts += [self._pick(label) for _ in range(chance.choice((0, 1, 1)))]
        parts += chance.sample(self._words_by_use["small"], chance.randrange(2, 7))
        chance.shuffle(parts)
        if chance.random() < 0.3:
            parts.insert(chance.choice((0, len(parts))), self._comma.strip() + self._pick("constraint"))
        return self._gap.join(parts)

    def _contrasted(self, wish: str, objective: str) -> str:
        """A wish beside an objective that is not wanted."""
        other = self._chance.choice([name for name in OBJECTIVES if name != objective])
        contrast = self._pick("contrast", other=self._draw(f"<{_NOUNS[other]}>"))
        if self._chance.random() < 0.6 or contrast.endswith((",", ":", "\uff0c")):
            return contrast + self._gap + wish
        return wish + self._comma + contrast

    def _other(self, template: str, label: str) -> str:
        """What is no wish, at times among other sentences."""
        chance = self._chance
        text = self._draw(template)
        kind = label.partition(".")[0]
        if chance.random() < (0.2 if kind != "question" else 0.1):
            text = self._pick("opener") + self._gap + text
        if chance.random() < 0.15:
            text += chance.choice((self._gap, self._comma)) + self._pick("closer")
        if label in ("clarify.opposite", "clarify.negated", "clarify.rivals") and chance.random() < 0.3:
            text += self._comma + self._pick("constraint")
        text = self._as_question(text) if kind != "question" or chance.random() > 0.7 else text + "?"
        if chance.random() < 0.05:
            text = self._pick("neutral") + self._comma + text
        return text


SPOKEN, FRAMES = Path(__file__).with_name("spoken"), Path(__file__).with_name("frames")

FILLED, _LONGEST, _CHOICE = 4, 60, 3_000
"""How often each frame is filled, in turns with what people said, in so many letters, and with one of so many drawn."""

MILD, FRAME, TALK = 0.6, 3.0, 0.8
"""What a sentence counts that was not written to be mistaken, a frame, and a line of a talk, beside one that was."""

_LINE = deferred(r"(?:\w+\W+){4}\w|[\u3400-\u9fff]{6}")
"""A line of a talk that says by itself whether it orders something: five words, or six Chinese characters."""

_DRAWN, _NEAR, _FILLING = 0.5, 0.3, 0.5
"""What the kind of a drawn aim counts, of a sentence that only orders or does not, and of the wish in a frame that
orders it, beside one that is known."""

_BESIDE = 0.5
"""In what share of the passes a line that orders nothing is read of those with what is only told beside: of all that
such authors wrote half is one, and long orders would be doubted."""

_SLIPS = 0.15
"""How much of what people wrote of aims is read with a slip as well."""

_ASKED = ("?", "？", "吗")
"""How most questions end."""


def lines_of(folder: Path) -> Iterator[tuple[str, str]]:
    """Every line that is written down in a folder, with the name of its file.

    Raises:
        InputError: there are none; an installed package leaves them out.
    """
    paths = sorted(folder.glob("*.t??"))
    if not paths:
        raise InputError(f"no sentences in {folder}: train from a checkout of the sources, which has them")
    for path in paths:
        for line in path.read_text(encoding="utf-8").splitlines():
            yield path.stem, line


@dataclass(frozen=True, kw_only=True)
class Spoken:
    """A sentence with its label; ``constraints`` are None where nobody wrote them down.

    Attributes:
        near: whether it was written to be mistaken.
        turned: whether it was written so that something else is read of it than it means, or nearly so.
        told: whether it was written beside what is only told.
    """

    text: str
    label: str
    language: str
    constraints: Mapping[str, Any] | None = None
    near: bool = False
    turned: bool = False
    told: bool = False

    @property
    def is_order(self) -> bool | None:
        """Whether it orders something now; None where it may or may not."""
        if self.label.startswith(("order", "command", *OBJECTIVES)) or (self.label == "clarify" and self.constraints):
            return True
        return False if self.label.startswith(("none", "question", "out_of_scope")) else None


def spoken(folder: Path = SPOKEN) -> Iterator[Spoken]:
    """The sentences of all languages."""
    for name, line in lines_of(folder):
        label, text, *more = line.split("\t")
        language, _, near = name.partition("_")
        yield Spoken(
            text=text, label=label, language=language, near=bool(near), turned=near == "turned", told=near == "told",
            constraints=json.loads(more[0]) if more else None,
        )  # fmt: skip


def framed() -> Iterator[tuple[str, bool, str]]:
    """Each frame, filled with wishes, whether it orders something, and the kind of its wish."""
    makers = {each: _Maker(each, random.Random(1)) for each in LANGUAGES}
    drawn = {each: [maker.wish() for _ in range(_CHOICE)] for each, maker in makers.items()}
    by_people: dict[str, list[tuple[str, str]]] = {each: [] for each in LANGUAGES}
    for each in spoken():
        if each.label in OBJECTIVES and len(each.text) <= _LONGEST:
            by_people[each.language].append((each.text, each.label))
    for language, line in lines_of(FRAMES):
        label, frame = line.split("\t")
        chance = random.Random(f"1 {frame}")  # what one is filled with hangs on no other
        for turn in range(FILLED):
            wish, kind = chance.choice((drawn if turn % 2 else by_people)[language])
            wish = wish.rstrip(".!。！")
            yield frame.replace("{}", wish[:1].lower() + wish[1:]), label == "order", kind


def in_talks() -> Iterator[tuple[str, bool]]:
    """Every other line of the talks, where it is long enough, and whether it changes something."""
    said = itertools.chain.from_iterable(lines for _, lines, _ in talks())
    for text, does in itertools.islice(said, 0, None, 2):
        if _LINE.search(text):
            yield text, not does.startswith(("nothing", "ask", "suppose"))


class Example(NamedTuple):
    """A sentence, and what it teaches.

    Attributes:
        kind: the label that is right, or what all right ones begin with; "order" and "none" for any that does or not.
        kind_counts, order_counts: how much that teaches of its kind, and of whether it orders something.
        turns: in what share of the passes it is read.
        bent: whether it means something else than can be read of it; None where nobody knows.
        constraints: that it states, where it is known not to be ``bent``.
    """

    text: str
    kind: str
    kind_counts: float
    orders: bool
    order_counts: float
    turns: float
    bent: bool | None = None
    constraints: Mapping[str, Any] | None = None


def examples() -> Iterator[Example]:
    """All of them; the same each time."""
    for text, label in sorted(set(sentences())):
        aim, tells = label in OBJECTIVES, label.startswith(("command", "question"))
        yield Example(
            text, label, _DRAWN if aim else 1.0, label.startswith("command"), MILD if tells else 0.0,
            0.3 if aim else 0.6,
        )  # fmt: skip
    yield from _spoken()
    for text, does, kind in framed():
        taught, counts = (kind, _FILLING) if does else (_nothing(text), _NEAR)
        yield Example(text, taught, counts, does, FRAME / FILLED, 0.5)
    for text, does in in_talks():
        yield Example(text, "", 0.0, does, TALK, 0.5)


def _spoken() -> Iterator[Example]:
    slips = random.Random(1)
    for each in spoken():
        limits, asked = each.constraints, each.label == "clarify" and each.constraints is None
        kind = "clarify.limits" if each.label == "clarify" and limits else each.label
        counts = 0.0 if asked and each.turned else _NEAR if kind in ("order", "none") else 1.0
        kind, does = _nothing(each.text) if kind == "none" else kind, each.is_order
        tells = 0.0 if does is None else 1.0 if each.near else MILD
        bent = True if asked else None if limits is None else False
        turns = _BESIDE if each.told and each.label == "none" else 1.0
        example = Example(each.text, kind, counts, bool(does), tells, turns, bent, limits)
        yield example
        if (kind in OBJECTIVES or limits) and slips.random() < _SLIPS:
            yield example._replace(text=mistyped(each.text, slips))


def _nothing(text: str) -> str:
    """The kind of what orders nothing: most of it tells of an aim, some asks."""
    return "none" if text.rstrip(" .。!！").endswith(_ASKED) else TOLD
