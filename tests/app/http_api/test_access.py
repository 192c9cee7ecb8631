from __future__ import annotations

import asyncio
import json

import pytest

from diorama_app.http_api.access import MAX_BODIES, MAX_BODY_BYTES, Guard
from diorama_app.web.visitors import Visitors

HOST = (b"host", b"127.0.0.1:8090")


def ask(guard: Guard, *headers: tuple[bytes, bytes], method: str = "GET", query: bytes = b"", parts=(b"",)):
    """The status and what the request is told."""
    sent, left = [], list(parts)
    scope = {"type": "http", "method": method, "path": "/v1/jobs", "query_string": query, "headers": [*headers]}

    async def receive():
        return {"type": "http.request", "body": left.pop(0), "more_body": bool(left)}

    async def send(message):
        sent.append(message)

    asyncio.run(guard(scope, receive, send))
    return sent[0]["status"], json.loads(sent[1]["body"])


async def served(scope, receive, send) -> None:
    while (await receive())["more_body"]:
        pass
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"{}"})


@pytest.mark.parametrize(
    ("headers", "query", "status"),
    [
        ((HOST, (b"authorization", b"Bearer right")), b"", 200),
        ((HOST, (b"authorization", b"bearer  right")), b"", 200),
        ((HOST, (b"authorization", b"Bearer wrong")), b"token=right", 401),
        ((HOST,), b"token=right", 200),
        ((HOST, (b"authorization", b"Basic right")), b"", 401),
        ((HOST,), b"", 401),
        (((b"host", b"evil.example"), (b"authorization", b"Bearer right")), b"", 403),
        ((HOST, (b"origin", b"http://evil.example"), (b"authorization", b"Bearer right")), b"", 403),
        ((HOST, HOST), b"token=right", 403),
        ((HOST, (b"content-length", b"x")), b"token=right", 400),
    ],
)
def test_who_may_ask(headers, query: bytes, status: int) -> None:
    assert ask(Guard(served, Visitors("127.0.0.1", "right")), *headers, query=query)[0] == status


def test_a_body_that_grows_beyond_its_announcement_is_cut_off() -> None:
    guard, half = Guard(served, Visitors("127.0.0.1")), bytes(MAX_BODY_BYTES // 2)
    status, told = ask(guard, HOST, method="POST", parts=(half, half, b"x"))
    assert (status, "are taken" in told["error"]) == (413, True)
    assert ask(guard, HOST, method="POST", parts=(half, half))[0] == 200


def test_only_so_many_bodies_at_once() -> None:
    guard = Guard(served, Visitors("127.0.0.1"))
    guard._bodies = MAX_BODIES
    assert ask(guard, HOST, method="POST")[0] == 503
    assert ask(guard, HOST)[0] == 200
