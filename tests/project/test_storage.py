from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.artefacts import Inputs, Photo
from diorama_core.errors import ProjectError, SceneError
from diorama_core.library.library_names import BUILT_IN
from diorama_core.library.store import StoredLibrary
from diorama_core.pipeline import codec
from diorama_core.pipeline.runner import StageRun
from diorama_core.project import backups, storage
from diorama_core.project.storage import Project
from diorama_core.scene.types import Architecture, PhotoMaterial, Plane, Scene
from tests.library.store.test_stored import ingested
from tests.pipeline.test_codec import example_inputs
from tests.scene.test_edits import _stack


@pytest.fixture
def project(tmp_path: Path) -> Project:
    return Project.create(tmp_path / "room")


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


def test_an_emptied_scene_can_be_taken_back(project: Project) -> None:
    project.save_scene(_stack())
    project.save_scene(Scene())
    assert json.loads(project.backups()[0].read_text())["objects"]


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


def test_damaged_files_are_named(project: Project) -> None:
    with pytest.raises(ProjectError, match="no scene yet"):
        project.load_scene()
    project.scene_path.write_text("{")
    with pytest.raises(SceneError, match="not valid JSON"):
        project.load_scene()
    (project.folder / "project.json").write_text("[]")
    with pytest.raises(ProjectError, match="not a Diorama project"):
        Project.open(project.folder)


def test_texture_names_cannot_leave_the_project(project: Project, tmp_path: Path) -> None:
    project.save_textures({"../../outside": np.zeros((4, 4, 3), np.uint8)})
    assert not (tmp_path.parent / "outside.jpg").exists()
    assert (project.folder / "textures" / "outside.jpg").exists()


def test_how_long_stages_took_is_noted(project: Project) -> None:
    project.save_stage_runs([StageRun("depth", "Depth()", 0.25, cached=False)])
    noted = json.loads((project.folder / "project.json").read_text())["stages"]
    assert noted == [{"stage": "depth", "used": "Depth()", "seconds": 0.25, "cached": False}]


def test_pictures_beyond_the_limit_and_those_that_are_missing_are_left_out(
    project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    wall = Plane("wall_1", "wall", np.array([[0, 0, 0], [2, 0, 0], [2, 0, 2.0]]), texture="a")
    floor = Plane("floor", "floor", np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0.0]]), texture="b")
    lost = replace(floor, id="floor_2", texture="c")
    scene = Scene(architecture=Architecture((wall, floor, lost)))
    project.save_textures({name: np.full((8, 8, 3), 120, np.uint8) for name in "ab"})
    assert set(project.textures(scene)) == {"a", "b"}
    monkeypatch.setattr(storage, "MAX_TEXTURE_PIXELS", 64)
    assert set(project.textures(scene)) == {"a"}


def test_only_what_programs_left_behind_counts_as_nothing(tmp_path: Path) -> None:
    for number, name in enumerate((".a.part", ".diorama.lock", ".mine", "notes.part")):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / name).write_text("")
        if name in (".mine", "notes.part"):
            with pytest.raises(ProjectError, match="holds other files"):
                Project.create(folder)
        else:
            assert Project.create(folder).info()["name"] == str(number)


def test_a_library_is_named_with_the_projects_own_shapes(tmp_path: Path) -> None:
    project = Project.create(tmp_path / "a+b")
    assert (project.library_name, project.shared_library_name) == (BUILT_IN, BUILT_IN)
    project.update_info(library=f"{BUILT_IN}+mine+{storage.OWN_SHAPES}")
    own = str(tmp_path.resolve() / "a%2Bb" / "shapes")
    assert project.library_name == f"{BUILT_IN}+mine+{own}"
    assert project.shared_library_name == f"{BUILT_IN}+mine"
    project.update_info(library=storage.OWN_SHAPES)
    assert project.shared_library_name == BUILT_IN


def test_another_projects_library_is_taken_with_its_own_shapes(tmp_path: Path) -> None:
    imported, plain = Project.create(tmp_path / "imported"), Project.create(tmp_path / "plain")
    imported.shapes_folder.mkdir()
    (imported.shapes_folder / "chair.glb").write_bytes(b"a chair")
    imported.update_info(library=storage.OWN_SHAPES)
    taker = Project.create(tmp_path / "taker")
    for _ in range(2):
        taker.take_shapes(imported)
        assert (taker.folder / "shapes" / "chair.glb").read_bytes() == b"a chair"
    assert taker.library_name == str(taker.folder.resolve() / "shapes")
    taker.take_shapes(plain)
    assert taker.library_name == BUILT_IN


def test_shapes_of_two_projects_come_together(tmp_path: Path) -> None:
    first, second = Project.create(tmp_path / "first"), Project.create(tmp_path / "second")
    for project, names in ((first, ("chair", "lamp")), (second, ("chair", "table"))):
        StoredLibrary(project.shapes_folder, create=True).add_all(ingested(name) for name in names)
        project.update_info(library=storage.OWN_SHAPES)
    first.take_shapes(second)
    assert {s.id for s in StoredLibrary(first.shapes_folder).shapes()} == {"chair", "lamp", "table"}
    assert StoredLibrary(first.shapes_folder).glb("table") == StoredLibrary(second.shapes_folder).glb("table")
    StoredLibrary(second.shapes_folder).add(ingested("lamp", height=2.0))
    with pytest.raises(ProjectError, match="'lamp'"):
        first.take_shapes(second)


def test_uploads_are_kept_as_they_came_until_they_are_taken_back(project: Project) -> None:
    assert project.uploads() == {}
    project.save_upload("depth", b"depth")
    project.save_upload("photo", b"photo")
    assert project.uploads() == {"photo": b"photo", "depth": b"depth"}
    assert (project.has_upload("depth"), project.has_upload("masks")) == (True, False)
    for _ in range(2):
        project.save_upload("depth", None)
    assert project.uploads() == {"photo": b"photo"}


def test_the_photo_is_that_of_the_inputs(project: Project) -> None:
    assert (project.has_photo, project.photo()) == (False, None)
    project.save_inputs(example_inputs())
    assert project.has_photo
    assert project.photo() == example_inputs().photo


def test_a_version_is_kept_once_a_minute_and_before_all_is_deleted(project: Project) -> None:
    one, other = (replace(_stack(), metrics={"number": number}) for number in (1.0, 2.0))
    assert not project.save_scene(_stack()), "there was none before"
    assert project.save_scene(one)
    assert not project.save_scene(other), "within a minute of the one before"
    assert project.save_scene(Scene())
    assert len(project.backups()) == 2


@pytest.mark.parametrize(
    ("version", "reason"),
    [(2, "by a newer Diorama"), ("1", "no version number"), (True, "no version number"), (None, "no version number")],
)
def test_projects_of_other_versions_are_not_opened(project: Project, version: object, reason: str) -> None:
    document = {**json.loads((project.folder / "project.json").read_text()), "version": version}
    (project.folder / "project.json").write_text(json.dumps(document))
    with pytest.raises(ProjectError, match=reason):
        Project.open(project.folder)


def test_a_project_whose_file_is_gone_is_one_line(project: Project) -> None:
    (project.folder / "project.json").unlink()
    with pytest.raises(ProjectError, match=r"project\.json cannot be read \(No such file"):
        project.info()


def test_inputs_have_the_size_of_their_photo(tmp_path: Path) -> None:
    project, pixel = Project.create(tmp_path / "room"), Photo(np.zeros((1, 1, 3), np.uint8), "dot.png", (1, 1))
    for inputs in (Inputs(pixel), Inputs(pixel, normals_camera=np.zeros((1, 1, 3), np.float32))):
        project.save_inputs(inputs)
        assert project.load_inputs() == inputs
    path = project.stages_folder / "inputs.zip"
    for inputs in (
        replace(example_inputs(), depth_m=np.zeros((20, 31), np.float32)),
        Inputs(Photo(np.zeros((0, 1, 3), np.uint8), "nothing.png", (1, 1))),
    ):
        path.write_bytes(codec.dump(inputs))
        with pytest.raises(ProjectError, match=r"inputs\.zip: the photo cannot be read back .*another size"):
            project.load_inputs()


def test_of_a_damaged_scene_the_newest_version_that_can_be_read_is_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(backups, "BACKUP_EVERY_S", 0.0)
    project = Project.create(tmp_path / "room", name="My room")
    scenes = [replace(_stack(), metrics=(("number", float(number)),)) for number in range(4)]
    for scene in scenes:
        project.save_scene(scene)
    assert project.newest_scene() == (scenes[3], "")
    project.scene_path.write_text("{")
    project.backups()[0].write_text("[]")
    scene, told = project.newest_scene()
    assert scene == scenes[1]
    assert told.startswith("My room: the version of ")
    assert "not valid JSON" in told
    for path in project.backups():
        path.write_text("[]")
    with pytest.raises(SceneError, match="not valid JSON"):
        project.newest_scene()


def test_pictures_of_objects_are_read_and_pixels_are_counted(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    materials = (PhotoMaterial("wood", (0.5, 0.5, 0.5), "a"), PhotoMaterial("fabric", (0.5, 0.5, 0.5)))
    first, *others = _stack().objects
    scene = replace(_stack(), objects=(replace(first, photo_materials=materials), *others))
    wall = Plane("wall_1", "wall", np.array([[0, 0, 0], [2, 0, 0], [2, 0, 2.0]]), photo_texture="b")
    scene = replace(scene, architecture=Architecture((wall,)))
    project.save_textures({name: np.full((4, 6, 3), 120, np.uint8) for name in "ab"})
    monkeypatch.setattr(storage, "MAX_TEXTURE_PIXELS", 48)
    assert set(project.textures(scene)) == {"a", "b"}
    monkeypatch.setattr(storage, "MAX_TEXTURE_PIXELS", 47)
    assert set(project.textures(scene)) == {"a"}
