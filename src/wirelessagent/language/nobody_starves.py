"""A wish beside the wish: that nobody goes without, "… but don't starve anyone", 但别饿着任何人.

The highest total rate and the least power keep it only where a least rate says how; the fair objectives keep it by
themselves. Which of the two is meant has to be asked, lest the wish be dropped unheard.
"""

from __future__ import annotations

from wirelessagent.language.deferred import deferred
from wirelessagent.language.word_tables import either

_NOT = f"{either('moods', 'negation', 'clause')}|{either('figures', 'bounds', 'forbids')}"
_STARVES = either("figures", "starving", "goes_without")
_NOBODY_STARVES = deferred(
    rf"(?i)(?:{_NOT})[^,;.!?]{{0,40}}?(?:{_STARVES})|{either('figures', 'starving', 'cared_for')}"
)


def nobody_starves(plain: str) -> bool:
    """Whether a normalised sentence wishes that nobody goes without.

    >>> nobody_starves("max rate, but don't starve anyone"), nobody_starves("everyone is starving")
    (True, False)
    """
    return _NOBODY_STARVES.search(plain) is not None
