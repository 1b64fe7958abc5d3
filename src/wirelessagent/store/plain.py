"""Values as plain data that JSON can hold, and the one text that such data has.

A float keeps every bit: its shortest decimal form is read back to the same number. What is no number in JSON is text,
"nan", "inf" or "-inf", which NumPy reads as a number again.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from wirelessagent.model.errors import InputError


def plain(value: object) -> Any:
    """``value`` as numbers, text, lists and maps by name.

    >>> import numpy as np
    >>> plain({"rate": np.array([1.0, np.inf]), "out": Path("a.csv")})
    {'rate': [1.0, 'inf'], 'out': 'a.csv'}

    Raises:
        InputError: it holds something else.
    """
    if value is None or isinstance(value, bool | int):
        return value
    if isinstance(value, str | Path):
        return writable(str(value))
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if hasattr(value, "tolist"):  # an array or a figure of NumPy's, which a server need not load for the asking
        return plain(cast("Any", value).tolist())
    if isinstance(value, Mapping):
        return {writable(str(name)): plain(each) for name, each in cast("Mapping[Any, object]", value).items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in cast("list[object]", value)]
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {item.name: plain(getattr(value, item.name)) for item in dataclasses.fields(value)}
    raise InputError(f"an object of type {type(value).__name__} cannot be recorded: {value!r:.80}")


def writable(text: str) -> str:
    r"""The text with what no database takes written out: halves of characters, and NUL.

    >>> writable("20\x00W \ud83d")
    '20\\x00W \\ud83d'
    """
    return text.encode("utf-8", "backslashreplace").decode().replace("\x00", "\\x00")


def canonical(value: object) -> str:
    """The one JSON text of plain data: names in order, no spaces."""
    return json.dumps(plain(value), ensure_ascii=False, allow_nan=False, sort_keys=True, separators=(",", ":"))


def fingerprint(value: object) -> str:
    """SHA-256 of the canonical text in UTF-8, in hexadecimal."""
    return hashlib.sha256(canonical(value).encode()).hexdigest()
