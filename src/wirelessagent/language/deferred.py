"""Regular expressions that are compiled when they are first used.

There are more than two hundred, a quarter of the time that a first sentence takes to compile, and a sentence needs a
fifth of them.
"""

from __future__ import annotations

import functools
import re
from typing import Any, cast


class _Deferred:
    """Stands for the compiled expression and hands on its methods, which it keeps once they were asked for."""

    def __init__(self, pattern: str, flags: int) -> None:
        self.pattern, self._flags = pattern, flags

    @functools.cached_property
    def _compiled(self) -> re.Pattern[str]:
        return re.compile(self.pattern, self._flags)

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._compiled, name)
        setattr(self, name, found)
        return found


def deferred(pattern: str, flags: int = 0) -> re.Pattern[str]:
    """A regular expression for its methods and its text; what wants the compiled object itself needs re.compile.

    >>> deferred(r"[0-9]+ W").findall("10 W and 5 W"), deferred("a+").pattern
    (['10 W', '5 W'], 'a+')
    """
    return cast("re.Pattern[str]", _Deferred(pattern, flags))
