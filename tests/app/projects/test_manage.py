"""Projects in their folder: copies that are whole or not there, and names of any bytes."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from diorama_app.projects import manage
from diorama_app.projects.manage import address_of, duplicate_project, find_project, recent_projects, to_bin
from diorama_core.errors import ProjectError
from diorama_core.scene.types import Scene
from tests.app.small_room import make_project


def test_a_copy_cut_short_is_not_in_the_list(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The disk was full while a project was copied: half of it stayed, as a project."""
    project, copy = make_project(tmp_path / "room"), shutil.copy2
    copied: list[str] = []

    def full(source: str, target: str, **more: object) -> object:
        copied.append(source)
        if len(copied) > 2:
            raise OSError(28, "No space left on device")
        return copy(source, target)

    monkeypatch.setattr(shutil.copytree, "__kwdefaults__", None)
    monkeypatch.setattr(shutil.copytree, "__defaults__", (False, None, full, False, False))
    with pytest.raises(ProjectError, match=r"^cannot copy to .*room-2 \(some of its files cannot be read\)"):
        duplicate_project(project.folder, tmp_path)
    assert recent_projects(tmp_path) == [project.folder]
    assert [p.name for p in tmp_path.iterdir()] == ["room"]


@pytest.mark.posix
def test_a_copy_has_files_and_folders_only(tmp_path: Path) -> None:
    """A device or a pipe in a received project was copied for ever, a link copied what it led to."""
    project = make_project(tmp_path / "room")
    (tmp_path / "secret").write_text("secret")
    (project.folder / "exports").mkdir()
    (project.folder / "exports" / "mine.txt").write_text("mine")
    (project.folder / "exports" / "link.txt").symlink_to(tmp_path / "secret")
    (project.folder / "photos").symlink_to(tmp_path)
    os.mkfifo(project.folder / "exports" / "pipe")
    copy = duplicate_project(project.folder, tmp_path)
    assert [p.name for p in (copy.folder / "exports").iterdir()] == ["mine.txt"]
    assert not (copy.folder / "photos").exists()
    assert copy.load_scene() == project.load_scene()


def test_earlier_versions_and_hidden_files_are_not_copied(tmp_path: Path) -> None:
    project = make_project(tmp_path / "room")
    project.save_scene(Scene())
    (project.folder / ".notes").write_text("hidden")
    assert len(project.backups()) == 1
    copy = duplicate_project(project.folder, tmp_path)
    assert copy.backups() == ()
    assert not (copy.folder / ".notes").exists()


def test_projects_are_listed_by_the_time_of_their_scene_or_photo(tmp_path: Path) -> None:
    for name in ("scene", "photo", "neither", "no project", ".hidden"):
        make_project(tmp_path / name).scene_path.rename(tmp_path / name / "was.json")
        (tmp_path / name / "stages" / "inputs.zip").unlink()
    for number, path in enumerate(("scene/scene.json", "photo/stages/inputs.zip", "no project/scene.json")):
        shutil.copy2(tmp_path / "scene" / "was.json", tmp_path / path)
        os.utime(tmp_path / path, (1e9 + number, 1e9 + number))
    shutil.copy2(tmp_path / "scene" / "was.json", tmp_path / ".hidden" / "scene.json")
    (tmp_path / "no project" / "project.json").unlink()
    assert [folder.name for folder in recent_projects(tmp_path)] == ["photo", "scene"]
    copy = duplicate_project(tmp_path / "scene", tmp_path)
    assert recent_projects(tmp_path)[0] == copy.folder, "a copy is new, also one of an old project"
    assert (copy.has_scene, copy.has_photo) == (True, False)
    assert (manage.mtime(tmp_path / "photo"), manage.mtime(tmp_path / "neither")) == (1e9 + 1, 0.0)
    assert recent_projects(tmp_path / "none") == []


def test_a_damaged_project_is_called_by_its_folder(tmp_path: Path) -> None:
    project = make_project(tmp_path / "room")
    project.update_info(name="My room")
    assert manage.name_of(project.folder) == "My room"
    (project.folder / "project.json").write_text("{")
    assert manage.name_of(project.folder) == "room"


def test_the_last_deleted_is_the_first_in_the_bin(tmp_path: Path) -> None:
    for name in ("b-2-1001", "a-1003", "c-3-1002"):
        make_project(tmp_path / manage.BIN / name)
    (tmp_path / manage.BIN / "no-project-1004").mkdir()
    assert [place.name for place in manage.projects_in_bin(tmp_path)] == ["a-1003", "c-3-1002", "b-2-1001"]
    assert manage.out_of_bin(tmp_path / manage.BIN / "b-2-1001", tmp_path) == tmp_path / "b-2"


def test_projects_of_any_name_are_found_by_their_address(tmp_path: Path) -> None:
    names = [b"b\xe9te", b"b\xe8te", "запись".encode(), b"plain"]
    folders = [make_project(Path(os.fsdecode(os.fsencode(tmp_path) + b"/" + name))).folder for name in names]
    assert {find_project(tmp_path, address_of(folder)) for folder in folders} == set(folders)
    assert all(address_of(folder).encode() for folder in folders)
    assert find_project(tmp_path, "../plain") is None


def test_too_many_copies_are_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(manage, "MAX_COPIES", 3)
    project = make_project(tmp_path / "room")
    duplicate_project(project.folder, tmp_path)
    with pytest.raises(ProjectError, match="rename or delete"):
        duplicate_project(project.folder, tmp_path)


def test_what_cannot_be_moved_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    project, other = make_project(tmp_path / "room"), make_project(tmp_path / "other")
    place = to_bin(project.folder, tmp_path)

    def refused(self: Path, target: Path) -> Path:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "rename", refused)
    with pytest.raises(ProjectError, match="room cannot be taken out of the bin"):
        manage.out_of_bin(place, tmp_path)
    with pytest.raises(ProjectError, match=r"other to the bin \(Permission denied\)"):
        to_bin(other.folder, tmp_path)
    with pytest.raises(ProjectError, match=r"^cannot copy to .*other-2 \(Permission denied\)"):
        duplicate_project(other.folder, tmp_path)
