"""What the API tells connections that never become requests, with uvicorn's own machinery on a real socket."""

from __future__ import annotations

import asyncio
import json

import pytest

pytest.importorskip("uvicorn", reason="needs uvicorn (pip install 'diorama[api]')")
import uvicorn

from diorama_app.http_api import connections
from diorama_app.http_api.connections import Connection
from tests.app.http_api.test_access import served


async def _sent(data: bytes) -> bytes:
    """What a server answers to these bytes until it closes."""
    config = uvicorn.Config(served, port=0, http=Connection, log_level="error", lifespan="off", ws="none")
    server = uvicorn.Server(config)
    task = asyncio.create_task(server.serve())
    while not server.started:
        await asyncio.sleep(0.01)
    port = server.servers[0].sockets[0].getsockname()[1]
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(data)
    answer = await asyncio.wait_for(reader.read(), 10.0)
    writer.close()
    server.should_exit = True
    await task
    return answer


@pytest.mark.parametrize("data", [b"", b"GET / HTTP/1.1\r\n", b"GET / HTTP/1.1\r\nHost: a\r\n\r\nGET /"])
def test_connections_that_do_not_go_on_are_closed(data: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connections, "HEAD_S", 0.2)
    answer = asyncio.run(_sent(data))
    assert answer.count(b"HTTP/1.1 200") == data.count(b"\r\n\r\n")


def test_what_is_no_http_gets_its_line_as_json() -> None:
    head, _, body = asyncio.run(_sent(b"\x16\x03\x01 no http\r\n\r\n")).partition(b"\r\n\r\n")
    assert b" 400 " in head.splitlines()[0]
    assert json.loads(body)["error"].startswith("the request cannot be read")
