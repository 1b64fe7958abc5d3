"""serve and token: the service as commands."""

from __future__ import annotations

import os
import platform
import socket
import webbrowser
from pathlib import Path
from typing import Annotated, Literal
from urllib.parse import urlsplit

from pydantic import Field

from wirelessagent.operations.fields import Advanced, Positional
from wirelessagent.operations.operation import Event, InputError, Operation, Progress
from wirelessagent.operations.record import Block, Files, Record
from wirelessagent.operations.recording import StoreOptions

COMMANDS = {
    "serve": "Serve the console, the REST interface, MCP and the plug-in document, in one process",
    "token": "Make a token for somebody who uses a server, as a viewer or an operator; it is shown once",
}
"""What a server is run and looked after with, in a sentence each."""


class ServeRequest(StoreOptions):
    panel = "Options"

    host: str = Field("127.0.0.1", description="address to listen on; any but 127.0.0.1 needs a token first")
    port: int = Field(8642, ge=0, le=65535, description="port to listen on; 0 for any that is free")
    open: bool = Field(False, description="open the console in a browser")
    demonstration: bool = Field(True, description="begin with a demonstration cell where there is no cell yet")
    workers: Annotated[int, Advanced()] = Field(1, ge=1, le=64, description="processes that do the work")
    allowed_host: Annotated[list[str] | None, Advanced()] = Field(
        None, description="name by which the server is reached, beside its address; several times for several"
    )
    base_path: Annotated[str, Advanced()] = Field("", description="path that a proxy in front takes off, as /cell")
    public_url: Annotated[str | None, Advanced()] = Field(
        None, description="address by which others reach the server, for the plug-in document; where it listens if "
        "not given", pattern=r"^https?://[^\s/?#]+[^\s?#]*$",
    )  # fmt: skip
    trusted_proxy: Annotated[list[str] | None, Advanced()] = Field(
        None, description="address whose X-Forwarded headers are believed; several times for several"
    )
    pseudonym_key_file: Annotated[Path | None, Advanced()] = Field(
        None, description="file with a key, 16 characters or more, by which users are known by pseudonyms alone"
    )
    work_limit_s: Annotated[float, Advanced()] = Field(120.0, gt=0, description="time for one piece of work, s")
    receive_limit_s: Annotated[float, Advanced()] = Field(20.0, gt=0, description="time for a request to arrive, s")
    requests_per_s: Annotated[float, Advanced()] = Field(20.0, gt=0, description="requests of one caller, 1/s")


class ServeRecord(Record):
    """A server that has ended."""

    url: str

    def blocks(self) -> list[Block]:
        return [f"The server at {self.url} has ended."]


def serve(request: ServeRequest, progress: Progress) -> ServeRecord:
    try:
        import uvicorn

        from wirelessagent.interfaces.http.app import make_app
        from wirelessagent.interfaces.http.deadline import within
        from wirelessagent.interfaces.http.logs import log_as_json
        from wirelessagent.interfaces.http.shield import LOCAL_NAMES, Doors
        from wirelessagent.service.limits import Limits
        from wirelessagent.service.opening import open_service
    except ImportError as error:
        raise InputError(
            f"serving needs packages that are not installed ({error.name}): pip install 'wirelessagent[serve]'"
        ) from error
    limits = Limits(
        work_s=request.work_limit_s, receive_s=request.receive_limit_s, requests_per_s=request.requests_per_s
    )
    key = _key_in(request.pseudonym_key_file)
    service = open_service(request.store, limits, workers=request.workers, pseudonym_key=key)
    only_local = request.host in LOCAL_NAMES and not request.trusted_proxy and not request.base_path
    if not only_local and not service.access.callers:
        raise InputError(
            f"host: {request.host} is open to others, by itself or by a proxy, so a token is needed: make one with "
            "'wirelessagent token NAME --role operator' first, or listen on 127.0.0.1 alone"
        )
    listening = listening_on(request.host, request.port)
    port = listening.getsockname()[1]
    hosts = {request.host.lower(), *(LOCAL_NAMES if request.host in LOCAL_NAMES else ()), *(request.allowed_host or ())}
    if request.host in ("0.0.0.0", "::"):
        hosts |= {platform.node().lower(), *LOCAL_NAMES}
    base_path = request.base_path.rstrip("/")
    shown = f"[{request.host}]" if ":" in request.host else request.host
    url = f"http://{shown}:{port}{base_path}/"
    if request.public_url is not None:
        hosts.add(urlsplit(request.public_url).hostname or "")
    doors = Doors(
        hosts=frozenset(hosts), only_local=only_local, base_path=base_path,
        public_url=(request.public_url or url).rstrip("/"),
    )  # fmt: skip
    app = make_app(service, doors, demonstration=request.demonstration)
    progress(Event(stage="serve", message=f"the console is at {url} (Ctrl-C ends it)"))
    if request.open:
        webbrowser.open(url)
    proxies = request.trusted_proxy or []
    config = uvicorn.Config(
        app, http=within(limits.receive_s), loop="asyncio", ws="none", log_level="warning", access_log=False,
        server_header=False, proxy_headers=bool(proxies), forwarded_allow_ips=proxies, timeout_graceful_shutdown=5,
    )  # fmt: skip
    log_as_json()
    uvicorn.Server(config).run(sockets=[listening])
    return ServeRecord(url=url)


def _key_in(file: Path | None) -> str:
    try:
        key = "" if file is None else file.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"pseudonym_key_file: {file} cannot be read: {error}") from error
    if file is not None and len(key) < 16:
        raise InputError(f"pseudonym_key_file: {file} holds {len(key)} characters: a key has 16 or more")
    return key


def listening_on(host: str, port: int) -> socket.socket:
    """A socket on which a server can be called at once.

    Raises:
        InputError: the address cannot be had.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # Of a socket that does not say that it is TCP's, asyncio leaves Nagle's algorithm on: 40 ms for each answer.
    listening = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    if os.name == "posix":
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((host, port))
        listening.listen(128)  # so that whoever is told the address can call at once
    except OSError as error:
        listening.close()
        raise InputError(
            f"port: cannot listen on {host}:{port}: {error.strerror}; choose another with --port"
        ) from error
    return listening


SERVE = Operation(
    name="serve", request=ServeRequest, record=ServeRecord, run=serve, local=True,
    examples=("serve --open", "serve --port 9000 --store cell.sqlite3"),
)  # fmt: skip


class TokenRequest(StoreOptions):
    panel = "Options"

    name: Annotated[str, Positional()] = Field(min_length=1, max_length=100, description="whose token it is")
    role: Literal["viewer", "operator"] = Field("viewer", description="what they may do")
    revoke: bool = Field(False, description="take the token back instead")


class TokenRecord(Record):
    """A token that was made; it cannot be shown again."""

    name: str
    role: str
    token: str | None

    def blocks(self) -> list[Block]:
        if self.token is None:
            return [f"{self.name} has no token any more."]
        return [f"The token of {self.name} ({self.role}); it is not shown again:", Files("token", (self.token,))]


def grant(request: TokenRequest, progress: Progress) -> TokenRecord:
    del progress
    from wirelessagent.service.opening import open_access

    access = open_access(request.store)
    if request.revoke and not access.revoke(request.name):
        known = ", ".join(caller.name for caller in access.callers) or "nobody"
        raise InputError(f"name: {request.name!r} has no token; {known} has")
    token = None if request.revoke else access.grant(request.name, request.role)
    return TokenRecord(name=request.name, role=request.role, token=token)


TOKEN = Operation(
    name="token", request=TokenRequest, record=TokenRecord, run=grant, local=True,
    examples=("token alice --role operator", "token alice --revoke"),
)  # fmt: skip
