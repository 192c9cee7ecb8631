"""Environment maps: everything in its direction, and its light."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.errors import Cancelled
from diorama_core.geometry.sphere import directions
from diorama_core.progress import CancelToken, Progress
from diorama_core.render.lighting import Effort
from diorama_core.render.panorama import middle, panorama
from diorama_core.scene.types import Architecture, Plane, RoomLight, Scene
from tests.primitives import PrimitiveLibrary, box_room, furnished_room

LIBRARY = PrimitiveLibrary()
QUICK = Effort(1, 1)
WIDTH = 64
SIDES = {"+x": (1, 0, 0), "-x": (-1, 0, 0), "+y": (0, 1, 0), "-y": (0, -1, 0), "up": (0, 0, 1), "down": (0, 0, -1)}
COLOURS = ((0.8, 0.1, 0.1), (0.1, 0.8, 0.1), (0.1, 0.1, 0.8), (0.8, 0.8, 0.1), (0.8, 0.1, 0.8), (0.1, 0.8, 0.8))


def painted(direction: tuple[int, int, int], colour: tuple[float, float, float]) -> Plane:
    """The side of a cube of 4 m in this direction, seen from within."""
    inward = -np.array(direction, dtype=float)
    across = np.roll(inward, 1)
    along = np.cross(inward, across)
    corners = np.array([-2 * inward + 2 * (a * across + b * along) for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))])
    plane = Plane(str(direction), "wall", corners, colour=colour)
    return plane if plane.normal @ inward > 0 else replace(plane, polygon=corners[::-1])


def cube() -> Scene:
    planes = tuple(painted(d, c) for d, c in zip(SIDES.values(), COLOURS, strict=True))
    return Scene(architecture=Architecture(planes=planes))


def test_directions_are_those_of_a_latitude_longitude_map() -> None:
    away = directions(WIDTH)
    assert away.shape == (WIDTH // 2, WIDTH, 3)
    np.testing.assert_allclose(np.linalg.norm(away, axis=-1), 1.0)
    row = WIDTH // 4
    for column, side in ((WIDTH // 2, "-y"), (WIDTH // 4, "+x"), (0, "+y"), (3 * WIDTH // 4, "-x")):
        assert away[row, column] @ np.array(SIDES[side]) > 0.99
    assert (away[0] @ np.array(SIDES["up"]) > 0.99).all()


def test_every_side_of_a_room_is_where_it_is_seen_from_the_middle() -> None:
    found = panorama(cube(), LIBRARY, width=WIDTH, effort=QUICK)
    away = directions(WIDTH)
    for direction, colour in zip(SIDES.values(), COLOURS, strict=True):
        seen = found[away @ np.array(direction) > 0.9]
        assert np.corrcoef(np.median(seen, axis=0), colour)[0, 1] > 0.95, direction


def test_the_map_has_the_colour_of_the_photo_s_light() -> None:
    plain = replace(cube(), light=RoomLight())
    warm = replace(plain, light=RoomLight(colour=(1.0, 0.8, 0.6)))
    white, tinted = (panorama(s, LIBRARY, width=WIDTH, effort=QUICK).mean(axis=(0, 1)) for s in (plain, warm))
    assert tinted / white == pytest.approx([1.0, 0.8, 0.6], rel=1e-3)


def test_what_is_beyond_open_sides_is_the_even_light() -> None:
    nothing = panorama(Scene(), LIBRARY, width=WIDTH, effort=QUICK)
    assert np.isfinite(nothing).all()
    assert nothing.min() > 0.1


def test_the_middle_is_above_what_stands_there() -> None:
    room = box_room()
    place = middle(Scene(architecture=room))
    ends = np.concatenate([p.polygon for p in room.planes])
    assert (place > ends.min(axis=0)).all()
    assert (place < ends.max(axis=0)).all()
    scene = furnished_room(LIBRARY)
    tall = next(o for o in scene.objects if o.id != "b")
    at = replace(tall, pose=replace(tall.pose, position=middle(scene), scale=np.array([2.0, 2.0, 1.5])))
    above = middle(Scene(architecture=scene.architecture, objects=(at,)))
    assert above[2] > at.corners_world[:, 2].max()


def test_it_can_be_cancelled() -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        panorama(cube(), LIBRARY, width=WIDTH, effort=QUICK, progress=Progress(token=token))
