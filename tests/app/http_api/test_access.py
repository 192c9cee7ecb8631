from __future__ import annotations

import asyncio
import contextlib
import json
import time
from typing import Any

import pytest
import uvicorn

from diorama_app.http_api import access
from diorama_app.http_api.access import MAX_BODIES, MAX_BODY_BYTES, Application, Connection, Guard
from diorama_app.web.visitors import Visitors
from tests.app.http_api.asgi import HOST, messages


def ask(guard: Guard, *headers: tuple[bytes, bytes], **how: Any):
    """The status and what the request is told."""
    sent = asyncio.run(messages(guard, *headers, **how))
    return sent[0]["status"], json.loads(sent[1]["body"])


async def served(scope, receive, send) -> None:
    while (await receive())["more_body"]:
        pass
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"{}"})


@pytest.mark.parametrize(
    ("headers", "query", "status"),
    [
        ((HOST, (b"authorization", b"Bearer right")), "", 200),
        ((HOST, (b"authorization", b"bearer  right")), "", 200),
        ((HOST, (b"authorization", b"Bearer wrong")), "token=right", 401),
        ((HOST,), "token=right", 200),
        ((HOST, (b"authorization", b"Basic right")), "", 401),
        ((HOST,), "", 401),
        (((b"host", b"evil.example"), (b"authorization", b"Bearer right")), "", 403),
        ((HOST, (b"origin", b"http://evil.example"), (b"authorization", b"Bearer right")), "", 403),
        ((HOST, HOST), "token=right", 403),
        ((HOST, (b"content-length", b"x")), "token=right", 400),
    ],
)
def test_who_may_ask(headers, query: str, status: int) -> None:
    assert ask(Guard(served, Visitors("127.0.0.1", "right")), *headers, path=f"/v1/jobs?{query}")[0] == status


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
    now = [time.monotonic()]

    async def trouble(drip: bool) -> tuple[int, int]:
        guard, held = Guard(served, Visitors("127.0.0.1")), []

        async def receive():
            held.append(guard._bodies)
            if not drip:
                await asyncio.Event().wait()
            now[0] += 0.25 * access.GRACE_S / MAX_BODIES
            return {"type": "http.request", "body": b"x", "more_body": True}

        asked = (messages(guard, method="POST", receive=receive) for _ in range(MAX_BODIES))
        heads = [sent[0] for sent in await asyncio.gather(*asked)]
        assert {head["status"] for head in heads} == {408}
        assert all((b"connection", b"close") in head["headers"] for head in heads)
        assert len(held) < 6 * MAX_BODIES
        return max(held), guard._bodies

    monkeypatch.setattr(access, "STALLED_S", 0.05)
    assert asyncio.run(trouble(drip=False)) == (0, 0), "silent ones hold no place"
    monkeypatch.setattr(access, "STALLED_S", 600.0)
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
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


@pytest.mark.parametrize(
    ("query", "length", "status", "says"),
    [
        ("", 0, 401, {b"www-authenticate": b"Bearer"}),
        ("token=right", MAX_BODY_BYTES + 1, 413, {b"connection": b"close"}),
        ("token=right", MAX_BODY_BYTES, 503, {b"retry-after": b"5"}),
    ],
)
def test_a_refusal_says_what_to_do(query: str, length: int, status: int, says: dict[bytes, bytes]) -> None:
    guard = Guard(served, Visitors("127.0.0.1", "right"))
    for _ in range(MAX_BODIES):
        guard.take_place()
    announced = (b"content-length", str(length).encode())
    path = f"/v1/jobs?{query}"
    start, body = asyncio.run(messages(guard, HOST, announced, method="POST", path=path, parts=(b"x",)))
    told = dict(start["headers"])
    assert start["status"] == status
    assert int(told[b"content-length"]) == len(body["body"])
    hints = (b"www-authenticate", b"connection", b"retry-after")
    assert {name: value for name, value in told.items() if name in hints} == says


def test_what_is_no_request_is_handed_on() -> None:
    asked: list[str] = []

    async def started(scope, receive, send) -> None:
        asked.append(scope["type"])

    asyncio.run(Guard(started, Visitors("127.0.0.1", "right"))({"type": "lifespan"}, None, None))
    assert asked == ["lifespan"]


def test_requests_count_while_they_last(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(access, "MAX_REQUESTS", 2)

    async def waits(scope, receive, send) -> None:
        await scope["ends"].wait()
        await served(scope, receive, send)

    async def crowd(guard: Guard) -> list[int]:
        ends = asyncio.Event()
        requests = [asyncio.create_task(messages(guard, ends=ends)) for _ in range(3)]
        while not any(task.done() for task in requests):
            await asyncio.sleep(0)
        ends.set()
        return sorted(sent[0]["status"] for sent in await asyncio.gather(*requests))

    guard = Guard(waits, Visitors("127.0.0.1"))
    assert [asyncio.run(crowd(guard)) for _ in range(3)] == [[200, 200, 503]] * 3


def test_after_the_last_part_comes_the_end_of_the_connection(monkeypatch: pytest.MonkeyPatch) -> None:
    async def reads_on(scope, receive, send) -> None:
        assert (await receive())["body"] == b"x"
        monkeypatch.setattr(access, "STALLED_S", 0.0)  # of the body alone: its answer may take longer
        assert (await receive())["body"] == b"what the server sends then"
        await send({"type": "http.response.start", "status": 200, "headers": []})

    parts = [{"type": "http.request", "body": b"x"}, {"body": b"what the server sends then", "more_body": False}]

    async def receive() -> dict:
        return parts.pop(0)

    guard = Guard(reads_on, Visitors("127.0.0.1"))
    assert asyncio.run(messages(guard, method="POST", receive=receive))[0]["status"] == 200
    assert parts == []


def test_an_error_within_an_answer_is_only_logged(caplog: pytest.LogCaptureFixture) -> None:
    async def broken(scope, receive, send) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": []})
        raise ZeroDivisionError("half way")

    sent = asyncio.run(messages(Guard(broken, Visitors("127.0.0.1"))))
    assert [m["type"] for m in sent] == ["http.response.start"]
    assert "half way" in caplog.text


async def _sent(*parts: bytes, app: Application = served, times_out: int = 0, idle_s: int = 5) -> bytes:
    """What a server answers to these parts, the later ones sent after an answer to the earlier, until it closes.

    Args:
        parts: bytes of requests.
        app: what answers.
        times_out: which of the waits for a head ends then, the first is 1; none by itself.
        idle_s: when a connection is closed after an answer.
    """
    loop, timers = asyncio.get_running_loop(), []
    call_later = loop.call_later

    def noted(delay: float, *call: Any) -> asyncio.TimerHandle:
        handle = call_later(delay, *call)
        timers.extend([handle] if delay == access.HEAD_S else [])
        return handle

    loop.call_later = noted
    config = uvicorn.Config(
        app, port=0, http=Connection, log_level="error", lifespan="off", ws="none", timeout_keep_alive=idle_s
    )
    server = uvicorn.Server(config)
    task = asyncio.create_task(server.serve())
    while not server.started:
        await asyncio.sleep(0.01)
    port = server.servers[0].sockets[0].getsockname()[1]
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    answer = b""
    for number, part in enumerate(parts):
        answer += await reader.readuntil(b"{}") if number else b""
        writer.write(part)
    while len(timers) < times_out:
        await asyncio.sleep(0.01)
    for timer in timers[times_out - 1 : times_out]:
        assert not timer.cancelled()
        timer._run()
    with contextlib.suppress(ConnectionResetError):  # closed before it had read all
        answer += await asyncio.wait_for(reader.read(), 60.0)
    assert all(timer.cancelled() for timer in timers[: times_out - 1])
    writer.close()
    server.should_exit = True
    await task
    return answer


WHOLE = b"GET / HTTP/1.1\r\nHost: a\r\n\r\n"


@pytest.mark.parametrize("data", [b"", b"GET / HTTP/1.1\r\n"])
def test_connections_that_send_no_whole_head_are_closed(data: bytes) -> None:
    assert asyncio.run(_sent(data, times_out=1)) == b""


def test_a_second_request_on_a_connection_has_as_long_as_the_first() -> None:
    answer = asyncio.run(_sent(WHOLE, b"GET /", times_out=2))
    assert answer.count(b"HTTP/1.1 200") == 1


def test_half_a_request_behind_a_whole_one_is_given_up() -> None:
    answer = asyncio.run(_sent(WHOLE + b"GET /", idle_s=1))
    assert answer.count(b"HTTP/1.1 200") == 1


def test_what_is_no_http_gets_its_line_as_json() -> None:
    head, _, body = asyncio.run(_sent(b"\x16\x03\x01 no http\r\n\r\n")).partition(b"\r\n\r\n")
    assert b" 400 " in head.splitlines()[0]
    assert json.loads(body)["error"].startswith("the request cannot be read")
