"""`diorama import`, and a film from `diorama picture`, as commands."""

from __future__ import annotations

import inspect
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from PIL import Image

from diorama_app.cli import main
from diorama_core.export import export_scene
from diorama_core.export.turntable import write_turntable
from diorama_core.library.catalogue import built_in_library
from diorama_core.project.storage import Project
from diorama_core.scene.types import Architecture, Pose, Scene, SceneObject, Support
from tests.cli.running import refused, told
from tests.primitives import box_room, eye_camera


@pytest.fixture
def furnished() -> Scene:
    library = built_in_library()
    shape = library.in_category("chair")[0]
    chair = SceneObject(
        "c", "chair", "chair", shape.id, shape.size_m, Pose.upright((0.5, 3.0, shape.size_m[2] / 2), 0.4)
    )
    planes = tuple(replace(p, texture="w") if p.id == "back" else p for p in box_room().planes)
    return Scene(eye_camera(), Architecture(planes), (chair,), (Support("c", "floor"),))


def test_an_exported_file_becomes_the_same_project(tmp_path, furnished: Scene, capsys) -> None:
    picture = np.full((64, 64, 3), 200, np.uint8)
    export_scene(furnished, built_in_library(), tmp_path / "room.glb", "glb", textures={"w": picture})
    command = ["import", str(tmp_path / "room.glb"), "-o", str(tmp_path / "back")]
    assert "1 object, 6 planes" in told(capsys, command)
    project = Project.open(tmp_path / "back")
    assert project.load_scene() == furnished
    texture = project.texture("w")
    assert texture is not None
    assert np.abs(texture.astype(int) - 200).max() <= 2
    assert "has a scene already" in refused(capsys, command)


def test_what_cannot_be_read_is_one_line_and_leaves_no_project(tmp_path, capsys) -> None:
    (tmp_path / "room.glb").write_bytes(b"nothing")
    assert refused(capsys, ["import", str(tmp_path / "room.glb"), "-o", str(tmp_path / "p")])
    assert not (tmp_path / "p").exists()


def test_a_unit_is_given_where_the_file_is_wrong_about_its_own(tmp_path, capsys) -> None:
    floor = trimesh.creation.box(bounds=[(-8, -0.1, -8), (8, 0, 8)])
    stool = trimesh.creation.box(bounds=[(0, 0, 0), (1.5, 1.75, 1.5)])
    trimesh.Scene({"floor": floor, "stool": stool}).export(tmp_path / "room.glb")
    assert main(["import", str(tmp_path / "room.glb"), "-o", str(tmp_path / "room"), "--unit", "foot"]) == 0
    (found,) = Project.open(tmp_path / "room").load_scene().objects
    np.testing.assert_allclose(sorted(found.size_m), 0.3048 * np.array([1.5, 1.5, 1.75]), rtol=1e-4)
    assert "taken for" not in capsys.readouterr().err


def test_a_film_of_a_project(tmp_path, furnished: Scene, monkeypatch) -> None:
    project = Project.create(tmp_path / "p")
    project.save_scene(furnished)
    arguments = [
        "picture",
        str(tmp_path / "p"),
        "-o",
        str(tmp_path / "f.gif"),
        "--view",
        "turntable",
        "--size",
        "64x48",
    ]
    monkeypatch.setitem(inspect.unwrap(write_turntable).__kwdefaults__, "frames", 2)
    assert main(arguments) == 0
    with Image.open(tmp_path / "f.gif") as film:
        assert film.n_frames == 2
