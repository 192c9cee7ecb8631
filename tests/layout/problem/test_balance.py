"""An object stands as long as its centre of mass is above its support."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.geometry.convex import box_part, hull_part
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.problem.balance import HELD, bearing_of, centre_of_mass
from diorama_core.layout.problem.footing import footing_of
from diorama_core.layout.problem.problem import build_problem
from diorama_core.progress import Progress
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.small_rooms import Room

DOWN = np.array([0.0, 0.0, -1.0])
LIBRARY = box_library()


def test_the_centre_of_mass_of_two_boxes_is_between_them_by_their_volumes() -> None:
    parts = (box_part((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), box_part((2.0, 0.0, 0.0), (3.0, 1.0, 3.0)))
    np.testing.assert_allclose(centre_of_mass("", parts), [(0.5 + 3 * 2.5) / 4, 0.5, (0.5 + 3 * 1.5) / 4])


def test_the_centre_of_mass_of_a_cone_is_a_quarter_up() -> None:
    cone = hull_part(trimesh.creation.cone(radius=0.5, height=1.0, sections=32).vertices)
    np.testing.assert_allclose(centre_of_mass("", (cone,)), [0.0, 0.0, 0.25], atol=0.02)


def test_flat_parts_balance_at_their_middle() -> None:
    flat = box_part((0.0, 0.0, 0.0), (1.0, 2.0, 0.0))
    np.testing.assert_allclose(centre_of_mass("", (flat,)), [0.5, 1.0, 0.0])


def test_what_must_be_held_up_is_around_the_centre_of_mass() -> None:
    lamp = (box_part((-0.1, -0.1, 0.0), (0.1, 0.1, 0.1)), box_part((0.0, -0.1, 0.1), (0.2, 0.1, 0.4)))
    balance = centre_of_mass("", lamp)
    held = bearing_of(footing_of(lamp, DOWN), DOWN, balance)
    np.testing.assert_allclose(held[:, 2], 0.0)
    reach = np.array([[-0.1, -0.1], [0.1, 0.1]])
    np.testing.assert_allclose(held.min(axis=0)[:2], balance[:2] + HELD * (reach[0] - balance[:2]))
    np.testing.assert_allclose(held.max(axis=0)[:2], balance[:2] + HELD * (reach[1] - balance[:2]))


def test_only_what_stands_on_an_object_may_overhang(room: Room) -> None:
    table = room.put("table_0", (0.0, 0.6, 0.37), id="a-table")
    room.put("vase_20", (0.0, 0.6, 0.88), on=table, id="b-vase")
    problem = build_problem(room.scene(), LIBRARY)
    np.testing.assert_array_equal(problem.bearing[0], problem.footing[0])
    np.testing.assert_allclose(np.ptp(problem.bearing[1], axis=0), HELD * np.ptp(problem.footing[1], axis=0))


@pytest.mark.parametrize(("over_m", "moves"), [(0.03, False), (-0.02, True)])
def test_a_vase_over_the_edge_of_a_locked_table_stays_while_it_balances(
    room: Room, over_m: float, *, moves: bool
) -> None:
    table = room.put("table_0", (0.0, 0.6, 0.37), locked=True)
    edge = float(room.objects[0].corners_world[:, 0].max())
    top = float(room.objects[0].size_m[2])
    height = float(LIBRARY.shape("vase_20").size_m[2])
    vase = room.put("vase_20", (edge - over_m, 0.6, top + height / 2), on=table)
    scene = room.scene(camera=looking_north())
    settled = FeasibleRecipe(LIBRARY, depth_measured=True).optimise(scene, Progress())[0]
    before, after = scene.object(vase), settled.object(vase)
    assert before.corners_world[:, 0].max() > edge
    assert (abs(after.pose.position - before.pose.position).max() > 0.01) == moves
    assert after.pose.position[0] < edge
