from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.errors import Cancelled, InputError
from diorama_core.layout.feasible import recipe as feasible
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.feasible.separate import Program, Separation
from diorama_core.layout.recipes import NAMES, recipe
from diorama_core.layout.settings import LAYOUT
from diorama_core.progress import CancelToken, Progress
from diorama_core.scene.types import Architecture, Plane, Pose, Scene, Support, yaw_rotation
from diorama_core.synthesis.layout_rooms import BoxLibrary, GeneratedRoom, box_library, generate_room, perturb_graph
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.small_rooms import Room, tilted

LIBRARY = box_library()
BOX_M = 0.45


def solve(scene: Scene, **settings) -> tuple[Scene, object]:
    return FeasibleRecipe(LIBRARY, **settings).optimise(scene, Progress())


def positions(scene: Scene) -> dict[str, np.ndarray]:
    return {o.id: o.pose.position for o in scene.objects}


def same(a: Scene, b: Scene, atol: float = 1e-6) -> None:
    for item in a.objects:
        other = b.object(item.id).pose
        assert np.allclose(item.pose.position, other.position, atol=atol), item.id
        assert np.allclose(item.pose.R_world_object, other.R_world_object, atol=atol), item.id
        assert np.allclose(item.pose.scale, other.scale, atol=atol), item.id


def moved_by(scene: Scene, T: np.ndarray) -> Scene:
    def pose(p: Pose) -> Pose:
        return Pose(T[:3, :3] @ p.R_world_object, T[:3, :3] @ p.position + T[:3, 3], p.scale)

    planes = tuple(replace(p, polygon=p.polygon @ T[:3, :3].T + T[:3, 3]) for p in scene.architecture.planes)
    return replace(
        scene,
        architecture=Architecture(planes),
        objects=tuple(replace(o, pose=pose(o.pose)) for o in scene.objects),
    )


@pytest.mark.parametrize("seed", range(6))
def test_generated_rooms_become_exact_and_free_of_overlap(seed: int) -> None:
    room: GeneratedRoom = generate_room(seed, 20)
    scene, report = solve(room.observed)
    assert report.after["structure"] == 1.0
    assert report.after["in_support"] == 1.0
    assert report.after["part_overlap_m"] == 0.0
    assert report.after["moved_m"] < 0.12
    assert dict(scene.metrics) == report.after
    assert scene.supports == room.observed.supports


@settings(max_examples=8)
@given(st.integers(0, 500), st.integers(2, 24))
def test_a_second_run_changes_nothing(seed: int, count: int) -> None:
    once, _ = solve(generate_room(seed, count).observed)
    twice, _ = solve(once)
    same(once, twice)


@settings(max_examples=8)
@given(st.integers(0, 500), st.randoms(use_true_random=False))
def test_the_order_of_objects_does_not_matter(seed: int, shuffler) -> None:
    scene = generate_room(seed, 15).observed
    objects, supports = list(scene.objects), list(scene.supports)
    shuffler.shuffle(objects)
    shuffler.shuffle(supports)
    mixed = replace(scene, objects=tuple(objects), supports=tuple(supports))
    same(solve(scene)[0], solve(mixed)[0], atol=0.0)


@settings(max_examples=8)
@given(st.integers(0, 500), st.floats(-3.0, 3.0), st.floats(-20.0, 20.0))
def test_the_answer_moves_with_the_world(seed: int, yaw: float, shift: float) -> None:
    scene = generate_room(seed, 15).observed
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = yaw_rotation(yaw), [shift, -0.7 * shift, 0.3 * shift]
    same(moved_by(solve(scene)[0], T), solve(moved_by(scene, T))[0], atol=1e-4)


def test_a_chair_under_a_table_stays_there(room: Room) -> None:
    room.put("table_0", (0, 0, 0.37))
    chair = room.put("chair_4", (0.45, 0, 0.45), yaw=np.pi)
    scene = room.scene()
    after, _ = solve(scene)
    assert np.allclose(after.object(chair).pose.position, scene.object(chair).pose.position, atol=1e-6)


@pytest.mark.parametrize(("taller", "fits"), [(1.3, True), (2.5, False)])
def test_what_stands_between_boards_is_no_taller_than_their_gap(room: Room, taller: float, fits: bool) -> None:
    """A shape is taller than the object that was seen there; far too tall, it was hardly seen there."""
    shelf = room.put("bookshelf_6", (0, 2.0, 0.9), yaw=-np.pi / 2)
    surface, size = LIBRARY.shape("bookshelf_6").surfaces[1], np.array(LIBRARY.shape("books_18").size_m)
    tall = float(taller * surface.clearance_m / size[2])
    at = (0.1, 2.0, surface.height_m + taller * surface.clearance_m / 2)
    book = room.put("books_18", at, on=shelf, yaw=-np.pi / 2, parent_surface=1, scale=(1.0, 1.0, tall))
    after, report = FeasibleRecipe(LIBRARY).optimise(room.scene(), Progress())
    assert (after.object(book).size_m[2] < surface.clearance_m) == fits
    assert any("too tall" in reason for reason in report.reasons) != fits


def test_a_book_in_a_shelf_stays_in_it(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0, 2.0, 0.9), yaw=-np.pi / 2)
    book = room.put("books_18", (0.1, 2.0, 0.62), on=shelf, yaw=-np.pi / 2, parent_surface=1)
    after, report = solve(room.scene())
    surface = LIBRARY.shape("bookshelf_6").surfaces[1]
    bottom = after.object(book).pose.position[2] - after.object(book).size_m[2] / 2
    assert bottom == pytest.approx(after.object(shelf).pose.position[2] + surface.height_m, abs=1e-6)
    assert report.after["in_support"] == 1.0


def test_a_picture_hangs_upright_on_its_wall(room: Room) -> None:
    pose = tilted(Pose.upright((0.0, 2.4, 1.5), -np.pi / 2), 12.0, axis=1)
    picture = room.put("picture_13", (0, 0, 0), on="wall_2", relation="mounted on", pose=pose)
    after, _ = solve(room.scene())
    hung = after.object(picture)
    assert np.allclose(hung.pose.R_world_object[:, 2], [0, 0, 1], atol=1e-9)
    assert hung.pose.position[1] + hung.size_m[0] / 2 == pytest.approx(2.5)


def test_a_stated_wall_is_stood_against(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0, 2.2, 0.9), yaw=-np.pi / 2 + 0.2, adheres_to=("wall_2",))
    after, _ = solve(room.scene())
    stood = after.object(shelf)
    assert stood.pose.position[1] + stood.size_m[0] / 2 == pytest.approx(2.5)


def test_round_the_corner_of_a_wall_that_stands_in_objects_stay_where_they_are(room: Room) -> None:
    corners = np.array([[-2, -2, 0], [2, -2, 0], [2, 0, 0], [0, 0, 0], [0, 2, 0], [-2, 2, 0]], dtype=float)
    up = np.array([0.0, 0.0, 2.5])
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    walls = [Plane(f"wall_{k}", "wall", np.array([b, a, a + up, b + up])) for k, (a, b) in enumerate(sides)]
    beyond = room.put("box_24", (0.3, -0.4, 0.15))  # behind the plane of the wall from (0, 0) to (0, 2)
    through = room.put("box_24", (-0.1, 1.0, 0.15), id="through")
    after, _ = solve(room.scene(architecture=Architecture((Plane("floor", "floor", corners), *walls))))
    np.testing.assert_allclose(after.object(beyond).pose.position[:2], (0.3, -0.4), atol=1e-9)
    assert after.object(through).pose.position[0] == pytest.approx(-after.object(through).size_m[0] / 2, abs=1e-6)


def test_nothing_leaves_the_room(room: Room) -> None:
    box = room.put("cabinet_10", (2.95, 2.4, 0.4))
    after, _ = solve(room.scene())
    assert (np.abs(after.object(box).corners_world[:, :2]) <= np.array([3.0, 2.5]) + 1e-6).all()


def test_children_ride_with_what_is_pushed(room: Room) -> None:
    table = room.put("table_3", (0.0, 0, 0.275))
    room.put("wardrobe_12", (0.5, 0, 1.0), locked=True)
    cup = room.put("cup_21", (0.0, 0, 0.6), on=table)
    scene = room.scene()
    after, _ = solve(scene)
    shift = {k: after.object(k).pose.position - scene.object(k).pose.position for k in (table, cup)}
    assert np.linalg.norm(shift[table]) > 0.01
    assert np.allclose(shift[table][:2], shift[cup][:2], atol=1e-6)


def test_locked_objects_and_others_than_the_selection_stay(room: Room) -> None:
    a = room.put("box_24", (0, 0, 0.3), locked=True)
    b = room.put("box_24", (0.1, 0, 0.2))
    c = room.put("box_24", (2, 1, 0.5))
    scene = room.scene()
    after, report = solve(scene, only=frozenset({b}))
    for stays in (a, c):
        assert after.object(stays).pose == scene.object(stays).pose
    assert report.after["part_overlap_m"] == 0.0


def test_without_edges_objects_stand_on_what_is_below(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37), on=None)
    cup = room.put("cup_21", (0.1, 0.2, 0.85), on=None)
    after, report = solve(room.scene())
    assert after.object(cup).pose.position[2] == pytest.approx(0.74 + 0.05, abs=1e-6)
    assert after.object(table).pose.position[2] == pytest.approx(0.37, abs=1e-6)
    assert any(r.startswith("no support edge") for r in report.reasons)


def test_without_room_or_camera_nothing_breaks(room: Room) -> None:
    room.put("table_0", (0, 0, 1.0), on=None)
    room.put("table_1", (0.1, 0, 1.0), on=None)
    after, report = solve(room.scene(architecture=Architecture()))
    assert report.after["part_overlap_m"] == 0.0
    assert after.objects[0].pose.position[2] == 1.0
    assert solve(Scene())[0].objects == ()


def test_a_sloping_floor(room: Room) -> None:
    slope = np.deg2rad(20.0)
    corners = np.array([[-3.0, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]])
    turn = np.array([[np.cos(slope), 0, np.sin(slope)], [0, 1, 0], [-np.sin(slope), 0, np.cos(slope)]])
    floor = Plane("floor", "floor", corners @ turn.T)
    box = room.put("box_24", (0.2, 0.1, 0.3))
    after, report = solve(room.scene(architecture=Architecture((floor,))))
    assert report.after["structure"] == 1.0
    assert np.allclose(after.object(box).pose.R_world_object[:, 2], floor.normal)


@pytest.mark.parametrize("seed", range(6))
def test_wrong_graphs_stay_finite_and_inside(seed: int) -> None:
    room = generate_room(seed, 20)
    scene, report = solve(perturb_graph(room.observed, 0.1, seed))
    x = np.abs(room.truth.architecture.planes[0].polygon[:, :2]).max(axis=0)
    for item in scene.objects:
        assert np.isfinite(item.pose.matrix).all()
        if not any("overhangs" in r for r in report.reasons):
            assert (np.abs(item.corners_world[:, :2]) <= x + 1e-3).all(), item.id
    assert report.after["part_overlap_m"] < 1e-3 or any(r.startswith("no room") for r in report.reasons)


def test_larger_than_its_support_is_named(room: Room) -> None:
    stand = room.put("night_stand_11", (0, 0, 0.25))
    room.put("box_24", (0.0, 0, 0.7), on=stand, scale=(1.9, 1.9, 1.0))
    _, report = solve(room.scene())
    assert any(r.startswith("larger than its support") for r in report.reasons)


def test_a_full_shelf_is_named(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0, 0, 0.9))
    for k in range(12):
        room.put("books_18", (0.0, -0.3 + 0.05 * k, 0.6), on=shelf, parent_surface=1)
    after, report = solve(room.scene())
    assert any(r.startswith("no room") for r in report.reasons)
    assert report.after["structure"] == 1.0
    assert all(np.isfinite(o.pose.matrix).all() for o in after.objects)


def test_a_cycle_is_named(room: Room) -> None:
    a = room.put("box_24", (0, 0, 0.2), on=None)
    b = room.put("box_24", (0, 0, 0.6), on=None)
    scene = replace(room.scene(), supports=(Support(a, b), Support(b, a)))
    _, report = solve(scene)
    assert any(r.startswith("cycle") for r in report.reasons)


def test_what_must_sink_slides_along_its_viewing_ray(room: Room) -> None:
    box = room.put("box_24", (0.0, 1.0, 0.2))
    camera = looking_north()
    scene = room.scene(camera=camera)
    with_photo = solve(scene)[0].object(box)
    straight_down = solve(replace(scene, camera=None))[0].object(box)
    seen = camera.project(scene.object(box).pose.position)
    shift = [float(np.linalg.norm(camera.project(o.pose.position) - seen)) for o in (with_photo, straight_down)]
    assert shift[0] < 0.3 * shift[1]


def test_previews_and_progress_end_at_the_result() -> None:
    shown, heard = [], []
    scene, _ = FeasibleRecipe(LIBRARY).optimise(
        generate_room(2, 20).observed,
        Progress(on_event=heard.append),
        lambda s, costs: shown.append((s, costs)),
    )
    assert shown
    assert heard
    same(shown[-1][0], scene)


@pytest.mark.parametrize("name", NAMES)
def test_cancelling_raises(name: str) -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        recipe(name, LIBRARY).optimise(generate_room(0, 8).observed, Progress(token=token))


def test_unknown_recipes_are_refused(library: BoxLibrary) -> None:
    with pytest.raises(InputError, match="choose one of feasible"):
        recipe("best", library)


def test_repr_is_a_cache_key(library: BoxLibrary) -> None:
    assert repr(recipe("feasible", library)) == repr(recipe("feasible", box_library()))
    assert len(repr(recipe("feasible", library))) < 1500  # with every number of its settings


def between_cabinets(room: Room, gap_m: float) -> str:
    """A box between two cabinets that cannot move; returns its id."""
    for side in (-1, 1):
        at = (side * (0.5 + gap_m / 2), 0.5, 0.4)
        room.put("cabinet_10", at, yaw=-np.pi / 2, locked=True)
    return room.put("box_24", (0.0, 0.5, 0.15), yaw=np.pi / 2)


def solved(scene: Scene, name: str) -> tuple[float, np.ndarray, tuple[str, ...]]:
    """How far an object was moved, its scale, and what was reported."""
    settled, report = FeasibleRecipe(LIBRARY).optimise(scene, Progress())
    assert report.after["part_overlap_m"] == 0.0
    moved = settled.object(name).pose.position - scene.object(name).pose.position
    return float(np.linalg.norm(moved)), settled.object(name).pose.scale, report.reasons


def test_what_is_a_little_too_wide_for_its_gap_is_made_smaller_and_stays(room: Room) -> None:
    box = between_cabinets(room, BOX_M - 0.02)
    moved, scale, reasons = solved(room.scene(camera=looking_north()), box)
    assert moved < 0.03
    assert LAYOUT.smallest_shrink <= scale.min() < 0.97
    assert any(f"{box} was made smaller" in reason for reason in reasons)


def test_what_is_much_too_wide_moves_out_and_keeps_its_size(room: Room) -> None:
    box = between_cabinets(room, 0.5 * BOX_M)
    moved, scale, _ = solved(room.scene(camera=looking_north()), box)
    assert moved > 0.2
    np.testing.assert_allclose(scale, 1.0)


def test_what_holds_something_up_keeps_its_size(room: Room) -> None:
    box = between_cabinets(room, BOX_M - 0.02)
    room.put("cup_21", (0.0, 0.5, 0.35), on=box)
    _, scale, _ = solved(room.scene(camera=looking_north()), box)
    assert scale.max() == pytest.approx(1.0, abs=0.02)


def test_without_a_photo_sizes_stay(room: Room) -> None:
    box = between_cabinets(room, BOX_M - 0.02)
    moved, scale, _ = solved(room.scene(), box)
    assert moved > 0.1
    np.testing.assert_allclose(scale, 1.0)


def test_a_room_is_not_moved_about_for_one_small_overlap(room: Room, monkeypatch: pytest.MonkeyPatch) -> None:
    for k in range(2):
        room.put("box_24", (0.1 * k, 0.0, 0.15), id=f"box {k}")

    def moved(program: Program, distance_m: float, *stuck: tuple[int, int]) -> Separation:
        return Separation(np.full(program.J.shape[2], distance_m), 0.0, stuck)

    def far_away(program: Program, **_: object) -> Separation:
        program.tried[0, 1] = []
        return moved(program, 6.0)

    monkeypatch.setattr(feasible, "separate", far_away)
    monkeypatch.setattr(feasible, "relocate", lambda program, _: moved(program, 0.1, (0, 1)))
    monkeypatch.setattr(feasible, "relax", lambda _, way: way)
    scene, report = solve(room.scene(camera=looking_north()))
    assert np.abs(positions(scene)["box 0"] - room.scene().object("box 0").pose.position).max() < 0.3
    assert any("still overlap" in reason for reason in report.reasons)
