"""Texts with more figures than any request has: a pasted table, a log. They are refused before anybody reads them."""

from __future__ import annotations

from wirelessagent.language.deferred import deferred

MOST_FIGURES = 40
_MOST_DIGITS = 200
_FIGURE = deferred(
    r"[0-9]+(?:[.,'][0-9]+)*|[零〇一二两三四五六七八九十百千万亿半几]+|\b(?:one|two|three|four|five|six|seven|eight|nine|ten|"
    r"eleven|twelve|twenty|thirty|fifty|hundred|thousand|dos|tres|cuatro|cinco|deux|trois|quatre|cinq|zwei|drei|vier|"
    r"fünf)\b"
)


def too_many_figures(plain: str) -> bool:
    """Whether a normalised text holds more figures, users' numbers among them, or longer ones than a request can have.

    >>> too_many_figures("users 1 to 40, 20 W"), too_many_figures("1 2 3 " * 20), too_many_figures("9" * 300)
    (False, True, True)
    """
    sizes = [match.end() - match.start() for match in _FIGURE.finditer(plain.lower())]
    return len(sizes) > MOST_FIGURES or sum(sizes) > _MOST_DIGITS
