from __future__ import annotations

import numpy as np
import pytest

from diorama_core.editing.new_room import empty_room
from diorama_core.editing.plan_edits import corners, move_corner, set_wall_length, wall_feet
from diorama_core.errors import EditRefused
from diorama_core.scene.types import Architecture, Scene


def lengths(scene: Scene) -> dict[str, float]:
    return {f.id: round(f.length_m, 6) for f in wall_feet(scene)}


def test_four_walls_meet_in_four_corners_and_look_outward() -> None:
    scene = empty_room(4.0, 3.0, 2.5)
    assert sorted(lengths(scene).values()) == [3.0, 3.0, 4.0, 4.0]
    assert len(corners(scene)) == 4
    middle = scene.plane("floor").centre[:2]
    for foot in wall_feet(scene):
        assert float(((foot.start + foot.end) / 2 - middle) @ foot.outward) > 0


def test_a_corner_goes_where_it_is_dragged_and_the_room_stays_closed() -> None:
    scene = empty_room(4.0, 3.0, 2.5)
    corner = corners(scene)[0]
    moved = move_corner(scene, corner.first, corner.second, np.array([0.3, -0.2]))
    new = next(c for c in corners(moved) if (c.first, c.second) == (corner.first, corner.second))
    np.testing.assert_allclose(new.at, corner.at + np.array([0.3, -0.2]), atol=1e-9)
    assert len(corners(moved)) == 4
    assert any(np.allclose(p[:2], new.at, atol=1e-9) for p in moved.plane("floor").polygon)


@pytest.mark.parametrize("number", range(4))
def test_every_wall_takes_a_typed_length(number: int) -> None:
    scene = empty_room(4.0, 3.0, 2.5)
    wall = wall_feet(scene)[number].id
    changed = set_wall_length(scene, wall, 5.25)
    assert lengths(changed)[wall] == pytest.approx(5.25)
    assert len(corners(changed)) == 4


def test_a_wall_at_one_end_is_enough_and_none_is_refused() -> None:
    scene = empty_room(4.0, 3.0, 2.5)
    corner = corners(scene)[0]
    two = Scene(
        architecture=Architecture((scene.plane("floor"), scene.plane(corner.first), scene.plane(corner.second)))
    )
    for wall in (corner.first, corner.second):
        assert lengths(set_wall_length(two, wall, 2.2))[wall] == pytest.approx(2.2)
    one = Scene(architecture=Architecture((scene.plane("floor"), scene.plane(corner.first))))
    with pytest.raises(EditRefused, match="no other wall"):
        set_wall_length(one, corner.first, 2.0)


@pytest.mark.parametrize("length", [0.0, -1.0, 51.0, float("nan")])
def test_what_is_no_length_of_a_wall_is_refused(length: float) -> None:
    with pytest.raises(EditRefused, match="cannot be"):
        set_wall_length(empty_room(4.0, 3.0, 2.5), "wall_1", length)


def test_walls_that_do_not_meet_have_no_corner() -> None:
    scene = empty_room(4.0, 3.0, 2.5)
    opposite = next(
        (a.id, b.id) for a in wall_feet(scene) for b in wall_feet(scene) if float(a.outward @ b.outward) < -0.9
    )
    with pytest.raises(EditRefused, match="do not meet"):
        move_corner(scene, *opposite, np.array([0.1, 0.1]))
