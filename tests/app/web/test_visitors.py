"""Who is let in, asked over real connections."""

from __future__ import annotations

import socket
import urllib.request
from types import SimpleNamespace

import pytest
import viser

from diorama_app.web.viser_adapter import create_server, stop_server
from diorama_app.web.visitors import (
    MAX_BYTES_IN_FLIGHT,
    MAX_UPLOAD_BYTES,
    MAX_UPLOADS_IN_FLIGHT,
    MAX_UPLOADS_PER_CLIENT,
    RunningUpload,
    Visitors,
    page_address,
    why_refused,
    with_token,
)
from diorama_core.errors import InputError
from tests.app.web.http_client import connects, fetch


def test_foreign_origins_and_foreign_names_are_refused(server: viser.ViserServer) -> None:
    assert not connects(server, Origin="https://evil.example")
    assert not connects(server, Origin=f"http://127.0.0.1:{server.get_port() + 1}")
    assert fetch(server, Host="evil.example")[0] == 403
    assert fetch(server, Host=f"localhost:{server.get_port()}")[0] == 200


def test_with_a_token_only_those_who_bring_it_get_in(guarded: viser.ViserServer) -> None:
    origin = f"http://127.0.0.1:{guarded.get_port()}"
    assert fetch(guarded)[0] == 403
    assert fetch(guarded, "/?token=wrong")[0] == 403
    status, headers = fetch(guarded, "/?token=s3cret")
    assert status == 200
    cookie = headers["Set-Cookie"].partition(";")[0]
    assert "HttpOnly" in headers["Set-Cookie"]
    assert not connects(guarded, Origin=origin)
    assert not connects(guarded, Origin=origin, Cookie="diorama_token=wrong")
    assert connects(guarded, Origin=origin, Cookie=cookie)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "", "192.168.1.5"])
def test_where_others_can_reach_it_there_is_a_token(host: str) -> None:
    made = with_token(host, None)
    assert made is not None
    assert len(made) >= 20
    assert made != with_token(host, None)
    assert with_token(host, "mine") == "mine"
    assert with_token("127.0.0.1", None) is None


def test_a_server_for_everybody_still_knows_its_names() -> None:
    made = create_server(host="0.0.0.0", port=0, label="test", visitors=Visitors("0.0.0.0", "s3cret"))
    try:
        assert fetch(made, "/?token=s3cret", Host="evil.example")[0] == 403
        assert fetch(made, "/?token=s3cret", Host="rebound.example:80")[0] == 403
        assert fetch(made, "/", Host=f"127.0.0.1:{made.get_port()}")[0] == 403, "no token"
        for name in ("127.0.0.1", "192.168.7.7", "localhost", "[fe80::1]", socket.gethostname()):
            assert fetch(made, "/?token=s3cret", Host=f"{name}:{made.get_port()}")[0] == 200, name
    finally:
        stop_server(made)


def speaks_ipv6() -> bool:
    try:
        with socket.socket(socket.AF_INET6) as probe:
            probe.bind(("::1", 0))
    except OSError:
        return False
    return True


@pytest.mark.parametrize("host", ["127.0.0.1", "0.0.0.0", "::"])
def test_the_address_that_is_printed_answers_and_lets_in(host: str) -> None:
    if host == "::" and not speaks_ipv6():
        pytest.skip("this machine has no IPv6")
    token = with_token(host, None)
    made = create_server(host=host, port=0, label="test", visitors=Visitors(host, token))
    try:
        address = page_address(host, made.get_port(), token)
        with urllib.request.urlopen(address, timeout=60) as reply:
            assert reply.status == 200
        if token is not None:
            with pytest.raises(urllib.error.HTTPError, match="403"):
                urllib.request.urlopen(page_address(host, made.get_port(), None), timeout=60)
    finally:
        stop_server(made)


@pytest.mark.parametrize(
    "origin", ["*", "https://*.example", "http://localhost:8888/lab", "localhost:8888", "http://a; x"]
)
def test_what_is_no_origin_of_a_page_may_frame_nothing(origin: str) -> None:
    with pytest.raises(InputError, match="give scheme, host and port alone"):
        Visitors("127.0.0.1", frame_origins=(origin,))


def request(**changes):
    return SimpleNamespace(
        **{"transfer_uuid": "new", "filename": "a.png", "size_bytes": 1000, "part_count": 1} | changes
    )


PAGE, OTHER_PAGE, ELSEWHERE = (0, 1), (0, 2), (1, 1)
"""The last has the number of the first, in another project."""


def running(count: int, page: tuple[int, int] = PAGE, total_bytes: int = 1000) -> list[RunningUpload]:
    return [RunningUpload(f"1-{i}", page, total_bytes) for i in range(count)]


def test_an_ordinary_file_may_come() -> None:
    assert why_refused(request(), PAGE, running(MAX_UPLOADS_PER_CLIENT - 1)) is None
    assert why_refused(request(size_bytes=MAX_UPLOAD_BYTES, part_count=300), PAGE, []) is None
    assert why_refused(request(size_bytes=0, part_count=0), PAGE, []) is None


@pytest.mark.parametrize(
    "changes",
    [
        {"size_bytes": -1},
        {"size_bytes": "many"},
        {"part_count": None},
        {"filename": 7},
        {"part_count": -1},
        {"size_bytes": 10, "part_count": 3},
    ],
)
def test_requests_that_make_no_sense_are_refused(changes) -> None:
    assert why_refused(request(**changes), PAGE, []) == "the page sent an invalid request; reload it"


def test_each_limit_has_its_line() -> None:
    assert "files up to 134 MB" in why_refused(request(size_bytes=MAX_UPLOAD_BYTES + 1), PAGE, [])
    assert "already" in why_refused(request(transfer_uuid="1-0"), PAGE, running(1))
    assert "other uploads" in why_refused(request(), PAGE, running(MAX_UPLOADS_PER_CLIENT))
    assert "other uploads" in why_refused(request(), OTHER_PAGE, running(MAX_UPLOADS_IN_FLIGHT))
    assert "other large" in why_refused(
        request(size_bytes=2), OTHER_PAGE, running(1, total_bytes=MAX_BYTES_IN_FLIGHT - 1)
    )
    assert why_refused(request(), OTHER_PAGE, running(MAX_UPLOADS_PER_CLIENT)) is None, "another page's turn is its own"
    assert why_refused(request(), ELSEWHERE, running(MAX_UPLOADS_PER_CLIENT)) is None
    assert "other uploads" in why_refused(request(), ELSEWHERE, running(MAX_UPLOADS_IN_FLIGHT))
