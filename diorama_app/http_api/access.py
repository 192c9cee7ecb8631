"""Who may ask, and how much may be sent: checked before anything of a request is read. What ends before a request is
whole, or is no HTTP, gets a JSON line as well.
"""

from __future__ import annotations

import asyncio
import json
import logging
import time
from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any
from urllib.parse import quote

import h11
from fastapi import HTTPException
from uvicorn.protocols.http.h11_impl import H11Protocol
from websockets.datastructures import Headers
from websockets.http11 import Request

from diorama_app.web.visitors import MAX_UPLOAD_BYTES, Visitors

log = logging.getLogger(__name__)

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
Application = Callable[[Scope, Receive, Send], Awaitable[None]]

MAX_BODY_BYTES = MAX_UPLOAD_BYTES
"""Size of one request: photo, depth and masks together."""
MAX_BODIES = 4
"""Requests whose bodies are taken or worked on at a time; one that has sent nothing yet takes no place."""
MAX_REQUESTS = 500
"""At a time. One that waits for a job's end holds a connection and no thread."""
STALLED_S = 10.0
"""A body of which nothing comes for so long is given up."""
MIN_BYTES_S, GRACE_S = 20_000.0, 20.0
"""A body that comes more slowly, after the first seconds, is given up, too: a slow network sends five times as much."""
HEADERS = (
    (b"cache-control", b"no-store"),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
)


class Guard:
    """ASGI middleware: refuses strangers, large bodies and too many at once, with one JSON line each."""

    def __init__(self, app: Application, visitors: Visitors) -> None:
        self._app, self._visitors = app, visitors
        self._bodies = self._requests = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a request, or hand it on."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        status, reason = self._refusal(scope)
        if reason is not None:
            await answer(send, status, reason)
            return
        if self._requests >= MAX_REQUESTS:
            await answer(send, 503, "too many requests are under way; try again in a moment")
            return
        self._requests += 1
        reply, body = _Told(send), _Body(self, receive)
        try:
            await self._app(scope, body, reply)
        except HTTPException as error:
            await reply.answer(error.status_code, str(error.detail))
        except Exception:  # the one place for what nobody expected: whoever asks gets a line, the log the rest
            log.exception("%s %s failed", scope["method"], quote(scope["path"]))
            await reply.answer(500, "internal error; the server's log says more")
        finally:
            self._requests -= 1
            self._bodies -= body.has_place

    def take_place(self) -> None:
        """Count a body that has begun; refuses one too many."""
        if self._bodies >= MAX_BODIES:
            raise HTTPException(503, "other uploads are under way; try again in a moment", {"Retry-After": "5"})
        self._bodies += 1

    def _refusal(self, scope: Scope) -> tuple[int, str | None]:
        try:
            headers = [(name.decode("latin-1"), value.decode("latin-1")) for name, value in scope["headers"]]
            request = Request(_address(scope, dict(headers)), Headers(headers))
            length = int(request.headers.get("Content-Length", "0"))
        except (ValueError, LookupError):
            return 400, "the request headers are invalid"
        refusal = self._visitors.refusal(request)
        if refusal is not None:
            return (401 if "token" in refusal else 403), refusal
        return 413, too_large(length) if length > MAX_BODY_BYTES else None


def too_large(length: int) -> str:
    """Why a body is not taken."""
    return f"the request has {length / 1e6:.0f} MB or more, and up to {MAX_BODY_BYTES / 1e6:.0f} MB are taken"


async def answer(send: Send, status: int, reason: str) -> None:
    """A refusal as every other error is told: `{"error": "..."}`."""
    body, headers = _error(reason)
    headers += HEADERS
    headers += [(b"www-authenticate", b"Bearer")] if status == 401 else []
    headers += [(b"retry-after", b"5")] if status == 503 else []
    headers += [(b"connection", b"close")] if status in (408, 413) else []
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def _error(reason: str) -> tuple[bytes, list[tuple[bytes, bytes]]]:
    """A body and its headers."""
    body = json.dumps({"error": reason}).encode()
    return body, [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode())]


def _address(scope: Scope, headers: dict[str, str]) -> str:
    """The path with its query, and in it a token of the Authorization header: the editor's rules read it there."""
    kind, _, token = headers.get("authorization", "").partition(" ")
    query = scope["query_string"].decode("latin-1")
    if kind.lower() == "bearer":
        query = f"token={quote(token.strip(), safe='')}"
    return f"{quote(scope['path'])}?{query}"


class _Body:
    """What a request sends: in bounded time, of bounded size, and counted from its first byte on."""

    def __init__(self, guard: Guard, receive: Receive) -> None:
        self._guard, self._receive = guard, receive
        self.has_place = False
        self._ended = False
        self._taken, self._began = 0, time.monotonic()

    async def __call__(self) -> MutableMapping[str, Any]:
        """The next part; after the last one, only the end of the connection comes."""
        if self._ended:
            return await self._receive()
        left = GRACE_S + self._taken / MIN_BYTES_S - (time.monotonic() - self._began)
        try:
            message = await asyncio.wait_for(self._receive(), max(0.0, min(STALLED_S, left)))
        except TimeoutError as error:
            raise HTTPException(408, "the request did not go on; send it again", {"Connection": "close"}) from error
        content = message.get("body", b"")
        self._ended = not message.get("more_body", False)
        self._taken += len(content)
        if content and not self.has_place:
            self._guard.take_place()
            self.has_place = True
        if self._taken > MAX_BODY_BYTES:
            raise HTTPException(413, too_large(self._taken), {"Connection": "close"})
        return message


class _Told:
    """Hands on an answer with the headers that every one has, and can give one of its own while none has begun."""

    def __init__(self, send: Send) -> None:
        self._send = send
        self._begun = False

    async def __call__(self, message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            self._begun = True
            message = {**message, "headers": [*message["headers"], *HEADERS]}
        await self._send(message)

    async def answer(self, status: int, reason: str) -> None:
        """Tell an error; one that comes within an answer can only be logged."""
        if not self._begun:
            await answer(self._send, status, reason)


HEAD_S = 15.0
"""Within which the head of a request must have come; uvicorn itself waits for ever."""


class Connection(H11Protocol):  # type: ignore[misc]  # uvicorn's modules are Any to mypy (pyproject.toml)
    """uvicorn's connection, which gives up on silent ones and tells errors as JSON.

    Pinned by `tests/app/http_api/test_access.py`: uvicorn has no option for either.
    """

    _patience: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Begin to wait for a request."""
        super().connection_made(transport)
        self._wait_for_head()

    def data_received(self, data: bytes) -> None:
        """Take what came; a head that is not whole yet has so long and no longer."""
        super().data_received(data)
        if self.conn.their_state is h11.IDLE:
            self._wait_for_head()
        elif self._patience is not None:
            self._patience.cancel()
            self._patience = None

    def send_400_response(self, msg: str) -> None:
        """Tell that the request is no HTTP."""
        body, headers = _error(f"the request cannot be read ({msg})")
        head = h11.Response(status_code=400, headers=[*headers, (b"connection", b"close")])
        for event in (head, h11.Data(data=body), h11.EndOfMessage()):
            self.transport.write(self.conn.send(event))
        self.transport.close()

    def _wait_for_head(self) -> None:
        if self._patience is None:
            self._patience = self.loop.call_later(HEAD_S, self.transport.close)
