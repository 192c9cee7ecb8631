"""What the API tells connections that never become requests, with uvicorn's own machinery on a real socket."""

from __future__ import annotations

import asyncio
import contextlib
import json
from typing import Any

import pytest

pytest.importorskip("uvicorn", reason="needs uvicorn (pip install 'diorama[api]')")
import uvicorn

from diorama_app.http_api import access
from diorama_app.http_api.access import Application, Connection
from tests.app.http_api.test_access import served


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
