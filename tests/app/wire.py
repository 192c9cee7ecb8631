"""A page without a browser: speaks viser's protocol on a real websocket, with the buttons the server sent it."""

from __future__ import annotations

import json
import re
import threading
import time
from collections.abc import Callable
from typing import Any

import msgspec
import viser
import websockets
import zstandard
from viser import _messages
from websockets.sync.client import connect

Seen = dict[str, Any]


class WirePage:
    """One connection. Messages that the server sends are kept by the panel element they make."""

    def __init__(
        self, port: int, *, host: str = "127.0.0.1", query: str = "", read: bool = True, **headers: str
    ) -> None:
        self.socket = connect(
            f"ws://{host}:{port}/{query}",
            subprotocols=[websockets.Subprotocol(f"viser-v{viser.__version__}")],
            additional_headers=headers,
            max_size=None,
            ping_interval=None,  # a browser sends none
        )
        self.elements: dict[str, Seen] = {}
        """What the server sent of each panel element, by its id."""
        self.nodes: dict[str, Seen] = {}
        self.notices: list[str] = []
        self.messages: list[Seen] = []
        self._changed = threading.Condition()
        self.send(
            _messages.ViewerCameraMessage(
                (1.0, 0.0, 0.0, 0.0), (0.0, -3.0, 1.5), 1.0, 0.1, 100.0, 600, 800, (0.0, 1.0, 1.0), (0.0, 0.0, 1.0)
            )
        )
        if read:
            threading.Thread(target=self._read, daemon=True).start()

    def send(self, message: _messages.Message) -> None:
        self.socket.send(msgspec.msgpack.encode(message.as_serializable_dict([])))

    def close(self) -> None:
        self.socket.close()

    def _read(self) -> None:
        unpack = zstandard.ZstdDecompressor()
        try:
            for raw in self.socket:
                assert isinstance(raw, bytes)
                packed = int.from_bytes(raw[8:16], "little")
                window = msgspec.msgpack.decode(unpack.decompress(raw[16 : 16 + packed]))
                with self._changed:
                    for message in window["messages"]:
                        self._take(message)
                    self._changed.notify_all()
        except websockets.ConnectionClosed:
            return

    def _take(self, message: Seen) -> None:
        kind = message["type"]
        if kind.startswith("Gui") and "uuid" in message and "props" in message:
            self.elements[message["uuid"]] = {"kind": kind, "value": message.get("value"), **message["props"]}
        elif kind == "GuiUpdateMessage":
            self.elements.setdefault(message["uuid"], {}).update(message["updates"])
        elif kind == "NotificationShowMessage" or kind == "NotificationMessage":
            self.notices.append(str(message.get("props", message)))
        elif kind == "SetPositionMessage":
            self.nodes[message["name"]] = message
        self.messages.append({"type": kind, "at": time.monotonic()})
        del self.messages[:-2000]

    def wait_for(self, found: Callable[[], Any], timeout_s: float = 60.0) -> Any:
        """Wait until something is true of what arrived."""
        with self._changed:
            assert self._changed.wait_for(found, timeout_s), "it never came"
            return found()

    def element(self, label: str, kind: str = "") -> str:
        """Id of the panel element with a label."""
        return str(
            self.wait_for(
                lambda: next(
                    (u for u, e in self.elements.items() if e.get("label") == label and kind in str(e.get("kind", ""))),
                    None,
                )
            )
        )

    def set(self, uuid: str, value: Any) -> None:
        """Change a field, or press a button (True)."""
        self.send(_messages.GuiUpdateMessage(uuid, {"value": value}))

    def act(self, do: str) -> None:
        """Click something drawn in HTML, as its handler does."""
        clicked = f'data-do="{do}"'
        drawn = lambda: [e["content"] for e in self.elements.values() if clicked in str(e.get("content", ""))]  # noqa: E731
        field = re.search(r"__dioSend\(&#x27;([^&]+)&#x27;", self.wait_for(drawn)[0])
        assert field is not None
        self.set(field[1], json.dumps([{"do": do, "arg": "", "add": False, "number": time.time_ns()}]))

    def begin_upload(self, button: str, name: str, size: int, parts: int, transfer: str = "") -> str:
        transfer = transfer or f"{name}-{time.monotonic_ns()}"
        self.send(_messages.FileTransferStartUpload(button, transfer, name, "image/png", parts, size))
        return transfer

    def send_part(self, button: str, transfer: str, index: int, content: bytes) -> None:
        self.send(_messages.FileTransferPart(button, transfer, index, content))

    def upload(self, button: str, name: str, content: bytes, part: int = 512 * 1024) -> str:
        """As the page does it."""
        count = -(-len(content) // part)
        transfer = self.begin_upload(button, name, len(content), count)
        for i in range(count):
            self.send_part(button, transfer, i, content[i * part : (i + 1) * part])
        return transfer
