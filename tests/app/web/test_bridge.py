from __future__ import annotations

import asyncio
import threading

import pytest
from websockets.asyncio.server import ServerConnection
from websockets.server import ServerProtocol
from websockets.typing import Subprotocol

from diorama_app.web.bridge import Bridge


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
