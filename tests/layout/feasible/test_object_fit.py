"""One object's least-squares problem: derivatives, and steps within limits."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.layout.feasible.object_fit import ObjectFit, solve_bounded_step
from tests.layout.feasible.test_photo_observations import LIBRARY, looking_north, observations_of
from tests.layout.small_rooms import Room


@settings(max_examples=20)
@given(
    st.floats(-1.0, 1.0),
    st.floats(0.5, 3.0),
    st.floats(-3.0, 3.0),
    st.lists(st.floats(-0.1, 0.1), min_size=5, max_size=5),
)
def test_derivatives_are_the_slopes(x: float, y: float, yaw: float, state: list[float]) -> None:
    room = Room(LIBRARY)
    room.put("box_24", (x, y, 0.3), yaw=yaw)
    scene = room.scene(camera=looking_north())
    pose = scene.objects[0].pose
    fit = observations_of(scene)._object_fit(
        0, pose.R_world_object, pose.position, pose.scale, np.eye(3)[:, :2], np.array([0.0, 0.0, -1.0])
    )
    assert isinstance(fit, ObjectFit)
    here, step = np.array(state), 1e-6
    system = fit.linearise(here)
    assert system is not None
    for k, towards in enumerate(step * np.eye(5)):
        ahead, behind = fit.linearise(here + towards), fit.linearise(here - towards)
        assert ahead is not None
        assert behind is not None
        slope = (ahead[1] - behind[1]) / (2 * step)
        # Where two corners are equally far out, an outline has a slope to either side: any between them will do.
        one_sided = np.stack([(ahead[1] - system[1]) / step, (system[1] - behind[1]) / step])
        smooth = np.abs(one_sided[0] - one_sided[1]) < 1e-3
        assert np.allclose(system[0][smooth, k], slope[smooth], atol=1e-4)


def test_a_size_that_reaches_its_limit_is_held_there_and_the_rest_solved_again() -> None:
    J = np.vstack([np.eye(5), [1.0, 0.0, 0.0, 0.0, 1.0]])
    wanted = np.array([0.0, 0.0, 0.05, -0.05, 0.5, 0.5])
    step = solve_bounded_step(J, -wanted, np.full(3, -0.2), np.full(3, 0.2))
    assert np.isclose(step[4], 0.2)
    np.testing.assert_allclose(step[:4], [0.15, 0.0, 0.05, -0.05], atol=1e-9)  # half of what the limit left over
