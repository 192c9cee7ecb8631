from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.geometry.sat import pair_axes, place_bodies
from diorama_core.layout.escape import exits, ring
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.report import part_overlaps
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene, yaw_rotation
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.small_rooms import Room

LIBRARY = box_library()


def overlap_m(scene: Scene, moved: str, offset: np.ndarray) -> float:
    problem = build_problem(scene, LIBRARY)
    problem.p[problem.ids.index(moved)] += offset
    return max(part_overlaps(problem).values(), default=0.0)


@settings(max_examples=25)
@given(st.floats(-0.6, 0.6), st.floats(-0.8, 0.8), st.floats(-3.0, 3.0))
def test_the_way_out_is_free_and_no_shorter_one_is(x: float, y: float, yaw: float) -> None:
    room = Room(LIBRARY)
    room.put("table_0", (0, 0, 0.37), id="a table")
    chair = room.put("chair_4", (x, y, 0.45), id="b chair", yaw=yaw)
    scene = room.scene()
    problem = build_problem(scene, LIBRARY)
    bodies = place_bodies(problem.packed, problem.R, problem.p, problem.scale)
    a, b = (m.ravel() for m in np.meshgrid(np.flatnonzero(bodies.owner == 1), np.flatnonzero(bodies.owner == 0)))
    blocks = pair_axes(bodies, a, b)
    directions = ring(problem.R[1], np.eye(3)[:, :2])
    still = [np.zeros((len(block.a), 3)) for block in blocks]
    far = exits(blocks, still, [np.ones(len(block.a)) for block in blocks], directions, 0.0)
    for direction, distance in zip(directions[::5], far[::5], strict=True):
        assert overlap_m(scene, chair, (distance + 1e-6) * direction) < 2e-6
        if distance > 1e-3:
            shorter = [overlap_m(scene, chair, t * distance * direction) for t in (0.0, 0.4, 0.8, 0.999)]
            assert min(shorter) > 0.0


@given(st.floats(-3.0, 3.0))
def test_the_directions_turn_with_the_object(yaw: float) -> None:
    turn = yaw_rotation(yaw)
    floor = np.eye(3)[:, :2]
    np.testing.assert_allclose(ring(turn, floor), ring(np.eye(3), floor) @ turn.T, atol=1e-9)
    assert ring(turn, floor).shape == (24, 3)
    assert ring(turn, floor[:, :1]).shape == (2, 3)
    assert ring(turn, 0.0 * floor).shape == (0, 3)


def test_a_tucked_chair_whose_back_meets_the_table_stays_tucked(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37), confidence=0.8)
    cup = room.put("cup_21", (0.0, 0.3, 0.79), on=table, confidence=0.8)
    chair = room.put("chair_4", (-0.20, 0.0, 0.45), confidence=0.4)  # the back would be 3 cm inside the top
    scene = room.scene(camera=looking_north(4.0))
    assert overlap_m(scene, chair, np.zeros(3)) > 0.02
    after, report = FeasibleRecipe(LIBRARY).optimise(scene, Progress())
    moved = {
        n: float(np.linalg.norm(after.object(n).pose.position - scene.object(n).pose.position))
        for n in (table, cup, chair)
    }
    assert report.after["part_overlap_m"] == 0.0
    assert moved[chair] < 0.05
    assert moved[table] < moved[chair]
    assert moved[cup] < 0.01  # what stands on a table stays where it was seen
    assert report.after["box_overlap_m"] > 0.05


def test_what_is_on_a_shelf_keeps_its_level_when_the_shelf_sinks(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0.0, 2.0, 1.04), yaw=-np.pi / 2)  # seen 14 cm too high: its foot was hidden
    levels = [s.height_m + 0.9 for s in LIBRARY.shape("bookshelf_6").surfaces]
    book = room.put("books_19", (0.0, 2.0, levels[2] - 0.12 + 0.02), on=shelf)
    scene = room.scene()
    after = FeasibleRecipe(LIBRARY).optimise(scene, Progress())[0]
    bottom = after.object(book).pose.position[2] - after.object(book).size_m[2] / 2
    nearest = min(levels, key=lambda z: abs(z - (levels[2] - 0.12)))
    assert bottom == pytest.approx(nearest, abs=1e-6)


def test_what_moved_far_is_named(room: Room) -> None:
    room.put("wardrobe_12", (0.0, 1.0, 1.0), locked=True)
    room.put("box_24", (0.0, 1.0, 0.15), id="hidden box")
    _, report = FeasibleRecipe(LIBRARY).optimise(room.scene(camera=looking_north(4.0)), Progress())
    assert any(r.startswith("agrees less with the photo: hidden box") for r in report.reasons)
    room.objects.pop()
    room.supports.pop()
    _, report = FeasibleRecipe(LIBRARY).optimise(room.scene(camera=looking_north(4.0)), Progress())
    assert not any(r.startswith("agrees less") for r in report.reasons)
