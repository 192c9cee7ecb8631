"""One object against its object: the conventions of fronts, carriers and colours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.evaluation.adapters.photo_annotations import AnnotatedObject
from diorama_core.evaluation.metrics.annotated import front_deg, measure, not_built, shape_iou
from diorama_core.geometry.projection import visible_bounds
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene import edits
from diorama_core.scene.types import Camera, Candidate, Intrinsics, Pose, Scene, SceneObject, Support, yaw_rotation
from tests.primitives import PrimitiveLibrary, place
from tests.synthetic_rooms import look

LIBRARY = built_in_library()
CAMERA = Camera(
    Intrinsics(640, 480, 500, 500, 320, 240),
    np.array([[1.0, 0, 0, 0], [0, 0, 1, -4], [0, -1, 0, 1.2], [0, 0, 0, 1]]),
)
"""Looks along +y from (0, -4), upright."""
PRIMITIVES = PrimitiveLibrary()
SCENE = Scene(look(0, 14, 1.5, 70, (160, 120)), objects=(place(PRIMITIVES, "table", "table", (0.3, 2.6, 0.36)),))


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


def test_an_outline_agrees_with_its_own_box_less_when_moved_and_not_at_all_without_a_camera() -> None:
    corners = SCENE.camera.to_camera(SCENE.object("table").corners_world)
    box = tuple(visible_bounds(corners[None], SCENE.camera.intrinsics)[0][0])
    moved = edits.move(SCENE, "table", SCENE.object("table").pose.move((0.5, 0, 0)))
    ious = [shape_iou(s, "table", box, PRIMITIVES) for s in (SCENE, moved, replace(SCENE, camera=None), Scene(CAMERA))]
    assert ious[0] == pytest.approx(1.0, abs=0.02)
    assert ious[1] < ious[0] - 0.2
    assert ious[2:] == [0.0, 0.0]
