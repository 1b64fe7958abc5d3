"""mcp: the MCP server on standard input and output, as clients on the same machine start it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from wirelessagent.operations.fields import Advanced
from wirelessagent.operations.operation import InputError, Operation, Progress
from wirelessagent.operations.record import Block, Record
from wirelessagent.operations.recording import StoreOptions

if TYPE_CHECKING:
    from mcp.server.lowlevel.server import Server

    from wirelessagent.service.service import Service

COMMANDS = {"mcp": "Speak MCP on standard input and output, for a client on this machine that starts it"}
"""The command, in a sentence."""


class McpRequest(StoreOptions):
    panel = "Options"

    demonstration: bool = Field(True, description="begin with a demonstration cell where there is no cell yet")
    work_limit_s: Annotated[float, Advanced()] = Field(120.0, gt=0, description="time for one piece of work, s")


class McpRecord(Record):
    """A conversation with a client that has ended."""

    def blocks(self) -> list[Block]:
        return []

    @property
    def raw_lines(self) -> list[str]:
        return []  # standard output belongs to the protocol


def speak(request: McpRequest, progress: Progress) -> McpRecord:
    del progress
    try:
        import anyio

        from wirelessagent.interfaces.mcp.server import make_server
        from wirelessagent.service.access import LOCAL
        from wirelessagent.service.limits import Limits
        from wirelessagent.service.opening import open_service
    except ImportError as error:
        raise InputError(
            f"MCP needs packages that are not installed ({error.name}): pip install 'wirelessagent[serve]'"
        ) from error
    service = open_service(request.store, Limits(work_s=request.work_limit_s))
    anyio.run(_serve, service, make_server(service, lambda context: LOCAL), request.demonstration)
    return McpRecord()


async def _serve(service: Service, server: Server[Any], demonstration: bool) -> None:
    from mcp.server.stdio import stdio_server

    if demonstration:
        await service.demonstrate()
    try:
        async with stdio_server() as (read, write):
            await server.run(read, write, server.create_initialization_options())
    finally:
        await service.close()


MCP = Operation(
    name="mcp", request=McpRequest, record=McpRecord, run=speak, local=True,
    examples=("mcp", "mcp --store cell.sqlite3"),
)  # fmt: skip
