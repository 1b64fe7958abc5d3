"""What the terms mean that decisions are told in; objectives of plug-ins tell of themselves."""

from __future__ import annotations

import functools
import re
import unicodedata
from dataclasses import dataclass

from wirelessagent import plugins
from wirelessagent.model.objective import Objective
from wirelessagent.telling.catalogue import (
    Said,
    goal_named,
    has_message,
    joined,
    languages,
    lines_of,
    message,
    messages,
)
from wirelessagent.telling.report import Report

_NAMES, _MEANING = "term.names.", "term.meaning."
_FIGURES = {
    "max_rate": "sum_rate_bps",
    "goodput": "goodput_bps",
    "min_power": "power_w",
    "power_budget": "power_w",
    "max_energy_efficiency": "energy_efficiency_bit_per_j",
    "spectral_efficiency": "spectral_efficiency_bps_per_hz",
    "fairness_index": "jain_index",
}
"""Terms that name a figure of a report."""
_CHINESE = re.compile("[\u4e00-\u9fff]")
_LETTER = "[a-z0-9\u00df-\u024f]"
"""What goes on with a word in European languages; a Chinese character beside it does not."""


@dataclass(frozen=True, kw_only=True)
class Entry:
    """A term: what people call it in any language, and where it stands in the catalogue or which objective it is."""

    key: str
    names: tuple[str, ...]
    objective: type[Objective] | None = None
    summary: str = ""

    def told(self, language: str) -> str:
        """What it means."""
        key, one = _MEANING + self.key, self.objective
        meaning = message(language, key) if has_message(language, key) else self.summary
        if one is None:
            return meaning
        spoken = one.name if language == "en" else next(
            iter(one.phrases.get(language, ())), goal_named(self.key, self.key, language)
        )  # fmt: skip
        unit = message(language, "term.unit", unit=one.unit) if one.unit else ""
        return message(language, "term.objective", objective=spoken, meaning=meaning) + unit


def explained(text: str, language: str) -> Said:
    """What the terms in a text mean, in the order they are named, two at most; empty where none is known."""
    return lines_of(dict.fromkeys(entry.told(language) for entry in _named(text)[:2]))


def speaks_of(key: str, text: str) -> bool:
    """Whether a text has a word of those that a message lists: of "term.now", of what is, or of "term.nothing"."""
    said = _plain(text)
    return any(_places(said, _plain(word)) for word in _words(key))


def figures_asked(text: str, report: Report, language: str) -> Said:
    """The figures of a decision that a text names; empty where it names none."""
    rows = {row[0]: row[1:] for row in report.figures(language)}
    said: list[Said] = []
    for name in dict.fromkeys(_FIGURES[entry.key] for entry in _named(text) if entry.key in _FIGURES):
        label = message(language, f"label.{name}")
        predicted, achieved, *_ = rows[label]
        key = "term.figure" if achieved in ("–", predicted) else "term.figure_achieved"
        said.append(message(language, key, label=label, predicted=predicted, achieved=achieved))
    return joined(language, said)


def _named(text: str) -> list[Entry]:
    """The terms in a text in the order they are named; a longer one wins: "price of power" is not power."""
    said = _plain(text)
    found: list[tuple[int, int, Entry]] = []
    for entry in entries():
        places = [(at, at + len(name)) for name in entry.names for at in _places(said, _plain(name))]
        if places:
            first, last = max(places, key=lambda place: place[1] - place[0])
            found.append((first, last, entry))
    outer = [
        one for one in found
        if not any(first <= one[0] and one[1] <= last and last - first > one[1] - one[0] for first, last, _ in found)
    ]  # fmt: skip
    return [entry for _, _, entry in sorted(outer, key=lambda one: one[:2])]


def entries() -> list[Entry]:
    """All terms: those of the catalogue, and all registered objectives by their names, phrases and figures."""
    known = {key.removeprefix(_NAMES): _words(key) for key in messages("en") if key.startswith(_NAMES)}
    found = list[Entry]()
    for one in plugins.plugins("objective"):
        also = known.pop(one.name, ())
        if one.cls is None or not issubclass(one.cls, Objective):
            continue
        cls = one.cls
        phrases = tuple(phrase for said in (*cls.phrases.values(), *cls.figure_name.values()) for phrase in said)
        names = (cls.name, cls.name.replace("_", " "), *cls.aliases, *also, *phrases)
        found.append(Entry(key=cls.name, names=names, objective=cls, summary=one.summary))
    return [*(Entry(key=key, names=names) for key, names in known.items()), *found]


@functools.cache
def _words(key: str) -> tuple[str, ...]:
    """Words that a message lists, in all languages."""
    listed = [messages(language).get(key, "") for language in sorted(languages())]
    return tuple(word for words in listed for word in words.split(", ") if word)


def _plain(text: str) -> str:
    """Without case, accents of width, curled apostrophes, hyphens and underscores."""
    plain = unicodedata.normalize("NFKC", text).casefold().replace("’", "'")
    return re.sub(r"[\s_\-–]+", " ", plain).strip()


def _places(said: str, name: str) -> list[int]:
    """Where a name stands as a word of its own, or as Chinese characters; a plural is the same word."""
    edge = "{}" if _CHINESE.search(name) else f"(?<!{_LETTER}){{}}(?:s|es)?(?!{_LETTER})"
    return [match.start() for match in re.finditer(edge.format(re.escape(name)), said)]
