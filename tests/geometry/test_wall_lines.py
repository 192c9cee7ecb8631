"""Walls as lines with openings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.geometry.wall_lines import wall_lines
from diorama_core.scene.types import Architecture, Plane, Pose, Scene, SceneObject, Support
from tests.primitives import box_room


def walls(scene: Scene):
    return {w.plane.id: w for w in wall_lines(scene.architecture.planes, scene.objects, scene)}


def test_walls_run_left_to_right_seen_from_inside() -> None:
    found = walls(Scene(architecture=box_room()))
    back = found["back"]
    np.testing.assert_allclose([back.start, back.end], [[-2, 5], [2, 5]], atol=1e-9)
    np.testing.assert_allclose(back.outward, [0, 1], atol=1e-9)
    assert (back.bottom_m, back.top_m, back.length_m) == pytest.approx((0, 2.6, 4))
    for wall in found.values():
        np.testing.assert_allclose(wall.outward, -wall.plane.normal[:2], atol=1e-9)


def doorway_wall() -> Plane:
    """A wall with a doorway notched into its foot and a window reached by a cut from the foot."""
    outline = [
        [-2, 0], [-1.5, 0], [-1.5, 2], [-0.6, 2], [-0.6, 0],
        [1, 0], [1, 0.9], [0.4, 0.9], [0.4, 1.9], [1.6, 1.9], [1.6, 0.9], [1, 0.9], [1, 0],
        [2, 0], [2, 2.6], [-2, 2.6],
    ]  # fmt: skip
    return Plane("back", "wall", np.array([[x, 5, z] for x, z in outline]))


def test_gaps_of_the_polygon_are_openings() -> None:
    planes = tuple(doorway_wall() if p.id == "back" else p for p in box_room().planes)
    door, window = walls(Scene(architecture=Architecture(planes)))["back"].openings
    assert (door.from_m, door.to_m, door.bottom_m, door.top_m) == pytest.approx((0.5, 1.4, 0, 2))
    assert (window.from_m, window.to_m, window.bottom_m, window.top_m) == pytest.approx((2.4, 3.6, 0.9, 1.9))
    assert door.is_door
    assert not window.is_door


def test_a_sloping_top_is_no_opening() -> None:
    slope = Plane("back", "wall", np.array([[-2, 5, 0], [2, 5, 0], [2, 5, 1.5], [-2, 5, 2.6]], float))
    assert walls(Scene(architecture=Architecture((slope,))))["back"].openings == ()


def window_at(x: float, y: float) -> SceneObject:
    return SceneObject("w", "window", "window", "window", (0.1, 1.2, 1.0), Pose.upright((x, y, 1.5), -np.pi / 2))


@pytest.mark.parametrize("mounted", [True, False])
def test_windows_belong_to_the_wall_they_hang_on_or_stand_in(mounted: bool) -> None:
    edges = (Support("w", "back", "mounted on"),) if mounted else ()
    found = walls(Scene(None, box_room(), (window_at(0.5, 4.98),), edges))
    (opening,) = found["back"].openings
    assert (opening.from_m, opening.to_m, opening.bottom_m, opening.top_m) == pytest.approx((1.9, 3.1, 1.0, 2.0))
    assert opening.object_id == "w"
    assert all(not w.openings for name, w in found.items() if name != "back")


def test_a_window_in_a_gap_is_one_opening() -> None:
    planes = tuple(doorway_wall() if p.id == "back" else p for p in box_room().planes)
    scene = Scene(None, Architecture(planes), (window_at(1.0, 5.0),))
    assert [o.object_id for o in walls(scene)["back"].openings] == [None, "w"]
    assert len(walls(replace(scene, objects=()))["back"].openings) == 2
