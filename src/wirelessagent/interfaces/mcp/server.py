"""The MCP server of a service: tools, resources and prompts, for any transport."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Generator
from typing import Any, TypeAlias

from mcp.server.context import ServerRequestContext
from mcp.server.lowlevel.server import Server
from mcp.shared.exceptions import MCPError
from mcp.types import (
    INVALID_PARAMS,
    CallToolRequestParams,
    GetPromptRequestParams,
    GetPromptResult,
    ListPromptsResult,
    ListResourcesResult,
    ListResourceTemplatesResult,
    ListToolsResult,
    PaginatedRequestParams,
    ReadResourceRequestParams,
    ReadResourceResult,
)

from wirelessagent.interfaces.mcp import prompts
from wirelessagent.interfaces.mcp.calls import Call
from wirelessagent.interfaces.mcp.catalogue_tools import operation_tools
from wirelessagent.interfaces.mcp.cell_tools import cell_tools
from wirelessagent.interfaces.mcp.resources import Resources
from wirelessagent.interfaces.mcp.tool import Result, ServerTool, failure
from wirelessagent.operations.operation import WirelessAgentError, installed_version
from wirelessagent.service.access import Caller
from wirelessagent.service.problems import ProblemError, problem_of
from wirelessagent.service.service import Service

Context: TypeAlias = ServerRequestContext[Any, Any]

_APPS = "io.modelcontextprotocol/ui"
_APP_TYPES = {"mimeTypes": ["text/html;profile=mcp-app"]}

_INSTRUCTIONS = (
    "Plan downlink OFDMA cells. Pass on what the operator says with `say`, word for word; show what was decided and "
    "what would change; call `apply` with the plan's one-time id only after the operator said yes to it. Channels are "
    "named by ids (`observe`), never retyped, and figures come from the tools alone. wirelessagent://docs/guide says "
    "more."
)


class Desk:
    """Answers the requests of clients.

    Args:
        service: what they are about.
        caller_of: who sends a request.
    """

    def __init__(self, service: Service, caller_of: Callable[[Context], Caller]) -> None:
        self._service, self._caller_of = service, caller_of
        self._resources = Resources(service)
        self._tools: dict[str, ServerTool] = {}
        self._finding = asyncio.Lock()

    async def _found_tools(self) -> dict[str, ServerTool]:
        """The tools by name, from the forms that a worker makes once."""
        async with self._finding:
            if not self._tools:
                forms = await self._service.forms()
                self._tools = {one.shown.name: one for one in (*cell_tools(forms), *operation_tools(forms))}
        return self._tools

    async def list_tools(self, context: Context, params: PaginatedRequestParams | None) -> ListToolsResult:
        del context, params
        with _told():
            return ListToolsResult(tools=[one.shown for one in (await self._found_tools()).values()])

    async def call_tool(self, context: Context, params: CallToolRequestParams) -> Result:
        with _told():
            tool = (await self._found_tools()).get(params.name)
        if tool is None:
            raise MCPError(INVALID_PARAMS, f"there is no tool {params.name[:100]!r}")
        caller = self._caller_of(context)
        if not caller.may_change and not tool.only_reads:
            return failure(f"{caller.name!r} is a viewer and changes nothing: ask an operator")
        call = Call(service=self._service, caller=caller, context=context, params=params)
        try:
            return await tool.run(call, params.arguments or {})
        except (ProblemError, WirelessAgentError) as error:
            return failure(problem_of(error).detail)

    async def list_resources(self, context: Context, params: PaginatedRequestParams | None) -> ListResourcesResult:
        del context, params
        with _told():
            return ListResourcesResult(resources=await self._resources.listed())

    async def list_templates(
        self, context: Context, params: PaginatedRequestParams | None
    ) -> ListResourceTemplatesResult:
        del context, params
        return ListResourceTemplatesResult(resource_templates=self._resources.templates())

    async def read_resource(self, context: Context, params: ReadResourceRequestParams) -> ReadResourceResult:
        del context
        with _told():
            return await self._resources.read(str(params.uri))

    @staticmethod
    async def list_prompts(context: Context, params: PaginatedRequestParams | None) -> ListPromptsResult:
        del context, params
        return ListPromptsResult(prompts=prompts.listed())

    @staticmethod
    async def get_prompt(context: Context, params: GetPromptRequestParams) -> GetPromptResult:
        del context
        return prompts.filled(params.name, params.arguments or {})


def make_server(service: Service, caller_of: Callable[[Context], Caller]) -> Server[Any]:
    """The server of a service."""
    desk = Desk(service, caller_of)
    server: Server[Any] = Server(
        "wirelessagent",
        title="WirelessAgent",
        version=installed_version(),
        instructions=_INSTRUCTIONS,
        get_tool_input_schema=lambda name: None,  # no field of ours travels in a header
        on_list_tools=desk.list_tools,
        on_call_tool=desk.call_tool,
        on_list_resources=desk.list_resources,
        on_list_resource_templates=desk.list_templates,
        on_read_resource=desk.read_resource,
        on_list_prompts=desk.list_prompts,
        on_get_prompt=desk.get_prompt,
    )
    server.extensions[_APPS] = dict(_APP_TYPES)
    return server


@contextlib.contextmanager
def _told() -> Generator[None]:
    """Problems outside of tools as errors of the protocol."""
    try:
        yield
    except (ProblemError, WirelessAgentError) as error:
        raise MCPError(INVALID_PARAMS, problem_of(error).detail) from error
