"""The application: routes behind the shield, and the console's files."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncGenerator
from pathlib import Path
from typing import Any

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import FileResponse, JSONResponse, RedirectResponse
from starlette.exceptions import HTTPException
from starlette.routing import Match, Route
from starlette.staticfiles import StaticFiles

from wirelessagent.interfaces.http import forms
from wirelessagent.interfaces.http.answers import StrictRoute, problem_in, service_of
from wirelessagent.interfaces.http.plugin import add_plugin
from wirelessagent.interfaces.http.routes import PROBLEMS, router, texts
from wirelessagent.interfaces.http.shield import COOKIE, Doors, Shield, cookie_of
from wirelessagent.interfaces.mcp.door import Door
from wirelessagent.operations.operation import installed_version
from wirelessagent.service.access import SIGNED_IN_S
from wirelessagent.service.service import Service

_CONSOLE = Path(__file__).parent.parent / "console"

_DESCRIPTION = (
    "Say in plain words what a downlink OFDMA cell should do. The channel is sensed and repaired, the allocation "
    "decided with a certificate, applied once it is confirmed, and read back."
)


def make_app(service: Service, doors: Doors, *, demonstration: bool = False) -> FastAPI:
    """The application of a service; with a demonstration cell, where there is none yet and it is wanted."""
    mcp = Door(service)

    @contextlib.asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncGenerator[None]:
        del app
        if demonstration:
            await service.demonstrate()
        yield
        await mcp.close()
        await service.close()

    app = FastAPI(
        title="WirelessAgent", version=installed_version(), description=_DESCRIPTION, lifespan=lifespan,
        docs_url=None, redoc_url=None, root_path=doors.base_path,
    )  # fmt: skip
    app.router.route_class = StrictRoute
    app.state.service, app.state.doors = service, doors
    _add_health(app)
    app.include_router(router)
    app.include_router(texts)
    _add_way_in(app)
    _add_console(app)
    add_plugin(app)
    app.router.routes.append(Route("/mcp", endpoint=mcp))
    for kind in (RequestValidationError, HTTPException):  # any other error is the shield's
        app.add_exception_handler(kind, _answer)
    app.add_middleware(Shield, service=service, doors=doors)
    return app


async def _answer(request: Request, error: Exception) -> Response:
    """An error of the framework's as a problem; where it is the method's, with all those that there are."""
    problem = problem_in(error)
    if problem.status == 405:
        problem.headers["Allow"] = ", ".join(sorted(_methods(request)))
    return JSONResponse(
        problem.body, status_code=problem.status, headers=problem.headers, media_type="application/problem+json"
    )


def _methods(request: Request) -> set[str]:
    """The methods that some route has for a path."""
    there = [route for route in request.app.router.routes if route.matches(request.scope)[0] is not Match.NONE]
    return {method for route in there for method in getattr(route, "methods", None) or ()}


def _add_way_in(app: FastAPI) -> None:
    @app.post("/sign-in", status_code=204, tags=["console"], responses=PROBLEMS)
    async def sign_in(request: Request, form: forms.SignIn) -> Response:  # pyright: ignore[reportUnusedFunction]
        """Open a browser session with a token."""
        _, cookie = await asyncio.to_thread(service_of(request).access.sign_in, form.token)
        response = Response(status_code=204)
        response.set_cookie(
            COOKIE, cookie, max_age=SIGNED_IN_S, path=app.state.doors.base_path or "/", httponly=True,
            samesite="strict", secure=request.url.scheme == "https",
        )  # fmt: skip
        return response

    @app.post("/sign-out", status_code=204, tags=["console"], responses=PROBLEMS)
    async def sign_out(request: Request) -> Response:  # pyright: ignore[reportUnusedFunction]
        """End the browser session."""
        await asyncio.to_thread(service_of(request).access.sign_out, cookie_of(request.headers))
        response = Response(status_code=204)
        response.delete_cookie(COOKIE, path=app.state.doors.base_path or "/")
        return response


def _add_health(app: FastAPI) -> None:
    @app.get("/healthz", tags=["health"])
    async def healthy() -> dict[str, str]:  # pyright: ignore[reportUnusedFunction]
        """Whether the server answers."""
        return {"status": "ok"}

    @app.get("/readyz", tags=["health"], responses={503: {"model": forms.Problem}})
    async def ready(request: Request) -> Any:  # pyright: ignore[reportUnusedFunction]
        """Whether the server can work: its store can be read."""
        await asyncio.to_thread(service_of(request).ledger.find, "cell", "")
        return {"status": "ready"}

    @app.get("/metrics", tags=["health"], response_class=Response,
             responses={200: {"content": {"text/plain": {}}}})  # fmt: skip
    async def metrics(request: Request) -> Response:  # pyright: ignore[reportUnusedFunction]
        """Counters in Prometheus' text format."""
        return Response(service_of(request).metrics.text(), media_type="text/plain; version=0.0.4; charset=utf-8")


def _add_console(app: FastAPI) -> None:
    app.mount("/console", StaticFiles(directory=_CONSOLE, html=True), name="console")

    @app.get("/", include_in_schema=False)
    async def root() -> Response:  # pyright: ignore[reportUnusedFunction]
        return RedirectResponse(f"{app.root_path}/console/", status_code=307)

    @app.get("/sign-in", tags=["console"], status_code=307, response_class=RedirectResponse, responses=PROBLEMS)
    async def sign_in_page() -> Response:  # pyright: ignore[reportUnusedFunction]
        """Where people sign in."""
        return RedirectResponse(f"{app.root_path}/console/sign-in.html", status_code=307)

    @app.get("/favicon.ico", include_in_schema=False)
    async def icon() -> Response:  # pyright: ignore[reportUnusedFunction]
        found = _CONSOLE / "icon.svg"
        return FileResponse(found) if found.is_file() else Response(status_code=204)
