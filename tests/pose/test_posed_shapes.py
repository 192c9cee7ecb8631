"""The order of one object's posed shapes, and what decided which way it faces."""

from __future__ import annotations

import numpy as np

from diorama_core.pose import RenderAndCompare
from diorama_core.pose.posed_shapes import PosedShape, ordered_shapes
from diorama_core.progress import Progress
from diorama_core.scene.types import Pose
from tests.pose.rooms import LIBRARY, Room, camera_at, standing


def test_shapes_are_ordered_by_rank_and_then_by_name() -> None:
    pose = Pose(np.eye(3), np.zeros(3), np.ones(3))
    shapes = [PosedShape(LIBRARY.shape(name), pose, 0.1, 0.0) for name in ("table", "chair", "bed")]
    found = ordered_shapes(shapes, {"table": 0.0, "chair": 0.0, "bed": 1.0})
    assert [one.shape.id for one in found] == ["bed", "chair", "table"]


def test_candidates_say_why_they_face_as_they_do() -> None:
    room = Room(camera_at(), (standing("chair", 0.2, 2.6, 30.0),), (0,))
    posed = RenderAndCompare(LIBRARY).pose(
        room.inputs, room.objects, room.geometry, room.depth(measured=False), room.ranked(), Progress()
    )
    reasons = posed[0].reasons
    assert {(r.object_id, r.decision) for r in reasons} == {(posed[0].object_id, "front")}
    assert "picture" in {r.term for r in reasons}
