"""The room as furniture meets it."""

from __future__ import annotations

from diorama_core.editing.footprints import footprint_of, within
from diorama_core.editing.room_frame import RoomFrame, door_floors, front_floor
from diorama_core.scene.types import Architecture, Scene
from tests.editing.objects import SOFA, item


def test_floor_before_furniture_and_doors_is_known() -> None:
    front = front_floor(SOFA)
    assert front is not None
    assert front[:, 0].min() >= footprint_of(SOFA)[:, 0].max() - 1e-6
    assert front_floor(item("plant", (0.3, 0.3, 0.9), 0, 0)) is None
    assert len(door_floors([item("door", (0.06, 0.9, 2.0), 0, 0), SOFA])) == 1


def test_a_room_without_architecture_has_a_frame() -> None:
    frame = RoomFrame.of(Scene(objects=(SOFA,)))
    assert within(footprint_of(SOFA)[None], frame.outline)[0]
    assert frame.walls == ()
    assert RoomFrame.of(Scene(architecture=Architecture())).floor_id is None
