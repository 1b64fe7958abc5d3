"""What clients can read: the cells and their allocations, the history, the guide, and the page of the allocation."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from mcp.shared.exceptions import MCPError
from mcp.types import (
    INVALID_PARAMS,
    BlobResourceContents,
    ReadResourceResult,
    Resource,
    ResourceTemplate,
    TextResourceContents,
)

from wirelessagent.interfaces.mcp.cell_tools import APP
from wirelessagent.operations.catalogue import GROUPS, OPERATIONS
from wirelessagent.service.assistant import Assistant
from wirelessagent.service.problems import NotFoundError
from wirelessagent.service.service import Service

_HERE = Path(__file__).parent
_ROOT = "wirelessagent://"
_APP_TYPE = "text/html;profile=mcp-app"
_LAST = 50


class Resources:
    """The resources of a service."""

    def __init__(self, service: Service) -> None:
        self._service, self._assistant = service, Assistant(service)

    async def listed(self) -> list[Resource]:
        """Those that have an address of their own."""
        found = [
            _resource("docs/guide", "Guide", "how to use this server well", "text/markdown"),
            _resource("docs/operations", "Operations", "what can be asked for", "text/markdown"),
            _resource("cells", "Cells", "all cells", "application/json"),
            _resource("history", "History", f"the latest {_LAST} turns", "application/json"),
            Resource(
                uri=APP, name="allocation.html", title="Allocation", mime_type=_APP_TYPE,
                description="page that shows an allocation inside a client", _meta={"ui": {"prefersBorder": True}},
            ),
        ]  # fmt: skip
        for cell in await self._service.cells():
            name = cell["name"]
            found += [
                _resource(f"cells/{cell['id']}", name, f"the cell {name}", "application/json"),
                _resource(f"cells/{cell['id']}/allocation", f"{name}: allocation",
                          "its last allocation", "application/json"),
            ]  # fmt: skip
        return found

    @staticmethod
    def templates() -> list[ResourceTemplate]:
        """Those that are named by what they are about."""
        return [
            ResourceTemplate(uri_template=f"{_ROOT}{path}", name=name, description=description, mime_type=media_type)
            for path, name, description, media_type in (
                ("cells/{cell}", "Cell", "a cell", "application/json"),
                ("cells/{cell}/allocation", "Allocation", "what is in effect, else decided last", "application/json"),
                ("cells/{cell}/conversation", "Conversation", "its turns and its plan", "application/json"),
                ("observations/{observation}", "Observation", "a channel", "application/json"),
                ("history/{number}", "Turn", "all that is recorded of a turn", "application/json"),
                ("history/{number}/allocation.png", "Picture", "an allocation as a picture", "image/png"),
            )
        ]

    async def read(self, uri: str) -> ReadResourceResult:
        """What stands at an address.

        Raises:
            MCPError: nothing.
            ProblemError: it cannot be read.
        """
        if uri == APP:
            return _text(uri, (_HERE / "allocation.html").read_text(encoding="utf-8"), _APP_TYPE)
        path = uri.removeprefix(_ROOT)
        picture = re.fullmatch(r"history/(\d{1,15})/allocation\.png", path)
        if picture:
            drawn = await self._service.allocation(int(picture[1]), "png")
            content = BlobResourceContents(uri=uri, blob=drawn["content"], mime_type=drawn["media_type"])
            return ReadResourceResult(contents=[content])
        if path == "docs/guide":
            return _text(uri, (_HERE / "guide.md").read_text(encoding="utf-8"), "text/markdown")
        if path == "docs/operations":
            return _text(uri, _operations(), "text/markdown")
        try:
            found = await self._found(path) if uri.startswith(_ROOT) else None
        except NotFoundError as error:
            raise MCPError(INVALID_PARAMS, error.detail, {"uri": uri[:200]}) from error
        if found is None:
            raise MCPError(INVALID_PARAMS, "there is no such resource", {"uri": uri[:200]})
        return _text(uri, json.dumps(found, ensure_ascii=False), "application/json")

    async def _found(self, path: str) -> Any:
        match path.split("/"):
            case ["cells"]:
                return await self._service.cells()
            case ["cells", cell]:
                return await self._service.cell(cell)
            case ["cells", cell, "allocation"]:
                return await self._assistant.last_decided(cell)
            case ["cells", cell, "conversation"]:
                return await self._assistant.conversation(cell)
            case ["observations", observation]:
                return await self._service.observations.one(observation)
            case ["history"]:
                return await self._assistant.history(_LAST, None, _silent)
            case ["history", number] if number.isdecimal() and len(number) < 16:
                done = await self._service.operate("history show", {"number": int(number)}, _silent)
                return done["record"]
            case _:
                return None


def _resource(path: str, title: str, description: str, media_type: str) -> Resource:
    return Resource(uri=_ROOT + path, name=path, title=title, description=description, mime_type=media_type)


def _text(uri: str, text: str, media_type: str) -> ReadResourceResult:
    return ReadResourceResult(contents=[TextResourceContents(uri=uri, text=text, mime_type=media_type)])


def _operations() -> str:
    """The catalogue for people, under its headings."""
    parts = ["# Operations"]
    for heading, firsts in GROUPS.items():
        lines = [f"- `{name}`: {said}" for name, said in OPERATIONS.items() if name.split()[0] in firsts]
        parts += [f"## {heading}", "\n".join(lines)]
    return "\n\n".join(parts) + "\n"


def _silent(event: dict[str, Any]) -> None:
    del event
