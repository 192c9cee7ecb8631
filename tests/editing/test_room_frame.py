"""Walls seen from inside: places along and before them. The room as furniture meets it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from diorama_core.editing.footprints import footprint_of, lie_within
from diorama_core.editing.room_frame import RoomFrame, WallLine, door_floors, front_floor
from diorama_core.scene.types import Architecture, Scene
from tests.editing.objects import SOFA, item

metres = st.floats(-5.0, 5.0)


def test_what_stands_at_the_far_wall_of_a_room_looks_back_into_it() -> None:
    wall = WallLine("far", np.array([-2.0, 3.0]), np.array([2.0, 3.0]))
    assert wall.length_m == 4.0
    np.testing.assert_allclose(wall.inward, [0.0, -1.0])
    assert wall.yaw_rad == pytest.approx(-np.pi / 2)
    np.testing.assert_allclose(wall.point(1.0, 0.5), [-1.0, 2.5])


@given(metres, metres, metres, metres, metres, metres)
def test_places_are_found_again(x: float, y: float, far_x: float, far_y: float, t: float, off: float) -> None:
    start, end = np.array([x, y]), np.array([far_x, far_y])
    assume(float(np.linalg.norm(end - start)) > 0.1)
    wall = WallLine("w", start, end)
    place = wall.point(t, off)
    assert float(wall.t_of(place)) == pytest.approx(t, abs=1e-9)
    assert wall.off_of(place[None])[0] == pytest.approx(off, abs=1e-9)


def test_floor_before_furniture_and_doors_is_known() -> None:
    front = front_floor(SOFA)
    assert front is not None
    assert front[:, 0].min() >= footprint_of(SOFA)[:, 0].max() - 1e-6
    assert front_floor(item("plant", (0.3, 0.3, 0.9), 0, 0)) is None
    assert len(door_floors([item("door", (0.06, 0.9, 2.0), 0, 0), SOFA])) == 1


def test_a_room_without_architecture_has_a_frame() -> None:
    frame = RoomFrame.of(Scene(objects=(SOFA,)))
    assert lie_within(footprint_of(SOFA)[None], frame.outline)[0]
    assert frame.walls == ()
    assert RoomFrame.of(Scene(architecture=Architecture())).floor_id is None
