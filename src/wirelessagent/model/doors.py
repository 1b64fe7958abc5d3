"""What the model asks of layers above it, which import it and not the other way round.

Each door is one function. The package's ``__init__`` says where it is found; it is imported when it is first needed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, TypeAlias

Door: TypeAlias = Literal["check_objective", "draw"]
"""``check_objective(name)`` raises where no objective has the name or alias; ``draw(picture, small=…)`` draws."""

_FINDERS: dict[Door, Callable[[], Callable[..., Any]]] = {}


def install(door: Door, find: Callable[[], Callable[..., Any]]) -> None:
    """Say what finds the function that serves a door."""
    _FINDERS[door] = find


def through(door: Door) -> Callable[..., Any]:
    """The function that serves a door."""
    return _FINDERS[door]()
