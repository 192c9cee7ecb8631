from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.plan_edits import empty_room
from diorama_core.geometry.unseen_walls import HEAD_M, SILL_M, close_room, unseen_parts
from diorama_core.scene.types import Architecture, Plane, Pose, Scene, SceneObject


def room(*without: str) -> Scene:
    scene = empty_room(4.0, 3.0, 2.6)
    return replace(scene, architecture=Architecture(tuple(p for p in scene.architecture.planes if p.id not in without)))


def with_window(scene: Scene) -> Scene:
    pose = Pose.upright((0.0, 1.5, 1.5), -np.pi / 2)
    return replace(scene, objects=(SceneObject("window_1", "window", "window", "shape", (0.06, 1.0, 1.0), pose),))


def test_a_whole_room_is_left_alone() -> None:
    scene = room()
    assert unseen_parts(scene).planes == ()
    assert close_room(scene) is scene


def test_a_missing_wall_stands_where_it_was() -> None:
    whole = with_window(room())
    gone = next(p for p in whole.architecture.by_role("wall"))
    (wall,) = unseen_parts(with_window(room(gone.id))).planes
    assert wall.role == "wall"
    np.testing.assert_allclose(wall.normal, gone.normal, atol=1e-9)
    np.testing.assert_allclose(np.sort(wall.polygon, axis=0), np.sort(gone.polygon, axis=0), atol=1e-6)
    assert unseen_parts(with_window(room(gone.id))).openings == ()


def test_a_missing_ceiling_is_over_the_floor_and_looks_down() -> None:
    scene = room(*(p.id for p in room().architecture.by_role("ceiling")))
    (ceiling,) = unseen_parts(scene).planes
    np.testing.assert_allclose(ceiling.normal, (0.0, 0.0, -1.0))
    assert ceiling.polygon[:, 2] == pytest.approx(2.6)


def test_where_no_window_is_known_an_unseen_wall_has_a_usual_one() -> None:
    gone = next(p for p in room().architecture.by_role("wall"))
    unseen = unseen_parts(room(gone.id))
    (window,) = unseen.openings
    assert (window.corners[:, 2].min(), window.corners[:, 2].max()) == pytest.approx((SILL_M, HEAD_M))
    np.testing.assert_allclose(window.normal, gone.normal, atol=1e-9)
    area = sum(_area(p) for p in unseen.planes)
    assert area == pytest.approx(_area(gone) - _area(Plane("w", "wall", window.corners)))
    for plane in unseen.planes:
        np.testing.assert_allclose(plane.normal, gone.normal, atol=1e-9)


def test_half_a_wall_is_completed() -> None:
    scene = with_window(room())
    wall = next(p for p in scene.architecture.by_role("wall") if abs(p.normal[1]) > 0.9)
    half = replace(wall, polygon=np.column_stack([np.minimum(wall.polygon[:, 0], 0.5), wall.polygon[:, 1:]]))
    planes = tuple(half if p is wall else p for p in scene.architecture.planes)
    (rest,) = unseen_parts(replace(scene, architecture=Architecture(planes))).planes
    assert (rest.polygon[:, 0].min(), rest.polygon[:, 0].max()) == pytest.approx((0.5, 2.0))


def test_without_a_floor_nothing_is_known_of_the_rest() -> None:
    assert unseen_parts(Scene()).planes == ()


def _area(plane: Plane) -> float:
    a, b = plane.polygon, np.roll(plane.polygon, -1, axis=0)
    return float(np.linalg.norm(np.cross(a, b).sum(axis=0))) / 2
