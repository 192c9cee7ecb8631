"""Ports of servers that end and start again: nobody else is given them meanwhile."""

from __future__ import annotations

import os
import socket
from itertools import count
from pathlib import Path

GIVEN_TO_ANYBODY = Path("/proc/sys/net/ipv4/ip_local_port_range")
"""Where Linux says which ports it gives to connections and to servers that ask for any."""
FIRST, APART = 20_000, 200
_next = count()


def lasting_port() -> int:
    """A free port that the system gives to nobody who does not name it; each process of the tests has its own."""
    lowest, highest = 32_768, 65_535
    if GIVEN_TO_ANYBODY.exists():
        lowest, highest = map(int, GIVEN_TO_ANYBODY.read_text().split())
    process = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    begin = FIRST + APART * process
    return next(p for k in _next if not lowest <= (p := begin + k) <= highest and free(p))


def free(port: int) -> bool:
    """Whether a server may listen there."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except (OSError, OverflowError):
            return False
    return True
