"""What the server answers before viser sees a request."""

from __future__ import annotations

import asyncio
import gzip
import socket
import time
import urllib.request
from concurrent.futures import Future

import pytest
import viser
from websockets.datastructures import Headers
from websockets.http11 import Request

from diorama_app.strings import translated_script
from diorama_app.web import viser_adapter
from diorama_app.web.requests import MESSAGES_AT_ONCE, MESSAGES_PER_S, paced, project_of, redirected
from diorama_app.web.responses import SCRIPTS
from diorama_app.web.viser_adapter import create_server, stop_server
from diorama_app.web.visitors import Visitors
from tests.app.web.http_client import fetch, raw_status


@pytest.mark.parametrize("encoding", ["gzip", "identity"])
def test_our_scripts_run_before_the_page_and_the_page_is_whole(server: viser.ViserServer, encoding: str) -> None:
    address = f"http://127.0.0.1:{server.get_port()}/"
    with urllib.request.urlopen(urllib.request.Request(address, headers={"Accept-Encoding": encoding})) as reply:
        body = reply.read()
        assert int(reply.headers["Content-Length"]) == len(body)
    page = gzip.decompress(body) if encoding == "gzip" else body
    assert len(SCRIPTS) >= 3
    for path in SCRIPTS:
        script = translated_script(path.read_text("utf-8")).encode()
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


def test_messages_of_one_connection_are_taken_at_a_pace() -> None:
    class Connection:
        async def recv(self) -> bytes:
            return b"an edit"

    read_at: list[float] = []

    async def read(connection: Connection) -> None:
        for _ in range(MESSAGES_AT_ONCE + 90):
            assert await connection.recv() == b"an edit"
            read_at.append(time.monotonic())
        await asyncio.sleep(1.0)
        for _ in range(30):  # a second of rest is a second's messages more at once
            await connection.recv()
            read_at.append(time.monotonic())

    began = time.monotonic()
    asyncio.run(paced(read)(Connection()))
    assert read_at[MESSAGES_AT_ONCE + 89] - began > 0.9 * 90 / MESSAGES_PER_S
    assert read_at[-1] - read_at[-30] < 0.5 * 30 / MESSAGES_PER_S


def test_every_connection_is_paced(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the pace switched off, no test failed."""
    handlers: list[object] = []

    def noted(handler):
        handlers.append(handler)
        return paced(handler)

    monkeypatch.setattr(viser_adapter, "paced", noted)
    stop_server(create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1")))
    assert len(handlers) == 1


def test_an_address_names_its_project_and_one_that_names_none_leads_to_one() -> None:
    assert project_of("/?project=my%20room&tour=1") == "my room"
    assert project_of("/?tour=1") is None
    reply = redirected(Request("/?tour=&unit=ft", Headers()), "my room")
    assert reply.status_code == 302
    assert reply.headers["Location"] == "/?tour=&unit=ft&project=my+room"
