"""The operations as tools for an LLM: typed forms that follow from the requests, and nothing that changes anything.

Offered are the operations that only work something out, on the channel that the caller hands over. Applying an
allocation is no tool: the operator confirms it, in plain words.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pydantic import BaseModel

from wirelessagent.language.llm_tool import LlmTool
from wirelessagent.operations.compare import COMPARE
from wirelessagent.operations.forms import filled, form_of, needs_channel
from wirelessagent.operations.list_plugins import PLUGINS
from wirelessagent.operations.operation import AnyOperation, silent
from wirelessagent.operations.record import Block, Files, Table
from wirelessagent.operations.repair import REPAIR
from wirelessagent.operations.simulate import SIMULATE
from wirelessagent.operations.solve import SOLVE

OFFERED: tuple[AnyOperation, ...] = (SIMULATE, REPAIR, SOLVE, COMPARE, PLUGINS)
"""What an LLM may call. Only operations that change nothing once their paths are taken away belong here."""

_MOST_CHARACTERS = 20_000


def llm_tools(channel: Path | str | None = None, operations: Sequence[AnyOperation] = OFFERED) -> tuple[LlmTool, ...]:
    """The tools for a channel in a file; those that need one are left out where there is none."""
    return tuple(
        tool_of(operation, channel) for operation in operations if channel is not None or not needs_channel(operation)
    )


def tool_of(operation: AnyOperation, channel: Path | str | None = None) -> LlmTool:
    """One operation as a tool."""

    def run(form: BaseModel) -> str:
        return as_text(operation.run(filled(operation, form, channel), silent).blocks())

    name = operation.name.replace(" ", "_").replace("-", "_")
    return LlmTool(name=name, summary=operation.summary, form=form_of(operation), run=run)


def as_text(blocks: Sequence[Block]) -> str:
    """Paragraphs and tables as plain text, cut where it would be too long."""
    text = "\n\n".join(_paragraph(block) for block in blocks)
    return text if len(text) <= _MOST_CHARACTERS else f"{text[:_MOST_CHARACTERS]}\n… (cut)"


def _paragraph(block: Block) -> str:
    if isinstance(block, Table):
        return _table(block)
    if isinstance(block, Files):
        return " ".join([block.done, *map(str, block.paths)])
    return block if isinstance(block, str) else "\n".join(block)


def _table(table: Table) -> str:
    return "\n".join([table.title, *(" | ".join(row) for row in (table.columns, *table.rows))])
