"""What happens to a request, and to a connection's messages, before viser sees them, and a websocket that was accepted
in one event loop, for a server that runs in another.
"""

from __future__ import annotations

import asyncio
import http
import time
from collections.abc import Awaitable, Callable, Coroutine
from concurrent.futures import Future
from typing import Any, Protocol, runtime_checkable
from urllib.parse import parse_qs, parse_qsl, urlencode, urlsplit

import viser
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from diorama_app.web.responses import add_headers, picture, prepend_scripts
from diorama_app.web.visitors import Visitors

ConnectionHandler = Callable[[Any], Coroutine[Any, Any, None]]
"""Talks to one browser until it goes away."""


class Bridge:
    """What viser uses of a connection, done in the loop that the connection belongs to."""

    def __init__(self, connection: ServerConnection, home: asyncio.AbstractEventLoop) -> None:
        """Wrap a connection.

        Args:
            connection: as it was accepted.
            home: the loop that it was accepted in; it must go on running.
        """
        self._connection = connection
        self._home = home
        self.subprotocol = connection.subprotocol

    async def recv(self) -> str | bytes:
        """The next message; raises `ConnectionClosed` when the browser went away."""
        message: str | bytes = await self._run_at_home(self._connection.recv())
        return message

    async def send(self, message: bytes) -> None:
        """Send a message, waiting while the browser is slow to take it."""
        await self._run_at_home(self._connection.send(message))

    async def close(self, code: int = 1000, reason: str = "") -> None:
        """Say goodbye."""
        await self._run_at_home(self._connection.close(code, reason))

    def _run_at_home(self, work: Coroutine[Any, Any, Any]) -> Awaitable[Any]:
        return asyncio.wrap_future(asyncio.run_coroutine_threadsafe(work, self._home))


MESSAGES_PER_S, MESSAGES_AT_ONCE = 300, 600
"""Messages of one connection: a drag and a turning camera together send about a hundred a second."""
PICTURES = "pictures/"
"""Addresses below this one are pictures."""

HttpHandler = Callable[[ServerConnection, Request], Response | None]
Answer = Callable[[ServerConnection, Request], Response | Awaitable[Response] | None]
Pictures = Callable[[str], "Future[bytes | None]"]

PROJECT = "project"
"""The parameter of an address that names a project."""


@runtime_checkable
class ProjectServers(Protocol):
    """Which project an address leads to."""

    def first(self) -> str | None:
        """The project of an address that names none; None for the page of the server itself."""
        ...

    def server(self, name: str) -> viser.ViserServer | None:
        """The server of a project, opened if necessary; None where there is no such project. May take a while."""
        ...


def request_check(
    handler: HttpHandler | None, visitors: Visitors, pictures: Pictures | None, projects: ProjectServers | None
) -> Answer:
    """What websockets asks before anything else: refuses, redirects and serves pictures; the rest is viser's.

    Args:
        handler: viser's own, which serves the page.
        visitors: who may come.
        pictures: asked for what lies below `PICTURES`.
        projects: the first of them is where a page goes whose address names none.
    """

    def process_request(connection: ServerConnection, request: Request) -> Response | Awaitable[Response] | None:
        refusal = visitors.refusal(request)
        if refusal is not None:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f"Refused: {refusal}.\n")
        try:
            return serve(connection, request)
        except (ValueError, LookupError, OSError):  # an address that names no file: a null character, half a name
            return connection.respond(http.HTTPStatus.BAD_REQUEST, "This request is invalid.\n")

    def serve(connection: ServerConnection, request: Request) -> Response | Awaitable[Response] | None:
        name = urlsplit(request.path).path.removeprefix(f"/{PICTURES}")
        if pictures is not None and f"/{PICTURES}{name}" == urlsplit(request.path).path:
            return picture(connection, pictures(name))
        is_page = urlsplit(request.path).path in ("", "/") and request.headers.get("Upgrade") != "websocket"
        first = projects.first() if projects is not None and is_page and project_of(request.path) is None else None
        response: Response | None = None
        if first is not None:
            response = redirect(request, first)
        elif handler is not None and (response := handler(connection, request)) is not None:
            prepend_scripts(response)
        if response is not None:
            remember = visitors.token if visitors.brings_token(request) else None
            add_headers(response, remember=remember, frame_origins=visitors.frame_origins)
        return response

    return process_request


def project_of(address: str) -> str | None:
    """The project that an address names, or None."""
    return parse_qs(urlsplit(address).query).get(PROJECT, [None])[0]


def redirect(request: Request, project: str) -> Response:
    """Sends a page whose address names no project to the address that does."""
    query = [*parse_qsl(urlsplit(request.path).query, keep_blank_values=True), (PROJECT, project)]
    headers = Headers({"Location": f"/?{urlencode(query)}", "Content-Length": "0", "Cache-Control": "no-store"})
    headers["Connection"] = "close"
    return Response(http.HTTPStatus.FOUND, "Found", headers)


def pace(handler: Callable[[ServerConnection], Awaitable[None]]) -> Callable[[ServerConnection], Awaitable[None]]:
    """The handler, with messages taken no faster than anybody can work: the rest waits at its sender."""

    async def handle(connection: ServerConnection) -> None:
        receive, credit, at = connection.recv, float(MESSAGES_AT_ONCE), time.monotonic()

        async def recv(*args: Any, **kwargs: Any) -> Any:
            nonlocal credit, at
            now = time.monotonic()
            credit, at = min(MESSAGES_AT_ONCE, credit + (now - at) * MESSAGES_PER_S) - 1.0, now
            if credit < 0.0:
                await asyncio.sleep(-credit / MESSAGES_PER_S)
            return await receive(*args, **kwargs)

        connection.recv = recv  # type: ignore[method-assign]  # viser asks the connection itself for messages
        await handler(connection)

    return handle
