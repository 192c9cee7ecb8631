"""What the server adds to viser's answers: scripts, security headers, the token's cookie; and pictures of shapes."""

from __future__ import annotations

import asyncio
import functools
import gzip
import http
import re
from collections.abc import Sequence
from concurrent.futures import Future
from http.cookies import SimpleCookie
from pathlib import Path

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Response

from diorama_app.strings import language, translate_script

TOKEN_COOKIE = "diorama_token"
SECURITY_HEADERS = {
    # viser's page is one file of inline scripts, starts workers from blobs and compiles WebAssembly and templates.
    "Content-Security-Policy": "default-src 'none'; script-src 'self' 'unsafe-inline' 'unsafe-eval' blob:; "
    "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; "
    "connect-src 'self' data: blob:; worker-src 'self' blob:; media-src 'self' data: blob:; manifest-src 'self'; "
    "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'self'",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=(), payment=(), usb=()",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "SAMEORIGIN",
}


def prepend_scripts(response: Response) -> None:
    """Put our scripts in front of viser's, in the page itself; anything but a page is left alone.

    The header names the encoding: a browser looks for the page's own word for it in the first kilobyte only.
    """
    if not response.headers.get("Content-Type", "").startswith("text/html"):
        return
    zipped = response.headers.get("Content-Encoding") == "gzip"
    response.body = _page(bytes(response.body or b""), zipped)
    del response.headers["Content-Length"], response.headers["Content-Type"]
    response.headers["Content-Length"] = str(len(response.body))
    response.headers["Content-Type"] = "text/html; charset=utf-8"


@functools.lru_cache(maxsize=2)
def _page(body: bytes, zipped: bool) -> bytes:
    page = gzip.decompress(body) if zipped else body
    page = with_head(page)
    return gzip.compress(page, mtime=0) if zipped else page


async def picture(connection: ServerConnection, asked: Future[bytes | None]) -> Response:
    """The answer to a page that wants a picture: a PNG, or "not found" when `asked` gives None."""
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
    add_headers(response, remember=None)
    return response


def add_headers(response: Response, *, remember: str | None, frame_origins: Sequence[str] = ()) -> None:
    """Add the security headers, and the access token as a cookie where one is given.

    Args:
        response: to a page's request.
        remember: the token.
        frame_origins: whose pages may show the answer in a frame, beside our own.
    """
    for name, value in SECURITY_HEADERS.items():
        response.headers[name] = value
    if frame_origins:
        del response.headers["X-Frame-Options"]  # knows no list of origins
        policy = " ".join((response.headers.pop("Content-Security-Policy"), *frame_origins))
        response.headers["Content-Security-Policy"] = policy  # frame-ancestors is its last directive
    if remember is not None:
        cookie = SimpleCookie({TOKEN_COOKIE: remember})
        cookie[TOKEN_COOKIE].update({"path": "/", "httponly": "1", "samesite": "Strict"})
        response.headers["Set-Cookie"] = cookie[TOKEN_COOKIE].OutputString()


STATIC = Path(__file__).parents[1] / "static"
SCRIPTS = sorted(STATIC.glob("*.js"))
STYLES = sorted(STATIC.glob("*.css"))
TITLE = b"Diorama"


def with_head(page: bytes) -> bytes:
    """The page with our title, styles and scripts before everything that viser brings."""
    styles = b"".join(b"\n<style>" + style.read_bytes() + b"</style>" for style in STYLES)
    scripts = b"".join(
        b"\n<script>" + translate_script(script.read_text("utf-8")).encode() + b"</script>" for script in SCRIPTS
    )
    page = re.sub(
        rb"<title>.*?</title>", lambda match: b"<title>" + TITLE + b"</title>", page, count=1, flags=re.DOTALL
    )
    page = re.sub(rb'<html lang="[^"]*"', f'<html lang="{language()}"'.encode(), page, count=1)
    return page.replace(b"<head>", b"<head>" + styles + scripts, 1)
