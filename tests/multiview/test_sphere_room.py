from __future__ import annotations

import manifold3d
import numpy as np
import pytest

from diorama_core.geometry.sphere import directions
from diorama_core.multiview.sphere_room import SphereThing, room_on_sphere
from tests.multiview.spheres import BOX, CEILING, FLOOR, L_SHAPE, room_sphere


def shared(a: np.ndarray, b: np.ndarray) -> float:
    """Intersection over union in plan."""
    one, two = (manifold3d.CrossSection([p]) for p in (a, b))
    both = (one ^ two).area()
    return float(both / (one.area() + two.area() - both))


@pytest.mark.parametrize(("outline", "ceiling"), [(0.6 * BOX, 1.1), (L_SHAPE, 0.7)])
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


def test_the_foot_of_a_counter_along_a_wall_is_no_border() -> None:
    """Cupboards before the whole wall at +x, 0.6 deep and as high as the camera's half: their foot is all one sees."""
    counter, high = 1.5, -0.5
    picture, away = room_sphere(BOX, 0.8), directions(1024)
    reach = counter / np.maximum(away[..., 0], 1e-6)  # where a ray meets the fronts
    is_front = (away[..., 0] > 0) & (reach * away[..., 2] > -1.0) & (reach * away[..., 2] < high)
    is_front &= (reach * away[..., 1] > BOX[0, 1]) & (reach * away[..., 1] < BOX[2, 1])
    top = high / np.minimum(away[..., 2], -1e-6)
    is_top = (away[..., 2] < 0) & (top * away[..., 0] > counter) & (top * away[..., 0] < BOX[1, 0])
    is_top &= (top * away[..., 1] > BOX[0, 1]) & (top * away[..., 1] < BOX[2, 1])
    picture[is_top], picture[is_front] = [150, 150, 150], [40, 44, 48]
    ends = np.arctan2(BOX[[0, 2], 1], counter)
    foot = float(np.arctan2(-1.0, counter))
    thing = SphereThing(float(ends.mean()), float(np.ptp(ends)) / 2, foot, float(np.arctan2(high, BOX[1, 0])), True)
    room = room_on_sphere(picture, [thing])
    assert shared(room.outline, BOX) > 0.95
    assert shared(room_on_sphere(picture).outline, BOX) < shared(room.outline, BOX)


def test_rows_of_tiles_are_no_walls_where_the_floor_is_known() -> None:
    picture = room_sphere(BOX, 0.8)
    is_floor, is_ceiling = ((picture == colour).all(axis=-1) for colour in (FLOOR, CEILING))
    shares = np.stack([is_floor, ~(is_floor | is_ceiling), is_ceiling]).astype(np.float32)
    away = directions(1024)
    below = np.minimum(away[..., 2], -1e-6)
    dark = (np.floor(away[..., 0] / below / 0.3) + np.floor(away[..., 1] / below / 0.3)) % 2 > 0
    picture[is_floor & dark] = [225, 220, 210]
    assert shared(room_on_sphere(picture, shares=shares).outline, BOX) > 0.97
    assert shared(room_on_sphere(picture).outline, BOX) < 0.93
