"""Who may talk to the server, by names, origins and tokens of requests, and how much browsers may upload: pure rules,
for one file and for all that are under way.
"""

from __future__ import annotations

import functools
import hmac
import ipaddress
import re
import secrets
import socket
from collections.abc import Sequence
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from typing import Any, Protocol, runtime_checkable
from urllib.parse import parse_qs, urlsplit

from websockets.http11 import Request

from diorama_app.web.responses import TOKEN_COOKIE
from diorama_core.errors import InputError
from diorama_core.io.text import clean_text

LOOPBACK_NAMES = frozenset({"127.0.0.1", "localhost", "::1"})
ANY_HOST = frozenset({"", "0.0.0.0", "::"})
ORIGIN = re.compile(r"https?://([a-z0-9.-]+|\[[0-9a-f:.]+\])(:\d{1,5})?", re.IGNORECASE)
"""No wildcards: a frame of any page could lead clicks to buttons that nobody sees."""


def page_address(host: str, port: int, token: str | None) -> str:
    """The page's address for a browser on this machine: where a server listens on every address, the loopback one.

    Args:
        host: The address it listens on.
        port: Its port.
        token: What visitors must bring; None where nobody needs one.
    """
    near = {"": "127.0.0.1", "0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
    address = f"http://{f'[{near}]' if ':' in near else near}:{port}/"
    return address if token is None else f"{address}?token={token}"


@dataclass(frozen=True)
class Visitors:
    """Access rules of the server."""

    host: str
    """The address it listens on."""
    token: str | None = None
    """When set, the first page load must carry `?token=...`; a cookie remembers it."""
    frame_origins: tuple[str, ...] = ()
    """Origins whose pages may show ours in a frame (`http://localhost:8888`); without them only our own may."""

    def __post_init__(self) -> None:
        for origin in self.frame_origins:
            if ORIGIN.fullmatch(origin) is None:
                raise InputError(
                    f"{clean_text(origin)[:100]!r} is not the origin of a page; give scheme, host and port alone, "
                    "such as http://localhost:8888"
                )

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


MAX_UPLOAD_BYTES = 128 * 1024 * 1024
MAX_UPLOADS_IN_FLIGHT = 8
MAX_UPLOADS_PER_CLIENT = 3
MAX_BYTES_IN_FLIGHT = 2 * MAX_UPLOAD_BYTES
"""Announced by all uploads that are under way: viser holds them in memory."""
MIN_PART_BYTES = 4096
"""The page sends parts of half a megabyte; very many small ones are only memory."""


@runtime_checkable
class UploadRequest(Protocol):
    """What a page says before it sends a file; nothing of it has been checked."""

    transfer_uuid: str
    filename: Any
    size_bytes: Any
    part_count: Any


@dataclass(frozen=True)
class RunningUpload:
    """An upload that is under way."""

    uuid: str
    page: tuple[int, int]
    total_bytes: int


def why_refused(request: UploadRequest, page: tuple[int, int], running: Sequence[RunningUpload]) -> str | None:
    """Why an upload may not start, in words for the user; None when it may.

    Args:
        request: what the page announces.
        page: number of the server of its project, and of the client there.
        running: uploads of all pages of all projects that are under way.
    """
    size, parts = request.size_bytes, request.part_count
    if not (isinstance(size, int) and isinstance(parts, int) and isinstance(request.filename, str)):
        return "the page sent an invalid request; reload it"
    if size > MAX_UPLOAD_BYTES:
        return (
            f"it has {size / 1e6:.0f} MB, and files up to {MAX_UPLOAD_BYTES / 1e6:.0f} MB can be uploaded; "
            "make it smaller"
        )
    if size < 0 or not 0 <= parts <= size // MIN_PART_BYTES + 2:
        return "the page sent an invalid request; reload it"
    if any(request.transfer_uuid == upload.uuid for upload in running):
        return "it is being uploaded already"
    of_page = sum(upload.page == page for upload in running)
    if of_page >= MAX_UPLOADS_PER_CLIENT or len(running) >= MAX_UPLOADS_IN_FLIGHT:
        return "other uploads are under way; try again when they are done"
    if sum(upload.total_bytes for upload in running) + size > MAX_BYTES_IN_FLIGHT:
        return "other large uploads are under way; try again when they are done"
    return None
