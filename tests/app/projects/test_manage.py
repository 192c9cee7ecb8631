"""Projects in their folder: copies that are whole or not there, and names of any bytes."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from diorama_app.projects import manage
from diorama_app.projects.manage import address_of, duplicate_project, find_project, recent_projects, to_bin
from diorama_core.errors import ProjectError
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
    with pytest.raises(ProjectError, match=r"^cannot copy to .*room-2"):
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


def test_what_cannot_leave_the_bin_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    project = make_project(tmp_path / "room")
    place = to_bin(project.folder, tmp_path)

    def refused(self: Path, target: Path) -> Path:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "rename", refused)
    with pytest.raises(ProjectError, match="room cannot be taken out of the bin"):
        manage.out_of_bin(place, tmp_path)
