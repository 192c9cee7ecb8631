from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import ProjectError, SceneError
from diorama_core.library.library_names import BUILT_IN
from diorama_core.pipeline.runner import StageRun
from diorama_core.project import backups, storage
from diorama_core.project.storage import Project
from diorama_core.scene.types import Architecture, Plane, Scene
from tests.pipeline.test_codec import example_inputs
from tests.scene.test_edits import _stack


def test_a_project_keeps_inputs_scene_and_textures(tmp_path: Path) -> None:
    project = Project.create(tmp_path / "room", name="My room")
    inputs = example_inputs()
    project.save_inputs(inputs, ["a note"])
    project.save_scene(_stack())
    project.save_textures({"wall_1": np.full((8, 8, 3), 120, np.uint8)})
    again = Project.open(tmp_path / "room")
    assert again.name == "My room"
    assert again.load_inputs() == inputs
    assert again.load_scene() == _stack()
    assert again.texture("wall_1") is not None
    assert again.shared_library_name == BUILT_IN
    assert (tmp_path / "room" / "photo.jpg").exists()
    assert json.loads((tmp_path / "room" / "project.json").read_text())["warnings"] == ["a note"]


def test_creating_twice_keeps_what_is_there(tmp_path: Path) -> None:
    Project.create(tmp_path / "room", name="first").save_scene(_stack())
    assert Project.create(tmp_path / "room", name="second").name == "first"


def test_an_emptied_scene_can_be_taken_back(tmp_path: Path) -> None:
    project = Project.create(tmp_path / "room")
    project.save_scene(_stack())
    project.save_scene(Scene())
    assert json.loads(project.backups()[0].read_text())["objects"]


def test_backups_rotate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backups, "BACKUP_EVERY_S", 0.0)
    project = Project.create(tmp_path / "room")
    for number in range(backups.MAX_BACKUPS + 5):
        project.save_scene(replace(_stack(), metrics={"number": float(number)}))
    assert len(project.backups()) == backups.MAX_BACKUPS


def test_a_folder_with_other_objects_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(ProjectError, match="holds other files"):
        Project.create(tmp_path)
    with pytest.raises(ProjectError, match="is a file"):
        Project.create(tmp_path / "letter.txt")
    with pytest.raises(ProjectError, match="not a project"):
        Project.open(tmp_path)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_an_unwritable_folder_is_one_clear_line(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(ProjectError, match="cannot write"):
        Project.create(tmp_path / "room")


def test_a_place_that_cannot_be_a_folder_is_one_clear_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ProjectError, match="cannot write"):
        Project.create(tmp_path / "file" / "room")


def test_damaged_files_are_named(tmp_path: Path) -> None:
    project = Project.create(tmp_path / "room")
    with pytest.raises(ProjectError, match="no scene yet"):
        project.load_scene()
    project.scene_path.write_text("{")
    with pytest.raises(SceneError, match="not valid JSON"):
        project.load_scene()
    (project.folder / "project.json").write_text("[]")
    with pytest.raises(ProjectError, match="not a Diorama project"):
        Project.open(project.folder)


def test_texture_names_cannot_leave_the_project(tmp_path: Path) -> None:
    project = Project.create(tmp_path / "room")
    project.save_textures({"../../outside": np.zeros((4, 4, 3), np.uint8)})
    assert not (tmp_path.parent / "outside.jpg").exists()
    assert (project.folder / "textures" / "outside.jpg").exists()


def test_how_long_stages_took_is_noted(tmp_path: Path) -> None:
    project = Project.create(tmp_path / "room")
    project.save_stage_runs([StageRun("depth", "Depth()", 0.25, cached=False)])
    noted = json.loads((project.folder / "project.json").read_text())["stages"]
    assert noted == [{"stage": "depth", "used": "Depth()", "seconds": 0.25, "cached": False}]


def test_pictures_beyond_the_limit_and_those_that_are_missing_are_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    project = Project.create(tmp_path / "room")
    wall = Plane("wall_1", "wall", np.array([[0, 0, 0], [2, 0, 0], [2, 0, 2.0]]), texture="a")
    floor = Plane("floor", "floor", np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0.0]]), texture="b")
    lost = replace(floor, id="floor_2", texture="c")
    scene = Scene(architecture=Architecture((wall, floor, lost)))
    project.save_textures({name: np.full((8, 8, 3), 120, np.uint8) for name in "ab"})
    assert set(project.textures(scene)) == {"a", "b"}
    monkeypatch.setattr(storage, "MAX_TEXTURE_PIXELS", 64)
    assert set(project.textures(scene)) == {"a"}
