"""The process of `diorama api`."""

from __future__ import annotations

import socket
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI

import diorama_core as diorama
from diorama_app.http_api.access import Connection
from diorama_app.http_api.jobs import JobQueue
from diorama_app.http_api.open_projects import OpenProjects
from diorama_app.http_api.routes import create_app
from diorama_app.serve import Running, start
from diorama_app.web.visitors import LOOPBACK_NAMES, Visitors, page_address, with_token
from diorama_core.errors import InputError

MAX_CONNECTIONS = 1000
"""Open ones, waiting ones included; `access.MAX_REQUESTS` refuses earlier, and in JSON."""
IDLE_S = 15


def serve_api(*, projects_dir: Path, host: str, port: int, token: str | None, library: str) -> None:
    """Answer requests until Ctrl+C.

    Args:
        projects_dir: where jobs become projects; those that an earlier server left unfinished are taken up again.
        host: address to listen on.
        port: 0 lets the system choose.
        token: what requests must bring; generated where other machines can ask and none is given.
        library: name of the shape library.

    Raises:
        InputError: the port is taken.
        LibraryError: there is no library of that name.
        ProjectError: the folder of projects cannot be made.
    """
    host = host or "0.0.0.0"
    token = with_token(host, token)
    listening = listen(host, port)
    queue = JobQueue(projects_dir, diorama.open_library(library), library)
    running: list[Running] = []

    def editor() -> Running:
        """The page of what is edited, started when something is."""
        running.append(start(projects_dir=projects_dir, host=host, token=token, library=library))
        print(f"What is edited is seen at {running[0].url}", flush=True)
        return running[0]

    opened = OpenProjects(editor)
    app = create_app(queue, Visitors(host, token), opened)
    address = page_address(host, listening.getsockname()[1], None)
    print(f"Diorama answers at {address} (Ctrl+C stops it)", flush=True)
    print(f"Its OpenAPI document is at {address}openapi.json", flush=True)
    if token is not None and host not in LOOPBACK_NAMES:
        print(f"Requests must bring the header 'Authorization: Bearer {token}'", flush=True)
    queue.start()
    try:
        uvicorn_server(app, limit_concurrency=MAX_CONNECTIONS).run(sockets=[listening])
    except KeyboardInterrupt:
        print("Stopping.", flush=True)
    finally:
        opened.close()
        for one in running:
            one.stop()
        queue.close()
        listening.close()


def uvicorn_server(app: FastAPI, **settings: Any) -> uvicorn.Server:
    """A server of the application, with what is set for it alone."""
    common = {"log_level": "warning", "timeout_keep_alive": IDLE_S, "server_header": False, "ws": "none"}
    return uvicorn.Server(uvicorn.Config(app, http=Connection, **common, **settings))


def listen(host: str, port: int) -> socket.socket:
    """A socket that listens there; raises `InputError` where it cannot be had."""
    try:
        return socket.create_server((host, port), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except OSError as error:
        raise InputError(
            f"port {port} of {host} cannot be used ({error.strerror}); choose another with --port"
        ) from error
