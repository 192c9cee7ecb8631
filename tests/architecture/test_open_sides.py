"""Open sides of a floor move out to what stands there, and walls go on to them."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.open_sides import with_open_sides_moved
from diorama_core.geometry.planes import in_polygon
from diorama_core.scene.types import Architecture, Plane, Scene

FLOOR = np.array([[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]], dtype=float)


def wall(name: str, start: tuple[float, float], end: tuple[float, float]) -> Plane:
    """A wall of 2.5 m whose room is on the left of its way."""
    (ax, ay), (bx, by) = start, end
    return Plane(name, "wall", np.array([[ax, ay, 0], [bx, by, 0], [bx, by, 2.5], [ax, ay, 2.5]], dtype=float))


BACK, LEFT = wall("back", (4, 3), (0, 3)), wall("left", (0, 3), (0, 0))


def room(*walls: Plane, floor: np.ndarray = FLOOR) -> Scene:
    return Scene(architecture=Architecture((Plane("floor", "floor", floor), *walls)))


def square(x: float, y: float, half: float = 0.5) -> np.ndarray:
    return np.array([[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]])


def bounds(scene: Scene) -> list[float]:
    outline = scene.architecture.floor.polygon[:, :2]
    assert len(outline) == 4
    return [*outline.min(axis=0), *outline.max(axis=0)]


def test_a_side_without_a_wall_moves_along_all_of_it_and_the_wall_goes_on_to_it() -> None:
    wider = with_open_sides_moved(room(BACK, LEFT), [square(4.2, 2.4)])
    assert bounds(wider) == pytest.approx([0, 0, 4.7, 3])
    assert wider.plane("back").polygon[:, 0].max() == pytest.approx(4.7)
    assert wider.plane("back").offset == pytest.approx(BACK.offset)
    assert np.array_equal(wider.plane("left").polygon, LEFT.polygon)


def test_a_side_with_a_wall_stays() -> None:
    scene = room(BACK, LEFT)
    assert with_open_sides_moved(scene, [square(0.2, 1.5)]) is scene
    assert with_open_sides_moved(scene, [square(2.0, 3.2)]) is scene


def test_what_stands_off_a_corner_moves_no_side() -> None:
    scene = room(BACK, LEFT)
    assert with_open_sides_moved(scene, [square(5.0, -1.0)]) is scene
    assert with_open_sides_moved(scene, []) is scene


def test_two_open_sides_keep_their_corner() -> None:
    wider = with_open_sides_moved(room(BACK, LEFT), [square(4.2, 1.0), square(1.0, -0.4)])
    assert bounds(wider) == pytest.approx([0, -0.9, 4.7, 3])
    assert wider.plane("left").polygon[:, 1].min() == pytest.approx(-0.9)
    assert in_polygon(np.array([[4.6, -0.8]]), wider.architecture.floor.polygon[:, :2]).all()


def test_a_wall_that_meets_another_ends_there() -> None:
    right = wall("right", (4, 1), (4, 3))
    scene = room(BACK, right)
    wider = with_open_sides_moved(scene, [square(-0.2, 1.0)])
    assert wider.plane("back").polygon[:, 0].min() == pytest.approx(-0.7)
    assert wider.plane("back").polygon[:, 0].max() == pytest.approx(4.0)


def test_slanting_and_short_sides_stay() -> None:
    slanted = np.array([[0, 0, 0], [3, 0, 0], [4, 3, 0], [0, 3, 0]], dtype=float)
    scene = room(BACK, LEFT, floor=slanted)
    assert with_open_sides_moved(scene, [square(3.8, 1.0)]) is scene
    notched = np.array([[0, 0, 0], [4, 0, 0], [4, 2.5, 0], [3.5, 2.5, 0], [3.5, 3, 0], [0, 3, 0]], dtype=float)
    scene = room(LEFT, floor=notched)
    assert with_open_sides_moved(scene, [square(3.75, 2.4, half=0.2)]) is scene
