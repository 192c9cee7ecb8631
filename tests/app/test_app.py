"""The whole editor put together, and a person at it without a browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from diorama_app.app import LEFT_TABS, RIGHT_TABS, Editor
from diorama_app.interaction.gestures import Gestures
from diorama_app.panels.in_place import InPlace
from diorama_app.session import autosave
from diorama_app.session.connected_client import ConnectedClient, Panel
from diorama_core.errors import DioramaError
from diorama_core.project.storage import Project
from tests.app import pointer
from tests.app.page import Page
from tests.app.people import LocalClient
from tests.app.small_room import PlainLibrary, make_project


@pytest.fixture
def editor(server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Editor]:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path / "libraries"))
    monkeypatch.setattr(autosave, "SETTLE_S", 0.01)
    made = Editor(server, PlainLibrary(), tmp_path / "projects", low_graphics=True)
    yield made
    made.close()
    server.scene.reset()
    server.gui.reset()


def enter(editor: Editor) -> tuple:
    """Somebody comes: the client and the page as it was laid out."""
    viser_client = LocalClient(editor.server, 0)
    page = Page(editor.server.gui, None)
    viser_client.gui = page
    editor.session.ui_thread.post(lambda: editor.session.join(viser_client))
    assert editor.session.ui_thread.wait(60.0)
    page.client = editor.session.clients[0]
    return page.client, page


def test_the_page_has_every_panel_and_shows_the_project(editor: Editor, tmp_path: Path) -> None:
    editor.open_first(make_project(tmp_path / "projects" / "demo"))
    client, page = enter(editor)
    assert isinstance(client, ConnectedClient)
    assert all(isinstance(p, Panel) for p in client.panels)
    kinds = {type(p.panel if isinstance(p, InPlace) else p).__name__ for p in client.panels}
    assert {
        "Toolbar",
        "Outliner",
        "PhotoPanel",
        "Optimiser",
        "Projects",
        "Properties",
        "LibraryPanel",
    } <= kinds
    assert isinstance(client.handles, Gestures)
    assert "dining table" in page.html
    for tab in (*LEFT_TABS, *RIGHT_TABS):
        assert f"&quot;{tab}&quot;" in page.html
    assert not client.viser_client.told


def test_clicks_and_drags_go_to_the_gestures_of_whoever_made_them(editor: Editor, tmp_path: Path) -> None:
    editor.open_first(make_project(tmp_path / "projects" / "demo"))
    client, _ = enter(editor)
    editor.session.view.on_pick("chair_1", pointer.clicked(client.viser_client, "chair_1"))
    nobody = LocalClient(editor.session.server, 7)
    editor.session.view.on_pick("lamp_1", pointer.clicked(nobody, "lamp_1"))
    assert editor.session.ui_thread.wait(60.0)
    assert client.selection == ("chair_1",)


def test_commands_are_run_for_whoever_asked(editor: Editor, tmp_path: Path) -> None:
    editor.open_first(make_project(tmp_path / "projects" / "demo"))
    client, _ = enter(editor)
    client.select(["chair_1"])
    editor._ask(editor.commands["delete"], 5)
    editor._ask(editor.commands["delete"], None)
    assert editor.session.ui_thread.wait(60.0)
    assert editor.session.scene.has_object("chair_1")
    editor._ask(editor.commands["delete"], 0)
    assert editor.session.ui_thread.wait(60.0)
    assert not editor.session.scene.has_object("chair_1")


def test_a_project_that_cannot_be_opened_is_an_error(editor: Editor, tmp_path: Path) -> None:
    broken = make_project(tmp_path / "projects" / "broken")
    broken.scene_path.write_text("{")
    with pytest.raises(DioramaError):
        editor.open_first(Project.open(broken.folder))


def test_too_large_uploads_are_told(editor: Editor, tmp_path: Path) -> None:
    editor.open_first(make_project(tmp_path / "projects" / "demo"))
    client, _ = enter(editor)
    editor.refuse_upload(0, "house.glb has 900 MB; that is too large")
    assert editor.session.ui_thread.wait(60.0)
    assert client.viser_client.told[-1] == "house.glb has 900 MB; that is too large"
