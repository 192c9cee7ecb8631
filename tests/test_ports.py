from __future__ import annotations

import socket

import pytest

from tests import ports
from tests.ports import free, lasting_port


@pytest.fixture(autouse=True)
def _apart(monkeypatch: pytest.MonkeyPatch) -> None:
    """Browser tests, which may run meanwhile, have the others."""
    monkeypatch.setattr(ports, "FIRST", 26_000)


def test_a_port_is_named_once_and_is_given_to_nobody_who_asks_for_any() -> None:
    named = {lasting_port() for _ in range(20)}
    assert len(named) == 20
    asked = [socket.create_server(("127.0.0.1", 0)) for _ in range(20)]
    given = {server.getsockname()[1] for server in asked}
    for server in asked:
        server.close()
    assert not named & given
    if ports.GIVEN_TO_ANYBODY.exists():
        lowest, highest = map(int, ports.GIVEN_TO_ANYBODY.read_text().split())
        assert not [port for port in named if lowest <= port <= highest]


def test_a_port_that_is_taken_is_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    taken = lasting_port()
    with socket.create_server(("127.0.0.1", taken)):
        assert not free(taken)
        monkeypatch.setattr(ports, "_next", iter(range(taken - ports.FIRST, taken - ports.FIRST + 2000)))
        monkeypatch.setenv("PYTEST_XDIST_WORKER", "gw0")
        assert lasting_port() > taken
