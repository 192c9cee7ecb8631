from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.problem.problem import build_problem
from diorama_core.progress import Progress
from diorama_core.scene.types import Architecture, Plane, Scene
from tests.layout.feasible.test_photo_observations import LIBRARY, looking_north
from tests.layout.small_rooms import Room


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
