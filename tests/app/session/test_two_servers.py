"""A project that is open in one server is looked at in the other, and a damaged one opens with its newest version."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from diorama_app.commands.edit import rename
from diorama_app.reconstruction import build_job as work
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_app.web.viser_adapter import create_server, stop_server
from diorama_app.web.visitors import Visitors
from diorama_core.errors import DioramaError, EditRefused
from diorama_core.project import backups
from diorama_core.project.storage import Project
from diorama_core.scene.edits import rename as renamed
from tests.app.people import join
from tests.app.small_room import PlainLibrary, furnished_scene, make_project

NewRoom = Callable[[], EditorSession]


@pytest.fixture
def new_room(tmp_path: Path) -> Iterator[NewRoom]:
    made: list[EditorSession] = []

    def begin() -> EditorSession:
        server = create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1"))
        made.append(EditorSession(server, PlainLibrary(), tmp_path / "projects", Client))
        return made[-1]

    yield begin
    for session in made:
        session.close()
        stop_server(session.server)


def test_the_second_server_only_looks_and_says_who_has_it(new_room: NewRoom, tmp_path: Path) -> None:
    project = make_project(tmp_path / "projects" / "demo")
    first, second = new_room(), new_room()
    first.open_project(project)
    client = join(second)
    second.open_project(Project.open(project.folder))
    assert "open in the editor of" in client.viser_client.told[-1]
    for act in (
        lambda: rename(client, "chair_1", "throne"),
        lambda: second.undo(client),
        lambda: second.redo(client),
        lambda: second.commit("swap", renamed(furnished_scene(), "chair_1", "x"), by=client),
    ):
        with pytest.raises(EditRefused, match="open in the editor of"):
            act()
    assert second.scene == furnished_scene()
    with pytest.raises(DioramaError, match="open in the editor of"):
        work.build(client.session)
    other = join(first)
    rename(other, "chair_1", "throne")
    first.autosave.flush()
    second.autosave.flush()
    assert project.load_scene().object("chair_1").label == "throne", "nothing of the first is overwritten"


def test_the_second_may_edit_when_the_first_has_let_go(new_room: NewRoom, tmp_path: Path) -> None:
    project, another = make_project(tmp_path / "projects" / "demo"), make_project(tmp_path / "projects" / "other")
    first, second = new_room(), new_room()
    first.open_project(project)
    second.open_project(Project.open(project.folder))
    assert second.read_only
    first.open_project(another)
    second.open_project(Project.open(project.folder))
    assert not second.read_only
    rename(join(second), "chair_1", "throne")
    second.autosave.flush()
    assert project.load_scene().object("chair_1").label == "throne"


def test_a_damaged_scene_opens_with_the_newest_version_that_can_be_read(
    new_room: NewRoom, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(backups, "BACKUP_EVERY_S", 0.0)
    project = make_project(tmp_path / "projects" / "demo")
    project.save_scene(renamed(furnished_scene(), "chair_1", "throne"))
    project.save_scene(renamed(furnished_scene(), "chair_1", "newer"))
    project.scene_path.write_bytes(project.scene_path.read_bytes()[:1000])
    project.backups()[0].write_bytes(b"\xff")
    session = new_room()
    client = join(session)
    session.open_project(project)
    assert session.scene == furnished_scene()
    told = client.viser_client.told[-1]
    assert "is shown, since the scene file is not valid JSON" in told
    assert len(told) < 400
