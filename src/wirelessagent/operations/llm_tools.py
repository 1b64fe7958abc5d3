"""The operations as tools for an LLM: typed forms that follow from the requests, and nothing that changes anything.

Offered are the operations that only work something out, on the channel that the caller hands over. Applying an
allocation is no tool: the operator confirms it, in plain words.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pydantic import BaseModel

from wirelessagent.language.llm.client import LlmTool
from wirelessagent.operations.compare import COMPARE
from wirelessagent.operations.forms import filled, form_of, needs_channel
from wirelessagent.operations.list_plugins import PLUGINS
from wirelessagent.operations.operation import AnyOperation, silent
from wirelessagent.operations.paragraphs import as_plain, plain_text
from wirelessagent.operations.repair import REPAIR
from wirelessagent.operations.simulate import SIMULATE
from wirelessagent.operations.solve import SOLVE

OFFERED: tuple[AnyOperation, ...] = (SIMULATE, REPAIR, SOLVE, COMPARE, PLUGINS)
"""What an LLM may call. Only operations that change nothing once their paths are taken away belong here."""


def llm_tools(channel: Path | str | None = None, operations: Sequence[AnyOperation] = OFFERED) -> tuple[LlmTool, ...]:
    """The tools for a channel in a file; those that need one are left out where there is none."""
    return tuple(
        tool_of(operation, channel) for operation in operations if channel is not None or not needs_channel(operation)
    )


def tool_of(operation: AnyOperation, channel: Path | str | None = None) -> LlmTool:
    """One operation as a tool."""

    def run(form: BaseModel) -> str:
        blocks = operation.run(filled(operation, form, channel), silent).blocks()
        return plain_text([as_plain(block) for block in blocks])

    name = operation.name.replace(" ", "_").replace("-", "_")
    return LlmTool(name=name, summary=operation.summary, form=form_of(operation), run=run)
