"""One object against its object: the conventions of fronts, carriers and colours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.evaluation.adapters.photo_annotations import AnnotatedObject
from diorama_core.evaluation.metrics.annotated import agreement, front_deg, measure, not_built, shape_iou
from diorama_core.geometry.projection import visible_bounds
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene import edits
from diorama_core.scene.types import Camera, Candidate, Intrinsics, Pose, Scene, SceneObject, Support, yaw_rotation
from tests.primitives import PrimitiveLibrary, place
from tests.synthetic_rooms import Shot, box_room, cuboid, look, shoot

LIBRARY = built_in_library()
CAMERA = Camera(
    Intrinsics(640, 480, 500, 500, 320, 240),
    np.array([[1.0, 0, 0, 0], [0, 0, 1, -4], [0, -1, 0, 1.2], [0, 0, 0, 1]]),
)
"""Looks along +y from (0, -4), upright."""
PRIMITIVES = PrimitiveLibrary()
TABLE = cuboid("table", (0.3, 2.6, 0), (0.8, 1.4, 0.72), 0)
SHOT: Shot = shoot(look(0, 14, 1.5, 70, (160, 120)), box_room(-2.2, 2.2, 4.0, 2.6), (TABLE,), ("table",))
SCENE = Scene(SHOT.camera, objects=(place(PRIMITIVES, "table", "table", (0.3, 2.6, 0.36)),))


def placed(shape_id: str, yaw_deg: float, colour=None, name="it", others=()) -> SceneObject:
    shape = LIBRARY.shape(shape_id)
    pose = Pose(yaw_rotation(np.radians(yaw_deg)), np.array([0.0, 0.0, shape.size_m[2] / 2]), np.ones(3))
    candidates = tuple(Candidate(i, LIBRARY.shape(i).size_m, 0.5, pose) for i in (shape_id, *others))
    pixels = CAMERA.project(pose.apply(LIBRARY.mesh(shape_id).vertices))
    box = tuple(float(v) for v in (*pixels.min(axis=0), *pixels.max(axis=0)))
    return SceneObject(name, "chair", "chair", shape_id, shape.size_m, pose, candidates, 1, box, colour=colour)


def annotated(**more) -> AnnotatedObject:
    return AnnotatedObject.model_validate(
        {"bbox": (270, 200, 370, 380), "class": "chair", "kind": "office chair", "on": "floor", **more}
    )


@pytest.mark.parametrize(("yaw_deg", "expected"), [(-90, 0), (0, 90), (90, 180), (180, 270)])
def test_fronts_are_0_toward_the_camera_90_to_the_right_180_away_270_left(yaw_deg, expected) -> None:
    assert front_deg(placed("chair-slat-oak", yaw_deg), CAMERA) == pytest.approx(expected, abs=1e-6)


def test_what_is_compared() -> None:
    item = placed("chair-slat-oak", -60, (1.0, 0.0, 0.0), others=("office-chair-mesh-black",))
    scene = Scene(camera=CAMERA, objects=(item,))
    stated = annotated(bbox=item.box_px, front=0, colour=(255, 0, 0), attributes={"arms": "no"})
    found = measure("p", 0, stated, item, scene, LIBRARY, {}, np.array([1.0, 0.0, 0.0]))
    assert found.loose
    assert (found.kind_first, found.kind_among) == (False, True)
    assert found.form == {"arms": True}
    assert found.colour_difference == pytest.approx(0.0, abs=1e-3)
    assert found.front_error_deg == pytest.approx(30.0)
    assert found.front
    assert found.supporter is False
    assert found.iou == pytest.approx(1.0, abs=0.01)


def test_turns_that_look_the_same_are_the_same_front() -> None:
    item = placed("table-oak-classic", 90)
    found = measure("p", 0, annotated(front=0), item, Scene(camera=CAMERA, objects=(item,)), LIBRARY, {})
    assert found.front_error_deg == pytest.approx(0.0, abs=1e-6)


def test_a_carrier_is_an_index_of_the_list() -> None:
    table, lamp = placed("table-oak-classic", 0, name="table"), placed("chair-slat-oak", 0, name="lamp")
    scene = Scene(camera=CAMERA, objects=(table, lamp), supports=(Support("lamp", "table"),))
    index_of = {"table": 3, "lamp": 5}
    assert measure("p", 5, annotated(on=3), lamp, scene, LIBRARY, index_of).supporter is True
    assert measure("p", 5, annotated(on="floor"), lamp, scene, LIBRARY, index_of).supporter is False


def test_what_was_not_built_is_wrong_and_an_opening_is_not_judged() -> None:
    missing = not_built("p", 0, annotated(front=10))
    assert (missing.kind_first, missing.kind_among, missing.supporter, missing.front) == (False,) * 4
    assert missing.iou == 0.0
    opening = not_built("p", 0, annotated(front=10), opening=True)
    assert opening.kind_first is None
    assert opening.front is None
    assert opening.iou is None


def box_of(scene: Scene) -> tuple[float, ...]:
    corners = scene.camera.to_camera(scene.object("table").corners_world)
    return tuple(visible_bounds(corners[None], scene.camera.intrinsics)[0][0])


def test_a_scene_that_is_the_photo_agrees_wholly() -> None:
    objects = (replace(SHOT.objects[0], box=box_of(SCENE)),)
    (row,) = agreement(objects, SHOT.geometry, SCENE, SCENE, PRIMITIVES)
    assert row.cuboid_iou == pytest.approx(1.0, abs=0.01)
    assert row.shape_iou == row.final_iou == pytest.approx(1.0, abs=0.02)
    assert row.plausible
    assert row.size_m == pytest.approx((0.8, 1.4, 0.72))


def test_what_moved_agrees_less_and_what_is_missing_not_at_all() -> None:
    moved = edits.move(SCENE, "table", SCENE.object("table").pose.move((0.5, 0, 0)))
    (row,) = agreement(SHOT.objects, SHOT.geometry, SCENE, moved, PRIMITIVES)
    assert row.final_iou < row.shape_iou - 0.2
    empty = Scene(SHOT.camera)
    (gone,) = agreement(SHOT.objects, replace(SHOT.geometry, cuboids=()), empty, empty, PRIMITIVES)
    assert (gone.cuboid_iou, gone.shape_iou, gone.final_iou) == (0.0, 0.0, 0.0)
    assert not gone.plausible
    assert shape_iou(replace(SCENE, camera=None), "table", SHOT.objects[0].box, PRIMITIVES) == 0.0


@pytest.mark.parametrize(("height", "plausible"), [(0.2, False), (0.36, True), (1.0, True), (1.2, False)])
def test_sizes_are_judged_by_category(height: float, plausible: bool) -> None:
    item = SCENE.object("table")
    scaled = replace(item, pose=Pose(item.pose.R_world_object, item.pose.position, np.array([1, 1, height / 0.72])))
    scene = replace(SCENE, objects=(scaled,))
    (row,) = agreement(SHOT.objects, SHOT.geometry, SCENE, scene, PRIMITIVES)
    assert row.plausible is plausible
