"""What the server answers before viser sees a request."""

from __future__ import annotations

import asyncio
import gzip
import http.client
import socket
import threading
import time
import urllib.request
from concurrent.futures import Future

import pytest
import viser
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request
from websockets.server import ServerProtocol
from websockets.typing import Subprotocol

from diorama_app.strings import translate_script
from diorama_app.web import viser_adapter
from diorama_app.web.requests import MESSAGES_AT_ONCE, MESSAGES_PER_S, Bridge, pace, project_of, redirect
from diorama_app.web.responses import SCRIPTS
from diorama_app.web.viser_adapter import create_server, stop_server
from diorama_app.web.visitors import Visitors
from tests.app.web.http_client import fetch, raw_status


class Connection(ServerConnection):
    """Works in one loop only, as websockets do."""

    def __init__(self) -> None:
        self.loop = asyncio.get_running_loop()
        self.protocol = ServerProtocol()
        self.protocol.subprotocol = Subprotocol("viser-v1")
        self.sent: list[bytes] = []
        self.coming: asyncio.Queue[bytes] = asyncio.Queue()

    async def recv(self) -> bytes:
        assert asyncio.get_running_loop() is self.loop
        message = await self.coming.get()
        if not message:
            raise ConnectionResetError("it went away")
        return message

    async def send(self, message: bytes) -> None:
        assert asyncio.get_running_loop() is self.loop
        self.sent.append(message)


@pytest.fixture
def home():
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever, daemon=True)
    thread.start()
    yield loop
    loop.call_soon_threadsafe(loop.stop)
    thread.join(60.0)
    loop.close()


def test_messages_cross_from_one_loop_to_the_other_and_so_does_the_end(home: asyncio.AbstractEventLoop) -> None:
    async def made() -> Connection:
        return Connection()

    connection = asyncio.run_coroutine_threadsafe(made(), home).result(5.0)
    bridge = Bridge(connection, home)
    assert bridge.subprotocol == "viser-v1"

    async def talk() -> None:
        await bridge.send(b"hello")
        home.call_soon_threadsafe(connection.coming.put_nowait, b"hi")
        assert await bridge.recv() == b"hi"
        waiting = asyncio.create_task(bridge.recv())
        await asyncio.sleep(0.05)  # it waits by now
        waiting.cancel()
        with pytest.raises(asyncio.CancelledError):
            await waiting
        home.call_soon_threadsafe(connection.coming.put_nowait, b"")
        with pytest.raises(ConnectionResetError):
            await bridge.recv()

    asyncio.run(talk())
    assert connection.sent == [b"hello"]


@pytest.mark.parametrize("encoding", ["gzip", "identity"])
def test_our_scripts_run_before_the_page_and_the_page_is_whole(server: viser.ViserServer, encoding: str) -> None:
    address = f"http://127.0.0.1:{server.get_port()}/"
    with urllib.request.urlopen(urllib.request.Request(address, headers={"Accept-Encoding": encoding})) as reply:
        body = reply.read()
        assert int(reply.headers["Content-Length"]) == len(body)
    page = gzip.decompress(body) if encoding == "gzip" else body
    assert len(SCRIPTS) >= 3
    for path in SCRIPTS:
        script = translate_script(path.read_text("utf-8")).encode()
        assert page.count(script) == 1
        assert page.index(script) < page.index(b"<script data-p")
    assert page.rstrip().endswith(b"</html>")


NONSENSE = (
    {"Host": "[::1"},
    {"Host": "127.0.0.1", "Origin": "http://[half"},
    {"Host": "127.0.0.1\u00e9"},
    {"Cookie": 'diorama_token="\\777'},
    {"Cookie": "[]=;;;=,"},
)


@pytest.mark.parametrize("headers", NONSENSE)
def test_headers_that_make_no_sense_are_refused_not_an_error(
    guarded: viser.ViserServer, headers: dict[str, str], caplog: pytest.LogCaptureFixture
) -> None:
    assert raw_status(guarded, "/", headers) in (400, 403)
    assert not [r for r in caplog.records if r.levelname == "ERROR"]


@pytest.mark.parametrize(
    "path", ["/%00", "/a" * 2000, "/pictures/%00", "//[", "/?token=%ff&token", "/pictures/" + "x" * 3000]
)
def test_addresses_that_make_no_sense_are_refused_not_an_error(
    server: viser.ViserServer, path: str, caplog: pytest.LogCaptureFixture
) -> None:
    assert raw_status(server, path, {}) in (200, 400, 403, 404)
    assert not [r for r in caplog.records if r.levelname == "ERROR"]


def test_a_connection_that_asks_for_nothing_is_no_error(
    server: viser.ViserServer, caplog: pytest.LogCaptureFixture
) -> None:
    socket.create_connection(("127.0.0.1", server.get_port())).close()
    with socket.create_connection(("127.0.0.1", server.get_port())) as page:
        page.sendall(b"GET / HT")
    assert fetch(server)[0] == 200
    assert not caplog.records


def test_pictures_are_served_beside_the_page_to_those_who_may_see_it() -> None:
    def picture(name: str) -> Future[bytes | None]:
        asked: Future[bytes | None] = Future()
        asked.set_result(b"\x89PNG" if name == "chair.png" else None)
        return asked

    made = create_server(
        host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1", "s3cret"), pictures=picture
    )
    status, headers = fetch(made, "/pictures/chair.png?token=s3cret")
    assert (status, headers["Content-Type"]) == (200, "image/png")
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert fetch(made, "/pictures/none.png?token=s3cret")[0] == 404
    assert fetch(made, "/pictures/chair.png")[0] == 403
    assert fetch(made, "/?token=s3cret")[0] == 200
    stop_server(made)


def test_a_page_that_is_closed_while_its_picture_is_made_is_no_error(caplog: pytest.LogCaptureFixture) -> None:
    asked: Future[bytes | None] = Future()
    made = create_server(
        host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1"), pictures=lambda name: asked
    )
    with socket.create_connection(("127.0.0.1", made.get_port())) as page:
        page.sendall(f"GET /pictures/chair.png HTTP/1.1\r\nHost: 127.0.0.1:{made.get_port()}\r\n\r\n".encode())
        time.sleep(0.2)  # the request arrives, and below the end of its connection; nothing tells of either
    time.sleep(0.2)
    asked.set_result(b"\x89PNG")
    assert fetch(made, "/pictures/table.png")[0] == 200
    stop_server(made)
    assert not [record.message for record in caplog.records if record.levelname == "ERROR"]


def test_messages_of_one_connection_are_taken_at_a_pace(monkeypatch: pytest.MonkeyPatch) -> None:
    class Connection:
        async def recv(self) -> bytes:
            return b"an edit"

    now = [time.monotonic()]

    async def sleep(seconds: float) -> None:
        assert seconds > 0.0
        now[0] += seconds

    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    monkeypatch.setattr(asyncio, "sleep", sleep)

    rests: list[float] = []

    async def read(connection: Connection) -> None:
        for rest_s, at_once in ((0.0, MESSAGES_AT_ONCE), (1.0, MESSAGES_PER_S), (600.0, MESSAGES_AT_ONCE)):
            now[0] += rest_s
            began = now[0]
            for _ in range(at_once):
                assert await connection.recv() == b"an edit"
            assert now[0] == began
            for _ in range(MESSAGES_PER_S):
                await connection.recv()
            assert now[0] - began == pytest.approx(1.0)
            rests.append(rest_s)

    asyncio.run(pace(read)(Connection()))
    assert rests == [0.0, 1.0, 600.0], "the handler is awaited"


def test_every_connection_is_paced(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the pace switched off, no test failed."""
    handlers: list[object] = []

    def noted(handler):
        handlers.append(handler)
        return pace(handler)

    monkeypatch.setattr(viser_adapter, "pace", noted)
    stop_server(create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1")))
    assert len(handlers) == 1


def test_an_address_names_its_project_and_one_that_names_none_leads_to_one() -> None:
    assert project_of("/?project=my%20room&tour=1") == "my room"
    assert project_of("/?tour=1") is None
    reply = redirect(Request("/?tour=&unit=ft", Headers()), "my room")
    assert reply.status_code == 302
    assert reply.headers["Location"] == "/?tour=&unit=ft&project=my+room"


class Rooms:
    """A server of one project."""

    def first(self) -> str | None:
        return "my room"

    def server(self, name: str) -> viser.ViserServer | None:
        return None


def _location(server: viser.ViserServer, path: str, **headers: str) -> str | None:
    """Where a page is sent."""
    connection = http.client.HTTPConnection("127.0.0.1", server.get_port(), timeout=60)
    connection.request("GET", path, headers=headers)
    reply = connection.getresponse()
    connection.close()
    return reply.headers["Location"] if reply.status == 302 else None


def test_only_pages_whose_address_names_no_project_are_sent_to_one() -> None:
    made = create_server(
        host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1", "s3cret"), projects=Rooms()
    )
    try:
        assert _location(made, "/?token=s3cret") == "/?token=s3cret&project=my+room"
        assert _location(made, "/?token=s3cret&project=other") is None
        assert _location(made, "/none.js?token=s3cret") is None
        assert _location(made, "/?token=s3cret", Upgrade="websocket", Connection="Upgrade") is None
        cookie = fetch(made, "/?token=s3cret&project=a")[1]["Set-Cookie"].partition(";")[0]
        status, headers = fetch(made, "/?project=a", Cookie=cookie)
        assert (status, headers.get("Set-Cookie")) == (200, None), "remembered once"
    finally:
        stop_server(made)
