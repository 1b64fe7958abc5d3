"""How facts and errors of channel files name options and numbers of things."""

from __future__ import annotations

import reprlib


def option(name: str, value: object) -> str:
    """An option of the file source as it is given in Python and on the command line.

    >>> option("missing_value", -999)
    'missing_value=-999 (--missing-value -999)'
    """
    return f"{name}={value} (--{name.replace('_', '-')} {value})"


def counted(count: int, singular: str, plural: str = "") -> str:
    """So many things.

    >>> counted(1, "user"), counted(3, "entry is", "entries are")
    ('1 user', '3 entries are')
    """
    return f"{count} {singular if count == 1 else plural or singular + 's'}"


def shown(value: object) -> str:
    """A value from a file in at most 40 characters, however long it is or deeply nested.

    >>> shown([1] * 99), shown("x")
    ('[1, 1, 1, 1, 1, 1, ...]', "'x'")
    """
    return f"{reprlib.repr(value):.40}"


def whole_characters(text: str) -> str:
    """A text from a file without halves of characters (lone surrogates), which nothing could write down again.

    >>> whole_characters("Zo\\ud800ë")
    'Zo?ë'
    """
    return text.encode("utf-8", "replace").decode()


_LONGEST = 450


def one_line(message: str) -> str:
    """A message in one line of bearable length: names in a file may be as long as it is, and in several lines.

    >>> one_line("has no array called 'a\\nb'")
    "has no array called 'a b'"
    """
    line = " ".join(whole_characters(message).split())
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 200]} … {line[-197:]}"
