"""A tool as this server has it: its description for clients, and what it does."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

from mcp.types import CallToolResult, ContentBlock, InputRequiredResult, TextContent, Tool, ToolAnnotations

from wirelessagent.interfaces.mcp.calls import Call

Json: TypeAlias = dict[str, Any]
Result: TypeAlias = CallToolResult | InputRequiredResult


@dataclass(frozen=True, kw_only=True)
class ServerTool:
    """A tool.

    Attributes:
        shown: as clients see it; its annotation says whether it only reads, so that a viewer may call it.
        run: what it does with arguments that nobody checked yet.
    """

    shown: Tool
    run: Callable[[Call, Json], Awaitable[Result]]

    @property
    def only_reads(self) -> bool:
        annotations = self.shown.annotations
        return annotations is not None and annotations.read_only_hint is True


def annotated(
    title: str, *, only_reads: bool = False, destroys: bool = False, repeatable: bool = False
) -> ToolAnnotations:
    """What clients are told of a tool's effects; none reaches beyond this server and the base stations of its cells."""
    return ToolAnnotations(
        title=title, read_only_hint=only_reads, destructive_hint=destroys, idempotent_hint=repeatable or only_reads,
        open_world_hint=False,
    )  # fmt: skip


def answer(text: str, structured: Json, *more: ContentBlock, meta: Json | None = None) -> CallToolResult:
    """What a tool answers: text for the model, the same as data, and more content."""
    content: list[ContentBlock] = [TextContent(type="text", text=text), *more]
    return CallToolResult(content=content, structured_content=structured, _meta=meta)


def failure(text: str) -> CallToolResult:
    """What a tool answers where it could not do what was asked, so that the model can mend its call."""
    return CallToolResult(content=[TextContent(type="text", text=text)], is_error=True)
