from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.arrangement.noise import MEASURED, REASONED
from diorama_core.layout.support_check import checked_supports
from diorama_core.progress import Progress
from diorama_core.scene.types import Candidate
from diorama_core.synthesis.layout_rooms import room_box
from tests.layout.feasible.test_photo_observations import LIBRARY, looking_north
from tests.layout.small_rooms import Room


def test_a_cup_on_a_cabinet_is_not_mounted_on_the_wall_behind(room: Room) -> None:
    cabinet = room.put("cabinet_10", (0.0, 2.25, 0.4), yaw=-np.pi / 2)
    top = room.objects[0].size_m[2]
    cup = room.put("cup_21", (0.0, 2.25, top + 0.05), on="wall_2", relation="mounted on")
    scene = room.scene(camera=looking_north())
    checked, reasons = checked_supports(scene, LIBRARY, MEASURED)
    assert checked.support_of(cup).parent == cabinet
    assert checked.support_of(cabinet) == scene.support_of(cabinet)
    assert len(reasons) == 1
    assert "cup" in reasons[0]
    settled = FeasibleRecipe(LIBRARY).optimise(checked, Progress())[0]
    assert np.linalg.norm(settled.object(cup).pose.position - scene.object(cup).pose.position) < 0.02


def test_an_edge_within_the_noise_stays(room: Room) -> None:
    table = room.put("table_0", (0.0, 0.0, 0.37))
    room.put("cup_21", (0.0, 0.1, 0.82), on=table)
    scene = room.scene(camera=looking_north())
    assert checked_supports(scene, LIBRARY, MEASURED) == (scene, ())


def test_a_contradicted_edge_stays_where_nothing_else_fits(room: Room) -> None:
    picture = room.put("picture_13", (0.0, 1.7, 1.5), on="wall_2", relation="mounted on", yaw=-np.pi / 2)
    scene = room.scene(camera=looking_north())
    assert checked_supports(scene, LIBRARY, MEASURED)[0].support_of(picture).parent == "wall_2"


def test_a_measured_gap_to_a_wall_is_no_adherence(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0.0, 2.15, 0.9), yaw=-np.pi / 2, adheres_to=("wall_2",))
    scene = room.scene(camera=looking_north(6.0))
    assert checked_supports(scene, LIBRARY, MEASURED)[0].support_of(shelf).adheres_to == ()
    assert checked_supports(scene, LIBRARY, REASONED)[0].support_of(shelf).adheres_to == ("wall_2",)


@pytest.mark.parametrize(("gap_m", "stands_against"), [(0.03, True), (0.09, False)])
def test_half_the_tolerance_is_a_measured_gap(room: Room, gap_m: float, stands_against: bool) -> None:
    # Seen from 8 m a measured position along the ray is within 16 cm; what stands 9 cm before its wall does not touch.
    depth = float(LIBRARY.shape("bookshelf_6").size_m[0])
    shelf = room.put("bookshelf_6", (0.0, 2.5 - gap_m - depth / 2, 0.9), yaw=-np.pi / 2, adheres_to=("wall_2",))
    checked, _ = checked_supports(room.scene(camera=looking_north(6.0)), LIBRARY, MEASURED)
    assert (checked.support_of(shelf).adheres_to == ("wall_2",)) == stands_against


@pytest.mark.parametrize(("degrees", "stands_against"), [(5.0, True), (12.0, False)])
def test_what_was_measured_turned_touches_its_wall_with_an_edge(
    room: Room, degrees: float, stands_against: bool
) -> None:
    depth, width = LIBRARY.shape("box_24").size_m[:2]
    turn = np.deg2rad(degrees)
    reach = 0.5 * (depth * np.cos(turn) + width * np.sin(turn))
    box = room.put("box_24", (0.0, 2.5 - reach, 0.2), yaw=-np.pi / 2 + turn, adheres_to=("wall_2",))
    scene = room.scene(camera=looking_north())
    for noise, against in ((MEASURED, stands_against), (REASONED, True)):
        assert (checked_supports(scene, LIBRARY, noise)[0].support_of(box).adheres_to == ("wall_2",)) == against


def test_without_a_camera_and_without_edges_nothing_breaks(room: Room) -> None:
    room.put("cup_21", (0.0, 0.1, 0.82), on=None)
    scene = room.scene(architecture=room_box(6.0, 5.0))
    assert checked_supports(scene, LIBRARY, MEASURED) == (scene, ())


def test_furniture_does_not_hang_in_the_air(room: Room) -> None:
    chair = room.put("chair_4", (0.0, 1.0, 1.3), on="wall_2", relation="mounted on", yaw=-np.pi / 2)
    checked, reasons = checked_supports(room.scene(camera=looking_north()), LIBRARY, REASONED)
    assert checked.support_of(chair).parent == "floor"
    assert len(reasons) == 1
    settled = FeasibleRecipe(LIBRARY, sizes_reasoned=True).optimise(checked, Progress())[0]
    assert abs(settled.object(chair).corners_world[:, 2].min()) < 1e-6


def test_what_should_have_something_below_it_is_reported(room: Room) -> None:
    oven = room.put("microwave_25", (0.0, 2.3, 1.6), on="wall_2", relation="mounted on", yaw=-np.pi / 2)
    checked, reasons = checked_supports(room.scene(camera=looking_north()), LIBRARY, REASONED)
    assert checked.support_of(oven).parent == "wall_2"
    assert "please check: microwave" in reasons[0]


def test_what_was_seen_inside_a_shelf_stands_on_its_lowest_board(room: Room) -> None:
    shelf = room.put("bookshelf_7", (0.0, 1.0, 0.6))
    books = room.put("books_18", (0.0, 1.0, 0.1), yaw=0.2)
    beside = room.put("books_19", (1.5, 1.0, 0.02))
    checked, reasons = checked_supports(room.scene(camera=looking_north()), LIBRARY, MEASURED)
    assert checked.support_of(books).parent == shelf
    assert checked.support_of(beside).parent == "floor"
    assert len(reasons) == 1
    assert "in something that is on the floor" in reasons[0]


def test_what_is_under_a_table_stays_on_the_floor(room: Room) -> None:
    room.put("table_0", (0.0, 1.0, 0.37))
    box = room.put("box_24", (0.0, 1.0, 0.15))
    assert checked_supports(room.scene(camera=looking_north()), LIBRARY, MEASURED)[0].support_of(box).parent == "floor"


def test_where_shapes_may_not_leave_room_only_a_measured_gap_counts_for_what_stands_on_floors(room: Room) -> None:
    room.put("bookshelf_7", (0.0, 1.0, 0.6))
    basket = room.put("books_18", (0.0, 1.0, 0.12), yaw=0.2)
    room.objects[-1] = replace(room.objects[-1], category="trash can")
    scene = room.scene(camera=looking_north())
    assert checked_supports(scene, LIBRARY, MEASURED, shapes_clear=False) == (scene, ())
    assert checked_supports(scene, LIBRARY, MEASURED)[0].support_of(basket).parent != "floor"


@pytest.mark.parametrize("shapes_clear", [True, False])
def test_what_reaches_down_through_a_board_ends_there_and_its_top_stays(room: Room, shapes_clear: bool) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.37))
    top = float(room.scene().object(table).corners_world[:, 2].max())
    tall = 0.4 / LIBRARY.shape("books_18").size_m[2]
    books = room.put("books_18", (0.0, 1.0, top), scale=(1.0, 1.0, tall))
    room.put("books_18", (2.0, 1.0, top), scale=(1.0, 1.0, tall))
    scene = room.scene(camera=looking_north())
    checked, reasons = checked_supports(scene, LIBRARY, MEASURED, shapes_clear=shapes_clear)
    assert checked.support_of(books).parent == table
    low, high = np.sort(checked.object(books).corners_world[:, 2])[[0, -1]]
    assert low == pytest.approx(top, abs=1e-6)
    assert high == pytest.approx(top + 0.2)
    assert len(reasons) == 1


def test_a_vase_hung_within_a_cabinet_stands_on_it_with_all_its_shapes(room: Room) -> None:
    cabinet = room.put("cabinet_10", (0.0, 2.25, 0.4), yaw=-np.pi / 2)
    top = float(room.scene().object(cabinet).corners_world[:, 2].max())
    tall = 0.6 / LIBRARY.shape("cup_21").size_m[2]
    cup = room.put("cup_21", (0.0, 2.25, top), on="wall_2", relation="mounted on", scale=(1.0, 1.0, tall))
    item = room.objects[-1]
    room.objects[-1] = replace(item, candidates=(Candidate(item.shape_id, item.shape_size_m, 0.5, item.pose),))
    checked, _ = checked_supports(room.scene(camera=looking_north()), LIBRARY, MEASURED)
    assert checked.support_of(cup).parent == cabinet
    found = checked.object(cup)
    assert found.corners_world[:, 2].min() == pytest.approx(top, abs=1e-6)
    np.testing.assert_allclose(found.candidates[0].pose.scale, found.pose.scale)


@pytest.mark.parametrize("beside", [False, True])
def test_a_cup_measured_over_a_plate_is_on_the_plate_and_beside_it_on_the_table(room: Room, *, beside: bool) -> None:
    table = room.put("table_0", (0.0, 0.0, 0.37))
    top = float(room.scene().object(table).corners_world[:, 2].max())
    flat = 0.02 / LIBRARY.shape("box_24").size_m[2]
    plate = room.put("box_24", (0.0, 0.0, top + 0.01), on=table, scale=(0.7, 0.7, flat))
    room.objects[-1] = replace(room.objects[-1], category="plate")
    edge = float(room.objects[-1].size_m[1]) / 2
    foot = top if beside else top + 0.02
    cup = room.put("cup_21", (0.0, (edge + 0.01) * beside, foot + LIBRARY.shape("cup_21").size_m[2] / 2), on=table)
    checked, _ = checked_supports(room.scene(camera=looking_north()), LIBRARY, MEASURED)
    assert checked.support_of(cup).parent == (table if beside else plate)
    assert checked.support_of(plate).parent == table


def test_books_measured_over_the_lowest_board_of_a_shelf_are_on_it_and_not_on_the_floor(room: Room) -> None:
    shelf = room.put("bookshelf_7", (0.0, 1.0, 0.6))
    board = float(room.scene().object(shelf).corners_world[:, 2].min())
    places = LIBRARY.shape("bookshelf_7").surfaces
    board += 0.5 * room.objects[0].size_m[2] + min(float(place.polygon[0, 2]) for place in places)
    books = room.put("books_18", (0.0, 1.0, board + 0.01 + 0.5 * LIBRARY.shape("books_18").size_m[2]))
    scene = room.scene(camera=looking_north())
    assert 0.0 < board < 0.1
    assert checked_supports(scene, LIBRARY, MEASURED, shapes_clear=False)[0].support_of(books).parent == shelf


@pytest.mark.parametrize(("kind", "on_it"), [("plate", True), ("keyboard", False)])
def test_a_cup_reasoned_to_be_in_a_plate_is_on_it(room: Room, kind: str, *, on_it: bool) -> None:
    table = room.put("table_0", (0.0, 0.0, 0.37))
    top = float(room.scene().object(table).corners_world[:, 2].max())
    flat = 0.02 / LIBRARY.shape("box_24").size_m[2]
    plate = room.put("box_24", (0.0, 0.0, top + 0.01), on=table, scale=(0.7, 0.7, flat))
    room.objects[-1] = replace(room.objects[-1], category=kind)
    cup = room.put("cup_21", (0.02, 0.0, top + 0.5 * LIBRARY.shape("cup_21").size_m[2]), on=table)
    scene = room.scene(camera=looking_north())
    assert (checked_supports(scene, LIBRARY, REASONED)[0].support_of(cup).parent == plate) == on_it


def test_a_laptop_far_above_its_chair_rests_on_the_desk_below_it_although_its_foot_is_hidden(room: Room) -> None:
    chair = room.put("chair_4", (0.0, 0.9, 0.45))
    desk = room.put("table_0", (0.0, 1.2, 0.37))
    top = float(room.scene().object(desk).corners_world[:, 2].max())
    laptop = room.put("box_24", (0.0, 1.0, top + 0.15 + 0.12), on=chair)
    checked = checked_supports(room.scene(camera=looking_north()), LIBRARY, MEASURED)[0]
    assert checked.support_of(laptop).parent == desk


def test_a_chair_whose_foot_a_table_hides_is_not_on_the_table(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.37))
    chair = room.put("chair_4", (0.0, 1.5, 0.85), on=table)
    checked, reasons = checked_supports(room.scene(camera=looking_north()), LIBRARY, MEASURED)
    assert checked.support_of(chair).parent == "floor"
    assert len(reasons) == 1


def test_a_lamp_away_from_its_wall_stands_on_what_is_right_below_it(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.5, 0.37))
    lamp = room.put("lamp_16", (0.0, 1.5, 1.0), on="wall_2", relation="mounted on")
    checked, _ = checked_supports(room.scene(camera=looking_north()), LIBRARY, MEASURED)
    assert checked.support_of(lamp).parent == table


@pytest.mark.parametrize(
    ("above_m", "behind_m", "stands"), [(0.005, 0.06, True), (0.05, 0.06, False), (0.005, 0.0, False)]
)
def test_a_clock_near_its_wall_stands_where_its_measured_foot_is_clearly_nearer(
    room: Room, above_m: float, behind_m: float, *, stands: bool
) -> None:
    top, (depth, _, height) = LIBRARY.shape("cabinet_10").size_m[2], LIBRARY.shape("lamp_16").size_m
    cabinet = room.put("cabinet_10", (0.0, 2.25, top / 2), yaw=-np.pi / 2)
    at = (0.0, 2.5 - behind_m - depth / 2, top + above_m + height / 2)
    clock = room.put("lamp_16", at, on="wall_2", relation="mounted on", yaw=-np.pi / 2)
    room.objects[-1] = replace(room.objects[-1], category="clock")
    checked, _ = checked_supports(room.scene(camera=looking_north()), LIBRARY, MEASURED)
    assert checked.support_of(clock).parent == (cabinet if stands else "wall_2")


def test_a_door_stands_on_the_floor_where_it_was_measured_far_from_its_wall(room: Room) -> None:
    door = room.put("wardrobe_12", (0.0, 1.0, 1.1), on="wall_2", relation="mounted on")
    room.objects[0] = replace(room.objects[0], category="door")
    scene = room.scene(camera=looking_north())
    assert checked_supports(scene, LIBRARY, MEASURED)[0].support_of(door).parent == "floor"
    assert checked_supports(scene, LIBRARY, REASONED)[0].support_of(door).parent == "wall_2", "its distance is a guess"


def test_what_is_seen_beside_its_wall_hangs_on_the_wall_in_sight(room: Room) -> None:
    picture = room.put("picture_13", (3.4, 2.3, 1.5), on="wall_2", relation="mounted on", yaw=-np.pi / 2)
    scene = room.scene(camera=looking_north())
    checked, reasons = checked_supports(scene, LIBRARY, REASONED)
    (wall,) = (w.id for w in scene.architecture.by_role("wall") if w.normal[0] < -0.9)
    assert checked.support_of(picture).parent == wall
    assert "another wall" in reasons[0]


@pytest.mark.parametrize("x", [2.98, 2.85], ids=["in its wall", "a little before it"])
def test_a_measured_door_stays_on_its_wall_although_another_is_in_sight(room: Room, x: float) -> None:
    walls = room_box(6.0, 5.0)
    (own,) = (w.id for w in walls.by_role("wall") if w.normal[0] < -0.9)
    door = room.put("picture_13", (x, 1.16, 1.5), on=own, relation="mounted on", yaw=np.pi)
    shapes = {
        own: lambda polygon: np.clip(polygon, -9.0, [9.0, 1.1, 9.0]),
        "wall_2": lambda polygon: polygon * [2, 1, 1],
    }
    short = tuple(replace(p, polygon=shapes[p.id](p.polygon)) if p.id in shapes else p for p in walls.planes)
    scene = room.scene(camera=looking_north(), architecture=replace(walls, planes=short))
    reasoned = replace(MEASURED, measured=False)
    assert checked_supports(scene, LIBRARY, reasoned)[0].support_of(door).parent == "wall_2"
    assert checked_supports(scene, LIBRARY, MEASURED)[0].support_of(door).parent == own


def test_a_plant_over_a_table_stands_on_it(room: Room) -> None:
    table = room.put("table_0", (0.0, 0.0, 0.37))
    top = room.objects[0].size_m[2]
    plant = room.put("cup_21", (0.0, 0.1, top + 0.05))
    scene = room.scene(camera=looking_north())
    potted = tuple(replace(o, category="plant") if o.id == plant else o for o in scene.objects)
    checked, _ = checked_supports(replace(scene, objects=potted), LIBRARY, MEASURED)
    assert checked.support_of(plant).parent == table


@pytest.mark.parametrize(("kind", "beside"), [("vase", True), ("pillow", False)])
def test_reasoned_distances_move_nothing_to_odd_company(room: Room, kind: str, beside: bool) -> None:
    """A vase whose night stand came out too far away is not on the bed; a pillow is."""
    stand = room.put("cabinet_10", (0.0, 0.0, 0.4))
    top = room.objects[0].size_m[2]
    bed = room.put("table_0", (0.9, 0.0, 0.37))
    item = room.put("cup_21", (0.9, 0.0, top + 0.03), on=stand)
    scene = room.scene(camera=looking_north())
    kinds = {stand: "night stand", bed: "bed", item: kind}
    scene = replace(scene, objects=tuple(replace(o, category=kinds[o.id]) for o in scene.objects))
    assert checked_supports(scene, LIBRARY, REASONED)[0].support_of(item).parent == (stand if beside else bed)


def test_furniture_on_a_rug_stands_on_the_floor(room: Room) -> None:
    rug = room.put("table_0", (0.0, 0.0, 0.01), scale=(2.0, 2.0, 0.03))
    cabinet = room.put("cabinet_10", (0.0, 0.0, 0.4))
    scene = room.scene(camera=looking_north())
    kinds = {rug: "rug", cabinet: "cabinet"}
    scene = replace(scene, objects=tuple(replace(o, category=kinds[o.id]) for o in scene.objects))
    checked, reasons = checked_supports(scene, LIBRARY, REASONED)
    assert checked.support_of(cabinet).parent == "floor"
    assert not reasons
