"""A model hub on loopback: serves small files well, or misbehaves as told."""

from __future__ import annotations

import hashlib
import json
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import SimpleNamespace
from typing import Any

import pytest

SHA = "0123456789abcdef0123456789abcdef01234567"


@dataclass
class Hub:
    """What it serves and how; tests change these between requests."""

    files: dict[str, bytes]
    """Content by path: "owner/name/file" or, for plain addresses, "plain/file"."""
    status: int = 200
    """What to answer instead, when not 200."""
    cut_after: list[int] = field(default_factory=list)
    """For each transfer in turn, after how many bytes the connection is cut."""
    corrupt: bool = False
    pause_s: float = 0.0
    """Before every hundredth of a file."""
    address: str = ""
    ranges: list[str] = field(default_factory=list)
    """Range headers that were asked for."""

    def content(self, path: str) -> bytes | None:
        parts = path.strip("/").split("/")
        if parts[0] == "plain":
            return self.files.get(path.strip("/"))
        if len(parts) > 4 and parts[2] == "resolve":
            return self.files.get("/".join([*parts[:2], *parts[4:]]))
        return None


def _handler(hub: Hub) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def log_message(self, *args: Any) -> None:
            pass

        def do_HEAD(self) -> None:
            self._answer(body=False)

        def do_GET(self) -> None:
            self._answer(body=True)

        def _answer(self, body: bool) -> None:
            data = hub.content(self.path.split("?")[0])
            if hub.status != 200:
                self._plain(hub.status, b"no")
            elif self.path.startswith("/api/models/"):
                self._plain(200, json.dumps({"id": "owner/name", "sha": SHA}).encode(), "application/json")
            elif data is None:
                self._plain(404, b"not here", error="EntryNotFound")
            else:
                self._file(data, body)

        def _file(self, data: bytes, body: bool) -> None:
            etag = hashlib.sha256(data).hexdigest()
            if hub.corrupt:
                data = bytes(reversed(data))
            start = 0
            asked = self.headers.get("Range")
            if asked:
                hub.ranges.append(asked)
                start = int(asked.removeprefix("bytes=").split("-")[0])
            self.send_response(206 if asked else 200)
            self.send_header("Content-Length", str(len(data) - start))
            self.send_header("Accept-Ranges", "bytes")
            if asked:
                self.send_header("Content-Range", f"bytes {start}-{len(data) - 1}/{len(data)}")
            self.send_header("ETag", f'"{etag}"')
            self.send_header("X-Repo-Commit", SHA)
            self.end_headers()
            if body:
                self._send(data[start:])

        def _send(self, data: bytes) -> None:
            limit = hub.cut_after.pop(0) if hub.cut_after else None
            step = max(1, len(data) // 100)
            sent = 0
            while sent < len(data):
                if limit is not None and sent >= limit:
                    self.close_connection = True
                    self.wfile.flush()
                    self.connection.close()
                    return
                time.sleep(hub.pause_s)
                try:
                    self.wfile.write(data[sent : sent + step])
                    self.wfile.flush()
                except OSError:
                    return
                sent += step

        def _plain(self, status: int, data: bytes, kind: str = "text/plain", error: str = "") -> None:
            self.send_response(status)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(data)))
            if error:
                self.send_header("X-Error-Code", error)
            self.end_headers()
            if self.command != "HEAD":
                self.wfile.write(data)

    return Handler


def try_again_at_once(patch: pytest.MonkeyPatch) -> None:
    """The hub's client does not wait a second before each of its five tries."""
    at_once = SimpleNamespace(**{**vars(time), "sleep": lambda seconds: None})
    patch.setattr("huggingface_hub.file_download.time", at_once)


@contextmanager
def serving(hub: Hub) -> Iterator[Hub]:
    """The hub, answering at `hub.address`."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), _handler(hub))
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True)
    thread.start()
    hub.address = f"http://127.0.0.1:{server.server_address[1]}"
    try:
        yield hub
    finally:
        server.shutdown()
        server.server_close()
