"""An open project on a real server, and somebody at it without a browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import viser

from diorama_app import serve
from diorama_app.commands.camera_presets import Views
from diorama_app.commands.definitions import build_commands
from diorama_app.commands.registry import CommandTable
from diorama_app.reconstruction.photo_outlines import PhotoOutlines
from diorama_app.serve import Running, start
from diorama_app.session import autosave, redraws
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.web.viser_adapter import create_server, stop_server
from diorama_app.web.visitors import Visitors
from diorama_core.library.record import ShapeLibrary
from tests.app.page import Page
from tests.app.people import join
from tests.app.small_room import PlainLibrary, make_project


@pytest.fixture(scope="module")
def server() -> Iterator[viser.ViserServer]:
    """One for all tests of a module: starting and stopping takes half a second."""
    made = create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1"))
    yield made
    stop_server(made)


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """An editor as `diorama serve` starts it, with the small room as its project `demo`; nothing is preloaded."""
    folder = tmp_path_factory.mktemp("projects")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(serve, "warm_up", lambda stopped: None)
        made = start(project=make_project(folder / "demo").folder, projects_dir=folder, library=PlainLibrary())
        yield made
        made.stop()


@pytest.fixture
def session_library() -> ShapeLibrary:
    return PlainLibrary()


@pytest.fixture
def session(
    server: viser.ViserServer, session_library: ShapeLibrary, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[EditorSession]:
    monkeypatch.setattr(autosave, "SETTLE_S", 0.01)
    monkeypatch.setattr(redraws, "EVERY_S", 0.0)  # panels are drawn at once
    monkeypatch.setattr(redraws, "SHARE", 1e9)
    made = EditorSession(server, session_library, tmp_path / "projects", Client)
    # Tests do the UI thread's work: what other threads post to it would draw at the same time.
    made.checker.look_at = lambda scene: None
    made._look_again = lambda: None
    made.open_project(make_project(tmp_path / "projects" / "demo"))
    yield made
    made.close()
    server.scene.reset()
    server.gui.reset()


@pytest.fixture
def client(session: EditorSession) -> Client:
    return join(session)


@pytest.fixture
def page(session: EditorSession, client: Client) -> Page:
    return Page(session.server.gui, client)


@pytest.fixture
def views(session: EditorSession) -> Views:
    return Views(session)


@pytest.fixture
def commands(session: EditorSession, views: Views) -> CommandTable:
    nothing = [lambda client: None] * 2
    return build_commands(session, views, PhotoOutlines(session), lambda client: False, *nothing)
