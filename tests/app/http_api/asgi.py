"""One request to an application, without a server."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

HOST = (b"host", b"127.0.0.1:8090")


async def messages(
    app: Callable[..., Awaitable[None]],
    *headers: tuple[bytes, bytes],
    method: str = "GET",
    path: str = "/v1/jobs",
    parts: tuple[bytes, ...] = (b"",),
    receive: Callable[[], Awaitable[dict]] | None = None,
    **more: Any,
) -> list[dict]:
    """What the application sends.

    Args:
        app: what answers.
        headers: of the request; the host alone where there are none.
        method: how it asks.
        path: for what, with its query.
        parts: of the body.
        receive: gives the messages instead of these parts.
        more: of the request's scope.
    """
    sent: list[dict] = []
    left, (way, _, query) = list(parts), path.partition("?")

    async def part() -> dict:
        return {"type": "http.request", "body": left.pop(0), "more_body": bool(left)}

    async def send(message: dict) -> None:
        sent.append(message)

    about = {"type": "http", "http_version": "1.1", "scheme": "http", "method": method, "path": way}
    about |= {"raw_path": way.encode(), "query_string": query.encode(), "headers": [*(headers or (HOST,))], **more}
    await app(about, receive or part, send)
    return sent
