"""A websocket that was accepted in one event loop, for a server that runs in another."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

from websockets.asyncio.server import ServerConnection

ConnectionHandler = Callable[[Any], Coroutine[Any, Any, None]]
"""Talks to one browser until it goes away."""


class Bridge:
    """What viser uses of a connection, done in the loop that the connection belongs to."""

    def __init__(self, connection: ServerConnection, home: asyncio.AbstractEventLoop) -> None:
        """Wrap a connection.

        Args:
            connection: as it was accepted.
            home: the loop that it was accepted in; it must go on running.
        """
        self._connection = connection
        self._home = home
        self.subprotocol = connection.subprotocol

    async def recv(self) -> str | bytes:
        """The next message; raises `ConnectionClosed` when the browser went away."""
        message: str | bytes = await self._at_home(self._connection.recv())
        return message

    async def send(self, message: bytes) -> None:
        """Send a message, waiting while the browser is slow to take it."""
        await self._at_home(self._connection.send(message))

    async def close(self, code: int = 1000, reason: str = "") -> None:
        """Say goodbye."""
        await self._at_home(self._connection.close(code, reason))

    def _at_home(self, work: Coroutine[Any, Any, Any]) -> Awaitable[Any]:
        return asyncio.wrap_future(asyncio.run_coroutine_threadsafe(work, self._home))
