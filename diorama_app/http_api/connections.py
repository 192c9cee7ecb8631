"""Connections of the API: what ends before a request is whole, or is no HTTP, gets a JSON line as everything does."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

HEAD_S = 15.0
"""Within which the head of a request must have come; uvicorn itself waits for ever."""


class Connection(H11Protocol):  # type: ignore[misc]  # uvicorn's modules are Any to mypy (pyproject.toml)
    """uvicorn's connection, which gives up on silent ones and tells errors as JSON.

    Pinned by `tests/app/http_api/test_connections.py`: uvicorn has no option for either.
    """

    _patience: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Begin to wait for a request."""
        super().connection_made(transport)
        self._wait_for_head()

    def data_received(self, data: bytes) -> None:
        """Take what came; a head that is not whole yet has so long and no longer."""
        super().data_received(data)
        if self.conn.their_state is h11.IDLE:
            self._wait_for_head()
        elif self._patience is not None:
            self._patience.cancel()
            self._patience = None

    def send_400_response(self, msg: str) -> None:
        """Tell that the request is no HTTP."""
        body = json.dumps({"error": f"the request cannot be read ({msg})"}).encode()
        headers = [
            (b"content-type", b"application/json"),
            (b"content-length", str(len(body)).encode()),
            (b"connection", b"close"),
        ]
        for event in (h11.Response(status_code=400, headers=headers), h11.Data(data=body), h11.EndOfMessage()):
            self.transport.write(self.conn.send(event))
        self.transport.close()

    def _wait_for_head(self) -> None:
        if self._patience is None:
            self._patience = self.loop.call_later(HEAD_S, self.transport.close)
