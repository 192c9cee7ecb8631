"""A project as one file: the same project elsewhere, and nothing from outside it."""

from __future__ import annotations

import os
import zipfile
from pathlib import Path

import pytest

from diorama_app.projects.dropped import interpret
from diorama_app.projects.manage import recent_projects
from diorama_app.projects.packing import is_packed, pack_project, unpack_project
from diorama_app.reconstruction.opening_job import open_packed
from diorama_core.errors import InputError, ProjectError, SceneError
from diorama_core.project.storage import Project
from tests.app.people import settle
from tests.app.small_room import furnished_scene, make_project


@pytest.fixture
def packed(tmp_path: Path) -> Path:
    project = make_project(tmp_path / "home" / "room")
    (project.folder / "backups").mkdir(exist_ok=True)
    (project.folder / "backups" / "old.json").write_text("{}")
    (project.folder / ".diorama.lock").touch()
    os.symlink("/etc/hostname", project.folder / "link")
    return pack_project(project, tmp_path / "room.diorama")


def test_it_comes_back_as_it_was(packed: Path, tmp_path: Path) -> None:
    names = set(zipfile.ZipFile(packed).namelist())
    assert {"project.json", "scene.json"} <= names
    assert not {"link", ".diorama.lock", "backups/old.json"} & names
    made = unpack_project(packed, tmp_path / "there")
    assert made.folder == tmp_path / "there" / "room"
    assert made.load_scene() == furnished_scene()
    assert made.load_inputs() is not None
    assert unpack_project(packed, tmp_path / "there").folder.name == "room-2"
    assert unpack_project(packed, tmp_path, folder=tmp_path / "mine").folder == tmp_path / "mine"
    with pytest.raises(ProjectError, match="exists already"):
        unpack_project(packed, tmp_path, folder=tmp_path / "mine")


def test_what_would_not_open_leaves_nothing_behind(packed: Path, tmp_path: Path) -> None:
    other, there = tmp_path / "other.diorama", tmp_path / "there"
    with zipfile.ZipFile(other, "w") as archive:
        archive.writestr("readme.txt", "hello")
    with pytest.raises(InputError, match=r"no project\.json"):
        unpack_project(other, there)
    with zipfile.ZipFile(packed) as old, zipfile.ZipFile(other, "w") as archive:
        for name in old.namelist():
            archive.writestr(name, b"{" if name == "scene.json" else old.read(name))
    with pytest.raises(SceneError):
        unpack_project(other, there)
    with pytest.raises(InputError, match="cannot be unpacked"):
        unpack_project(_written(tmp_path / "cut.diorama", packed.read_bytes()[:900]), there)
    assert recent_projects(there) == []


def test_a_received_project_names_no_folders_of_this_machine(packed: Path, tmp_path: Path) -> None:
    project = Project.open(tmp_path / "home" / "room")
    project.update_info(library="built-in+/etc/shapes+./shapes+mine")
    made = unpack_project(pack_project(project, packed), tmp_path / "there")
    assert made.info()["library"] == "built-in+./shapes+mine"


@pytest.mark.parametrize(
    ("names", "packed"),
    [
        (("project.json", "scene.json"), True),
        (("room/project.json", "room/scene.json", "room/photo.jpg"), True),
        (("project.json", "photo.jpg"), False),
        (("a/b/project.json", "a/b/scene.json"), False),
    ],
)
def test_packed_projects_are_told_by_their_names(names: tuple[str, ...], packed: bool) -> None:
    assert is_packed(names) is packed


def test_one_that_is_dropped_on_the_page_opens(packed: Path, client, session) -> None:
    content = packed.read_bytes()
    (reading,) = interpret(content, "sent.zip", None).readings
    assert reading.action == "project"
    open_packed(client, "sent.zip", content)
    settle(session)
    assert session.project.folder.name == "sent"
    assert session.scene == furnished_scene()


def _written(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path
