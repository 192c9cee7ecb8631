from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.evaluation.metrics.photo_agreement import agreement, shape_iou
from diorama_core.geometry.projection import visible_bounds
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene
from tests.primitives import PrimitiveLibrary, place
from tests.synthetic_rooms import Shot, box_room, cuboid, look, shoot

LIBRARY = PrimitiveLibrary()
TABLE = cuboid("table", (0.3, 2.6, 0), (0.8, 1.4, 0.72), 0)
SHOT: Shot = shoot(look(0, 14, 1.5, 70, (160, 120)), box_room(-2.2, 2.2, 4.0, 2.6), (TABLE,), ("table",))
SCENE = Scene(SHOT.camera, objects=(place(LIBRARY, "table", "table", (0.3, 2.6, 0.36)),))


def box_of(scene: Scene) -> tuple[float, ...]:
    corners = scene.camera.to_camera(scene.object("table").corners_world)
    return tuple(visible_bounds(corners[None], scene.camera.intrinsics)[0][0])


def test_a_scene_that_is_the_photo_agrees_wholly() -> None:
    objects = (replace(SHOT.objects[0], box=box_of(SCENE)),)
    (row,) = agreement(objects, SHOT.geometry, SCENE, SCENE, LIBRARY)
    assert row.cuboid_iou == pytest.approx(1.0, abs=0.01)
    assert row.shape_iou == row.final_iou == pytest.approx(1.0, abs=0.02)
    assert row.plausible
    assert row.size_m == pytest.approx((0.8, 1.4, 0.72))


def test_what_moved_agrees_less_and_what_is_missing_not_at_all() -> None:
    moved = edits.move(SCENE, "table", SCENE.object("table").pose.moved((0.5, 0, 0)))
    (row,) = agreement(SHOT.objects, SHOT.geometry, SCENE, moved, LIBRARY)
    assert row.final_iou < row.shape_iou - 0.2
    empty = Scene(SHOT.camera)
    (gone,) = agreement(SHOT.objects, replace(SHOT.geometry, cuboids=()), empty, empty, LIBRARY)
    assert (gone.cuboid_iou, gone.shape_iou, gone.final_iou) == (0.0, 0.0, 0.0)
    assert not gone.plausible
    assert shape_iou(replace(SCENE, camera=None), "table", SHOT.objects[0].box, LIBRARY) == 0.0


@pytest.mark.parametrize(("height", "plausible"), [(0.2, False), (0.36, True), (1.0, True), (1.2, False)])
def test_sizes_are_judged_by_category(height: float, plausible: bool) -> None:
    item = SCENE.object("table")
    scaled = replace(item, pose=Pose(item.pose.R_world_object, item.pose.position, np.array([1, 1, height / 0.72])))
    scene = replace(SCENE, objects=(scaled,))
    (row,) = agreement(SHOT.objects, SHOT.geometry, SCENE, scene, LIBRARY)
    assert row.plausible is plausible
