from __future__ import annotations

import numpy as np
import pytest

from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.problem.volumes import Volumes, contact_templates
from diorama_core.scene.types import Pose
from tests.layout.small_rooms import Room


@pytest.fixture
def problem(room: Room) -> Problem:
    table = room.put("table_0", (0, 0, 0.37), yaw=0.3, scale=(1.1, 0.9, 1.2))
    room.put("cup_21", (0.2, 0.3, 0.85), on=table)
    shelf = room.put(room.library.in_category("bookshelf")[0].id, (-2, 0, 0.9))
    room.put("cup_21", (-2.0, 0.1, 0.5), on=shelf)
    return build_problem(room.scene(), room.library)


def test_batched_volumes_equal_the_surfaces_one_by_one(problem: Problem, rng: np.random.Generator) -> None:
    volumes = Volumes.of(problem)
    R = np.array([rotation_from_vector(v) for v in rng.normal(0, 1, (problem.count, 3))])
    p, scale = rng.normal(0, 1, (problem.count, 3)), rng.uniform(0.5, 2.0, (problem.count, 3))
    found = volumes.at(R, p, scale)
    assert volumes.supported.tolist() == [i for i, s in enumerate(problem.surface) if s is not None]
    assert (volumes.supporter >= 0).sum() == 2
    for row, i in enumerate(volumes.supported):
        j = int(problem.parent[i])
        surface = problem.surface[i]
        one = surface if j < 0 else surface.in_world(Pose(R[j], p[j], scale[j]))
        k = len(one.offset)
        np.testing.assert_allclose(found.outward[row, :k], one.outward, atol=1e-12)
        np.testing.assert_allclose(found.offset[row, :k], one.offset, atol=1e-12)
        assert not found.outward[row, k:].any()
        np.testing.assert_allclose(found.normal[row], one.normal, atol=1e-12)
        assert found.level[row] == pytest.approx(one.level)
        assert found.clearance[row] == pytest.approx(one.clearance_m)


def test_contact_templates_are_the_corners_of_the_touching_face(problem: Problem) -> None:
    every = np.arange(problem.count)
    corners, half = contact_templates(problem, every)
    np.testing.assert_allclose(half, problem.shape_size / 2)
    for i in every:
        np.testing.assert_allclose(corners[i] @ problem.contact[i], half[i] @ np.abs(problem.contact[i]))
        assert len({tuple(c) for c in corners[i].round(9)}) == 4
        np.testing.assert_allclose(np.abs(corners[i]), np.broadcast_to(half[i], (4, 3)))


def test_a_scene_without_supports_has_no_volumes(room: Room) -> None:
    empty = Volumes.of(build_problem(room.scene(), room.library))
    assert len(empty.supported) == 0
    assert len(empty.at(np.zeros((0, 3, 3)), np.zeros((0, 3)), np.zeros((0, 3))).level) == 0
