from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.refinement.freedom import (
    MEASURED,
    REASONED,
    Freedom,
    PosePrior,
    Precision,
    RoomLeft,
    freedom,
)
from diorama_core.layout.report import part_overlaps
from diorama_core.layout.settings import REFINEMENT
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.types import Pose, Scene, box_corners, yaw_rotation
from tests.layout.refinement.views import looking_down
from tests.layout.small_rooms import Room


def of(
    scene: Scene, room: Room, name: str, *, sized: bool = False, is_round: bool = False
) -> tuple[Freedom, Problem, int]:
    problem = build_problem(scene, room.library, adherence_m=0.004)
    i = problem.ids.index(name)
    surface = problem.surface[i]
    assert surface is not None
    return freedom(problem, i, problem.to_world(i, surface), sized=sized, is_round=is_round), problem, i


def changed_corners(free: Freedom, problem: Problem, i: int, changes: np.ndarray) -> np.ndarray:
    poses = free.poses(problem.R[i], problem.p[i], problem.scale[i], problem.shape_size[i], changes)
    return poses.apply(box_corners(problem.shape_size[i]))


def test_what_stands_free_moves_turns_and_grows_on_the_floor(room: Room) -> None:
    box = room.put("box_24", (0.5, 0.5, 0.0))
    height = room.library.shape("box_24").size_m[2]
    scene = room.scene(camera=looking_down())
    scene = edits.place(scene, {box: scene.object(box).pose.move((0.0, 0.0, height / 2))})
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
    at_wall = item.pose.move((0.0, 2.5 - half - item.pose.position[1], 0.0))
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


EYE = np.array([0.0, 0.0, 1.5])
OBSERVED = Pose.upright((0.0, 2.0, 0.5), 0.0, (1.0, 1.2, 0.8))


def cost(pose: Pose, precision: Precision) -> float:
    batch = PoseBatch.single(pose)
    return float(PosePrior(EYE, OBSERVED, precision).cost(batch)[0])


@pytest.mark.parametrize("precision", [MEASURED, REASONED])
def test_the_observed_pose_costs_nothing_and_a_standard_deviation_what_it_weighs(precision: Precision) -> None:
    assert cost(OBSERVED, precision) == pytest.approx(0.0, abs=1e-12)
    turned = replace(OBSERVED, R_world_object=yaw_rotation(0.1))
    assert cost(turned, precision) == pytest.approx(REFINEMENT.sigma)
    larger = replace(OBSERVED, scale=np.array(OBSERVED.scale) * np.exp(precision.size_share))
    assert cost(larger, precision) == pytest.approx(REFINEMENT.sigma)


def test_from_a_photo_alone_what_is_farther_is_larger() -> None:
    away = Pose(OBSERVED.R_world_object, EYE + 1.1 * (OBSERVED.position - EYE), OBSERVED.scale)
    enlarged = replace(away, scale=1.1 * np.array(away.scale))
    assert cost(enlarged, REASONED) < cost(away, REASONED)
    assert cost(enlarged, MEASURED) > cost(away, MEASURED)


def test_what_the_layout_changed_much_costs_no_more_for_another_change() -> None:
    much, more = (replace(OBSERVED, R_world_object=yaw_rotation(turn)) for turn in (1.0, 1.4))
    assert (
        cost(much, MEASURED)
        == pytest.approx(cost(more, MEASURED))
        == pytest.approx(REFINEMENT.sigma * REFINEMENT.max_sigmas**2)
    )


@pytest.mark.parametrize("precision", [MEASURED, REASONED])
def test_what_the_layout_moved_far_is_drawn_back_evenly(precision: Precision) -> None:
    usual = max(precision.distance_m / float(np.linalg.norm(OBSERVED.position - EYE)), precision.distance_share)
    away = [np.exp(k * usual) for k in (0.5, 4.0, 8.0, 12.0)]
    near, *far = (cost(_at_distance(d, precision), precision) for d in away)
    assert near == pytest.approx(REFINEMENT.sigma * 0.25)
    assert (
        far[2] - far[1]
        == pytest.approx(far[1] - far[0])
        == pytest.approx(REFINEMENT.sigma * 4.0 * 2.0 * REFINEMENT.linear_sigmas)
    )


def _at_distance(times: float, precision: Precision) -> Pose:
    grown = times if precision.sizes_follow else 1.0
    return Pose(OBSERVED.R_world_object, EYE + times * (OBSERVED.position - EYE), grown * np.array(OBSERVED.scale))


def test_only_what_was_measured_is_known_to_have_been_pushed_away() -> None:
    prior = PosePrior(EYE, OBSERVED, MEASURED)
    assert not prior.was_pushed_away(OBSERVED.move((0.01, 0.0, 0.0)).position)
    assert prior.was_pushed_away(OBSERVED.move((0.1, 0.0, 0.0)).position)
    assert not PosePrior(EYE, OBSERVED, REASONED).was_pushed_away(OBSERVED.move((0.1, 0.0, 0.0)).position)


def settled(room: Room) -> Problem:
    scene, _ = FeasibleRecipe(room.library).optimise(room.scene(), Progress())
    return build_problem(scene, room.library, adherence_m=0.004)


def allowed(problem: Problem, name: str, move: tuple[float, float, float], grown: float = 1.0) -> bool:
    i, p, scale = problem.ids.index(name), problem.p.copy(), problem.scale.copy()
    p[i] += move
    scale[i] *= grown
    return RoomLeft.of(problem).allows(i, problem.with_poses(problem.R, p, scale))


def test_a_settled_layout_is_allowed_and_so_is_a_move_into_free_space(room: Room) -> None:
    room.put("box_24", (0.0, 0.0, 0.15), id="a")
    room.put("box_24", (1.5, 0.0, 0.15), id="b")
    problem = settled(room)
    assert allowed(problem, "a", (0.0, 0.0, 0.0))
    assert allowed(problem, "a", (0.3, 0.2, 0.0))


def test_into_a_neighbour_through_a_wall_and_off_the_floor_nothing_moves(room: Room) -> None:
    room.put("box_24", (0.0, 0.0, 0.15), id="a")
    room.put("box_24", (1.5, 0.0, 0.15), id="b")
    room.put("box_24", (0.0, 2.2, 0.15), id="at wall")
    problem = settled(room)
    assert not allowed(problem, "a", (1.5, 0.1, 0.0))
    assert not allowed(problem, "a", (0.0, 0.0, 0.05))
    assert not allowed(problem, "at wall", (0.0, 0.4, 0.0))


def test_what_carries_something_does_not_leave_it_in_the_air(room: Room) -> None:
    low = room.put("box_24", (0.0, 0.0, 0.15), id="low")
    room.put("box_24", (0.0, 0.0, 0.45), on=low, id="on top", scale=(0.9, 0.9, 0.5))
    problem = settled(room)
    assert not allowed(problem, "low", (0.3, 0.0, 0.0))
    assert not allowed(problem, "on top", (0.3, 0.0, 0.0))
    assert np.isclose(problem.p[0, 2], problem.shape_size[0, 2] / 2)


def test_what_hangs_over_an_edge_does_not_leave_it_farther(room: Room) -> None:
    low = room.put("box_24", (0.0, 0.0, 0.15), id="low")
    room.put("box_24", (0.0, 0.0, 0.45), on=low, id="on top", scale=(2.0, 2.0, 0.5))
    problem = settled(room)
    assert allowed(problem, "on top", (0.0, 0.0, 0.0))
    assert not allowed(problem, "on top", (0.05, 0.0, 0.0), grown=1.0)


def test_what_is_on_a_lower_board_overlaps_the_sides_and_not_what_is_beside_it(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0.0, 0.0, 0.9), id="shelf")
    place, half = room.library.shape("bookshelf_6").surfaces[1], room.library.shape("cup_21").size_m[2] / 2
    room.put("cup_21", (0.0, 0.0, 0.9 + place.height_m + half), on=shelf, id="cup")
    problem = settled(room)
    through, p = problem.ids.index("cup"), problem.p.copy()
    p[through, 1] += 0.5 * room.library.shape("bookshelf_6").size_m[1]
    moved = replace(problem, p=p)
    assert part_overlaps(moved, only=through, supporters=True)[0, 1] > 0.01
    assert not part_overlaps(moved, only=through)
    assert not part_overlaps(problem, supporters=True)
