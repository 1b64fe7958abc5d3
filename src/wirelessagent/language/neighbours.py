"""Figures beside one another: the ends of a range, corrections, and the words between a figure and the next."""

from __future__ import annotations

from wirelessagent.language import figure_words
from wirelessagent.language.judged import Judged
from wirelessagent.language.surroundings import beside

_RANGE_GAP = 8
_NEAR = 30


class Neighbours:
    """The figures of a normalised sentence, by their place among them."""

    def __init__(self, plain: str, judged: Judged) -> None:
        self._plain, self._judged = plain, judged
        self.figures = judged.figures

    def beside(self, index: int) -> tuple[str, str]:
        """What stands before and after a figure within its clause, other figures being borders too."""
        return beside(self._plain, self.figures, index)

    def is_replaced(self, index: int) -> bool:
        """Whether a rate is corrected by the next figure, nobody being named between: "1 Mbit/s, sorry, 2 each"."""
        if {each.kind for each in self.figures[index : index + 2]} != {"rate"} or index + 1 == len(self.figures):
            return False
        figure, other = self.figures[index], self.figures[index + 1]
        named = any(m.role == "named" and figure.end <= m.start < other.start for m in self._judged.mentions)
        gap = self._plain[figure.end : other.start]
        return not named and len(gap) < _NEAR and figure_words.CORRECTION.search(gap) is not None

    def ends_a_range(self, index: int) -> bool:
        """Whether a figure is the upper end of a range, and so for whomever the lower one is."""
        if not 0 < index < len(self.figures):
            return False
        lower, figure = self.figures[index - 1], self.figures[index]
        near = figure.start - lower.end <= _RANGE_GAP and lower.kind == figure.kind
        parted = any(lower.end <= mention.start < figure.start for mention in self._judged.mentions)
        return near and not parted and (lower.comparator, figure.comparator) == ("at_least", "at_most")

    def is_of_a_subcarrier(self, index: int) -> bool:
        """Whether a power is that of a single subcarrier."""
        before, after = self.beside(index)
        return bool(figure_words.SUBCARRIER.match(after) or figure_words.SUBCARRIER_BEFORE.search(before))


def is_change(before: str, after: str) -> bool:
    """Whether the figure is an amount to save or to add, not a limit."""
    return figure_words.CHANGE_BEFORE.search(before) is not None or figure_words.CHANGE_AFTER.match(after) is not None
