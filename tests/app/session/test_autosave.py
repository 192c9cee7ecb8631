"""What is edited is saved whatever the page does, and one broken panel is one broken panel."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from diorama_app.commands.edit import rename
from diorama_app.commands.registry import CommandTable
from diorama_app.panels.projects import Projects
from diorama_app.projects import manage as project_care
from diorama_app.session.autosave import Unwritten
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.artefacts import Inputs
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.people import join
from tests.app.small_room import furnished_scene, make_project, plain_photo
from tests.io.test_bombs import png


def moved_to(x: float) -> Callable[[Scene], Scene]:
    def change(scene: Scene) -> Scene:
        item = scene.object("chair_1")
        return edits.move(scene, item.id, replace(item.pose, position=np.array([x, 1.0, 0.4])))

    return change


def test_a_field_that_holds_no_number_says_so(session: EditorSession, client: Client) -> None:
    before, told = session.scene, client.viser_client.told
    for count, x in enumerate((float("nan"), float("inf"), 1e12), start=1):
        client.post(lambda x=x: session.edit("move", moved_to(x), by=client))
        assert session.ui_thread.wait()
        assert len(told) == count
        assert "Something went wrong" not in told[-1]
        assert "value" in told[-1]
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
    session: EditorSession, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object) -> None:
        raise RuntimeError("deque mutated during iteration")

    monkeypatch.setattr(session.viewport, "show", fails)
    edited(session, client)
    assert saved_label(session) == "throne"


DAMAGED = {
    "project.json": (
        b"\xff\xfe\x00format",
        json.dumps({"format": "diorama-project", "version": "1"}).encode(),
        b"[]",
        b"[" * 100_000,
        b'{"format": "diorama-project", "version": ' + b"9" * 5000 + b"}",
        json.dumps({"format": "diorama-project", "version": 1, "name": {"a": 1}}).encode(),
    ),
    "photo.jpg": (png(20_000, 12_000, 8, 2, 3), b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n"),
}


@pytest.mark.parametrize("file", DAMAGED)
def test_another_projects_damaged_file_is_that_projects_matter(
    session: EditorSession, client: Client, commands: CommandTable, file: str
) -> None:
    other = make_project(session.projects_dir / "other").folder
    client.panels = [Projects(session.server.gui, client, commands, lambda name, content: None)]
    for number, content in enumerate(DAMAGED[file]):
        (other / file).write_bytes(content)
        assert project_care.name_of(other) == "other"
        session.glances.forget()
        edited(session, client, f"edit {number}")
        assert saved_label(session) == f"edit {number}"
    assert client.viser_client.told == []


def test_what_is_newer_replaces_what_waits_and_the_rest_stays() -> None:
    scene, other = furnished_scene(), furnished_scene()
    waiting = Unwritten(scene=scene, further=())
    assert waiting.with_newer(Unwritten(scene=other)).scene is other
    assert waiting.with_newer(Unwritten(scene=other)).further == ()
    assert waiting.with_newer(Unwritten(inputs=Inputs(plain_photo()))).scene is scene
    assert Unwritten().with_newer(waiting).further == ()
