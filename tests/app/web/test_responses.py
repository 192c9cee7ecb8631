from __future__ import annotations

import gzip
import http

from websockets.datastructures import Headers
from websockets.http11 import Response

from diorama_app.web.responses import (
    SCRIPTS,
    SECURITY_HEADERS,
    STYLES,
    TOKEN_COOKIE,
    add_headers,
    prepend_scripts,
    with_head,
)

PAGE = b"<html><head><title>Diorama</title></head></html>"


def response(body: bytes, **headers: str) -> Response:
    given = {name.replace("_", "-"): value for name, value in headers.items()}
    return Response(http.HTTPStatus.OK, "OK", Headers({"Content-Length": str(len(body)), **given}), body)


def test_scripts_come_first_in_a_page_zipped_or_not() -> None:
    plain = response(PAGE, Content_Type="text/html; charset=utf-8")
    zipped = response(gzip.compress(PAGE), Content_Type="text/html", Content_Encoding="gzip")
    for answer in (plain, zipped):
        prepend_scripts(answer)
        assert answer.headers["Content-Length"] == str(len(answer.body))
        assert answer.headers.get_all("Content-Type") == ["text/html; charset=utf-8"], (
            "scripts stand before the page's own"
        )
    assert gzip.decompress(zipped.body) == plain.body
    scripts, title = plain.body.split(b"<title>")
    assert scripts.count(b"<script>") == len(SCRIPTS)
    assert title == PAGE.split(b"<title>")[1]


def test_what_is_no_page_is_left_alone() -> None:
    answer = response(b"<head>", Content_Type="image/svg+xml")
    prepend_scripts(answer)
    assert answer.body == b"<head>"


def test_every_answer_has_the_security_headers_and_the_token_only_where_it_was_brought() -> None:
    answer = response(b"")
    add_headers(answer, remember=None)
    assert {n: answer.headers[n] for n in SECURITY_HEADERS} == SECURITY_HEADERS
    assert "Set-Cookie" not in answer.headers
    add_headers(answer, remember="s3cret")
    assert f"{TOKEN_COOKIE}=s3cret" in answer.headers["Set-Cookie"]
    assert "HttpOnly" in answer.headers["Set-Cookie"]
    assert "SameSite=Strict" in answer.headers["Set-Cookie"]


def test_our_title_styles_and_scripts_come_first() -> None:
    page = with_head(b"<html><head><title>Viser</title><script>viser()</script></head><body></body></html>")
    assert b"<title>Diorama</title>" in page
    assert b"Viser</title>" not in page
    assert page.count(b"\n<style>") == len(STYLES)
    assert page.count(b"\n<script>") == len(SCRIPTS)
    assert page.index(STYLES[0].read_bytes()) < page.index(SCRIPTS[0].read_bytes()) < page.index(b"viser()")
