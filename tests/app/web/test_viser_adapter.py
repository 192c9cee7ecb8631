"""The hardened server, and viser's private names that the adapter leans on."""

from __future__ import annotations

import gzip
import socket
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from concurrent.futures import Future

import pytest
import viser
import websockets
from viser import _messages
from websockets.sync.client import connect

from diorama_app.web import viser_adapter
from diorama_app.web.head import SCRIPTS
from diorama_app.web.viser_adapter import Visitors, create_server, stop_server
from diorama_core.errors import InputError


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    made = create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1"))
    yield made
    stop_server(made)


@pytest.fixture
def guarded() -> Iterator[viser.ViserServer]:
    made = create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1", "s3cret"))
    yield made
    stop_server(made)


def fetch(server: viser.ViserServer, path: str = "/", **headers: str) -> tuple[int, dict[str, str]]:
    request = urllib.request.Request(f"http://127.0.0.1:{server.get_port()}{path}", headers=headers)
    try:
        with urllib.request.urlopen(request, timeout=10) as reply:
            return reply.status, dict(reply.headers)
    except urllib.error.HTTPError as error:
        return error.code, dict(error.headers)


def connects(server: viser.ViserServer, **headers: str) -> bool:
    try:
        with connect(
            f"ws://127.0.0.1:{server.get_port()}/",
            additional_headers=headers,
            subprotocols=[websockets.Subprotocol(f"viser-v{viser.__version__}")],
        ):
            return True
    except websockets.InvalidStatus as refused:
        return refused.response.status_code != 403


def test_it_is_the_version_that_was_measured() -> None:
    assert viser.__version__ == "1.1.1"


def test_pages_of_its_own_origin_are_served(server: viser.ViserServer) -> None:
    status, headers = fetch(server)
    assert status == 200
    assert headers["X-Frame-Options"] == "SAMEORIGIN"
    assert "default-src 'none'" in headers["Content-Security-Policy"]
    assert connects(server, Origin=f"http://127.0.0.1:{server.get_port()}")


@pytest.mark.parametrize("encoding", ["gzip", "identity"])
def test_our_scripts_run_before_the_page_and_the_page_is_whole(server: viser.ViserServer, encoding: str) -> None:
    address = f"http://127.0.0.1:{server.get_port()}/"
    with urllib.request.urlopen(urllib.request.Request(address, headers={"Accept-Encoding": encoding})) as reply:
        body = reply.read()
        assert int(reply.headers["Content-Length"]) == len(body)
    page = gzip.decompress(body) if encoding == "gzip" else body
    assert len(SCRIPTS) >= 3
    for path in SCRIPTS:
        script = path.read_bytes()
        assert page.count(script) == 1
        assert page.index(script) < page.index(b"<script data-p")
    assert page.rstrip().endswith(b"</html>")


def test_foreign_origins_and_foreign_names_are_refused(server: viser.ViserServer) -> None:
    assert not connects(server, Origin="https://evil.example")
    assert not connects(server, Origin=f"http://127.0.0.1:{server.get_port() + 1}")
    assert fetch(server, Host="evil.example")[0] == 403
    assert fetch(server, Host=f"localhost:{server.get_port()}")[0] == 200


def test_with_a_token_only_those_who_bring_it_get_in(guarded: viser.ViserServer) -> None:
    origin = f"http://127.0.0.1:{guarded.get_port()}"
    assert fetch(guarded)[0] == 403
    assert fetch(guarded, "/?token=wrong")[0] == 403
    status, headers = fetch(guarded, "/?token=s3cret")
    assert status == 200
    cookie = headers["Set-Cookie"].partition(";")[0]
    assert "HttpOnly" in headers["Set-Cookie"]
    assert not connects(guarded, Origin=origin)
    assert not connects(guarded, Origin=origin, Cookie="diorama_token=wrong")
    assert connects(guarded, Origin=origin, Cookie=cookie)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "", "192.168.1.5"])
def test_where_others_can_reach_it_there_is_a_token(host: str) -> None:
    made = viser_adapter.with_token(host, None)
    assert made is not None
    assert len(made) >= 20
    assert made != viser_adapter.with_token(host, None)
    assert viser_adapter.with_token(host, "mine") == "mine"
    assert viser_adapter.with_token("127.0.0.1", None) is None


@pytest.mark.parametrize("host", ["0.0.0.0"])
def test_a_server_for_everybody_still_knows_its_names(host: str) -> None:
    made = create_server(host=host, port=0, label="test", visitors=Visitors(host, "s3cret"))
    try:
        assert fetch(made, "/?token=s3cret", Host="evil.example")[0] == 403
        assert fetch(made, "/?token=s3cret", Host="rebound.example:80")[0] == 403
        assert fetch(made, "/", Host=f"127.0.0.1:{made.get_port()}")[0] == 403, "no token"
        for name in ("127.0.0.1", "192.168.7.7", "localhost", "[fe80::1]", socket.gethostname()):
            assert fetch(made, "/?token=s3cret", Host=f"{name}:{made.get_port()}")[0] == 200, name
    finally:
        stop_server(made)


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


def raw_status(server: viser.ViserServer, path: str, headers: dict[str, str]) -> int:
    lines = [f"GET {path} HTTP/1.1", *(f"{k}: {v}" for k, v in headers.items())]
    if "Host" not in headers:
        lines.append(f"Host: 127.0.0.1:{server.get_port()}")
    with socket.create_connection(("127.0.0.1", server.get_port()), timeout=10) as page:
        page.sendall(("\r\n".join(lines) + "\r\n\r\n").encode("latin-1"))
        return int(page.recv(100).split()[1])


def test_a_taken_port_is_one_clear_line() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(InputError, match="cannot listen on"):
            create_server(host="127.0.0.1", port=taken.getsockname()[1], label="x", visitors=Visitors("127.0.0.1"))


def test_it_listens_on_loopback_only(server: viser.ViserServer) -> None:
    assert server.get_host() == "127.0.0.1"


def test_no_public_tunnel_is_ever_opened(server: viser.ViserServer) -> None:
    assert server.request_share_url() is None
    handlers = server._websock_server._incoming_handlers[_messages.ShareUrlRequest]
    for handler in handlers:
        handler(0, _messages.ShareUrlRequest())
    time.sleep(0.2)
    assert server._share_tunnel is None


def test_stopping_returns_at_once(server: viser.ViserServer) -> None:
    began = time.monotonic()
    stop_server(server)
    assert time.monotonic() - began < 0.5


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
        time.sleep(0.2)
    time.sleep(0.2)
    asked.set_result(b"\x89PNG")
    assert fetch(made, "/pictures/table.png")[0] == 200
    stop_server(made)
    assert not [record.message for record in caplog.records if record.levelname == "ERROR"]


def test_drawing_from_many_threads_never_disturbs_the_loop() -> None:
    """`asyncio.Event.set` walks its waiters; from another thread that failed now and then."""
    import asyncio
    import threading
    from collections import deque

    from viser.infra import _infra

    class Waiters(deque):
        """Tells whether another thread than the loop's ever touches the list of waiters."""

        def __iter__(self):  # type: ignore[no-untyped-def]
            touched.add(threading.get_ident())
            return super().__iter__()

    touched: set[int] = set()

    async def wait_for_messages() -> int:
        buffer = _infra.AsyncMessageBuffer(asyncio.get_running_loop(), persistent_messages=False)
        buffer.message_event._waiters = Waiters()  # type: ignore[attr-defined]
        windows = buffer.window_generator(client_id=0)
        arrived = 0

        def draw(number: int) -> None:
            for i in range(200):
                buffer.push(_messages.SetPositionMessage(f"/{number}/{i}", (0.0, 0.0, 0.0)))

        threads = [threading.Thread(target=draw, args=(number,)) for number in range(3)]
        for thread in threads:
            thread.start()
        async for window in windows:
            arrived += len(window)
            if arrived == 600:
                break
        await windows.aclose()
        return arrived

    assert asyncio.run(asyncio.wait_for(wait_for_messages(), 20.0)) == 600, "every message arrives"
    assert touched <= {threading.get_ident()}
