from __future__ import annotations

import numpy as np
import pytest

from diorama_core.library.taxonomy import category
from diorama_core.perception.metrology.box_observations import BoxObservations, gather
from diorama_core.perception.metrology.floor import HEIGHTS_M, place_on_floor, scan_heights, solve_all, stands_on_floor
from diorama_core.perception.metrology.problem import View, cuboids
from diorama_core.perception.metrology.settings import SETTINGS
from tests.perception.metrology.test_metrology import ROOM, K, detected, rotation, seen

R = rotation(12.0)
VIEW = View(K, R)


def observed(items=ROOM[:4], height_m: float = 1.5) -> BoxObservations:
    return gather(seen(items, R, height_m), K.width, K.height)


@pytest.mark.parametrize("height_m", [1.2, 1.5, 1.8])
def test_objects_of_usual_size_tell_the_cameras_height(height_m: float) -> None:
    scan = scan_heights(observed(height_m=height_m), VIEW)
    assert scan.height_m == pytest.approx(height_m, rel=0.1)
    assert 0 < scan.log_sigma < 0.2


def test_one_object_suffices_for_an_unusually_low_camera() -> None:
    level = View(K, rotation(0.0))
    one = gather(seen(ROOM[1:2], level.R_world_camera, 0.55), K.width, K.height)
    assert scan_heights(one, level).height_m == pytest.approx(0.55, rel=0.15)


def test_more_objects_make_it_surer() -> None:
    assert scan_heights(observed(ROOM[:4]), VIEW).log_sigma < scan_heights(observed(ROOM[:1]), VIEW).log_sigma


def test_without_objects_on_the_floor_the_prior_decides() -> None:
    for observations in (gather((), 640, 480), observed(ROOM[6:])):
        scan = scan_heights(observations, VIEW)
        assert scan.height_m == pytest.approx(SETTINGS.heights.height_prior_m, abs=0.02)
        assert scan.cost == pytest.approx(0.0, abs=0.05)
        assert HEIGHTS_M.min() < scan.height_m < HEIGHTS_M.max()


def test_one_mislabelled_object_is_outvoted() -> None:
    objects = seen(ROOM[:4], R, 1.5)
    wrong = (*objects[:3], detected("wrong", "wardrobe", objects[3].box))
    assert scan_heights(gather(wrong, 640, 480), VIEW).height_m == pytest.approx(1.5, rel=0.15)


def test_objects_on_the_floor_and_doors_vote() -> None:
    assert stands_on_floor(category("sofa"))
    assert stands_on_floor(category("door"))
    assert not any(stands_on_floor(category(n)) for n in ("picture", "pillow", "ceiling lamp"))


def test_objects_that_stand_freely_may_stand_at_odd_angles() -> None:
    observations = observed()
    headings = [{round(float(np.rad2deg(r.yaw_rad[0]))) for r in place_on_floor(observations, i, 1.5)} for i in (0, 1)]
    free = [c.quarter_turns_free for c in observations.categories[:2]]
    expected = {True: {0, 90, 30, -30, 60, -60}, False: {0, 90}}
    assert headings == [expected[f] for f in free]
    assert True in [c.quarter_turns_free for c in observations.categories]
    straight = [r for r in place_on_floor(observations, 1, 1.5) if r.yaw_rad[0] == 0]
    turned = [r for r in place_on_floor(observations, 1, 1.5) if np.isclose(r.yaw_rad[0], np.deg2rad(30))]
    if turned:
        assert turned[0].extra[0] > straight[0].extra[0]


def test_the_cheapest_solution_is_the_true_place() -> None:
    observations = observed()
    for index in (0, 2):
        solved = solve_all(place_on_floor(observations, index, 1.5), VIEW)
        assert len(solved.cost) == 3 * len(place_on_floor(observations, index, 1.5))
        best = int(solved.cost.argmin())
        centre = cuboids(solved.unknowns, solved.problems, VIEW).centre[best]
        np.testing.assert_allclose(centre, ROOM[index].centre, atol=0.2)
