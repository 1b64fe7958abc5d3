"""What is told beside sentences: tables for people, and events while a piece of work is running."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from wirelessagent.telling.catalogue import has_message, message


@dataclass(frozen=True, kw_only=True)
class Table:
    """All cells are text; numbers come with their units in the column's name or in the cell."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, kw_only=True)
class Event:
    """Something that just happened.

    Attributes:
        stage: "read", "understand", "note", "sense", "repair", "decide", "act" or the name of a piece of long work.
        message: one sentence for the user.
        done, total: how far counted work has come; both 0 where nothing is counted.
        language: of the message.
    """

    stage: str
    message: str
    done: int = 0
    total: int = 0
    language: str = "en"

    @property
    def label(self) -> str:
        """What the stage is called."""
        key = f"doing.{self.stage}"
        return message(self.language, key) if has_message(self.language, key) else self.stage


Progress: TypeAlias = Callable[[Event], None]


def silent(event: Event) -> None:
    """A progress listener for callers that want none."""
    del event
