"""The HTTP interface of a running editor, on a port of its own for programs of this machine, and how they find it.

Every server notes its address in a file of the person's own, which goes when the server ends.
"""

from __future__ import annotations

import contextlib
import json
import logging
import os
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import platformdirs
from pydantic import BaseModel, ValidationError

from diorama_app.http_api.open_projects import OpenProjects
from diorama_app.http_api.routes import create_app
from diorama_app.http_api.server import listen, uvicorn_server
from diorama_app.serve import Running
from diorama_app.web.visitors import Visitors
from diorama_core.io.atomic import write_atomically

log = logging.getLogger(__name__)

HOST = "127.0.0.1"
END_S = 1
"""Seconds within which answers under way must end; events never do."""
START_S, ANSWER_S = 10.0, 2.0
"""Within which the server must listen, and a server that was noted must answer."""


class NotedServer(BaseModel):
    """A server of this machine."""

    address: str
    token: str | None


@contextlib.contextmanager
def api_beside(running: Running, token: str | None) -> Iterator[str]:
    """Answer other programs while the editor runs, where they bring the page's token, if any; gives the address."""
    opened = OpenProjects(lambda: running)
    listening = listen(HOST, 0)
    app = create_app(None, Visitors(HOST, token), opened)
    server = uvicorn_server(app, timeout_graceful_shutdown=END_S, lifespan="off")
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]}, daemon=True, name="api")
    thread.start()
    address = f"http://{HOST}:{listening.getsockname()[1]}/"
    until = time.monotonic() + START_S
    while not server.started and thread.is_alive() and time.monotonic() < until:
        time.sleep(0.02)
    noted = _note(NotedServer(address=address, token=token))
    try:
        yield address
    finally:
        noted.unlink(missing_ok=True)
        server.should_exit = True
        thread.join(START_S)
        opened.close()
        listening.close()


def _folder() -> Path:
    return platformdirs.user_state_path("diorama", appauthor=False, ensure_exists=True) / "servers"


def _note(server: NotedServer) -> Path:
    path = _folder() / f"{os.getpid()}-{server.address.rstrip('/').rpartition(':')[2]}.json"
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)  # the token is nobody else's
    write_atomically(path, server.model_dump_json().encode())
    return path


def find_servers() -> tuple[NotedServer, ...]:
    """Servers of this person that answer, the one that was started last first; what others left behind is removed."""
    servers = []
    for path in sorted(_folder().glob("*.json"), key=lambda p: p.stat().st_mtime, reverse=True):
        try:
            server = NotedServer.model_validate_json(path.read_bytes())
            _answers(server)
            servers.append(server)
        except (OSError, ValidationError, ValueError) as error:
            log.info("the server of %s does not answer (%s)", path.name, error)
            with contextlib.suppress(OSError):
                path.unlink()
    return tuple(servers)


def _answers(server: NotedServer) -> None:
    """Raise `OSError` where nothing answers there."""
    headers = {} if server.token is None else {"Authorization": f"Bearer {server.token}"}
    request = urllib.request.Request(f"{server.address}v1/formats", headers=headers)
    with urllib.request.urlopen(request, timeout=ANSWER_S) as reply:
        json.load(reply)
