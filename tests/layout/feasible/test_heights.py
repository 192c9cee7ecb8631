from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.layout.feasible.heights import joint_heights
from diorama_core.layout.feasible.photo_observations import photo_observations
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.settings import LAYOUT
from tests.layout.feasible.test_photo_observations import boxed, looking_north
from tests.layout.small_rooms import Room

BOX, CUP = "box_24", "cup_21"


def problems_of(room: Room, cups: tuple[float, ...], *, box_foot_m: float = 0.0) -> tuple[Problem, Problem]:
    """A box on the floor with cups seen so far above its top; before and after."""
    size, cup = np.array(room.library.shape(BOX).size_m), np.array(room.library.shape(CUP).size_m)
    box = room.put(BOX, (0.0, 1.0, box_foot_m + size[2] / 2), id="box")
    for k, gap in enumerate(cups):
        at = (0.1 * (k - (len(cups) - 1) / 2), 1.0, box_foot_m + size[2] + gap + cup[2] / 2)
        room.put(CUP, at, on=box, id=f"cup_{k}")
    camera = looking_north()
    scene = room.scene(camera=camera)
    problem = build_problem(boxed(scene), room.library)
    seen = photo_observations(problem, camera, depth_weight=1.0, measured=True)
    return problem, joint_heights(problem, seen)[0]


def ends(problem: Problem, name: str) -> tuple[float, float]:
    """Heights of an object's foot and top."""
    k = problem.ids.index(name)
    half = problem.shape_size[k, 2] * problem.scale[k, 2] / 2
    return float(problem.p[k, 2] - half), float(problem.p[k, 2] + half)


@pytest.mark.parametrize("gap", [-0.04, 0.04])
def test_a_supporter_becomes_as_high_as_its_loads_say(room: Room, gap: float) -> None:
    before, after = problems_of(room, (gap, gap, gap))
    top = ends(after, "box")[1]
    assert abs(top - ends(before, "cup_1")[0]) < 0.25 * abs(gap)
    for cup in ("cup_0", "cup_1", "cup_2"):
        assert ends(after, cup)[0] == pytest.approx(top)
        assert ends(after, cup)[1] == pytest.approx(ends(before, cup)[1], abs=0.3 * abs(gap))


def test_one_load_that_says_otherwise_does_not_outvote_the_others(room: Room) -> None:
    before, after = problems_of(room, (0.0, 0.0, 0.0, 0.08))
    assert ends(after, "box")[1] == pytest.approx(ends(before, "box")[1], abs=0.012)


def test_what_is_exact_stays(room: Room) -> None:
    before, after = problems_of(room, (0.0, 0.0))
    np.testing.assert_array_equal(after.scale, before.scale)
    np.testing.assert_array_equal(after.p, before.p)


def test_a_load_that_was_seen_far_from_its_place_says_nothing_about_it(room: Room) -> None:
    before, after = problems_of(room, (0.5,))
    assert ends(after, "box")[1] == pytest.approx(ends(before, "box")[1])


def test_a_foot_that_hangs_above_the_floor_comes_down_while_the_top_stays(room: Room) -> None:
    before, after = problems_of(room, (0.0,), box_foot_m=0.05)
    assert ends(after, "box")[0] == pytest.approx(0.0)
    assert ends(after, "box")[1] == pytest.approx(ends(before, "box")[1], abs=1e-6)


def test_heights_change_within_limits(room: Room) -> None:
    before, after = problems_of(room, (0.11, 0.11, 0.11), box_foot_m=0.1)
    k = before.ids.index("box")
    assert after.scale[k, 2] <= LAYOUT.max_stretch * before.scale[k, 2] + 1e-9


def test_decided_heights_are_not_fitted_again(room: Room) -> None:
    size = np.array(room.library.shape(BOX).size_m)
    room.put(BOX, (0.0, 1.0, 0.03 + size[2] / 2), id="box")
    camera = looking_north()
    scene = room.scene(camera=camera)
    problem = build_problem(scene, room.library)
    seen = photo_observations(problem, camera, depth_weight=1.0, measured=True)
    seen = replace(seen, measured=np.array([True]))
    after, limited = joint_heights(problem, seen)
    assert limited.least[0, 2] == limited.most[0, 2] == after.scale[0, 2]
    np.testing.assert_array_equal(limited.least[0, :2], seen.least[0, :2])


def test_objects_that_a_person_may_have_put_anywhere_stay(room: Room) -> None:
    size = np.array(room.library.shape(BOX).size_m)
    room.put(BOX, (0.0, 1.0, 0.05 + size[2] / 2), id="box")
    camera = looking_north()
    problem = build_problem(room.scene(camera=camera), room.library)
    seen = photo_observations(problem, camera, depth_weight=1.0, measured=True)
    assert not seen.measured.any()
    after, _ = joint_heights(problem, seen)
    np.testing.assert_array_equal(after.p, problem.p)
