"""Scene states, read as SceneEval reads them: its field names, its defaults, its way of placing a model."""

from __future__ import annotations

import io
import json
import zipfile

import numpy as np
import pytest
import trimesh

from diorama_core.export import export_scene
from diorama_core.scene.types import Plane, Pose, Scene, SceneObject, Support
from tests.export import gltf_reader
from tests.primitives import PrimitiveLibrary, box_room, furnished_room

LIBRARY = PrimitiveLibrary()


@pytest.fixture
def state(tmp_path) -> dict:
    export_scene(furnished_room(LIBRARY), LIBRARY, tmp_path / "scene_0.json", "scene-state")
    return json.loads((tmp_path / "scene_0.json").read_text())


def test_head_says_format_units_and_axes(state: dict) -> None:
    scene = state["scene"]
    assert state["format"] == "sceneState"
    assert (scene["version"], scene["arch"]["version"]) == ("scene@1.0.2", "arch@1.0.2")
    assert (scene["unit"], scene["up"], scene["front"]) == (1.0, [0, 0, 1], [0, 1, 0])


def test_elements_are_of_the_three_known_types(state: dict) -> None:
    elements = state["scene"]["arch"]["elements"]
    assert {e["type"] for e in elements} == {"Floor", "Ceiling", "Wall"}
    for wall in (e for e in elements if e["type"] == "Wall"):
        assert len(wall["points"]) == 2
        assert wall["height"] == pytest.approx(2.6)
    walls = state["scene"]["arch"]["regions"][0]["walls"]
    assert [elements[n]["type"] for n in walls] == ["Wall"] * 4


def test_objects_say_who_carries_them(state: dict) -> None:
    objects = {o["id"]: o for o in state["scene"]["object"]}
    assert [o["index"] for o in state["scene"]["object"]] == list(range(5))
    assert objects["b"]["parentId"] == "t"
    assert objects["b"]["parentIndex"] == objects["t"]["index"]
    assert (objects["t"]["parentId"], objects["t"]["parentIndex"]) == ("floor", -1)
    assert objects["p"]["supportRelation"] == "mounted on"
    for item in objects.values():
        source, name = item["modelId"].split(".")  # readers split at the one full stop
        assert source == "diorama"
        assert "/" not in name


def test_models_placed_by_the_matrix_are_where_the_scene_says(tmp_path) -> None:
    scene = furnished_room(LIBRARY)
    export_scene(scene, LIBRARY, tmp_path / "room.zip", "scene-state")
    with zipfile.ZipFile(tmp_path / "room.zip") as archive:
        state = json.loads(archive.read("room.json"))
        for placed in state["scene"]["object"]:
            name = placed["modelId"].split(".")[1]
            data = archive.read(f"assets/{name}/{name}.glb")
            gltf_reader.check(data)
            model = trimesh.load_scene(io.BytesIO(data), file_type="glb").to_geometry()
            matrix = np.reshape(placed["transform"]["data"], (4, 4)).T
            here = trimesh.transform_points(model.vertices, matrix)
            item = scene.object(placed["id"])
            there = item.pose.apply(LIBRARY.mesh(item.shape_id).vertices)
            np.testing.assert_allclose(here.min(axis=0), there.min(axis=0), atol=1e-5)
            np.testing.assert_allclose(here.max(axis=0), there.max(axis=0), atol=1e-5)
            said = json.loads(archive.read(f"assets/{name}/data.json"))["annotations"]
            assert said["category"] == item.category


def test_matrix_and_vectors_agree(state: dict) -> None:
    from scipy.spatial.transform import Rotation

    for item in state["scene"]["object"]:
        t = item["transform"]
        R = Rotation.from_quat(t["rotation"]).as_matrix()
        matrix = np.reshape(t["data"], (4, 4)).T
        np.testing.assert_allclose(matrix[:3, :3], R * np.array(t["scale"]), atol=1e-9)
        np.testing.assert_allclose(matrix[:3, 3], t["translation"], atol=1e-9)


def test_doors_are_holes_from_the_walls_first_point(tmp_path) -> None:
    door = SceneObject("d", "door", "door", "print", (0.02, 0.8, 0.6), Pose.upright((0.5, 4.99, 0.3), -np.pi / 2))
    scene = Scene(None, box_room(), (door,), (Support("d", "back", "mounted on"),))
    export_scene(scene, LIBRARY, tmp_path / "s.json", "scene-state")
    elements = json.loads((tmp_path / "s.json").read_text())["scene"]["arch"]["elements"]
    (hole,) = next(e for e in elements if e["id"] == "back")["holes"]
    assert hole["type"] == "Door"
    np.testing.assert_allclose([hole["box"]["min"], hole["box"]["max"]], [[2.1, 0], [2.9, 0.6]], atol=1e-6)


def test_a_scene_without_walls_is_written(tmp_path) -> None:
    floor = Plane("floor", "floor", np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float))
    from diorama_core.scene.types import Architecture

    export_scene(Scene(architecture=Architecture((floor,))), LIBRARY, tmp_path / "s.json", "scene-state")
    arch = json.loads((tmp_path / "s.json").read_text())["scene"]["arch"]
    assert [e["type"] for e in arch["elements"]] == ["Floor"]
