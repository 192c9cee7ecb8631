"""What fell is held by what it lies on then; what stayed is held as before."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.support_changes import reattach, why_not_on
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene
from tests.app.small_room import furnished_scene
from tests.primitives import PrimitiveLibrary, furnished_room


def test_what_fell_off_is_held_by_the_floor() -> None:
    room = furnished_room(PrimitiveLibrary())
    ball = next(o for o in room.objects if o.shape_id == "ball")
    table = room.support_of(ball.id)
    assert table is not None
    beside = room.object(table.parent).corners_world[:, :2].max(axis=0) + 0.3
    to_floor = float(ball.size_m[2]) / 2 - float(ball.pose.position[2])
    low = ball.pose.move((*(beside - ball.pose.position[:2]), to_floor))
    after = reattach(room, edits.place(room, {ball.id: low}))
    edge = after.support_of(ball.id)
    assert edge is not None
    assert edge.parent == "floor"
    assert reattach(room, room) == room


SIZES = {
    "sofa": (0.9, 2.0, 0.8),
    "mug": (0.09, 0.09, 0.1),
    "table": (0.8, 1.4, 0.74),
    "lamp": (0.3, 0.3, 0.5),
    "tray": (0.4, 0.6, 0.03),
    "stool": (0.35, 0.35, 0.45),
    "television": (0.1, 1.2, 0.7),
    "cabinet": (0.4, 1.4, 0.5),
}


def scene() -> Scene:
    one = furnished_scene().objects[0]
    made = [replace(one, id=n, label=n, shape_size_m=s, pose=Pose.upright(np.zeros(3), 0.0)) for n, s in SIZES.items()]
    return Scene(objects=tuple(made))


@pytest.mark.parametrize(("child", "parent"), [("sofa", "mug"), ("sofa", "stool"), ("table", "lamp")])
def test_the_absurd_is_refused_with_the_reason(child: str, parent: str) -> None:
    assert child in why_not_on(scene(), child, parent)


@pytest.mark.parametrize(
    ("child", "parent"),
    [("mug", "table"), ("lamp", "table"), ("lamp", "stool"), ("television", "cabinet"), ("mug", "tray"), ("x", "mug")],
)
def test_the_usual_is_not(child: str, parent: str) -> None:
    assert why_not_on(scene(), child, parent) == ""
