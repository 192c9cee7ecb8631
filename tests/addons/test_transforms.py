"""Poses, sizes and edits of what was done in Blender, beside what the scene makes of them."""

from __future__ import annotations

import ast
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from addons.blender.transforms import (
    MAX_EDITS,
    Matrix,
    OpenedObject,
    UnsendableError,
    changes,
    matrix_of_entry,
    moved_ids,
    opened_object,
)
from diorama_core.scene.schema import scene_to_json
from diorama_core.scene.types import Pose, Scene, Support, yaw_rotation
from diorama_core.text.edit_plan import EditPlan
from diorama_core.text.editing_by_words import apply_edits
from tests.app.small_room import PlainLibrary, furnished_scene

Matrices = dict[str, Matrix]
ADDON = Path(__file__).parents[2] / "addons" / "blender"


def opened_room(scene: Scene) -> tuple[list[OpenedObject], Matrices]:
    """Objects as they are opened, and their matrices."""
    opened = [opened_object(entry) for entry in json.loads(scene_to_json(scene))["objects"]]
    return opened, {o.id: o.matrix for o in opened}


def sent(scene: Scene, opened: list[OpenedObject], now: Matrices) -> Scene:
    """What the scene becomes by the edits, checked as a request's are."""
    plan = EditPlan.model_validate({"edits": changes(opened, now).edits})
    return apply_edits(plan.edits, scene, PlainLibrary()).scene


def rows(matrix: np.ndarray) -> Matrix:
    """As Blender gives a matrix, with its rounding."""
    return tuple(tuple(float(v) for v in row) for row in matrix.astype(np.float32))


def turned(matrix: Matrix, yaw_rad: float, shift: Any = (0, 0, 0), scale: Any = (1, 1, 1)) -> Matrix:
    made = np.array(matrix)
    made[:3, :3] = yaw_rotation(yaw_rad) @ made[:3, :3] * np.array(scale)
    made[:3, 3] += shift
    return rows(made)


def test_a_matrix_is_that_of_the_pose() -> None:
    scene = furnished_scene()
    for entry in json.loads(scene_to_json(scene))["objects"]:
        np.testing.assert_allclose(matrix_of_entry(entry), scene.object(entry["id"]).pose.matrix, atol=1e-6)


def test_blender_s_rounding_is_no_change() -> None:
    opened, now = opened_room(furnished_scene())
    now = {i: rows(np.array(m)) for i, m in now.items()}
    assert changes(opened, now).edits == ()
    assert moved_ids(opened, now) == ()


@given(
    st.floats(-3.1, 3.1),
    st.tuples(*[st.floats(-0.5, 0.5)] * 3),
    st.tuples(*[st.floats(0.5, 2.0)] * 3),
    st.sampled_from(["chair_1", "lamp_1", "picture_1"]),
)
@settings(max_examples=15)
def test_the_scene_has_an_object_where_blender_has_it(yaw: float, shift: Any, scale: Any, object_id: str) -> None:
    scene = furnished_scene()
    opened, now = opened_room(scene)
    now[object_id] = turned(now[object_id], yaw, shift, scale)
    after = sent(scene, opened, now)
    for item in after.objects:
        np.testing.assert_allclose(item.pose.matrix, now[item.id], atol=3e-4)


def test_what_stands_on_a_moved_object_goes_along_without_an_edit_of_its_own() -> None:
    scene = furnished_scene()
    opened, now = opened_room(scene)
    to_table = turned(now["table_1"], 0.5, (0.3, 0.1, 0))
    delta = np.array(to_table) @ np.linalg.inv(np.array(now["table_1"]))
    now |= {"table_1": to_table, "lamp_1": rows(delta @ np.array(now["lamp_1"]))}
    assert [e["objects"] for e in changes(opened, now).edits] == [["table_1"]]
    np.testing.assert_allclose(sent(scene, opened, now).object("lamp_1").pose.matrix, now["lamp_1"], atol=1e-5)


@pytest.mark.parametrize("scale", [(1, 1, 1), (1.0, 1.2, 1.4)])
def test_what_stayed_in_blender_stays_where_its_support_moves(scale: Any) -> None:
    scene = furnished_scene()
    opened, now = opened_room(scene)
    now["table_1"] = turned(now["table_1"], 0.5, (0.3, 0.1, 0), scale)
    after = sent(scene, opened, now)
    np.testing.assert_allclose(after.object("lamp_1").pose.matrix, now["lamp_1"], atol=1e-5)
    np.testing.assert_allclose(after.object("table_1").pose.matrix, now["table_1"], atol=1e-5)


def test_what_stood_on_a_deleted_object_is_deleted_only_where_blender_deleted_it() -> None:
    scene = furnished_scene()
    opened, now = opened_room(scene)
    del now["table_1"]
    after = sent(scene, opened, now)
    assert not after.has_object("table_1")
    assert after.object("lamp_1").pose == scene.object("lamp_1").pose
    assert after.support_of("lamp_1") is None
    del now["lamp_1"]
    assert {o.id for o in sent(scene, opened, now).objects} == {"chair_1", "chair_2", "picture_1"}


def test_what_stood_on_a_deleted_rug_stands_on_the_floor() -> None:
    rug = OpenedObject("rug_1", "rug", opened_room(furnished_scene())[0][0].matrix, (1, 2, 0.01), "floor")
    chair = OpenedObject("chair_9", "chair", rug.matrix, (0.5, 0.5, 0.9), "rug_1")
    edits = changes([rug, chair], {"chair_9": chair.matrix}).edits
    assert edits[0] == {"do": "support", "objects": ["chair_9"], "parent": "floor"}
    assert edits[1] == {"do": "remove", "objects": ["rug_1"]}


def test_a_tilt_is_told_and_not_sent() -> None:
    opened, now = opened_room(furnished_scene())
    tilt = np.eye(4)
    tilt[1:3, 1:3] = [[0.9, -np.sqrt(1 - 0.81)], [np.sqrt(1 - 0.81), 0.9]]
    now["chair_1"] = rows(np.array(now["chair_1"]) @ tilt)
    assert "is not tilted" in changes(opened, now).notes[0]


def test_what_hangs_at_a_tilt_keeps_it_when_it_is_turned() -> None:
    scene = furnished_scene()
    leaning = np.array([[0.8, 0, -0.6], [0, 1, 0], [0.6, 0, 0.8]])
    item = scene.object("picture_1")
    item = replace(item, pose=Pose(leaning, item.pose.position, item.pose.scale))
    scene = replace(scene, objects=(*scene.objects[:-1], item))
    opened, now = opened_room(scene)
    now["picture_1"] = turned(now["picture_1"], 0.4, (0.1, 0, 0))
    assert changes(opened, now).notes == ()
    np.testing.assert_allclose(sent(scene, opened, now).object("picture_1").pose.matrix, now["picture_1"], atol=1e-5)


def test_what_has_no_meaning_in_the_scene_is_one_line() -> None:
    opened, now = opened_room(furnished_scene())
    for scale in ((-1, 1, 1), (0, 1, 1)):
        with pytest.raises(UnsendableError, match=r"chair \(chair_1\) is mirrored or has no size"):
            changes(opened, {**now, "chair_1": turned(now["chair_1"], 0, scale=scale)})
    many = [replace(opened[2], id=f"chair_{i}") for i in range(MAX_EDITS + 1)]
    with pytest.raises(UnsendableError, match="more than the 60"):
        changes(many, {o.id: turned(o.matrix, 0, (1, 0, 0)) for o in many})


def test_supports_in_a_circle_end() -> None:
    opened, now = opened_room(furnished_scene())
    ring = [replace(opened[0], parent="lamp_1"), *opened[1:]]
    assert changes(ring, {**now, "table_1": turned(now["table_1"], 0, (1, 0, 0))}).edits
    assert Support("lamp_1", "table_1") in furnished_scene().supports


@pytest.mark.parametrize("path", sorted(ADDON.glob("*.py")), ids=lambda p: p.name)
def test_the_add_on_needs_blender_s_python_alone(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text())):
        names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
        names += [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else []
        assert {n.partition(".")[0] for n in names} <= {*sys.stdlib_module_names, "bpy", "mathutils"}
