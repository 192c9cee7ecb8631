"""The hardened server, and viser's private names that the adapter leans on."""

from __future__ import annotations

import inspect
import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator

import msgspec
import pytest
import viser
import websockets
import zstandard
from viser import _messages
from viser.infra import _infra
from websockets.sync.client import connect

from diorama_app.web.viser_adapter import create_server, pack, stop_server
from diorama_app.web.visitors import Visitors
from diorama_core.errors import InputError
from tests.app.web.http_client import connects, fetch


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    made = create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1"))
    yield made
    stop_server(made)


def test_it_is_the_version_that_was_measured() -> None:
    assert viser.__version__ == "1.1.1"


STOPPED = """
import gc, weakref
from diorama_app.web.viser_adapter import create_server, create_server_without_port, stop_server
from diorama_app.web.visitors import Visitors
from tests.waiting import until

front = create_server(host="127.0.0.1", port=0, label="front", visitors=Visitors("127.0.0.1"))
server = create_server_without_port("project", front=front)
left = weakref.ref(server)
stop_server(server)
del server
until(lambda: gc.collect() >= 0 and left() is None, "its server is gone from memory")
"""


def test_nothing_keeps_a_project_s_server_that_was_stopped() -> None:
    """In a process of its own: what checks calls in the tests remembers their arguments."""
    subprocess.run([sys.executable, "-c", STOPPED], check=True, timeout=120)


def test_pages_of_its_own_origin_are_served(server: viser.ViserServer) -> None:
    status, headers = fetch(server)
    assert status == 200
    assert headers["X-Frame-Options"] == "SAMEORIGIN"
    assert "default-src 'none'" in headers["Content-Security-Policy"]
    assert connects(server, Origin=f"http://127.0.0.1:{server.get_port()}")


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
    time.sleep(0.2)  # a tunnel would be opened by a thread of viser's, of which nothing tells
    assert server._share_tunnel is None


def test_stopping_does_not_wait(server: viser.ViserServer, monkeypatch: pytest.MonkeyPatch) -> None:
    over, ended = threading.Event(), threading.Event()
    monkeypatch.setattr(server, "stop", lambda: over.wait(30.0) and ended.set())
    stop_server(server)
    assert not ended.is_set()
    over.set()
    assert ended.wait(60.0)


def test_drawing_from_many_threads_never_disturbs_the_loop() -> None:
    """`asyncio.Event.set` walks its waiters; from another thread that failed now and then."""
    import asyncio
    from collections import deque

    from viser.infra import _infra

    class Waiters(deque):
        """Tells whether another thread than the loop's ever touches the list of waiters."""

        def __iter__(self):
            touched.add(threading.get_ident())
            return super().__iter__()

    touched: set[int] = set()

    async def wait_for_messages() -> int:
        buffer = _infra.AsyncMessageBuffer(asyncio.get_running_loop(), persistent_messages=False)
        buffer.message_event._waiters = Waiters()
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


def test_one_half_character_does_not_blank_the_page_for_everybody(server: viser.ViserServer) -> None:
    """A folder with a name that is no UTF-8 ended every connection before its page was drawn."""
    server.gui.add_markdown("b\udce9te and \ud83d\ude00")
    server.gui.add_markdown("the last thing on the page")
    protocol = websockets.Subprotocol(f"viser-v{viser.__version__}")
    with connect(f"ws://127.0.0.1:{server.get_port()}/", subprotocols=[protocol]) as page:
        came = b""
        while b"the last thing on the page" not in came:
            message = page.recv(timeout=10.0)
            assert isinstance(message, bytes)
            size = int.from_bytes(message[8:16], "little")
            came += zstandard.ZstdDecompressor().decompress(message[16 : 16 + size])
    assert "b\ufffdte and \U0001f600".encode() in came


def test_what_viser_packs_goes_through_one_place() -> None:
    used = set(re.findall(r"(?<!import )msgspec[\w.]+", inspect.getsource(_infra)))
    assert used == {"msgspec.msgpack.encode"}
    assert pack({"plain": 1}) == msgspec.msgpack.encode({"plain": 1})
