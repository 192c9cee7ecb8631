from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.geometry.projection import cuboid_corners
from diorama_core.library.taxonomy import category
from diorama_core.perception.metrology.box_observations import BoxObservations, gather
from diorama_core.perception.metrology.problem import UNTOLD, Cuboids, concatenate_problems
from diorama_core.perception.metrology.settings import SETTINGS
from diorama_core.perception.metrology.supported_objects import (
    extent_of,
    place_below_ceiling,
    place_on,
    place_on_wall,
    supporters_of,
)
from tests.perception.metrology.test_metrology import detected

PARENT = Cuboids(np.array([[0.5, 3.0, 0.4]]), np.array([-np.pi / 2]), np.array([[2.0, 1.6, 0.8]]))
"""Front to the camera, 2 m deep, 1.6 m wide."""


def of(*names: str) -> BoxObservations:
    boxes = [(100.0 + 20 * n, 100.0, 200.0 + 20 * n, 300.0) for n in range(len(names))]
    return gather(tuple(detected(f"o{n}", name, b) for n, (name, b) in enumerate(zip(names, boxes))), 640, 480)


def corners(centre, size, yaw=0.0) -> np.ndarray:
    return cuboid_corners(np.array([centre]), np.array([yaw]), np.array([size]))


def test_an_empty_floor_is_an_ordinary_room() -> None:
    room = extent_of(np.zeros((0, 8, 3)), ())
    assert (room.left_m, room.right_m, room.back_m) == (2.0, 2.0, 3.5)
    assert room.footprint == pytest.approx([0.0, 1.75, 0.0, 2.0, 1.75])


def test_the_room_reaches_past_the_farthest_object_and_to_what_stands_at_walls() -> None:
    chair = corners((2.0, 2.0, 0.4), (0.5, 0.5, 0.8))
    shelf = corners((0.0, 4.0, 0.9), (0.4, 0.8, 1.8), -np.pi / 2)
    room = extent_of(np.concatenate([chair, shelf]), ("chair", "bookshelf"))
    assert room.right_m == pytest.approx(1.1 * (2.25 + 0.05))
    assert room.right_sigma == 0.3
    assert room.back_m == pytest.approx(4.2 + 0.05)
    assert room.back_sigma == 0.12
    assert room.left_m == pytest.approx((1.0 + 0.05) * 1.1 if room.left_sigma == 0.3 else 1.05)


def test_a_door_tells_the_wall_that_it_is_in() -> None:
    door = corners((0.0, 4.0, 1.0), (0.05, 0.9, 2.0), -np.pi / 2)
    assert extent_of(door, ("door",)).back_sigma == 0.12
    assert extent_of(door, ("door",)).right_sigma == 0.3


@given(x=st.floats(0, 300), width=st.floats(20, 200), bottom=st.floats(50, 400))
def test_supporters_hold_most_of_the_width_and_the_bottom(x, width, bottom) -> None:
    items = (detected("c", "lamp", (x, bottom - 40, x + width, bottom)), detected("p", "table", (100, 150, 300, 350)))
    observations = gather(items, 640, 480)
    box = observations.box_px[0]
    shared = max(min(box[2], 300) - max(box[0], 100), 0)
    drawn = 2.0 * np.hypot(observations.edge_sigma_px[0, 3], observations.edge_sigma_px[1, 1])
    expected = shared >= 0.5 * (box[2] - box[0]) and 150 - max(30, drawn) < box[3] <= 353
    assert supporters_of(observations, 0, [0, 1]) == ([1] if expected else [])


def test_a_box_that_is_drawn_a_little_high_above_a_carrier_that_shows_little_still_rests_in_it() -> None:
    items = (detected("v", "vase", (330, 122, 353, 183)), detected("n", "night stand", (319, 190, 394, 210)))
    far = (detected("v", "vase", (330, 102, 353, 163)), items[1])
    assert supporters_of(gather(items, 640, 480), 0, [1]) == [1]
    assert supporters_of(gather(far, 640, 480), 0, [1]) == []


def test_objects_lie_on_tops_within_the_parents_outline() -> None:
    rows = concatenate_problems(place_on(of("table", "books"), 1, 0, PARENT, 1.5, 0.7))
    assert set(rows.base_m.round(6)) == {0.8}
    np.testing.assert_allclose(rows.footprint, np.broadcast_to([0.5, 3.0, -np.pi / 2, 1.0, 0.8], rows.footprint.shape))
    assert (rows.extra >= 0.7).all()
    turns = {round(float(v), 6) for v in rows.yaw_rad - PARENT.yaw_rad[0]}
    assert turns <= {0.0, round(np.pi / 2, 6)}


def test_objects_lie_on_seats_before_backs_and_in_shelves() -> None:
    sofa = concatenate_problems(place_on(of("sofa", "pillow"), 1, 0, PARENT, 1.5, 0.0))
    seat = category("sofa").seat_height_m
    levels = dict(zip(sofa.base_m.round(6), sofa.extra, strict=True))
    assert set(levels) == {round(seat, 6), round(seat + 0.15, 6), 0.8}
    assert min(levels, key=levels.get) == pytest.approx(seat)
    odd = concatenate_problems(place_on(of("sofa", "vase"), 1, 0, PARENT, 1.5, 0.0))
    assert odd.extra.min() == pytest.approx(sofa.extra.min() + 6.0)
    on_back = odd.extra[np.argmax(odd.base_m)]
    assert on_back > odd.extra.min() + 5.0, "a vase stands on a backrest still more seldom"
    shelf = concatenate_problems(place_on(of("bookshelf", "books"), 1, 0, PARENT, 1.5, 0.0))
    assert len(set(shelf.base_m.round(6))) == 4


def test_pillows_lie_at_the_head_of_the_bed_away_from_the_camera() -> None:
    rows = concatenate_problems(place_on(of("bed", "pillow"), 1, 0, PARENT, 1.5, 0.0))
    assert rows.footprint[0, 1] > 3.0 + 0.5
    assert rows.footprint[0, 3] == pytest.approx(0.45)
    # The head's far edge is the bed's own.
    assert rows.footprint[0, 1] + rows.footprint[0, 3] == pytest.approx(4.0)


def test_walls_ahead_left_and_right_are_tried() -> None:
    room = extent_of(np.zeros((0, 8, 3)), ())
    rows = concatenate_problems(place_on_wall(of("picture"), 0, 1.5, room, 2.0))
    modes = len(rows) // 3
    assert sorted(zip(rows.yaw_rad[:3].round(3), rows.wall_m[:3], strict=True)) == [
        (-1.571, 3.5),
        (0.0, 2.0),
        (3.142, 2.0),
    ]
    assert rows.extra[0] == rows.extra.min()
    middles = rows.base_m + np.exp(rows.log_size[:, 2]) / 2
    np.testing.assert_allclose(middles, 1.5, atol=1e-9)
    assert modes >= 1
    door = concatenate_problems(place_on_wall(of("door"), 0, 1.5, room, 0.0))
    assert not door.base_m.any()
    assert not door.base_sigma_m.any()
    assert (door.wall_sigma >= UNTOLD).all(), "its foot tells where its wall is"
    assert (door.footprint_sigma_m >= UNTOLD).all()


def test_lamps_hang_from_the_usual_ceiling() -> None:
    room = extent_of(np.zeros((0, 8, 3)), ())
    rows = concatenate_problems(place_below_ceiling(of("ceiling lamp"), 0, 1.5, room, 0.0))
    np.testing.assert_allclose(rows.base_m + np.exp(rows.log_size[:, 2]), SETTINGS.placement.ceiling_m)
    assert (rows.top_m == SETTINGS.placement.ceiling_m).all()
