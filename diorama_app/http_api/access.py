"""Who may ask, and how much may be sent: checked before anything of a request is read."""

from __future__ import annotations

import json
from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any
from urllib.parse import quote

from websockets.datastructures import Headers
from websockets.http11 import Request

from diorama_app.web.upload_limits import MAX_UPLOAD_BYTES
from diorama_app.web.visitors import Visitors

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
Application = Callable[[Scope, Receive, Send], Awaitable[None]]

MAX_BODY_BYTES = MAX_UPLOAD_BYTES
"""Of one request: photo, depth and masks together."""
MAX_BODIES = 4
"""Requests with a body at a time."""
HEADERS = (
    (b"cache-control", b"no-store"),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
)


class BodyTooLargeError(Exception):
    """More was sent than was announced, or is taken."""


class Guard:
    """ASGI middleware: refuses strangers, large bodies and too many at once, with one JSON line each."""

    def __init__(self, app: Application, visitors: Visitors) -> None:
        self._app, self._visitors = app, visitors
        self._bodies = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a request, or hand it on."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        status, reason = self._refusal(scope)
        if reason is not None:
            await answer(send, status, reason)
            return
        has_body = scope["method"] not in ("GET", "HEAD", "DELETE")
        if has_body and self._bodies >= MAX_BODIES:
            await answer(send, 503, "other uploads are under way; try again in a moment")
            return
        self._bodies += has_body
        try:
            await self._app(scope, _bounded(receive), _with_headers(send))
        except BodyTooLargeError as error:
            await answer(send, 413, str(error))
        finally:
            self._bodies -= has_body

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
    body = json.dumps({"error": reason}).encode()
    headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode()), *HEADERS]
    headers += [(b"www-authenticate", b"Bearer")] if status == 401 else []
    headers += [(b"retry-after", b"5")] if status == 503 else []
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def _address(scope: Scope, headers: dict[str, str]) -> str:
    """The path with its query, and in it a token of the Authorization header: the editor's rules read it there."""
    kind, _, token = headers.get("authorization", "").partition(" ")
    query = scope["query_string"].decode("latin-1")
    if kind.lower() == "bearer":
        query = f"token={quote(token.strip(), safe='')}"
    return f"{quote(scope['path'])}?{query}"


def _bounded(receive: Receive) -> Receive:
    taken = 0

    async def bounded() -> MutableMapping[str, Any]:
        nonlocal taken
        message = await receive()
        taken += len(message.get("body", b""))
        if taken > MAX_BODY_BYTES:
            raise BodyTooLargeError(too_large(taken))
        return message

    return bounded


def _with_headers(send: Send) -> Send:
    async def sent(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message["headers"], *HEADERS]}
        await send(message)

    return sent
