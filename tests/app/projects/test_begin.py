from __future__ import annotations

from pathlib import Path

import pytest

from diorama_app.projects import manage
from diorama_app.projects.begin import begin_project, fresh_folder
from diorama_core.artefacts import Inputs
from diorama_core.errors import ProjectError
from diorama_core.perception.inputs import ReadInputs
from diorama_core.project.storage import Project
from tests.app.small_room import plain_photo


def test_a_photo_is_a_listed_project_without_a_scene(tmp_path: Path) -> None:
    read = ReadInputs(Inputs(plain_photo()), ("it is dark",))
    made = begin_project(tmp_path, "my room.JPG", read, b"as it came")
    assert made.folder.name == "my-room"
    assert made.name == "my room"
    again = Project.open(made.folder)
    assert not again.has_scene
    assert again.has_photo
    assert again.uploads() == {"photo": b"as it came"}
    assert again.info()["warnings"] == ["it is dark"]
    assert manage.recent_projects(tmp_path) == [made.folder]
    assert begin_project(tmp_path, "my room.JPG", read, b"x").folder.name == "my-room-2"
    copy = manage.duplicate_project(made.folder, tmp_path)
    assert not copy.has_scene


def test_nothing_is_left_behind_where_it_cannot_be_saved(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*given: object) -> None:
        raise ProjectError("no space left")

    monkeypatch.setattr(Project, "save_inputs", full)
    with pytest.raises(ProjectError):
        begin_project(tmp_path, "room.jpg", ReadInputs(Inputs(plain_photo())), b"x")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("name", "folder"), [("../../etc/x.png", "x"), ("Zimmer Ä.jpg", "Zimmer"), ("...", "room")])
def test_folders_have_plain_names(tmp_path: Path, name: str, folder: str) -> None:
    assert fresh_folder(tmp_path, name) == tmp_path / folder
