"""Blocks of records as plain data that JSON can hold, and as plain text for who reads text only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from wirelessagent.operations.record import Block, Files, Table

Plain: TypeAlias = str | Sequence[str] | Mapping[str, Any]

_MOST_CHARACTERS = 20_000


def as_plain(block: Block) -> Plain:
    """A block as plain data: a paragraph, lines, or a table's title, columns and rows."""
    if isinstance(block, Table):
        return {"title": block.title, "columns": list(block.columns), "rows": [list(row) for row in block.rows]}
    if isinstance(block, Files):
        return " ".join([block.done, *map(str, block.paths)])
    return block if isinstance(block, str) else list(block)


def plain_text(blocks: Sequence[Plain]) -> str:
    """One text, cut where it would be too long for a language model to keep in mind.

    >>> plain_text(["Two users.", {"title": "Users", "columns": ["user", "power"], "rows": [["1", "2 W"]]}])
    'Two users.\\n\\nUsers\\nuser | power\\n1 | 2 W'
    """
    text = "\n\n".join(_paragraph(block) for block in blocks)
    return text if len(text) <= _MOST_CHARACTERS else f"{text[:_MOST_CHARACTERS]}\n… (cut)"


def _paragraph(block: Plain) -> str:
    if isinstance(block, str):
        return block
    if isinstance(block, Mapping):
        rows: list[list[str]] = [block["columns"], *block["rows"]]
        return "\n".join([block["title"], *(" | ".join(row) for row in rows)])
    return "\n".join(block)
