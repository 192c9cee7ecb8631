"""The only place that touches viser's private names, each pinned by a contract test in `tests/app`.

What it adds to viser 1.1.1: a server that listens where it is told and nowhere else, refuses pages of foreign
origin and (optionally) visitors without a token, never opens a public tunnel, caps uploads, and stops at once.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import io
import itertools
import logging
import socket
import threading
import time
import weakref
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import msgspec.msgpack
import rich
import viser
import websockets.asyncio.server
from viser import _messages
from viser.infra import _infra
from websockets.asyncio.server import ServerConnection
from websockets.exceptions import InvalidMessage

from diorama_app.strings import _
from diorama_app.web.requests import (
    Bridge,
    ConnectionHandler,
    HttpHandler,
    Pictures,
    ProjectServers,
    pace,
    project_of,
    request_check,
)
from diorama_app.web.visitors import RunningUpload, Visitors, why_refused
from diorama_core.errors import InputError
from diorama_core.io.text import clean_strings

UPLOAD_STALLED_S = 60.0
"""An upload idle for this long is dropped when its slot is needed."""
MAX_MESSAGE_BYTES = 16 * 1024 * 1024

Refused = Callable[[int, str], None]
"""Told (client id, one line) of every upload that was refused."""


def _is_worth_logging(record: logging.LogRecord) -> bool:
    """Not of a connection that ends before it asks for anything: browsers open some in advance."""
    return not (record.exc_info and isinstance(record.exc_info[1], InvalidMessage))


logging.getLogger("websockets.server").addFilter(_is_worth_logging)


class _LoopEvent(asyncio.Event):
    """An event that other threads cannot disturb.

    viser sets it from whatever thread draws, and then asks its loop to set it again. `asyncio.Event` is not made for
    the first: it walks the list of waiters while the loop changes it. The second is enough.
    """

    def set(self) -> None:
        try:
            asyncio.get_running_loop()
        except RuntimeError:
            return
        super().set()


@dataclass
class _Buffer(_infra.AsyncMessageBuffer):  # type: ignore[misc]  # viser's modules are Any to mypy (pyproject.toml)
    message_event: asyncio.Event = field(default_factory=_LoopEvent)
    flush_event: asyncio.Event = field(default_factory=_LoopEvent)


def pack(value: Any) -> bytes:
    """What viser sends, as bytes; a half character anywhere in it becomes a sign instead of ending the connection."""
    try:
        return msgspec.msgpack.encode(value)
    except UnicodeEncodeError:
        return msgspec.msgpack.encode(clean_strings(value))


_infra.msgspec = SimpleNamespace(msgpack=SimpleNamespace(encode=pack))  # all that this module of viser's takes of it
_infra.AsyncMessageBuffer = _Buffer  # each connection makes its own by this name
rich.get_console().quiet = True  # viser prints that it stopped, from a thread: nobody else here prints through it


def create_server(
    *,
    host: str,
    port: int,
    label: str,
    visitors: Visitors,
    refused: Refused | None = None,
    pictures: Pictures | None = None,
    projects: ProjectServers | None = None,
) -> viser.ViserServer:
    """A hardened viser server.

    Args:
        host: address to listen on.
        port: 0 lets the system choose.
        label: shown above the panels.
        visitors: who may talk to it.
        refused: told of every upload that was refused.
        pictures: asked for a PNG when a page wants `pictures/<name>`. The browser fetches what it shows and nothing
            else, beside the websocket on which the scene comes.
        projects: where browsers go whose address names a project (`/?project=...`).

    Raises:
        InputError: the port is taken or the address is not this machine's.
    """
    _check_port(host, port)
    with _replace_serve(_serve_with_check(visitors, pictures, projects)), contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host=host, port=port, label=label, verbose=False)
    _secure(server, _Uploads(), refused)
    return server


def create_server_without_port(
    label: str, *, front: viser.ViserServer, refused: Refused | None = None
) -> viser.ViserServer:
    """A viser server whose connections come from the one that has the port (`projects` of `create_server`).

    Args:
        label: shown above the panels.
        front: the server that has the port; the uploads of both are counted together.
        refused: told of every upload that was refused.
    """
    handlers: list[ConnectionHandler] = []

    def serve(handler: ConnectionHandler, *args: Any, **kwargs: Any) -> _NoPort:
        handlers.append(handler)
        return _NoPort()

    with _replace_serve(serve), contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host="127.0.0.1", port=0, label=label, verbose=False)
    _HANDLERS[server] = handlers[0]
    _secure(server, _UPLOADS[front], refused)
    return server


def _secure(server: viser.ViserServer, uploads: _Uploads, refused: Refused | None) -> None:
    """No public tunnel, and caps on the uploads of every page."""
    server.request_share_url = _no_share_url
    _UPLOADS[server] = uploads
    number = uploads.next_server()
    uploads.watch(server.gui, number, refused)

    async def watch(viser_client: viser.ClientHandle) -> None:
        uploads.watch(viser_client.gui, number, refused)

    server.on_client_connect(watch)  # the first to be told, before anything makes an upload button


_HANDLERS: weakref.WeakKeyDictionary[viser.ViserServer, ConnectionHandler] = weakref.WeakKeyDictionary()
"""Handlers of servers without a port: what talks to a browser, in the loop of that server."""
_UPLOADS: weakref.WeakKeyDictionary[viser.ViserServer, _Uploads] = weakref.WeakKeyDictionary()
"""What counts the uploads of a server; one for all projects behind a port."""
_STARTING = threading.Lock()


class _NoPort:
    """Stands where viser expects the socket that it listens on."""

    sockets = ()

    async def __aenter__(self) -> _NoPort:
        self.server = self
        return self

    async def __aexit__(self, *error: object) -> None:
        return None


@contextlib.contextmanager
def _replace_serve(serve: Callable[..., Any]) -> Iterator[None]:
    """While it lasts, viser starts its websocket servers by `serve`.

    viser 1.1.1 calls `websockets.asyncio.server.serve` by this name when a server is made, and has no option for a
    check before the handshake, a limit on messages or a socket of the caller's.
    """
    with _STARTING:
        original = websockets.asyncio.server.serve
        setattr(websockets.asyncio.server, "serve", serve)  # noqa: B010  # a class to mypy, to which none is assigned
        try:
            yield
        finally:
            setattr(websockets.asyncio.server, "serve", original)  # noqa: B010


def stop_server(server: viser.ViserServer) -> None:
    """Stop without waiting: viser's own `stop` can block for seconds after a browser has been connected."""

    def stop() -> None:
        server.stop()
        _HANDLERS.pop(server, None)  # it refers to its server, and would keep that and its project in memory

    threading.Thread(target=stop, daemon=True, name="stop viser").start()


def component_uuid(handle: Any) -> str:
    """The id by which the page knows a panel element."""
    return str(handle._impl.uuid)


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


def _serve_with_check(
    visitors: Visitors, pictures: Pictures | None, projects: ProjectServers | None
) -> Callable[..., Any]:
    """Starts websocket servers with the visitors' check in front."""
    original = websockets.asyncio.server.serve

    @functools.wraps(original)
    def serve(handler: Any, *args: Any, process_request: HttpHandler | None = None, **kwargs: Any) -> Any:
        kwargs["max_size"] = MAX_MESSAGE_BYTES
        check = request_check(process_request, visitors, pictures, projects)
        routed = handler if projects is None else _route(handler, projects)
        return original(pace(routed), *args, process_request=check, **kwargs)

    return serve


def _route(handler: ConnectionHandler, projects: ProjectServers) -> ConnectionHandler:
    """A handler that gives a connection to the server of the project in its address, or else to `handler`."""

    async def handle(connection: ServerConnection) -> None:
        name = project_of("" if connection.request is None else connection.request.path)
        server = None if name is None else await asyncio.to_thread(projects.server, name)
        inner = None if server is None else _HANDLERS.get(server)
        if server is None or inner is None:
            await handler(connection)
            return
        loop = server._websock_server._background_event_loop
        assert loop is not None
        bridge = Bridge(connection, asyncio.get_running_loop())
        await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(inner(bridge), loop))

    return handle


class _Uploads:
    """Caps on the uploads of all pages of all projects behind a port: the servers' own panels and every client's.

    Used from the loops of several servers, one at a time.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._servers = itertools.count()
        self._guis: weakref.WeakKeyDictionary[viser.GuiApi, int] = weakref.WeakKeyDictionary()
        """The panels of pages, with the number of their server: each numbers its clients by itself."""
        self._moved_at: dict[str, float] = {}
        """When the last part of each upload came."""

    def next_server(self) -> int:
        """A number for another server."""
        return next(self._servers)

    def watch(self, gui: viser.GuiApi, server: int, refused: Refused | None) -> None:
        """Put the caps before viser's own handlers of one page's panels.

        Args:
            gui: of the page.
            server: number of the server.
            refused: called with what was turned away.
        """
        with self._lock:
            self._guis[gui] = server
        handlers = gui._websock_interface._incoming_handlers
        start, part = gui._handle_file_transfer_start, gui._handle_file_transfer_part

        def refuse(client_id: Any, message: Any, name: str, reason: str) -> None:
            """End an upload that is refused, and say why to whoever is told of refusals.

            Args:
                client_id: of the browser.
                message: that began the upload.
                name: of the file.
                reason: in words.
            """
            _end_transfer(gui, message)
            if refused is not None:
                refused(int(client_id), _("{file} was refused: {reason}").format(file=name[:100], reason=_(reason)))

        def cap_start(client_id: Any, message: _messages.FileTransferStartUpload) -> None:
            with self._lock:
                reason = why_refused(message, (server, client_id), self._running())
                if reason is None:
                    self._moved_at[message.transfer_uuid] = time.monotonic()
                    start(client_id, message)
            if reason is not None:
                refuse(client_id, message, str(message.filename), reason)

        def cap_part(client_id: Any, message: _messages.FileTransferPart) -> None:
            with self._lock:
                state = gui._current_file_upload_states.get(message.transfer_uuid)
                if state is None or state["client_id"] != client_id:
                    return
                within = state["transferred_bytes"] + len(message.content) <= state["total_bytes"]
                if within:
                    self._moved_at[message.transfer_uuid] = time.monotonic()
                    part(client_id, message)
                else:
                    gui._current_file_upload_states.pop(message.transfer_uuid, None)
            if not within:
                refuse(client_id, message, state["filename"], "more data arrived than announced; try again")

        for kind, old, new in (
            (_messages.FileTransferStartUpload, start, cap_start),
            (_messages.FileTransferPart, part, cap_part),
        ):
            handlers[kind] = [new if known == old else known for known in handlers[kind]]

    def _running(self) -> list[RunningUpload]:
        """Uploads under way; those that stand still are given up."""
        now, uploads = time.monotonic(), list[RunningUpload]()
        for gui, server in list(self._guis.items()):
            for uuid, state in list(gui._current_file_upload_states.items()):
                if now - self._moved_at.get(uuid, now) > UPLOAD_STALLED_S:
                    gui._current_file_upload_states.pop(uuid, None)
                else:
                    uploads.append(RunningUpload(uuid, (server, state["client_id"]), state["total_bytes"]))
        alive = {upload.uuid for upload in uploads}
        self._moved_at = {uuid: at for uuid, at in self._moved_at.items() if uuid in alive}
        return uploads


def _end_transfer(gui: viser.GuiApi, message: Any) -> None:
    """Tell a page that a transfer is over, so that its progress notice goes away."""
    size = getattr(message, "size_bytes", 0)
    gui._websock_interface.queue_message(
        _messages.FileTransferPartAck(
            source_component_uuid=message.source_component_uuid,
            transfer_uuid=message.transfer_uuid,
            transferred_bytes=size,
            total_bytes=size,
        )
    )
