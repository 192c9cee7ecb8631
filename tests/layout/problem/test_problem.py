from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from diorama_core.geometry.convex import box_part, convex_parts
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.problem.problem import box_footing, build_problem, footing_of, reach_of
from diorama_core.progress import Progress
from diorama_core.scene.types import Architecture, Plane, Scene
from tests.layout.feasible.test_photo_observations import LIBRARY, looking_north
from tests.layout.small_rooms import Room

DOWN = np.array([0.0, 0.0, -1.0])
TURNED = np.array([[np.sqrt(0.5), -np.sqrt(0.5), 0], [np.sqrt(0.5), np.sqrt(0.5), 0], [0, 0, 1]])
EAST = np.array([[1.0, 0.0, 0.0]])


def l_shaped() -> Architecture:
    """A room 6 m deep on its left side and 4 m on its right: its second wall stands into it."""
    outline = np.array([(-3, 0), (3, 0), (3, 4), (0, 4), (0, 6), (-3, 6)], dtype=float)
    ends = np.roll(outline, -1, axis=0)
    walls = []
    for k, (a, b) in enumerate(zip(outline, ends, strict=True)):
        walls.append(Plane(f"wall_{k}", "wall", np.array([(*b, 0), (*a, 0), (*a, 2.6), (*b, 2.6)])))
    floor = Plane("floor", "floor", np.column_stack([outline, np.zeros(6)]))
    return Architecture((floor, *walls))


def beside_the_corner(room: Room, x: float) -> tuple[Scene, str]:
    name = room.put("table_0", (x, 3.9, 0.37), yaw=np.pi / 2)
    return room.scene(architecture=l_shaped(), camera=looking_north()), name


@pytest.mark.parametrize(("x", "meets"), [(-0.8, False), (0.4, True)])
def test_a_wall_that_stands_into_the_room_ends_where_it_ends(room: Room, x: float, *, meets: bool) -> None:
    scene, name = beside_the_corner(room, x)
    problem = build_problem(scene, LIBRARY)
    near = {wall.id for wall in problem.walls_near(problem.ids.index(name))}
    assert ("wall_2" in near) == meets


def test_a_table_beside_the_end_of_a_wall_stays_as_it_was_seen(room: Room) -> None:
    scene, name = beside_the_corner(room, -0.8)
    settled = FeasibleRecipe(LIBRARY).optimise(scene, Progress())[0]
    before, after = scene.object(name), settled.object(name)
    np.testing.assert_allclose(after.size_m, before.size_m, rtol=0.02)
    np.testing.assert_allclose(after.pose.position, before.pose.position, atol=0.02)


def test_nothing_passes_a_wall_of_a_room_without_a_floor(room: Room) -> None:
    scene, name = beside_the_corner(room, -0.8)
    walls = Architecture(tuple(p for p in scene.architecture.planes if p.role == "wall"))
    problem = build_problem(replace(scene, architecture=walls, supports=()), LIBRARY)
    assert "wall_2" in {wall.id for wall in problem.walls_near(problem.ids.index(name))}


def test_a_round_foot_reaches_its_radius_however_it_is_turned() -> None:
    disc = convex_parts(trimesh.creation.cylinder(radius=0.4, height=0.7, sections=48))
    for R in (np.eye(3), TURNED):
        # Convex parts contain the disc with a margin.
        assert 0.39 < reach_of(footing_of(disc, DOWN), R, np.ones(3), EAST)[0] < 0.46
    corners = box_footing(np.array([0.8, 0.8, 0.7]), DOWN)
    assert reach_of(corners, TURNED, np.ones(3), EAST)[0] == pytest.approx(0.4 * np.sqrt(2))


def test_a_shade_wider_than_its_foot_may_overhang() -> None:
    foot, shade = box_part((-0.1, -0.1, -0.3), (0.1, 0.1, 0.0)), box_part((-0.3, -0.3, 0.0), (0.3, 0.3, 0.3))
    lamp = (foot, shade)
    assert reach_of(footing_of(lamp, DOWN), np.eye(3), np.ones(3), EAST)[0] == pytest.approx(0.1)
    assert reach_of(footing_of(lamp, -DOWN), np.eye(3), np.ones(3), EAST)[0] == pytest.approx(0.3)


def test_scale_stretches_a_footing_along_its_own_axes() -> None:
    footing = box_footing(np.array([0.2, 0.4, 0.5]), DOWN)
    assert np.allclose(footing[:, 2], 0.0)
    reach = reach_of(footing, np.eye(3), np.array([2.0, 3.0, 9.0]), np.array([[1.0, 0, 0], [0, -1.0, 0]]))
    np.testing.assert_allclose(reach, [0.2, 0.6])
