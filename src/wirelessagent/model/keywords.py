"""Constructors that answer a mistyped name: "did you mean 'max_power_w'?"."""

from __future__ import annotations

import functools
import inspect
from typing import Any, Self

from wirelessagent.model.errors import UnknownNameError


class KnownKeywords:
    """A class whose constructor refuses a keyword that it does not have with the one that was meant.

    ``__new__`` comes before the ``__init__`` that a dataclass writes, and leaves its signature to be shown.
    """

    def __new__(cls, *args: Any, **keywords: Any) -> Self:
        if keywords:
            known = _keywords(cls)
            for name in keywords:
                if known is not None and name not in known:
                    raise UnknownNameError("argument", name, known, of=f"{cls.__name__}(…)")
        return super().__new__(cls)


@functools.cache
def _keywords(cls: type[Any]) -> tuple[str, ...] | None:
    """What the constructor may be given by name; None where that may be anything."""
    own = list(inspect.signature(cls.__init__).parameters.values())[1:]
    if any(one.kind is inspect.Parameter.VAR_KEYWORD for one in own):
        return None
    return tuple(one.name for one in own if one.kind is not inspect.Parameter.POSITIONAL_ONLY)
