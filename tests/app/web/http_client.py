"""What a browser, or somebody who is none, sends to a server."""

from __future__ import annotations

import socket
import urllib.error
import urllib.request

import viser
import websockets
from websockets.sync.client import connect


def fetch(server: viser.ViserServer, path: str = "/", **headers: str) -> tuple[int, dict[str, str]]:
    request = urllib.request.Request(f"http://127.0.0.1:{server.get_port()}{path}", headers=headers)
    try:
        with urllib.request.urlopen(request, timeout=60) as reply:
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


def raw_status(server: viser.ViserServer, path: str, headers: dict[str, str]) -> int:
    lines = [f"GET {path} HTTP/1.1", *(f"{k}: {v}" for k, v in headers.items())]
    if "Host" not in headers:
        lines.append(f"Host: 127.0.0.1:{server.get_port()}")
    with socket.create_connection(("127.0.0.1", server.get_port()), timeout=60) as page:
        page.sendall(("\r\n".join(lines) + "\r\n\r\n").encode("latin-1"))
        return int(page.recv(100).split()[1])
