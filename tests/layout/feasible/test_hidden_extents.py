from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.layout.feasible.hidden_extents import (
    MAX_CORD_M,
    MIN_SHARE,
    ending_before_neighbours,
    ending_on_walls,
    reaching_ceilings,
)
from diorama_core.layout.feasible.photo_observations import photo_observations
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.report import part_overlaps
from diorama_core.scene.types import Architecture, Plane
from diorama_core.synthesis.layout_rooms import room_box
from tests.layout.feasible.test_photo_observations import looking_north, outline
from tests.layout.small_rooms import Room

BOX = "box_24"
"""0.35 x 0.45 x 0.3 m."""


def problem_of(
    room: Room, x: float, *, hidden: bool = True, load: bool = False, amodal: bool = False
) -> tuple[Problem, Problem]:
    """A box whose left end is behind a nearer one, and in it; before and after."""
    far = room.put(BOX, (x, 1.0, 0.15), yaw=-np.pi / 2, id="far")
    near = room.put(BOX, (0.0, 0.8, 0.15), yaw=-np.pi / 2, id="near")
    if load:
        room.put("cup_21", (x - 0.2, 1.0, 0.35), on=far, id="load")
    camera = looking_north()
    scene = room.scene(camera=camera)
    boxes = {far: outline(scene, far), near: outline(scene, near)} if hidden else {far: outline(scene, far)}
    if hidden and not amodal:  # a photo's box ends where something nearer begins
        boxes[far][0] = max(boxes[far][0], boxes[near][2])
    boxed = tuple(replace(o, box_px=tuple(boxes[o.id]) if o.id in boxes else None) for o in scene.objects)
    problem = build_problem(replace(scene, objects=boxed), room.library)
    return problem, ending_before_neighbours(problem, photo_observations(problem, camera, depth_weight=1.0))


def test_a_hidden_end_stops_before_what_hides_it(room: Room) -> None:
    before, after = problem_of(room, 0.3)
    k = before.ids.index("far")
    assert after.scale[k, 1] < before.scale[k, 1]
    right = before.p[k, 0] + before.shape_size[k, 1] / 2
    assert after.p[k, 0] + after.shape_size[k, 1] * after.scale[k, 1] / 2 == pytest.approx(right)
    assert part_overlaps(before, before.R, before.p, before.scale)
    assert not part_overlaps(after, after.R, after.p, after.scale)


def test_an_end_that_was_seen_stays(room: Room) -> None:
    before, after = problem_of(room, 0.3, hidden=False)
    np.testing.assert_array_equal(after.scale, before.scale)


def test_an_end_that_the_photo_shows_above_what_hides_it_stays(room: Room) -> None:
    before, after = problem_of(room, 0.3, amodal=True)
    np.testing.assert_array_equal(after.scale, before.scale)


def test_no_object_loses_more_than_half(room: Room) -> None:
    before, after = problem_of(room, 0.05)
    assert (after.scale >= MIN_SHARE * before.scale - 1e-12).all()


def test_an_end_goes_on_under_its_load(room: Room) -> None:
    before, after = problem_of(room, 0.3, load=True)
    np.testing.assert_array_equal(after.scale, before.scale)


@pytest.mark.parametrize("held", [False, True])
def test_a_hidden_end_stops_before_what_stands_within_it_on_something_that_is_not_marked(
    room: Room, held: bool
) -> None:
    far = room.put(BOX, (0.3, 1.0, 0.15), yaw=-np.pi / 2, id="far")
    near = room.put(BOX, (0.02, 0.6, 0.15), yaw=-np.pi / 2, id="near")
    cup = room.put("cup_21", (0.16, 1.0, 0.2), on="floor" if held else None, id="cup")
    camera = looking_north()
    scene = room.scene(camera=camera)
    boxes = {name: outline(scene, name) for name in (far, near, cup)}
    boxes[far][0] = max(boxes[far][0], boxes[near][2])
    boxed = tuple(replace(o, box_px=tuple(boxes[o.id])) for o in scene.objects)
    problem = build_problem(replace(scene, objects=boxed), room.library)
    after = ending_before_neighbours(problem, photo_observations(problem, camera, depth_weight=1.0))
    k, c = problem.ids.index(far), problem.ids.index(cup)
    assert (problem.surface[c] is not None) == held
    assert (after.scale[k, 1] == problem.scale[k, 1]) == held
    assert bool(part_overlaps(after, after.R, after.p, after.scale)) == held


def hung(room: Room, top_m: float, *, cut: bool) -> tuple[Problem, Problem]:
    """A box on the far wall of a room 2.6 m high, whose upper end may be above the picture; before and after."""
    size = room.library.shape(BOX).size_m
    scale = (1.0, 1.0, 1.5 / size[2])
    at = (0.0, 2.5 - size[0] / 2, top_m - 0.75)
    name = room.put(BOX, at, on="wall_2", relation="mounted on", yaw=-np.pi / 2, scale=scale)
    camera = looking_north(0.5)  # sees the far wall up to 2.94 m
    scene = room.scene(camera=camera)
    box = outline(scene, name)
    box[1] = max(box[1], 0.0) if cut else box[1]
    scene = replace(scene, objects=tuple(replace(o, box_px=tuple(box)) for o in scene.objects))
    problem = build_problem(scene, room.library)
    return problem, ending_on_walls(problem, photo_observations(problem, camera, depth_weight=1.0, measured=True))


def test_what_goes_on_above_the_picture_ends_at_the_ceiling_and_its_lower_end_stays(room: Room) -> None:
    before, after = hung(room, 3.2, cut=True)
    low, high = (p.p[0, 2] + sign * 0.5 * p.shape_size[0, 2] * p.scale[0, 2] for p, sign in ((after, -1), (after, 1)))
    assert high == pytest.approx(2.6)
    assert low == pytest.approx(before.p[0, 2] - 0.75)


@pytest.mark.parametrize(("top_m", "cut"), [(2.5, True), (2.7, False)])
def test_what_ends_below_the_ceiling_or_whose_end_was_seen_stays(room: Room, top_m: float, cut: bool) -> None:
    before, after = hung(room, top_m, cut=cut)
    np.testing.assert_array_equal(after.scale, before.scale)
    np.testing.assert_array_equal(after.p, before.p)


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


@pytest.mark.parametrize(("top_m", "cut"), [(2.2, False), (2.55 - MAX_CORD_M, True)], ids=["seen", "far below"])
def test_a_lamp_whose_end_was_seen_or_that_is_far_below_stays(room: Room, top_m: float, cut: bool) -> None:
    before, after = hanging_lamp(room, top_m, cut=cut)
    np.testing.assert_array_equal(after.scale, before.scale)
    np.testing.assert_array_equal(after.p, before.p)
