from __future__ import annotations

from dataclasses import replace

import manifold3d
import numpy as np
import pytest

from diorama_core.geometry.openings import cut_wall, wall_of, with_hole, with_openings
from diorama_core.geometry.planes import plane_axes, plane_rectangle
from diorama_core.scene.types import Plane, Pose, Scene, SceneObject, Support
from tests.app.small_room import furnished_scene

ROOM = furnished_scene()
WALL = ROOM.plane("wall_3")
"""At y = 3.4, 4.4 m wide and 2.5 m high, facing -y."""


def fill(name: str, category: str, x: float, low: float, width: float, height: float) -> SceneObject:
    pose = Pose.upright((x, 3.37, low + height / 2), -np.pi / 2)
    return SceneObject(name, name, category, "shape", (0.06, width, height), pose)


DOOR = fill("door", "door", -1.5, 0.0, 0.9, 2.0)
WINDOW = fill("window", "window", 0.3, 0.9, 1.2, 1.1)
SECOND = fill("second", "window", 1.7, 1.0, 0.6, 0.8)


def area(plane: Plane) -> float:
    triangles = manifold3d.triangulate([plane.polygon @ np.stack(plane_axes(plane.normal), axis=1)])
    a, b, c = (plane.polygon[triangles[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2


def hole(item: SceneObject) -> float:
    _, width, height = item.size_m
    return float((width - 0.04) * (height - (0.02 if item.category == "door" else 0.04)))


@pytest.mark.parametrize("fills", [(DOOR,), (WINDOW,), (DOOR, WINDOW), (DOOR, WINDOW, SECOND)])
def test_what_fills_an_opening_is_missing_from_the_wall(fills) -> None:
    cut = cut_wall(WALL, fills)
    assert area(cut) == pytest.approx(area(WALL) - sum(hole(f) for f in fills), abs=1e-6)
    np.testing.assert_allclose(cut.normal, WALL.normal, atol=1e-9)
    for before, after in zip(plane_rectangle(WALL), plane_rectangle(cut), strict=True):
        np.testing.assert_allclose(after, before, atol=1e-9)


def test_a_window_above_another_is_reached_too() -> None:
    lower, upper = fill("lower", "window", 0.3, 0.3, 1.0, 0.6), fill("upper", "window", 0.3, 1.4, 1.0, 0.6)
    assert area(cut_wall(WALL, (upper, lower))) == pytest.approx(area(WALL) - hole(lower) - hole(upper), abs=1e-6)


def test_a_wall_stays_whole_where_nothing_sensible_would_be_left() -> None:
    everything = fill("all", "window", 0.0, -0.5, 6.0, 4.0)
    divider = fill("divider", "door", 0.0, 0.0, 0.9, 2.6)
    for item in (everything, divider, fill("slit", "window", 0.0, 1.0, 0.05, 1.0)):
        assert cut_wall(WALL, (item,)) is WALL


def test_doors_and_windows_find_their_wall_and_hidden_ones_cut_none() -> None:
    scene = replace(ROOM, objects=(*ROOM.objects, DOOR, WINDOW))
    scene = replace(scene, supports=(*scene.supports, Support("window", "wall_3", "mounted on")))
    walls = scene.architecture.by_role("wall")
    assert wall_of(WINDOW, walls, scene) is WALL
    assert wall_of(DOOR, walls, scene) is WALL, "right behind it"
    away = replace(DOOR, id="away", pose=DOOR.pose.move((0.0, -1.5, 0.0)))
    assert wall_of(away, walls, scene) is None
    cut = with_openings(scene)
    assert area(cut.plane("wall_3")) < area(WALL) - 2.5
    assert all(
        a is b for a, b in zip(cut.architecture.planes, ROOM.architecture.planes, strict=True) if a.id != "wall_3"
    )
    assert cut.objects == scene.objects
    closed = replace(scene, objects=tuple(replace(o, hidden=True) for o in scene.objects))
    assert with_openings(closed) is closed
    assert with_openings(Scene()) == Scene()


@pytest.mark.parametrize(("low", "high"), [(0.0, 2.0), (1.0, 1.8)])
def test_a_hole_has_no_frame(low: float, high: float) -> None:
    corners = np.array([[x, 3.1, z] for x in (-0.4, 0.5) for z in (low, high)])
    cut = with_hole(WALL, corners)
    assert area(cut) == pytest.approx(area(WALL) - 0.9 * (high - low), abs=1e-6)
    beyond = corners + np.array([20.0, 0.0, 0.0])
    assert with_hole(WALL, beyond) is WALL
    whole = np.array([[x, 3.1, z] for x in (-9.0, 9.0) for z in (-1.0, 9.0)])
    assert with_hole(WALL, whole) is WALL, "nothing would be left"
