"""What a sentence states: its constraints, the words that each came from, and what is in doubt."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from wirelessagent.language.intent import Constraint
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.text import Span


@dataclass(frozen=True, kw_only=True)
class Doubt:
    """A question that must be asked before acting: the key of its sentence, and what it names."""

    key: str
    names: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(frozen=True, kw_only=True)
class Reading:
    """The constraints of a sentence, the words that each came from, and what is in doubt.

    ``masked`` are the spans that are used up, so that their words do not count as wishes again; ``not_used`` are
    figures that describe the channel rather than ask for something, ``counted`` the spans of those that count.
    ``missing`` is a share of the channel that is said to be missing, ``steps`` amounts to add, by detail name, ``back``
    users to be taken in again, ``named`` everybody who is named; ``strangers`` are spans of names that no user has.
    ``marks`` are the spans of figures and users, each with what it was read as, "+" behind it for several users.
    """

    values: Mapping[str, Constraint]
    evidence: Mapping[str, str]
    doubts: Sequence[Doubt]
    not_used: Sequence[str]
    masked: Sequence[tuple[int, int]]
    counted: Sequence[tuple[int, int]]
    exact: frozenset[str]
    missing: float | None = None
    steps: Mapping[str, float] = field(default_factory=dict[str, float])
    back: tuple[str, ...] = ()
    named: tuple[str, ...] = ()
    strangers: Sequence[Span] = ()
    marks: Sequence[tuple[int, int, str]] = ()


class Notes:
    """What has been read of a sentence so far; the parts of a reading, as :class:`Reading` names them.

    ``text`` is the sentence as it stands, ``plain`` the same normalised. ``spoken_for`` are spans whose figures are
    used up before any figure is looked at.
    """

    def __init__(self, text: str, plain: str, quantities: Sequence[Quantity]) -> None:
        self.text, self.plain, self.quantities = text, plain, quantities
        self.values: dict[str, float] = {}
        self.evidence: dict[str, str] = {}
        self.doubts: list[Doubt] = []
        self.not_used: list[str] = []
        self.masked: list[Span] = []
        self.counted: list[Span] = []
        self.exact: set[str] = set()
        self.steps: dict[str, float] = {}
        self.missing: float | None = None
        self.spoken_for: list[Span] = []
        self.marks: list[tuple[int, int, str]] = []

    def doubt(self, key: str, **names: str) -> None:
        """Note a question."""
        self.doubts.append(Doubt(key=key, names=names))

    def put(self, name: str, value: float, span: Span) -> None:
        """Take a value that nothing else may state."""
        self.values[name], self.evidence[name] = value, self.text[slice(*span)]

    def take(self, name: str, value: float, figure: Quantity) -> None:
        """Take a value; two of them are a doubt."""
        if name in self.values and self.values[name] != value:
            self.doubt("conflict", one=self.evidence[name], other=figure.text)
            return
        if figure.comparator == "exactly":
            self.exact.add(name)
        self.values[name], self.evidence[name] = value, figure.text
