from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.refinement.freedom import Freedom, freedom
from diorama_core.scene import edits
from diorama_core.scene.types import Scene, box_corners
from tests.layout.refinement.views import looking_down
from tests.layout.small_rooms import Room


def of(
    scene: Scene, room: Room, name: str, *, sized: bool = False, is_round: bool = False
) -> tuple[Freedom, Problem, int]:
    problem = build_problem(scene, room.library, adherence_m=0.004)
    i = problem.ids.index(name)
    surface, parent = problem.surface[i], int(problem.parent[i])
    assert surface is not None
    if parent >= 0:
        surface = surface.at(problem.R[parent], problem.p[parent], problem.scale[parent])
    return freedom(problem, i, surface, sized=sized, is_round=is_round), problem, i


def changed_corners(free: Freedom, problem: Problem, i: int, changes: np.ndarray) -> np.ndarray:
    poses = free.poses(problem.R[i], problem.p[i], problem.scale[i], problem.shape_size[i], changes)
    return poses.apply(box_corners(problem.shape_size[i]))


def test_what_stands_free_moves_turns_and_grows_on_the_floor(room: Room) -> None:
    box = room.put("box_24", (0.5, 0.5, 0.0))
    height = room.library.shape("box_24").size_m[2]
    scene = room.scene(camera=looking_down())
    scene = edits.place(scene, {box: scene.object(box).pose.moved((0.0, 0.0, height / 2))})
    free, problem, i = of(scene, room, box)
    assert len(free.directions) == 2
    assert len(free.extents) == 3
    assert free.turns
    rng = np.random.default_rng(3)
    corners = changed_corners(free, problem, i, 0.1 * rng.standard_normal((20, 6)))
    assert np.abs(corners[..., 2].min(axis=1)).max() < 1e-9


def test_what_stands_at_a_wall_moves_along_it_and_stays_against_it(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0.6, 0.0, 0.9), yaw=-np.pi / 2, adheres_to=("wall_2",))
    scene = room.scene(camera=looking_down())
    problem = build_problem(scene, room.library)
    half = problem.shape_size[0][0] / 2
    item = scene.objects[0]
    at_wall = item.pose.moved((0.0, 2.5 - half - item.pose.position[1], 0.0))
    scene = edits.place(scene, {shelf: at_wall})
    free, problem, i = of(scene, room, shelf)
    assert len(free.directions) == 1
    assert abs(free.directions[0] @ [1.0, 0.0, 0.0]) == pytest.approx(1.0)
    assert not free.turns
    corners = changed_corners(free, problem, i, 0.2 * np.random.default_rng(4).standard_normal((20, 4)))
    assert corners[..., 1].max(axis=1) == pytest.approx(np.full(20, 2.5))


def test_what_carries_something_keeps_its_height(room: Room) -> None:
    low = room.put("box_24", (0.5, 0.5, 0.15))
    top = room.put("box_24", (0.5, 0.5, 0.45), on=low, scale=(0.5, 0.5, 0.5))
    scene = room.scene(camera=looking_down())
    np.testing.assert_array_equal(of(scene, room, low)[0].extents, np.eye(3)[:2])
    assert not of(scene, room, low)[0].turns
    assert len(of(scene, room, top)[0].extents) == 3
    assert len(of(scene, room, top, sized=True)[0].extents) == 0


def test_steps_are_either_way_of_every_freedom_and_of_all_extents_together(room: Room) -> None:
    free, *_ = of(room_with_one_box(room), room, "box")
    steps = free.steps(0.1, 0.02)
    assert steps.shape == (1 + 2 * 7, 6)
    assert not steps[0].any()
    assert np.allclose(steps.sum(axis=0), 0.0)
    assert (steps == [0.0, 0.0, 0.02, 0.02, 0.02, 0.0]).all(axis=1).any()


def test_steps_toward_a_place_lead_there_along_the_support(room: Room) -> None:
    free, problem, i = of(room_with_one_box(room), room, "box")
    place = problem.p[i] + np.array([0.4, -0.2, 0.3])
    changes = free.steps_toward(problem.p[i], place)
    poses = free.poses(problem.R[i], problem.p[i], problem.scale[i], problem.shape_size[i], changes)
    assert poses.position[0] == pytest.approx([place[0], place[1], problem.p[i, 2]])
    assert poses.position[1] == pytest.approx(problem.p[i] + [0.2, -0.1, 0.0])
    assert (poses.scale == problem.scale[i]).all()


def room_with_one_box(room: Room) -> Scene:
    room.put("box_24", (0.5, 0.5, 0.15), id="box")
    return room.scene(camera=looking_down())


def test_what_is_round_remains_round(room: Room) -> None:
    free, problem, i = of(room_with_one_box(room), room, "box", is_round=True)
    changes = 0.1 * np.random.default_rng(1).standard_normal((10, free.steps(0.1, 0.02).shape[1]))
    poses = free.poses(problem.R[i], problem.p[i], problem.scale[i], problem.shape_size[i], changes)
    assert poses.scale[:, 0] == pytest.approx(poses.scale[:, 1])
    assert np.ptp(poses.scale[:, 2] / poses.scale[:, 0]) > 0.05
