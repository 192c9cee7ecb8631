from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.errors import Cancelled
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.feasible.separate import Program, Separation, build_program, overlaps, separate
from diorama_core.layout.feasible.structure import exact_structure
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.settings import LAYOUT
from diorama_core.library.catalogue import built_in_library
from diorama_core.progress import Progress
from diorama_core.scene.types import Pose, Scene, SceneObject, Support
from diorama_core.synthesis.layout_rooms import box_library, room_box
from tests.layout.small_rooms import Room

BOX = "box_24"
"""0.35 x 0.45 x 0.3 m."""


def program(room: Room, weight: tuple[float, ...] = ()) -> Program:
    problem = build_problem(room.scene(), room.library)
    weights = np.eye(2) * np.array(weight or (1.0,) * problem.count)[:, None, None]
    return build_program(problem, exact_structure(problem), weights)


def solved(p: Program, rounds: int = 20) -> Separation:
    return separate(p, rounds=rounds, check=lambda y, depth: None)


def test_free_objects_do_not_move(room: Room) -> None:
    room.put(BOX, (0, 0, 0.15))
    room.put(BOX, (1, 0, 0.15))
    p = program(room)
    found = solved(p)
    np.testing.assert_allclose(p.moves(found.y), 0.0, atol=1e-9)
    assert found.depth_m == 0.0
    assert found.stuck == ()


def penetration_m(offset: np.ndarray, yaw: float) -> float:
    """How deep two of the boxes overlap in plan, by the separating axis theorem; negative when they are apart."""
    half = np.array([0.175, 0.225])
    c, s = np.cos(yaw), np.sin(yaw)
    sides = np.array([[1.0, 0.0], [0.0, 1.0], [c, s], [-s, c]])
    reach = np.abs(sides[:, :2]) @ half + np.abs(sides @ np.array([[c, -s], [s, c]])) @ half
    return float((reach - np.abs(sides @ offset)).min())


@settings(max_examples=15)
@given(x=st.floats(-0.3, 0.3), y=st.floats(-0.4, 0.4), yaw=st.floats(-3.1, 3.1))
def test_two_overlapping_boxes_part_by_the_least_move(x, y, yaw) -> None:
    room = Room(box_library())
    room.put(BOX, (0, 0, 0.15))
    room.put(BOX, (x, y, 0.15), yaw=yaw)
    p = program(room)
    before = penetration_m(np.array([x, y]), yaw)
    found = solved(p)
    assert found.stuck == ()
    assert overlaps(p, found.y)[0] <= 1e-4
    moves = p.moves(found.y)
    np.testing.assert_allclose(moves[:, 2], 0.0, atol=1e-9)
    if before > 1e-3:
        # Both give way alike, and together by the depth in plan, or a little more: only some directions are tried.
        np.testing.assert_allclose(moves[0], -moves[1], atol=1e-6)
        moved = float(np.linalg.norm(moves[0] - moves[1]))
        assert before + LAYOUT.apart_m - 2e-4 < moved < 1.1 * before + 2e-3


def test_the_heavier_of_two_moves_less(room: Room) -> None:
    room.put(BOX, (0, 0, 0.15))
    room.put(BOX, (0.2, 0, 0.15))
    p = program(room, (9.0, 1.0))
    a, b = np.linalg.norm(p.moves(solved(p).y), axis=1)
    assert b == pytest.approx(9.0 * a, rel=1e-3)


def test_a_locked_object_stays_and_the_other_gives_way(room: Room) -> None:
    room.put(BOX, (0, 0, 0.15), locked=True)
    room.put(BOX, (0.2, 0, 0.15))
    p = program(room)
    moves = p.moves(solved(p).y)
    assert not moves[0].any()
    assert moves[1] == pytest.approx([0.15 + LAYOUT.apart_m, 0.0, 0.0], abs=2e-4)


def test_what_stands_on_an_object_rides_along(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37))
    cup = room.put("cup_21", (0.1, 0.0, 0.79), on=table)
    room.put("wardrobe_12", (0.7, 0, 1.0), locked=True)
    p = program(room)
    moves = dict(zip(p.problem.ids, p.moves(solved(p).y), strict=True))
    assert moves[table][0] < -0.01
    np.testing.assert_allclose(moves[cup], moves[table], atol=1e-6)


def test_objects_stay_before_walls_and_on_their_supports(room: Room) -> None:
    room.put(BOX, (-2.75, 0, 0.15))
    room.put(BOX, (-2.6, 0.05, 0.15))
    p = program(room)
    found = solved(p)
    placed = [np.array(o.corners_world) + m for o, m in zip(room.objects, p.moves(found.y), strict=True)]
    assert min(corners[:, 0].min() for corners in placed) >= -3.0 - 1e-6
    assert found.stuck == ()


def test_what_has_no_way_out_is_named_with_its_depth(room: Room) -> None:
    stand = room.put("night_stand_11", (0, 0, 0.25), locked=True)
    fixed = room.put("cup_21", (0, 0, 0.55), on=stand, locked=True)
    # The stand's top leaves it 25 mm to either side; the cup is 90 mm wide.
    wedged = room.put(BOX, (0.01, 0, 0.65), on=stand)
    p = program(room)
    found = solved(p)
    assert [p.problem.ids[i] for i in found.stuck[0]] == sorted((fixed, wedged))
    # In plan the box covers the cup by 0.22 m; upward it may not go.
    assert found.depth_m > 0.05


def test_supporters_and_what_they_support_never_collide(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37))
    room.put("cup_21", (0.1, 0.0, 0.75), on=table)
    problem = build_problem(room.scene(), room.library)
    p = build_program(problem, exact_structure(problem), np.repeat(np.eye(2)[None], 2, axis=0))
    assert overlaps(p, np.zeros(p.J.shape[2])) == (0.0, ())


def test_no_objects_at_all(room: Room) -> None:
    found = solved(program(room))
    assert (found.depth_m, found.stuck, len(found.y)) == (0.0, (), 0)


def test_the_check_sees_every_round_and_may_stop(room: Room) -> None:
    room.put(BOX, (0, 0, 0.15))
    room.put(BOX, (0.2, 0, 0.15))
    seen: list[float] = []

    def check(y: np.ndarray, depth: float) -> None:
        seen.append(depth)
        if len(seen) == 2:
            raise Cancelled("enough")

    with pytest.raises(Cancelled):
        separate(program(room), rounds=20, check=check)
    assert seen[0] == pytest.approx(0.15, abs=1e-6)
    assert seen[1] < 1e-4


def test_round_things_with_many_axes_part_without_becoming_smaller() -> None:
    library = built_in_library()
    cup, plate = (library.shape(name) for name in ("cup-mug-white", "bowl-plate"))
    objects = tuple(
        SceneObject(s.id, s.id, s.category, s.id, s.size_m, Pose.upright((x, 0.1 * x, s.size_m[2] / 2), 0.3))
        for s, x in ((cup, 0.0), (plate, 0.05))
    )
    edges = tuple(Support(item.id, "floor") for item in objects)
    scene = Scene(objects=objects, supports=edges, architecture=room_box(4.0, 4.0))
    settled, report = FeasibleRecipe(library).optimise(scene, Progress())
    assert report.reasons == ()
    assert report.after["part_overlap_m"] == 0.0
    assert all(np.array_equal(o.pose.scale, np.ones(3)) for o in settled.objects)
