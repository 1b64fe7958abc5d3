"""Numbers and text as people write them in files."""

from __future__ import annotations

import codecs

from wirelessagent.model.errors import FileFormatError

MISSING = frozenset({"", "nan", "null", "na", "n/a"})
"""Cells that mean "not measured", in lower case."""

_GROUPING = str.maketrans("", "", ",_' ")


def decode(data: bytes) -> str:
    """UTF-8 text, with or without a byte-order mark."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        raise FileFormatError("is UTF-16 text; save it as UTF-8")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise FileFormatError(
            f"is not UTF-8 text: byte 0x{data[error.start]:02x} in line {line}; save it as UTF-8"
        ) from error


def is_label(cell: str) -> bool:
    """Whether a cell is a name or a heading: neither a number nor one in another spelling, such as 1,5 or 1_000.

    >>> is_label("Ann"), is_label("10.0.0.1"), is_label("1,5"), is_label("NaN"), is_label("")
    (True, True, False, False, False)
    """
    return number(cell) is None and number(cell.translate(_GROUPING)) is None


def number(cell: str) -> float | complex | None:
    """The number in a cell, NaN for one that means missing, None for anything else.

    >>> number(" 1e-9 "), number("NA"), number("0.1-0.2i"), number("abc"), number("1_000")
    (1e-09, nan, (0.1-0.2j), None, None)
    """
    text = cell.strip()
    if text.lower() in MISSING:
        return float("nan")
    if "_" in text or not text.isascii():  # Python reads 1_000 and other scripts' digits; people do not
        return None
    try:
        return float(text)
    except ValueError:
        pass
    if text.endswith(("i", "j", "i)", "j)")):
        try:
            return complex(text.replace("i", "j"))
        except ValueError:
            pass
    return None
