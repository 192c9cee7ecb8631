from __future__ import annotations

import manifold3d
import numpy as np
import pytest

from diorama_core.geometry.sphere import directions
from diorama_core.multiview.sphere_room import room_on_sphere
from tests.multiview.spheres import BOX, L_SHAPE, room_sphere


def shared(a: np.ndarray, b: np.ndarray) -> float:
    """Intersection over union in plan."""
    one, two = (manifold3d.CrossSection([p]) for p in (a, b))
    both = (one ^ two).area()
    return float(both / (one.area() + two.area() - both))


@pytest.mark.parametrize(("outline", "ceiling"), [(BOX, 0.8), (0.6 * BOX, 1.1), (L_SHAPE, 0.7)])
def test_the_room_is_found_all_round(outline: np.ndarray, ceiling: float) -> None:
    room = room_on_sphere(room_sphere(outline, ceiling))
    assert len(room.outline) == len(outline)
    assert shared(room.outline, outline) > 0.97
    assert room.ceiling == pytest.approx(ceiling, rel=0.03)
    assert (room.support > 0.3).all()


def test_a_wall_behind_an_inner_corner_is_hidden() -> None:
    outline = L_SHAPE - [1.8, 0.0]  # the camera stands to the right of the inner corner and sees past it
    room = room_on_sphere(room_sphere(outline, 0.7))
    assert shared(room.outline, outline) > 0.95
    assert (room.support == 0.0).sum() == 1


def test_rows_of_tiles_are_no_walls() -> None:
    picture = room_sphere(BOX, 0.8)

    away = directions(1024)
    below = np.minimum(away[..., 2], -1e-6)
    dark = (np.floor(away[..., 0] / below / 0.3) + np.floor(away[..., 1] / below / 0.3)) % 2 > 0
    is_floor = (picture == [120, 84, 60]).all(axis=-1)
    picture[is_floor & dark] = [225, 220, 210]
    assert shared(room_on_sphere(picture).outline, BOX) > 0.93
