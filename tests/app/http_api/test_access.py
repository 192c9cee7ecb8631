from __future__ import annotations

import asyncio
import json

import pytest

from diorama_app.http_api import access
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
    for _ in range(MAX_BODIES):
        guard.take_place()
    assert ask(guard, HOST, method="POST", parts=(b"x",))[0] == 503
    assert ask(guard, HOST, method="POST")[0] == 200, "what has no body, such as a cancel, needs no place"
    assert ask(guard, HOST)[0] == 200


def test_silent_and_dripping_bodies_are_given_up_and_hold_no_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four uploads that sent nothing kept every other one, and every cancel, out for 40 seconds."""
    monkeypatch.setattr(access, "STALLED_S", 0.05)
    monkeypatch.setattr(access, "GRACE_S", 0.3)

    async def trouble(drip: bool) -> tuple[int, int]:
        guard, sent = Guard(served, Visitors("127.0.0.1")), []

        async def receive():
            if not drip:
                await asyncio.sleep(30.0)
            await asyncio.sleep(0.02)
            return {"type": "http.request", "body": b"x" if drip else b"", "more_body": True}

        async def send(message):
            sent.append(message)

        scope = {"type": "http", "method": "POST", "path": "/v1/jobs", "query_string": b"", "headers": [HOST]}
        uploads = [asyncio.create_task(guard(scope, receive, send)) for _ in range(MAX_BODIES)]
        await asyncio.sleep(0.04)
        held = guard._bodies
        await asyncio.gather(*uploads)
        assert {m["status"] for m in sent if "status" in m} == {408}
        assert (b"connection", b"close") in sent[0]["headers"]
        return held, guard._bodies

    assert asyncio.run(trouble(drip=False)) == (0, 0), "silent ones hold no place"
    assert asyncio.run(trouble(drip=True)) == (MAX_BODIES, 0)


def test_what_nobody_expected_is_one_json_line_and_logged(caplog: pytest.LogCaptureFixture) -> None:
    async def broken(scope, receive, send) -> None:
        raise ZeroDivisionError("in a place that nobody thought of")

    status, told = ask(Guard(broken, Visitors("127.0.0.1")), HOST)
    assert (status, told) == (500, {"error": "internal error; the server's log says more"})
    assert "nobody thought of" in caplog.text


def test_too_many_requests_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(access, "MAX_REQUESTS", 0)
    assert ask(Guard(served, Visitors("127.0.0.1")), HOST)[0] == 503
