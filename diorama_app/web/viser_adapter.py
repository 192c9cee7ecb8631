"""The only place that touches viser's private names, each pinned by a contract test in `tests/app`.

What it adds to viser 1.1.1: a server that listens where it is told and nowhere else, refuses pages of foreign
origin and (optionally) visitors without a token, never opens a public tunnel, caps uploads, and stops at once.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import hmac
import http
import io
import ipaddress
import secrets
import socket
import threading
import time
import weakref
from collections.abc import Awaitable, Callable, Iterator
from concurrent.futures import Future
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from typing import Any, Protocol, runtime_checkable
from urllib.parse import parse_qs, parse_qsl, urlencode, urlsplit

import viser
import websockets.asyncio.server
from viser import _messages
from viser.infra import _infra
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from diorama_app.web.bridge import Bridge, ConnectionHandler
from diorama_app.web.responses import TOKEN_COOKIE, add_headers, picture, prepend_scripts
from diorama_app.web.upload_limits import RunningUpload, why_refused
from diorama_core.errors import InputError

LOOPBACK_NAMES = frozenset({"127.0.0.1", "localhost", "::1"})
ANY_HOST = frozenset({"", "0.0.0.0", "::"})
UPLOAD_STALLED_S = 60.0
"""An upload idle for this long is dropped when its slot is needed."""
MESSAGES_PER_S, MESSAGES_AT_ONCE = 300, 600
"""Of one connection: a drag and a turning camera together send about a hundred a second."""
MAX_MESSAGE_BYTES = 16 * 1024 * 1024

PICTURES = "pictures/"
"""Addresses below this one are pictures."""


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
class _Buffer(_infra.AsyncMessageBuffer):  # type: ignore[misc]
    message_event: asyncio.Event = field(default_factory=_LoopEvent)
    flush_event: asyncio.Event = field(default_factory=_LoopEvent)


_infra.AsyncMessageBuffer = _Buffer  # each connection makes its own by this name

HttpHandler = Callable[[ServerConnection, Request], Response | None]
Answer = Callable[[ServerConnection, Request], Response | Awaitable[Response] | None]
Refused = Callable[[int, str], None]
Pictures = Callable[[str], "Future[bytes | None]"]

PROJECT = "project"
"""The parameter of an address that names a project."""


@runtime_checkable
class Projects(Protocol):
    """Which project an address leads to."""

    def first(self) -> str | None:
        """The project of an address that names none; None for the page of the server itself."""
        ...

    def server(self, name: str) -> viser.ViserServer | None:
        """The server of a project, opened if necessary; None where there is no such project. May take a while."""
        ...


@dataclass(frozen=True)
class Visitors:
    """Access rules of the server."""

    host: str
    """The address it listens on."""
    token: str | None = None
    """When set, the first page load must carry `?token=...`; a cookie remembers it."""

    def refusal(self, request: Request) -> str | None:
        """Why a request is not served, or None when it is. Headers that make no sense are a reason."""
        try:
            return self._refusal(request)
        except (ValueError, LookupError, CookieError):  # headers given twice, half an IPv6 address, a broken cookie
            return "the request headers are invalid"

    def _refusal(self, request: Request) -> str | None:
        host_header = request.headers.get("Host", "")
        if not self._knows((urlsplit(f"//{host_header}").hostname or "").rstrip(".")):
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
        if self.host in ANY_HOST:
            return name in LOOPBACK_NAMES or _is_address(name) or name in own_names()
        return name == self.host.lower() or (self.host in LOOPBACK_NAMES and name in LOOPBACK_NAMES)


def with_token(host: str, token: str | None) -> str | None:
    """The token that clients must present: the given one, or a generated one when others can reach the server."""
    return token or (None if host in LOOPBACK_NAMES else secrets.token_urlsafe(18))


@functools.cache
def own_names() -> frozenset[str]:
    """Host names of this machine, in lower case."""
    name = socket.gethostname().lower()
    return frozenset({name, f"{name}.local", socket.getfqdn().lower()})


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def create_server(
    *,
    host: str,
    port: int,
    label: str,
    visitors: Visitors,
    refused: Refused | None = None,
    pictures: Pictures | None = None,
    projects: Projects | None = None,
) -> viser.ViserServer:
    """A hardened viser server.

    Args:
        host: address to listen on.
        port: 0 lets the system choose.
        label: shown above the panels.
        visitors: who may talk to it.
        refused: told (client id, one line) of every upload that was refused.
        pictures: asked for a PNG when a page wants `pictures/<name>`. The browser fetches what it shows and nothing
            else, beside the websocket on which the scene comes.
        projects: where browsers go whose address names a project (`/?project=...`).

    Raises:
        InputError: the port is taken or the address is not this machine's.
    """
    _check_port(host, port)
    with _guarded_serve(visitors, pictures, projects), contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host=host, port=port, label=label, verbose=False)
    _secure(server, refused)
    return server


def create_server_without_port(label: str, refused: Refused | None = None) -> viser.ViserServer:
    """A viser server whose connections come from the one that has the port (`projects` of `create_server`)."""
    handlers: list[ConnectionHandler] = []

    def serve(handler: ConnectionHandler, *args: Any, **kwargs: Any) -> _NoPort:
        handlers.append(handler)
        return _NoPort()

    with _replaced_serve(serve), contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host="127.0.0.1", port=0, label=label, verbose=False)
    _HANDLERS[server] = handlers[0]
    _secure(server, refused)
    return server


def _secure(server: viser.ViserServer, refused: Refused | None) -> None:
    """No public tunnel, and caps on the uploads of every page."""
    server.request_share_url = _no_share_url
    uploads = _Uploads(refused)
    uploads.watch(server.gui)

    async def watch(viser_client: viser.ClientHandle) -> None:
        uploads.watch(viser_client.gui)

    server.on_client_connect(watch)  # the first to be told, before anything makes an upload button


_HANDLERS: weakref.WeakKeyDictionary[viser.ViserServer, ConnectionHandler] = weakref.WeakKeyDictionary()
"""Of servers without a port: what talks to a browser, in the loop of that server."""
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
def _replaced_serve(serve: Callable[..., Any]) -> Iterator[None]:
    """While it lasts, viser starts its websocket servers by `serve`."""
    with _STARTING:
        original = websockets.asyncio.server.serve
        websockets.asyncio.server.serve = serve  # type: ignore[assignment, misc]
        try:
            yield
        finally:
            websockets.asyncio.server.serve = original  # type: ignore[misc]


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
def _guarded_serve(visitors: Visitors, pictures: Pictures | None, projects: Projects | None) -> Iterator[None]:
    """While it lasts, websocket servers are started with the visitors' check in front."""
    original = websockets.asyncio.server.serve

    @functools.wraps(original)
    def serve(handler: Any, *args: Any, process_request: HttpHandler | None = None, **kwargs: Any) -> Any:
        kwargs["max_size"] = MAX_MESSAGE_BYTES
        checked = _checked(process_request, visitors, pictures, projects)
        routed = handler if projects is None else _routed(handler, projects)
        return original(_paced(routed), *args, process_request=checked, **kwargs)

    with _replaced_serve(serve):
        yield


def _routed(handler: ConnectionHandler, projects: Projects) -> ConnectionHandler:
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


def project_of(address: str) -> str | None:
    """The project that an address names, or None."""
    return parse_qs(urlsplit(address).query).get(PROJECT, [None])[0]


def _redirected(request: Request, project: str) -> Response:
    """Sends a page whose address names no project to the address that does."""
    query = [*parse_qsl(urlsplit(request.path).query, keep_blank_values=True), (PROJECT, project)]
    headers = Headers({"Location": f"/?{urlencode(query)}", "Content-Length": "0", "Cache-Control": "no-store"})
    headers["Connection"] = "close"
    return Response(http.HTTPStatus.FOUND, "Found", headers)


def _paced(handler: Callable[[ServerConnection], Awaitable[None]]) -> Callable[[ServerConnection], Awaitable[None]]:
    """The handler, with messages taken no faster than anybody can work: the rest waits at its sender."""

    async def handle(connection: ServerConnection) -> None:
        receive, credit, at = connection.recv, float(MESSAGES_AT_ONCE), time.monotonic()

        async def recv(*args: Any, **kwargs: Any) -> Any:
            nonlocal credit, at
            now = time.monotonic()
            credit, at = min(MESSAGES_AT_ONCE, credit + (now - at) * MESSAGES_PER_S) - 1.0, now
            if credit < 0.0:
                await asyncio.sleep(-credit / MESSAGES_PER_S)
            return await receive(*args, **kwargs)

        connection.recv = recv  # type: ignore[method-assign]
        await handler(connection)

    return handle


def _checked(
    handler: HttpHandler | None, visitors: Visitors, pictures: Pictures | None, projects: Projects | None
) -> Answer:
    def process_request(connection: ServerConnection, request: Request) -> Response | Awaitable[Response] | None:
        refusal = visitors.refusal(request)
        if refusal is not None:
            return connection.respond(http.HTTPStatus.FORBIDDEN, f"Refused: {refusal}.\n")
        try:
            return served(connection, request)
        except (ValueError, LookupError, OSError):  # an address that names no file: a null character, half a name
            return connection.respond(http.HTTPStatus.BAD_REQUEST, "This request is invalid.\n")

    def served(connection: ServerConnection, request: Request) -> Response | Awaitable[Response] | None:
        name = urlsplit(request.path).path.removeprefix(f"/{PICTURES}")
        if pictures is not None and f"/{PICTURES}{name}" == urlsplit(request.path).path:
            return picture(connection, pictures(name))
        is_page = urlsplit(request.path).path in ("", "/") and request.headers.get("Upgrade") != "websocket"
        first = projects.first() if projects is not None and is_page and project_of(request.path) is None else None
        if first is not None:
            redirect = _redirected(request, first)
            add_headers(redirect, remember=visitors.token if visitors.brings_token(request) else None)
            return redirect
        response = handler(connection, request) if handler is not None else None
        if response is not None:
            prepend_scripts(response)
            add_headers(response, remember=visitors.token if visitors.brings_token(request) else None)
        return response

    return process_request


class _Uploads:
    """Caps on the uploads of all pages: the server's own panels and every client's. Used from viser's loop."""

    def __init__(self, refused: Refused | None) -> None:
        self._refused = refused
        self._guis: weakref.WeakSet[viser.GuiApi] = weakref.WeakSet()
        self._moved_at: dict[str, float] = {}
        """When the last part of each upload came."""

    def watch(self, gui: viser.GuiApi) -> None:
        """Put the caps before viser's own handlers of one page's panels."""
        self._guis.add(gui)
        handlers = gui._websock_interface._incoming_handlers
        start, part = gui._handle_file_transfer_start, gui._handle_file_transfer_part

        def capped_start(client_id: Any, message: _messages.FileTransferStartUpload) -> None:
            reason = why_refused(message, client_id, self._running())
            if reason is None:
                self._moved_at[message.transfer_uuid] = time.monotonic()
                start(client_id, message)
            else:
                self._refuse(gui, client_id, message, f"{message.filename[:100]} was refused: {reason}")

        def capped_part(client_id: Any, message: _messages.FileTransferPart) -> None:
            state = gui._current_file_upload_states.get(message.transfer_uuid)
            if state is None or state["client_id"] != client_id:
                return
            if state["transferred_bytes"] + len(message.content) > state["total_bytes"]:
                gui._current_file_upload_states.pop(message.transfer_uuid, None)
                name = state["filename"][:100]
                self._refuse(
                    gui, client_id, message, f"{name} was refused: more data arrived than announced; try again"
                )
                return
            self._moved_at[message.transfer_uuid] = time.monotonic()
            part(client_id, message)

        for kind, old, new in (
            (_messages.FileTransferStartUpload, start, capped_start),
            (_messages.FileTransferPart, part, capped_part),
        ):
            handlers[kind] = [new if known == old else known for known in handlers[kind]]

    def _running(self) -> list[RunningUpload]:
        """Uploads under way; those that stand still are given up."""
        now, found = time.monotonic(), list[RunningUpload]()
        for gui in list(self._guis):
            for uuid, state in list(gui._current_file_upload_states.items()):
                if now - self._moved_at.get(uuid, now) > UPLOAD_STALLED_S:
                    gui._current_file_upload_states.pop(uuid, None)
                else:
                    found.append(RunningUpload(uuid, state["client_id"], state["total_bytes"]))
        alive = {upload.uuid for upload in found}
        self._moved_at = {uuid: at for uuid, at in self._moved_at.items() if uuid in alive}
        return found

    def _refuse(self, gui: viser.GuiApi, client_id: Any, message: Any, line: str) -> None:
        size = getattr(message, "size_bytes", 0)
        gui._websock_interface.queue_message(
            # The transfer is over for the page, so that its progress notice goes away.
            _messages.FileTransferPartAck(
                source_component_uuid=message.source_component_uuid,
                transfer_uuid=message.transfer_uuid,
                transferred_bytes=size,
                total_bytes=size,
            )
        )
        if self._refused is not None:
            self._refused(int(client_id), line)
