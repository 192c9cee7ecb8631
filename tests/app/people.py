"""A person without a browser: what a connected client offers, answered by the server itself."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import viser

from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession


class Drawer:
    """What a browser keeps for its pages."""

    def __init__(self) -> None:
        self.retained: dict[str, str] = {}

    def set_item(self, key: str, value: str) -> None:
        self.retained[key] = value

    def get_item(self, key: str, timeout: float | None = None) -> str | None:
        return self.retained.get(key)


class LocalClient(viser.ClientHandle):
    """Stands in for a browser's handle; nodes and panels go to the shared scene of the server."""

    def __init__(self, server: viser.ViserServer, client_id: int) -> None:
        self.client_id = client_id
        self.scene, self.gui = server.scene, server.gui
        self.camera = SimpleNamespace(
            position=np.array([0.0, -3.0, 2.0]),
            look_at=np.array([0.1, 2.2, 0.4]),
            wxyz=np.array([1.0, 0.0, 0.0, 0.0]),
            up_direction=np.array([0.0, 0.0, 1.0]),
            fov=0.9,
            aspect=1.3,
            on_update=lambda callback: callback,
        )
        self.told: list[str] = []
        self.local_storage = Drawer()

    @contextlib.contextmanager
    def atomic(self) -> Iterator[None]:
        yield

    def flush(self) -> None:
        pass

    def add_notification(self, title: str, body: str, **options: Any) -> None:
        self.told.append(body)


def settle(session: EditorSession, seconds: float = 60.0) -> None:
    """Wait until the session's job is over and everything is shown."""
    assert session.jobs.wait(seconds)
    assert session.ui_thread.wait(60.0)


def node(server: viser.ViserServer, name: str | None) -> Any:
    """What a page draws under a name; None where there is nothing."""
    return server.scene._handle_from_node_name.get(name)


def join(session: EditorSession, client_id: int = 0) -> Client:
    """A browser connects to the session."""
    session.join(LocalClient(session.server, client_id))
    return session.clients[client_id]
