"""Supporters reach as far as what was seen on them. Lamps go on up to the ceiling that they hang from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.arrangement.surfaces import RestingSurface
from diorama_core.layout.feasible.photo_observations import photo_observations
from diorama_core.layout.feasible.reach import reaching_ceilings, reaching_loads
from diorama_core.layout.feasible.structure import exact_structure
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.settings import LAYOUT
from diorama_core.scene.types import Architecture, Plane
from diorama_core.synthesis.layout_rooms import box_library, room_box
from tests.layout.feasible.test_photo_observations import looking_north, outline
from tests.layout.small_rooms import Room

LIBRARY = box_library()


def reached(
    room: Room, beyond_m: float, *, above_m: float = 0.0, eye: np.ndarray | None = None
) -> tuple[Problem, Problem]:
    """A table with a vase whose middle is beyond its right end; before and after."""
    table = room.put("table_0", (0.0, 0.6, 0.37), id="a-table")
    right = float(room.objects[0].corners_world[:, 0].max())
    room.put("vase_20", (right + beyond_m, 0.6, 0.74 + above_m + 0.14), on=table, id="b-vase")
    problem = build_problem(room.scene(camera=looking_north()), LIBRARY)
    return problem, reaching_loads(problem, exact_structure(problem), eye)


def sides(problem: Problem) -> tuple[float, float]:
    half = 0.5 * np.abs(problem.R[0]) @ (problem.shape_size[0] * problem.scale[0])
    return float(problem.p[0, 0] - half[0]), float(problem.p[0, 0] + half[0])


def test_a_side_comes_out_to_its_load_and_the_other_stays(room: Room) -> None:
    before, after = reached(room, 0.02)
    vase = 0.5 * float(LIBRARY.shape("vase_20").size_m[1])
    assert sides(after)[0] == pytest.approx(sides(before)[0])
    assert sides(after)[1] == pytest.approx(before.p[1, 0] + vase, abs=2e-3)
    np.testing.assert_array_equal(after.p[1], before.p[1])


def test_sides_come_out_within_limits(room: Room) -> None:
    before, after = reached(room, 1.0)
    assert sides(after)[1] - sides(after)[0] == pytest.approx(
        LAYOUT.max_stretch * (sides(before)[1] - sides(before)[0])
    )


def test_a_load_larger_than_its_supporter_hangs_over(room: Room) -> None:
    table = room.put("table_0", (0.0, 0.6, 0.37), id="a-table")
    width = float(np.ptp(room.objects[0].corners_world, axis=0).max() / min(LIBRARY.shape("vase_20").size_m[:2]))
    room.put("vase_20", (0.05, 0.6, 0.88), on=table, id="b-vase", scale=(1.1 * width, 1.1 * width, 1.0))
    problem = build_problem(room.scene(camera=looking_north()), LIBRARY)
    after = reaching_loads(problem, exact_structure(problem), None)
    np.testing.assert_array_equal(after.scale, problem.scale)
    np.testing.assert_array_equal(after.p, problem.p)


def test_what_carries_its_load_stays_as_it_is(room: Room) -> None:
    before, after = reached(room, -0.3)
    np.testing.assert_array_equal(after.scale, before.scale)
    np.testing.assert_array_equal(after.p, before.p)


def test_from_a_photo_alone_a_load_is_where_its_line_of_sight_meets_its_place(room: Room) -> None:
    # Seen too high it is farther away than it was put, and with that farther to the right.
    eye = looking_north().position
    _, measured = reached(room, 0.02, above_m=0.04)
    room.objects.clear()
    room.supports.clear()
    _, reasoned = reached(room, 0.02, above_m=0.04, eye=eye)
    assert sides(reasoned)[1] > sides(measured)[1] + 0.02


@pytest.mark.parametrize(("share", "comes_out"), [(0.8, True), (0.5, False)])
def test_no_side_comes_out_for_a_divider_that_is_far_from_it(room: Room, share: float, comes_out: bool) -> None:
    table = room.put("table_0", (0.0, 0.6, 0.37), id="a-table")
    right = share * float(room.objects[0].corners_world[:, 0].max())
    room.put("vase_20", (right + 0.01, 0.6, 0.88), on=table, id="b-vase")
    problem = build_problem(room.scene(camera=looking_north()), LIBRARY)
    structure = exact_structure(problem)
    place = structure.surface[1]
    assert place is not None
    narrow = RestingSurface.of(place.polygon * [share, 1.0, 1.0], place.normal, place.clearance_m, of_plane=False)
    after = reaching_loads(problem, replace(structure, surface=(structure.surface[0], narrow)), None)
    assert (after.scale != problem.scale).any() == comes_out


def hanging_lamp(room: Room, top_m: float, *, cut: bool) -> tuple[Problem, Problem]:
    """A lamp below the ceiling of a room 2.6 m high, whose upper end may be above the picture; before and after."""
    name = room.put("lamp_16", (0.0, 0.5, top_m - room.library.shape("lamp_16").size_m[2] / 2), on="ceiling")
    room.objects[0] = replace(room.objects[0], category="ceiling lamp")
    room.supports[0] = replace(room.supports[0], relation="mounted on", child_face="top")
    camera = looking_north(0.5)
    corners = np.array([[-3.0, -2.5, 2.6], [-3.0, 2.5, 2.6], [3.0, 2.5, 2.6], [3.0, -2.5, 2.6]])
    planes = room_box(6.0, 5.0).planes
    ceiling = Architecture((*(p for p in planes if p.role != "ceiling"), Plane("ceiling", "ceiling", corners)))
    scene = room.scene(camera=camera, architecture=ceiling)
    box = outline(scene, name)
    box[1] = 0.0 if cut else max(box[1], 10.0)
    scene = replace(scene, objects=tuple(replace(o, box_px=tuple(box)) for o in scene.objects))
    problem = build_problem(scene, room.library)
    return problem, reaching_ceilings(problem, photo_observations(problem, camera, depth_weight=1.0, measured=True))


def test_a_lamp_whose_upper_end_was_not_seen_goes_on_up_to_the_ceiling(room: Room) -> None:
    before, after = hanging_lamp(room, 2.2, cut=True)
    half = 0.5 * before.shape_size[0, 2]
    assert after.p[0, 2] + half * after.scale[0, 2] == pytest.approx(2.6)
    assert after.p[0, 2] - half * after.scale[0, 2] == pytest.approx(before.p[0, 2] - half * before.scale[0, 2])
    np.testing.assert_array_equal(after.scale[:, :2], before.scale[:, :2])


@pytest.mark.parametrize(("top_m", "cut"), [(2.2, False), (2.55 - LAYOUT.max_cord_m, True)], ids=["seen", "far below"])
def test_a_lamp_whose_end_was_seen_or_that_is_far_below_stays(room: Room, top_m: float, cut: bool) -> None:
    before, after = hanging_lamp(room, top_m, cut=cut)
    np.testing.assert_array_equal(after.scale, before.scale)
    np.testing.assert_array_equal(after.p, before.p)
