r"""Text that shows all that it holds: what a terminal would act on or hide is written out.

Names, file facts and sentences come from elsewhere. An escape sequence in one of them could clear the screen, a
bidirectional control could turn "10 W" into "W 01", a zero-width sign could make two users look like one, and a line
break could add a line that the program never said. The escapes are those of JSON, so that JSON stays the same data.

>>> legible("user\x1b[2J \u202e1", keep="")
'user\\u001b[2J \\u202e1'
"""

from __future__ import annotations

import re
import unicodedata

_NOT_PLAIN = re.compile("[^ -~]")
_HIDDEN = re.compile(
    "[\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u3164\ufe00-\ufe0f\uffa0\ufff0-\ufff8\U000e0000-\U000e0fff]"
)
"""What shows nothing though it is no control: Default_Ignorable_Code_Point of Unicode beyond its format characters."""


def legible(text: str, *, keep: str = "\n") -> str:
    r"""The text with every sign written out that a terminal would not show as itself, but those in ``keep``.

    >>> legible("用户 3\n5\u00a0% — é"), legible("a\nb", keep="")
    ('用户 3\n5\xa0% — é', 'a\\u000ab')
    """
    return _NOT_PLAIN.sub(lambda found: found[0] if found[0] in keep else _shown(found[0]), text)


def _shown(sign: str) -> str:
    if (sign.isprintable() or unicodedata.category(sign) == "Zs") and _HIDDEN.match(sign) is None:
        return sign
    return written_out(sign)


def written_out(text: str) -> str:
    r"""The escapes of JSON for every sign of a text.

    >>> written_out("é😀")
    '\\u00e9\\ud83d\\ude00'
    """
    units = text.encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{units[place : place + 4]}" for place in range(0, len(units), 4))
