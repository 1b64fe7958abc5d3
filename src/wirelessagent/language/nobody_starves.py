"""A wish beside the wish: that nobody goes without, "… but don't starve anyone", 但别饿着任何人.

The highest total rate and the least power keep it only where a least rate says how; the fair objectives keep it by
themselves. Which of the two is meant has to be asked, lest the wish be dropped unheard.
"""

from __future__ import annotations

from wirelessagent.language.deferred import deferred

_NOT = (
    r"\b(?:not|never|without|nobody|no\s+one|no\s+user|none|avoid|mustn'?t|don'?t|shouldn'?t|can'?t|sin|nadie|ning[uú]n|no|"
    r"sans|personne|aucun|pas|jamais|ohne|niemand\w*|keine[rmn]?|nicht)\b"
)
_GO_WITHOUT = (
    r"(?:\bstarv\w*|\bgo(?:es|ing)?\s+(?:hungry|empty|without(?!\s+\w))|\b(?:left|end(?:s|ing)?\s+up)\s+with\s+nothing|"
    r"\bempty[- ]handed|\bhambre|\bsin\s+nada|\baffam\w+|\bsans\s+rien|"
    r"\bverhunger\w*|\bleer\s+aus\w*|\bzu\s+kurz\s+komm\w*)"
)
_NOBODY_STARVES = deferred(
    rf"(?i){_NOT}[^,;.!?]{{0,40}}?{_GO_WITHOUT}|"
    r"\b(?:look(?:ing)?\s+after|tak(?:e|ing)\s+care\s+of|protect(?:ing)?|mind(?:ing)?|spar(?:e|ing)\s+a\s+thought\s+for)\s+the\s+"
    r"(?:weak|slow|poor|worst|far|distant|cell[- ]edge|edge)\w*|"
    r"(?:别|不要|不能|不许|没人|没有人|谁也别|谁也不|避免|不让|别让|不至于)[^,\uff0c。;；!！]{0,8}?(?:饿|挨饿|饿死|断粮|颗粒无收|一点都?没有|什么都?没有|亏待)|"
    r"(?:照顾|顾及|兼顾|顾着|顾到|照应|关照)(?:好|到|一下)?(?:那些|信号)?(?:最)?(?:慢|弱|差|远|边缘|底)"
)


def nobody_starves(plain: str) -> bool:
    """Whether a normalised sentence wishes that nobody goes without.

    >>> nobody_starves("max rate, but don't starve anyone"), nobody_starves("everyone is starving")
    (True, False)
    """
    return _NOBODY_STARVES.search(plain) is not None
