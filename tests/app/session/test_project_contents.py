from __future__ import annotations

import pytest

from diorama_app.session.project_contents import MAX_NOTE_LENGTH, MAX_NOTES, build_notes, read_project
from diorama_core.errors import SceneError
from tests.app.small_room import furnished_scene, make_project


@pytest.fixture
def project(tmp_path):
    return make_project(tmp_path / "demo")


def test_a_sound_project_is_read_whole(project) -> None:
    project.update_info(notes=["the floor was guessed", "the floor was guessed", "two boxes overlap"])
    read = read_project(project)
    assert read.scene == furnished_scene()
    assert read.inputs is not None
    assert read.notes == ("the floor was guessed", "two boxes overlap")
    assert read.damage == ()


def test_a_photo_that_cannot_be_read_is_named_and_the_scene_is_shown(project) -> None:
    (project.stages_folder / "inputs.zip").write_bytes(b"not a zip")
    read = read_project(project)
    assert read.scene == furnished_scene()
    assert read.inputs is None
    assert len(read.damage) == 1
    assert "inputs.zip" in read.damage[0]


def test_a_damaged_scene_gives_way_to_the_newest_version_that_can_be_read(project) -> None:
    good = project.scene_path.read_bytes()
    (project.folder / "backups").mkdir(exist_ok=True)
    (project.folder / "backups" / "scene-n000001-20260101T000000Z.json").write_bytes(good)
    project.scene_path.write_text("{")
    read = read_project(project)
    assert read.scene == furnished_scene()
    assert "is shown, since" in read.damage[0]


def test_without_any_version_nothing_is_read(project) -> None:
    project.scene_path.write_text("{")
    with pytest.raises(SceneError):
        read_project(project)


def test_notes_are_bounded_and_anything_else_is_none(project) -> None:
    project.update_info(notes=[f"{i} " + "x" * 1000 for i in range(200)])
    notes = build_notes(project)
    assert len(notes) == MAX_NOTES
    assert max(map(len, notes)) <= MAX_NOTE_LENGTH
    project.update_info(notes={"not": "a list"})
    assert build_notes(project) == ()
