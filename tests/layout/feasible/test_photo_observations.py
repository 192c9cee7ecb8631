from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.geometry.projection import box_iou
from diorama_core.layout.feasible.photo_observations import (
    PhotoObservations,
    photo_observations,
)
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.settings import LAYOUT
from diorama_core.progress import Progress
from diorama_core.scene.types import Camera, Intrinsics, Scene
from diorama_core.synthesis.layout_rooms import box_library, generate_room
from tests.layout.small_rooms import Room

LIBRARY = box_library()


def looking_north(distance_m: float = 2.4, height_m: float = 1.5) -> Camera:
    """A camera behind the origin that looks along +Y."""
    T = np.eye(4)
    T[:3, :3] = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    T[:3, 3] = [0.0, -distance_m, height_m]
    return Camera(Intrinsics(640, 480, 500, 500, 320, 240), T)


def outline(scene: Scene, name: str) -> np.ndarray:
    assert scene.camera is not None
    flat = scene.camera.project(scene.object(name).corners_world)
    return np.array([*flat.min(axis=0), *flat.max(axis=0)])


def boxed(scene: Scene) -> Scene:
    """The scene with the photo's boxes where its objects are."""
    return replace(scene, objects=tuple(replace(o, box_px=tuple(outline(scene, o.id))) for o in scene.objects))


def solve(scene: Scene, **settings) -> Scene:
    return FeasibleRecipe(LIBRARY, **settings).optimise(scene, Progress())[0]


def observations_of(scene: Scene, **settings) -> PhotoObservations:
    assert scene.camera is not None
    settings.setdefault("depth_weight", 0.3)
    return photo_observations(build_problem(scene, LIBRARY), scene.camera, **settings)


def shelf_away_from_its_wall(room: Room, gap_m: float = 0.35) -> tuple[Scene, str]:
    name = room.put("bookshelf_6", (0.6, 2.35 - gap_m, 0.9), yaw=-np.pi / 2, adheres_to=("wall_2",))
    return room.scene(camera=looking_north()), name


def test_what_a_wall_moved_keeps_its_outline(room: Room) -> None:
    scene, shelf = shelf_away_from_its_wall(room)
    seen = outline(scene, shelf)
    alike = {e: float(box_iou(outline(solve(scene, observations=e), shelf), seen)) for e in (4.0, 0.0)}
    assert alike[4.0] > alike[0.0] + 0.04
    assert alike[4.0] > 0.85
    stood = solve(scene).object(shelf)
    assert stood.pose.position[1] + stood.size_m[0] / 2 == pytest.approx(2.5)
    assert stood.pose.position[2] - stood.size_m[2] / 2 == pytest.approx(0.0, abs=1e-9)


def test_sizes_stay_within_limits(room: Room) -> None:
    scene, shelf = shelf_away_from_its_wall(room, gap_m=1.5)
    ratio = solve(scene).object(shelf).pose.scale / scene.object(shelf).pose.scale
    assert (ratio <= LAYOUT.max_stretch + 1e-9).all()
    assert (ratio >= 1 / LAYOUT.max_stretch - 1e-9).all()
    assert ratio.max() > 1.01


def test_a_measured_distance_weighs_more(room: Room) -> None:
    box = room.put("box_24", (0.0, 1.0, 0.45))
    scene = room.scene(camera=looking_north())
    away = {
        weight: float(np.linalg.norm(solve(scene, depth_weight=weight).object(box).pose.position - [0.0, -2.4, 1.5]))
        for weight in (0.0, 5.0)
    }
    observed = float(np.linalg.norm(scene.object(box).pose.position - [0.0, -2.4, 1.5]))
    assert abs(away[5.0] - observed) < 0.5 * abs(away[0.0] - observed)


def test_what_agrees_already_is_left_alone(room: Room) -> None:
    scene, shelf = shelf_away_from_its_wall(room)
    stood = solve(scene)
    pushed = replace(stood, camera=looking_north(4.0, 1.0))
    assert np.allclose(solve(pushed).object(shelf).pose.matrix, stood.object(shelf).pose.matrix, atol=1e-9)


@settings(max_examples=6)
@given(st.integers(0, 200), st.integers(3, 14))
def test_with_a_photo_too_a_second_run_changes_nothing(seed: int, count: int) -> None:
    scene = replace(generate_room(seed, count).observed, camera=looking_north(6.0, 1.6))
    once = solve(scene)
    twice = solve(once)
    for item in once.objects:
        other = twice.object(item.id).pose
        assert np.allclose(item.pose.matrix, other.matrix, atol=1e-6), item.id
        assert np.allclose(item.pose.scale, other.scale, atol=1e-6), item.id


def test_behind_the_camera_there_is_no_evidence(room: Room) -> None:
    name = room.put("box_24", (0.0, -2.4, 1.5))
    scene = room.scene(camera=looking_north())
    assert np.isnan(observations_of(scene).bounds_px).all()
    assert np.isfinite(solve(scene).object(name).pose.matrix).all()


def test_what_was_made_smaller_is_not_made_larger_again(room: Room) -> None:
    room.put("box_24", (0.0, 0.0, 0.2))
    scene = room.scene(camera=looking_north())
    observations = observations_of(scene)
    smaller = np.full((1, 3), 0.9)
    assert (observations.limit_sizes(smaller).most == 0.9).all()
    assert (observations.limit_sizes(np.ones((1, 3))).most == observations.most).all()


def test_a_side_behind_a_nearer_object_is_a_least_bound(room: Room) -> None:
    cabinet = room.put("cabinet_10", (0.0, 1.5, 0.4), yaw=-np.pi / 2)
    box = room.put("box_24", (0.0, 0.4, 0.15), scale=(1.0, 3.0, 1.0))
    scene = room.scene(camera=looking_north(4.0))
    problem = build_problem(boxed(scene), LIBRARY)
    hidden = photo_observations(problem, looking_north(4.0), depth_weight=1.0).hidden
    assert hidden[problem.ids.index(cabinet)].tolist() == [False, False, False, True]
    assert not hidden[problem.ids.index(box)].any()
    assert not observations_of(scene).hidden.any()


def test_what_stands_on_an_object_does_not_hide_its_top(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37))
    top, (_, wide, high) = room.objects[0].size_m[2], room.library.shape("box_24").size_m
    box = room.put("box_24", (-0.1, 0, top + high / 2), on=table, scale=(1, 2.0 / wide, 1))
    camera = looking_north(height_m=0.6)
    scene = room.scene(camera=camera)
    under, load = boxed(scene).objects
    assert load.box_px[3] > under.box_px[1]
    for edges, hidden in (
        (scene.supports, False),
        ((scene.supports[0], replace(scene.supports[1], parent="floor")), True),
    ):
        problem = build_problem(replace(boxed(scene), supports=edges), LIBRARY)
        nearer = replace(problem, p=problem.p - np.outer(np.array(problem.ids) == box, [0, 0.2, 0]))
        seen = photo_observations(nearer, camera, depth_weight=1.0)
        assert seen.hidden[problem.ids.index(table), 1] == hidden


def test_a_box_counts_only_for_poses_that_agree_with_it(room: Room) -> None:
    cabinet = room.put("cabinet_10", (0.0, 1.5, 0.4), yaw=-np.pi / 2)
    scene = room.scene(camera=looking_north())
    x1, y1, x2, y2 = outline(scene, cabinet)
    taller, elsewhere = (x1, y1 - 0.3 * (y2 - y1), x2, y2), (x1 + 200.0, y1, x2 + 200.0, y2)
    for box, bound in ((taller, taller[1]), (elsewhere, y1)):
        placed = replace(scene, objects=(replace(scene.object(cabinet), box_px=box),))
        assert observations_of(placed).bounds_px[0, 1] == pytest.approx(bound, abs=1.5)


def test_a_shelf_moved_by_its_wall_brings_its_boards_under_its_load(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0.6, 2.0, 0.9), yaw=-np.pi / 2, adheres_to=("wall_2",))
    board = 0.9 + 0.45
    room.put("books_18", (0.6, 2.0, board + 0.12 + 0.08), on=shelf)
    scene = room.scene(camera=looking_north())
    alone = replace(scene, objects=scene.objects[:1], supports=scene.supports[:1])
    height = {len(s.objects): solve(s).object(shelf).pose.scale[2] for s in (scene, alone)}
    assert height[2] > height[1] + 0.01


def test_objects_that_left_the_picture_are_reported_as_data(room: Room) -> None:
    scene, shelf = shelf_away_from_its_wall(room, gap_m=0.5)
    _, report = FeasibleRecipe(LIBRARY, observations=0.0).optimise(scene, Progress())
    (found,) = [d for d in report.disagreements if d.object_id == shelf]
    assert found.moved_m > 0.2 or found.outline_shared < 0.6
    assert any(reason.startswith(f"agrees less with the photo: {found.label}") for reason in report.reasons)


def test_a_picture_seen_from_behind_is_turned_round_and_stays_as_large(room: Room) -> None:
    size = LIBRARY.shape("picture_13").size_m
    at = (0.8, 2.5 - size[0] / 2 - 0.01, 1.5)
    picture = room.put("picture_13", at, on="wall_2", relation="mounted on", yaw=np.pi / 2)
    scene = room.scene(camera=looking_north())
    hung = solve(scene, depth_weight=1.0).object(picture)
    assert np.allclose(hung.size_m, scene.object(picture).size_m, rtol=0.02)
    assert hung.pose.R_world_object[1, 0] == pytest.approx(-1.0)


def test_a_measured_top_stays_where_the_foot_has_to_come_down(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.43))
    scene = room.scene(camera=looking_north())
    seen = scene.object(table)
    stood = solve(boxed(scene), depth_weight=1.0, depth_measured=True).object(table)
    assert stood.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert stood.corners_world[:, 2].max() == pytest.approx(seen.corners_world[:, 2].max(), abs=0.01)


def test_a_table_that_a_person_lifted_comes_down_as_it_is(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.43))
    scene = room.scene(camera=looking_north())
    stood = solve(scene).object(table)
    assert stood.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert stood.size_m[2] == pytest.approx(scene.object(table).size_m[2], rel=0.08)


def test_what_came_out_to_its_loads_is_not_made_smaller_again(room: Room) -> None:
    room.put("table_0", (0.0, 0.6, 0.37))
    scene = room.scene(camera=looking_north())
    problem = build_problem(scene, LIBRARY)
    assert scene.camera is not None
    seen = photo_observations(problem, scene.camera, depth_weight=1.0)
    wider = problem.scale * [1.2, 1.0, 1.0]
    kept = seen.no_smaller(wider, wider > problem.scale)
    np.testing.assert_allclose(kept.least[0], [1.2, 1 / LAYOUT.max_stretch, 1 / LAYOUT.max_stretch])
    np.testing.assert_array_equal(kept.most, seen.most)


def test_boxes_of_the_photo_move_what_was_built_from_it_and_nothing_that_was_settled(room: Room) -> None:
    name = room.put("box_24", (0.0, 0.5, 0.15), scale=(1.0, 2.0, 1.0))
    scene = room.scene(camera=looking_north())
    x1, y1, x2, y2 = outline(scene, name)
    box = (x1 + 0.12 * (x2 - x1), y1, x2 - 0.12 * (x2 - x1), y2)
    seen = replace(scene, objects=(replace(scene.object(name), box_px=box),))
    built, again = (solve(seen, sizes_reasoned=reasoned).object(name).pose for reasoned in (True, False))
    assert built.scale[0] < 0.95 * scene.object(name).pose.scale[0] or built.scale[1] < 0.95 * 2.0
    np.testing.assert_allclose(again.scale, scene.object(name).pose.scale, rtol=1e-6)
    np.testing.assert_allclose(again.position, scene.object(name).pose.position, atol=1e-6)
