from __future__ import annotations

import numpy as np
import pytest

from diorama_core.geometry.projection import visible_bounds
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.priors import size_modes
from diorama_core.perception.metrology.problem import UNTOLD, Problems, View, corners_camera, cuboids
from diorama_core.perception.metrology.rows import contact_start, other_start, row, size_start
from tests.perception.metrology.test_metrology import K, detected, rotation
from tests.perception.metrology.test_problem import CENTRE, HEIGHT, SIZE, VIEW, problem, unknowns


def place(start: np.ndarray, of: Problems, view: View = VIEW) -> np.ndarray:
    return cuboids(start, of, view).centre[0]


def test_a_row_is_an_object_on_the_floor_unless_told_otherwise() -> None:
    observations = gather(
        (detected("a", "sofa", (100, 100, 300, 250)), detected("b", "table", (90, 200, 320, 400))), 640, 480
    )
    mode = size_modes("sofa")[0]
    made = row(observations, 0, mode, camera_height_m=1.4, yaw_rad=0.2, wall_m=3.0)
    assert len(made) == 1
    assert (made.item[0], made.base_m[0], made.base_sigma_m[0], made.extra[0]) == (0.0, 0.0, 0.0, mode.cost)
    assert made.wall_m[0] == 3.0
    assert made.footprint_sigma_m[0] == made.wall_sigma[0] == made.top_sigma_m[0] == UNTOLD
    np.testing.assert_array_equal(made.box_px[0], observations.box_px[0])
    assert made.hidden_px[0].tolist() == [0.0, 0.0, 0.0, 150.0]
    resting = row(observations, 0, mode, camera_height_m=1.4, yaw_rad=0.2, parent=1)
    assert not resting.hidden_px.any()


def test_contact_starts_where_the_bottom_meets_the_floor() -> None:
    start = contact_start(problem(), VIEW)
    assert place(start, problem())[:2] == pytest.approx(CENTRE[:2], abs=0.15)
    np.testing.assert_allclose(start[0, 2:5], np.log(SIZE))
    raised = contact_start(problem(base_m=0.5), VIEW)
    assert place(raised, problem(base_m=0.5))[1] < CENTRE[1] - 0.5


def test_where_the_bottom_never_meets_the_floor_the_size_tells() -> None:
    above = problem().with_columns(box_px=[200.0, 10.0, 300.0, 60.0])
    np.testing.assert_array_equal(contact_start(above, VIEW), size_start(above, VIEW))
    assert not np.array_equal(contact_start(problem(), VIEW), size_start(problem(), VIEW))


def test_size_starts_where_the_expected_size_fills_the_box() -> None:
    start = size_start(problem(), VIEW)
    made = cuboids(start, problem(), VIEW)
    bounds = visible_bounds(corners_camera(made, np.array([HEIGHT]), VIEW), K)[0][0]
    box = problem().box_px[0]
    grown = np.sqrt((bounds[2:] - bounds[:2]).prod() / (box[2:] - box[:2]).prod())
    assert grown == pytest.approx(1.0, abs=0.3)
    near, far = (place(size_start(problem(), VIEW, f), problem()) for f in (1.0, 1.5))
    assert far[1] == pytest.approx(1.5 * near[1])


@pytest.mark.parametrize("turn", [-30.0, 0.0, 45.0])
def test_starts_are_ahead_and_bounded(turn: float) -> None:
    view = View(K, rotation(12.0, turn))
    tiny = problem().with_columns(box_px=[300.0, 238.0, 302.0, 240.0])
    huge = problem().with_columns(box_px=[0.0, 0.0, 640.0, 480.0])
    for rows in (tiny, huge):
        for start in (contact_start(rows, view), size_start(rows, view)):
            assert np.log(0.4) - 1e-9 <= start[0, 1] <= np.log(12.0) + 1e-9
            assert abs(start[0, 0]) <= 3.0


def test_unknowns_of_the_truth_are_a_fixed_start() -> None:
    assert place(unknowns(), problem()) == pytest.approx(CENTRE)


def test_where_the_lower_end_may_be_hidden_a_start_has_the_usual_height() -> None:
    whole = problem()
    cut = whole.with_columns(
        box_px=whole.box_px - [[0.0, 0.0, 0.0, 0.6 * float(whole.box_px[0, 3] - whole.box_px[0, 1])]]
    )
    np.testing.assert_array_equal(other_start(cut, VIEW), size_start(cut, VIEW))
    hidden = cut.with_columns(hidden_odds=[0.0, 0.0, 0.0, 2.0])
    reached = [place(start, hidden)[1] for start in (other_start(hidden, VIEW), size_start(hidden, VIEW))]
    assert reached[0] == pytest.approx(CENTRE[1], abs=0.5)
    assert reached[1] > CENTRE[1] + 0.6
