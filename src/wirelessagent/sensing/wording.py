"""How facts and errors of channel files name options and numbers of things."""

from __future__ import annotations


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
