"""Sentences whose figures and users are marked with what they are there for: ``marked/<language>.txt``.

A mark is the words of a figure or of somebody named in brackets, and the role behind them in braces: "leave [user
3]{leave_out} out, at most [10 W]{limit}". Of "<least power|highest rate>, without [user 3]{leave_out}" each choice is a
sentence. Roles are the labels of :mod:`wirelessagent.language.figure_roles`, some by a shorter name; numbers without a
mark describe. They hold what a meaning cannot show: figures to ask about, and users who stay.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from wirelessagent.language.figure_roles import LABELS
from wirelessagent.language.mentions import Mention
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity
from wirelessagent.model.errors import InputError

MARKED = Path(__file__).with_name("marked")
_MARK = re.compile(r"\[([^\[\]]+)\]\{(\w+)\}")
_CHOICE = re.compile(r"<([^<>]*\|[^<>]*)>")
_MEANS = {
    "min": "min_rate_bps", "max": "max_rate_bps", "limit": "max_power_w", "circuit": "circuit_power_w",
    "carrier": "subcarrier_max_power_w",
    "theirs": "unclear", "uncapped": "unclear", "elsewhere": "unclear",
}  # fmt: skip


def marked(folder: Path = MARKED) -> list[str]:
    """The marked sentences.

    Raises:
        InputError: there are none; an installed package leaves them out.
    """
    lines = [line for path in sorted(folder.glob("*.txt")) for line in path.read_text(encoding="utf-8").splitlines()]
    found = [sentence for line in lines for sentence in _chosen(line)]
    if not found:
        raise InputError(f"no marked sentences in {folder}: train from a checkout of the sources, which has them")
    return found


def _chosen(line: str) -> Iterator[str]:
    """Each sentence that a line with choices stands for."""
    choice = _CHOICE.search(line)
    if choice is None:
        yield line
        return
    for words in choice[1].split("|"):
        yield from _chosen(line[: choice.start()] + words + line[choice.end() :])


def unmarked(line: str) -> tuple[str, list[tuple[int, int, str]]]:
    """A sentence without its marks, and what was marked, from where to where and as what.

    >>> unmarked("skip [user 3]{leave_out}, [10 W]{limit} on air")
    ('skip user 3, 10 W on air', [(5, 11, 'leave_out'), (13, 17, 'max_power_w')])
    """
    text, spans, place = "", list[tuple[int, int, str]](), 0
    for match in _MARK.finditer(line):
        text += line[place : match.start()]
        spans.append((len(text), len(text) + len(match[1]), _MEANS.get(match[2], match[2])))
        text, place = text + match[1], match.end()
    return text + line[place:], spans


class Marked:
    """A marked sentence, asked what its figures and users are there for, as one with its meaning is."""

    def __init__(self, line: str) -> None:
        self.text, self._marks = unmarked(line)

    def _roles(self, start: int, end: int) -> set[str]:
        return {role for first, last, role in self._marks if start < last and first < end}

    def of_number(self, number: Number) -> set[str]:
        """A user, or a figure that borrows a unit; it describes where it is not marked, but for "twice"."""
        roles = self._roles(number.start, number.end)
        if not roles and number.form == "times":
            return set()
        if roles == {"unclear"}:
            return {"limit"}
        if roles and roles <= {"user", "weight", "group", "share"}:
            return roles
        means = (means for means in ("user", "rate", "power") if roles and roles <= set(LABELS[means]))
        return {next(means, "harmless")}

    def of_user(self, mention: Mention, _: Sequence[Mention]) -> set[str]:
        return self._roles(mention.start, mention.end)

    def of_pronoun(self, _: Mention, __: Sequence[Mention]) -> set[str]:
        return set()

    def of_figure(self, figure: Quantity) -> set[str]:
        return self._roles(figure.start, figure.end)

    def owners(self, _: Quantity) -> set[str]:
        """Whose a rate is, marks do not say."""
        return set()

    def weighed(self, _: float) -> set[str]:
        return set()
