"""The only place that touches viser's private names, each pinned by a contract test in `tests/app`.

What it adds to viser 1.1.1: a server that listens where it is told and nowhere else, refuses pages of foreign
origin and (optionally) visitors without a token, never opens a public tunnel, caps uploads, and stops at once.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import gzip
import hmac
import http
import io
import socket
import threading
from collections.abc import Awaitable, Callable, Iterator
from concurrent.futures import Future
from dataclasses import dataclass
from http.cookies import SimpleCookie
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import viser
import websockets.asyncio.server
from viser import _messages
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from diorama_core.errors import InputError

TOKEN_COOKIE = "diorama_token"
LOOPBACK_NAMES = frozenset({"127.0.0.1", "localhost", "::1"})
ANY_HOST = frozenset({"", "0.0.0.0", "::"})
MAX_UPLOAD_BYTES = 128 * 1024 * 1024
MAX_UPLOADS_IN_FLIGHT = 8

HEAD_SCRIPTS = sorted((Path(__file__).parents[1] / "static").glob("*.js"))
"""Run in the page before viser does."""
PICTURES = "pictures/"
"""Addresses below this one are pictures."""

HttpHandler = Callable[[ServerConnection, Request], Response | None]
Answer = Callable[[ServerConnection, Request], Response | Awaitable[Response] | None]
TooLarge = Callable[[int, str, int], None]
Pictures = Callable[[str], "Future[bytes | None]"]


@dataclass(frozen=True)
class Visitors:
    """Who may talk to the server."""

    host: str
    """The address it listens on."""
    token: str | None = None
    """When set, the first page load must carry `?token=...`; a cookie remembers it."""

    def refusal(self, request: Request) -> str | None:
        """Why a request is not served, or None when it is."""
        host_header = request.headers.get("Host", "")
        if not self._knows(urlsplit(f"//{host_header}").hostname or ""):
            return "this address is not served here"
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc != host_header:
            return "pages of another origin are refused"
        if self.token is not None and not self.brings_token(request) and not self._remembers_token(request):
            return "the access token is missing or wrong; open the address that was printed at the start"
        return None

    def brings_token(self, request: Request) -> bool:
        """Whether the address carries the token."""
        given = parse_qs(urlsplit(request.path).query).get("token", [""])[0]
        return self._matches(given)

    def _remembers_token(self, request: Request) -> bool:
        cookie = SimpleCookie(request.headers.get("Cookie", "")).get(TOKEN_COOKIE)
        return cookie is not None and self._matches(cookie.value)

    def _matches(self, given: str) -> bool:
        return self.token is not None and hmac.compare_digest(given.encode(), self.token.encode())

    def _knows(self, name: str) -> bool:
        # A page elsewhere that resolves its own name to this machine (DNS rebinding) sends that name.
        return self.host in ANY_HOST or name == self.host or (self.host in LOOPBACK_NAMES and name in LOOPBACK_NAMES)


def create_server(
    *,
    host: str,
    port: int,
    label: str,
    visitors: Visitors,
    too_large: TooLarge | None = None,
    pictures: Pictures | None = None,
) -> viser.ViserServer:
    """A hardened viser server.

    Args:
        host: address to listen on.
        port: 0 lets the system choose.
        label: shown above the panels.
        visitors: who may talk to it.
        too_large: told (client id, file name, bytes) of every upload that was refused.
        pictures: asked for a PNG when a page wants `pictures/<name>`. The browser fetches what it shows and nothing
            else, beside the websocket on which the scene comes.

    Raises:
        InputError: the port is taken or the address is not this machine's.
    """
    _check_port(host, port)
    with _guarded_serve(visitors, pictures), contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host=host, port=port, label=label, verbose=False)
    server.request_share_url = _no_share_url
    _cap_uploads(server, too_large)
    return server


def stop_server(server: viser.ViserServer) -> None:
    """Stop without waiting: viser's own `stop` can block for seconds after a browser has been connected."""

    def stop() -> None:
        with contextlib.redirect_stdout(io.StringIO()):
            server.stop()

    threading.Thread(target=stop, daemon=True, name="stop viser").start()


def component_uuid(handle: Any) -> str:
    """The id by which the page knows a panel element."""
    return str(handle._impl.uuid)


def last_message_arrived(server: viser.ViserServer) -> int:
    """How many persistent messages the server keeps for late joiners: a measure of leaks."""
    return len(server._websock_server._broadcast_buffer.message_from_id)


def _no_share_url(verbose: bool = True) -> str | None:
    return None


def _check_port(host: str, port: int) -> None:
    if port == 0:
        return
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, port))
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise InputError(
                f"cannot listen on {host}:{port} ({reason}); choose another with --port, or stop what uses it"
            ) from error


@contextlib.contextmanager
def _guarded_serve(visitors: Visitors, pictures: Pictures | None) -> Iterator[None]:
    """While it lasts, websocket servers are started with the visitors' check in front."""
    original = websockets.asyncio.server.serve

    @functools.wraps(original)
    def serve(*args: Any, process_request: HttpHandler | None = None, **kwargs: Any) -> Any:
        return original(*args, process_request=_checked(process_request, visitors, pictures), **kwargs)

    websockets.asyncio.server.serve = serve  # type: ignore[assignment, misc]
    try:
        yield
    finally:
        websockets.asyncio.server.serve = original  # type: ignore[misc]


def _checked(handler: HttpHandler | None, visitors: Visitors, pictures: Pictures | None) -> Answer:
    def process_request(connection: ServerConnection, request: Request) -> Response | Awaitable[Response] | None:
        refusal = visitors.refusal(request)
        if refusal is not None:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f"Refused: {refusal}.\n")
        name = urlsplit(request.path).path.removeprefix(f"/{PICTURES}")
        if pictures is not None and f"/{PICTURES}{name}" == urlsplit(request.path).path:
            return _picture(connection, pictures(name))
        response = handler(connection, request) if handler is not None else None
        if response is not None:
            _prepend_script(response)
            _add_headers(response, remember=visitors.token if visitors.brings_token(request) else None)
        return response

    return process_request


def _prepend_script(response: Response) -> None:
    """Our scripts in front of viser's, in the page itself."""
    if not response.headers.get("Content-Type", "").startswith("text/html"):
        return
    zipped = response.headers.get("Content-Encoding") == "gzip"
    response.body = _page(bytes(response.body or b""), zipped)
    del response.headers["Content-Length"]
    response.headers["Content-Length"] = str(len(response.body))


@functools.lru_cache(maxsize=2)
def _page(body: bytes, zipped: bool) -> bytes:
    page = gzip.decompress(body) if zipped else body
    scripts = b"".join(b"\n<script>" + script.read_bytes() + b"</script>" for script in HEAD_SCRIPTS)
    page = page.replace(b"<head>", b"<head>" + scripts, 1)
    return gzip.compress(page, mtime=0) if zipped else page


async def _picture(connection: ServerConnection, asked: Future[bytes | None]) -> Response:
    png = await asyncio.wrap_future(asked)
    if connection.protocol.eof_sent:
        raise asyncio.CancelledError  # the page was closed meanwhile; websockets would trip over an answer to nobody
    if png is None:
        return Response(http.HTTPStatus.NOT_FOUND, "Not Found", Headers({"Content-Length": "0", "Connection": "close"}))
    headers = {
        "Content-Type": "image/png",
        "Content-Length": str(len(png)),
        "Cache-Control": "private, max-age=3600",
        "Connection": "close",
    }
    response = Response(http.HTTPStatus.OK, "OK", Headers(headers), png)
    _add_headers(response, remember=None)
    return response


def _add_headers(response: Response, *, remember: str | None) -> None:
    response.headers["X-Frame-Options"] = "SAMEORIGIN"
    response.headers["X-Content-Type-Options"] = "nosniff"
    response.headers["Referrer-Policy"] = "no-referrer"
    if remember is not None:
        cookie = SimpleCookie({TOKEN_COOKIE: remember})
        cookie[TOKEN_COOKIE].update({"path": "/", "httponly": "1", "samesite": "Strict"})
        response.headers["Set-Cookie"] = cookie[TOKEN_COOKIE].OutputString()


def _cap_uploads(server: viser.ViserServer, too_large: TooLarge | None) -> None:
    gui = server.gui
    start, part = gui._handle_file_transfer_start, gui._handle_file_transfer_part
    handlers = server._websock_server._incoming_handlers
    states = gui._current_file_upload_states

    def capped_start(client_id: Any, message: _messages.FileTransferStartUpload) -> None:
        if message.size_bytes > MAX_UPLOAD_BYTES or message.part_count > message.size_bytes + 1:
            _finish_progress(server, message)
            if too_large is not None:
                too_large(int(client_id), message.filename, message.size_bytes)
        elif len(states) < MAX_UPLOADS_IN_FLIGHT:
            start(client_id, message)

    def capped_part(client_id: Any, message: _messages.FileTransferPart) -> None:
        state = states.get(message.transfer_uuid)
        if state is not None and state["transferred_bytes"] + len(message.content) > state["total_bytes"]:
            states.pop(message.transfer_uuid, None)  # more than was announced
            return
        part(client_id, message)

    for kind, old, new in (
        (_messages.FileTransferStartUpload, start, capped_start),
        (_messages.FileTransferPart, part, capped_part),
    ):
        handlers[kind] = [new if known == old else known for known in handlers[kind]]


def _finish_progress(server: viser.ViserServer, message: _messages.FileTransferStartUpload) -> None:
    """Tell the page that the transfer is over, so that its progress notice goes away."""
    server._websock_server.queue_message(
        _messages.FileTransferPartAck(
            source_component_uuid=message.source_component_uuid,
            transfer_uuid=message.transfer_uuid,
            transferred_bytes=message.size_bytes,
            total_bytes=message.size_bytes,
        )
    )
