"""What is edited is saved whatever the page does, and one broken panel is one broken panel."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import viser

from diorama_app.commands.camera_presets import Views
from diorama_app.commands.definitions import build_commands
from diorama_app.commands.edit import rename
from diorama_app.panels.projects import Projects
from diorama_app.projects import manage as project_care
from diorama_app.reconstruction.photo_outlines import PhotoOutlines
from diorama_app.session.autosave import Unwritten
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.artefacts import Inputs
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.people import join
from tests.app.small_room import PlainLibrary, furnished_scene, make_project, plain_photo
from tests.io.test_bombs import png


@pytest.fixture
def session(server: viser.ViserServer, tmp_path: Path) -> Iterator[EditorSession]:
    made = EditorSession(server, PlainLibrary(), tmp_path / "projects", Client)
    made.open_project(make_project(tmp_path / "projects" / "demo"))
    yield made
    made.close()
    server.scene.reset()
    server.gui.reset()


def moved_to(x: float) -> Callable[[Scene], Scene]:
    def change(scene: Scene) -> Scene:
        item = scene.object("chair_1")
        return edits.move(scene, item.id, replace(item.pose, position=np.array([x, 1.0, 0.4])))

    return change


@pytest.mark.parametrize("x", [float("nan"), float("inf"), 1e12])
def test_a_field_that_holds_no_number_says_so(session: EditorSession, x: float) -> None:
    client = join(session)
    before = session.scene
    client.post(lambda: session.edit("move", moved_to(x), by=client))
    assert session.ui_thread.wait()
    told = client.viser_client.told
    assert len(told) == 1
    assert "Something went wrong" not in told[0]
    assert "value" in told[0]
    assert session.scene == before


class Broken:
    """A panel of which every redraw fails."""

    def refresh(self) -> None:
        raise RuntimeError("a panel broke")


class Counting:
    def __init__(self) -> None:
        self.count = 0

    def refresh(self) -> None:
        self.count += 1


def edited(session: EditorSession, client: Client, label: str = "throne") -> None:
    client.post(lambda: rename(client, "chair_1", label))
    assert session.ui_thread.wait()


def saved_label(session: EditorSession) -> str:
    session.autosave.flush()
    assert session.project is not None
    return session.project.load_scene().object("chair_1").label


def test_an_edit_is_saved_and_the_others_are_redrawn_when_a_panel_fails(session: EditorSession) -> None:
    client, other = join(session, 0), join(session, 1)
    fine = Counting()
    client.panels, other.panels = [Broken(), fine], [Broken(), fine]
    fine.count = 0
    edited(session, client)
    assert saved_label(session) == "throne"
    assert fine.count >= 2, "the panels after the broken one, of everybody"
    told = client.viser_client.told
    assert len(told) == 1, told
    assert "Broken" in told[0]
    assert "nothing was changed" not in told[0]
    edited(session, client, "stool")
    assert len(told) == 1, "said once, not at every edit"


def test_the_scene_is_saved_when_the_view_cannot_be_drawn(
    session: EditorSession, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object) -> None:
        raise RuntimeError("deque mutated during iteration")

    client = join(session)
    monkeypatch.setattr(session.viewport, "show", fails)
    edited(session, client)
    assert saved_label(session) == "throne"


DAMAGED = {
    "no text": b"\xff\xfe\x00format",
    "version in words": json.dumps({"format": "diorama-project", "version": "1"}).encode(),
    "not a table": b"[]",
    "deep": b"[" * 100_000,
    "huge number": b'{"format": "diorama-project", "version": ' + b"9" * 5000 + b"}",
    "name is a table": json.dumps({"format": "diorama-project", "version": 1, "name": {"a": 1}}).encode(),
}


@pytest.mark.parametrize("kind", DAMAGED)
def test_another_projects_damaged_file_is_that_projects_matter(session: EditorSession, kind: str) -> None:
    other = make_project(session.projects_dir / "other").folder
    (other / "project.json").write_bytes(DAMAGED[kind])
    assert project_care.name_of(other) == "other"
    client = join(session)
    client.panels = [projects_panel(session, client)]
    edited(session, client)
    assert saved_label(session) == "throne"
    assert client.viser_client.told == []


@pytest.mark.parametrize("photo", [png(20_000, 12_000, 8, 2, 3), b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n"])
def test_another_projects_photo_that_cannot_be_shown_is_left_out(session: EditorSession, photo: bytes) -> None:
    other = make_project(session.projects_dir / "other").folder
    (other / "photo.jpg").write_bytes(photo)
    client = join(session)
    client.panels = [projects_panel(session, client)]
    edited(session, client)
    assert saved_label(session) == "throne"
    assert client.viser_client.told == []


def projects_panel(session: EditorSession, client: Client) -> Projects:
    nothing = [lambda client: None] * 2
    commands = build_commands(session, Views(session), PhotoOutlines(session), lambda g: False, *nothing)
    return Projects(session.server.gui, client, commands, lambda name, content: None)


def test_what_is_newer_replaces_what_waits_and_the_rest_stays() -> None:
    scene, other = furnished_scene(), furnished_scene()
    waiting = Unwritten(scene=scene, further=())
    assert waiting.with_newer(Unwritten(scene=other)).scene is other
    assert waiting.with_newer(Unwritten(scene=other)).further == ()
    assert waiting.with_newer(Unwritten(inputs=Inputs(plain_photo()))).scene is scene
    assert Unwritten().with_newer(waiting).further == ()
