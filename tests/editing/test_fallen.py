"""What fell is held by what it lies on then; what stayed is held as before."""

from __future__ import annotations

from diorama_core.editing.fallen import held_again
from diorama_core.scene import edits
from tests.primitives import PrimitiveLibrary, furnished_room


def test_what_fell_off_is_held_by_the_floor() -> None:
    room = furnished_room(PrimitiveLibrary())
    ball = next(o for o in room.objects if o.shape_id == "ball")
    table = room.support_of(ball.id)
    assert table is not None
    beside = room.object(table.parent).corners_world[:, :2].max(axis=0) + 0.3
    to_floor = float(ball.size_m[2]) / 2 - float(ball.pose.position[2])
    low = ball.pose.moved((*(beside - ball.pose.position[:2]), to_floor))
    after = held_again(room, edits.place(room, {ball.id: low}))
    edge = after.support_of(ball.id)
    assert edge is not None
    assert edge.parent == "floor"
    assert held_again(room, room) == room
