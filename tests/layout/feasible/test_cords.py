"""Lamps go on up to the ceiling that they hang from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.layout.feasible.cords import reaching_ceilings
from diorama_core.layout.feasible.photo_observations import photo_observations
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.settings import LAYOUT
from diorama_core.scene.types import Architecture, Plane
from diorama_core.synthesis.layout_rooms import room_box
from tests.layout.feasible.test_photo_observations import looking_north, outline
from tests.layout.small_rooms import Room


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
