from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.placement import CEILING, FLOOR, WALL, Placement, place_all
from diorama_core.perception.metrology.problem import View
from tests.perception.metrology.test_metrology import ROOM, K, RequestedObject, rotation, seen

R = rotation(8.0)
VIEW = View(K, R)


def placed(*items: RequestedObject, height_m: float = 1.5) -> tuple[Placement, ...]:
    return place_all(gather(seen(items, R, height_m), K.width, K.height), VIEW, height_m)


def outlined(*items: RequestedObject) -> tuple[Placement, ...]:
    """Objects whose masks fill the boxes."""
    objects = seen(items, R, 1.5)
    for item in objects:
        x1, y1, x2, y2 = (round(v) for v in item.box)
        item.mask[y1:y2, x1:x2] = True
    return place_all(gather(objects, K.width, K.height), VIEW, 1.5)


def test_every_object_gets_its_supporter_and_place() -> None:
    found = placed(*ROOM)
    assert [p.index for p in found] == list(range(len(ROOM)))
    assert [p.supporter for p in found] == [FLOOR, FLOOR, FLOOR, FLOOR, 3, 0, WALL]
    for item, placement in zip(ROOM, found, strict=True):
        assert np.abs(placement.cuboid.centre[0] - item.centre).max() < 0.55, item.category
        assert len(placement.problem) == 1


def test_what_supports_another_object_stands_on_the_floor() -> None:
    found = placed(*ROOM)
    for placement in found:
        if placement.supporter >= 0:
            assert found[placement.supporter].supporter == FLOOR
            under = found[placement.supporter].cuboid
            assert placement.cuboid.base_m[0] <= under.top_m[0] + 0.15


def test_lamps_of_the_ceiling_hang_and_doors_are_on_walls_down_to_the_floor() -> None:
    lamp = RequestedObject("ceiling lamp", (0.2, 3.5, 2.35), (0.4, 0.45, 0.45))
    door = RequestedObject("door", (-1.6, 4.5, 1.02), (0.06, 0.9, 2.04))
    found = placed(*ROOM[:3], lamp, door)
    assert [p.supporter for p in found[3:]] == [CEILING, WALL]
    assert found[4].cuboid.base_m[0] == pytest.approx(0.0, abs=1e-6)
    assert found[3].cuboid.base_m[0] > 1.7


def test_a_television_is_on_its_stand_when_there_is_one_and_on_the_wall_otherwise() -> None:
    stand = RequestedObject("tv stand", (0.2, 4.0, 0.27), (0.42, 1.5, 0.54))
    on_stand = RequestedObject("television", (0.2, 4.0, 0.9), (0.08, 1.1, 0.7))
    on_wall = RequestedObject("television", (0.2, 4.2, 1.45), (0.08, 1.1, 0.7))
    assert placed(stand, on_stand)[1].supporter == 0
    assert placed(ROOM[0], on_wall)[1].supporter == WALL


def test_a_small_plant_is_on_the_table_that_it_ends_on_and_a_tall_one_beside_it() -> None:
    """From little above a table nothing but the coincidence of edges tells the plant from a tall one far behind."""
    table = RequestedObject("table", (0.1, 2.1, 0.44), (0.75, 0.8, 0.88))
    on_it = RequestedObject("plant", (-0.07, 2.05, 1.0), (0.2, 0.2, 0.25))
    beside = RequestedObject("plant", (-1.2, 3.4, 0.6), (0.5, 0.5, 1.2))
    found = placed(table, on_it, beside, height_m=1.04)
    assert [p.supporter for p in found[1:]] == [0, FLOOR]


def test_a_vase_with_flowers_is_on_the_night_stand_behind_the_bed() -> None:
    """A vase of the usual size would be half as far away, and so on the bed."""
    bed = RequestedObject("bed", (0.3, 2.6, 0.3), (2.1, 1.6, 0.6))
    stand = RequestedObject("night stand", (1.4, 2.75, 0.31), (0.42, 0.5, 0.62))
    vase = RequestedObject("vase", (1.35, 2.7, 1.04), (0.3, 0.3, 0.84))
    assert placed(bed, stand, vase, height_m=1.1)[2].supporter == 1


def test_a_plant_on_furniture_does_not_make_the_room_larger() -> None:
    sideboard = RequestedObject("sideboard", (0.9, 3.0, 0.4), (0.45, 1.2, 0.8))
    plant = RequestedObject("plant", (0.9, 3.0, 1.05), (0.35, 0.35, 0.5))
    picture = RequestedObject("picture", (0.0, 3.3, 1.6), (0.03, 0.8, 0.6))
    with_plant, without = placed(sideboard, picture, plant), placed(sideboard, picture)
    assert with_plant[1].cuboid.centre[0] == pytest.approx(without[1].cuboid.centre[0], abs=0.02)


def test_what_lies_on_a_table_is_not_on_the_rug_below_it() -> None:
    """On the rug it would be farther away and not lower in the picture; people do not put tablets on rugs."""
    rug = RequestedObject("rug", (0.0, 2.2, 0.005), (1.6, 1.9, 0.01))
    table = RequestedObject("coffee table", (0.0, 1.9, 0.2), (0.6, 1.05, 0.4))
    tablet = RequestedObject("tablet", (0.2, 2.12, 0.41), (0.2, 0.14, 0.012))
    assert placed(rug, table, tablet)[2].supporter == 1


def test_a_photo_frame_is_on_the_lower_board_of_its_night_stand() -> None:
    stand = RequestedObject("night stand", (0.4, 2.75, 0.35), (0.42, 0.5, 0.7))
    frame = RequestedObject("photo frame", (0.42, 2.62, 0.3), (0.09, 0.17, 0.21))
    found = placed(ROOM[0], stand, frame)[2]
    assert found.supporter == 1
    assert found.cuboid.base_m[0] == pytest.approx(0.195, abs=0.1)


def test_a_cup_is_on_the_books_that_are_seen_below_it_and_on_no_cup() -> None:
    table = RequestedObject("table", (0.1, 2.1, 0.37), (0.85, 1.4, 0.74))
    pile = RequestedObject("books", (0.2, 2.2, 0.84), (0.2, 0.28, 0.2))
    cup = RequestedObject("cup", (0.2, 2.2, 0.99), (0.09, 0.09, 0.1))
    found = outlined(table, pile, cup)
    assert [p.supporter for p in found] == [FLOOR, 0, 1]
    assert found[2].cuboid.base_m[0] == pytest.approx(found[1].cuboid.top_m[0], abs=0.06)
    other = RequestedObject("cup", (0.2, 2.2, 0.84), (0.2, 0.28, 0.2))
    assert outlined(table, other, cup)[2].supporter == 0


def test_large_objects_never_stand_on_others() -> None:
    sofa, table = ROOM[0], RequestedObject("desk", (0.2, 3.6, 0.37), (0.7, 1.4, 0.74))
    assert [p.supporter for p in placed(sofa, table)] == [FLOOR, FLOOR]


def test_overlapping_readings_are_parted() -> None:
    found = placed(
        RequestedObject("bed", (0.0, 4.0, 0.3), (2.0, 1.6, 0.6)),
        RequestedObject("chair", (1.2, 2.6, 0.43), (0.52, 0.5, 0.86)),
    )
    gap = np.linalg.norm(found[0].cuboid.centre[0, :2] - found[1].cuboid.centre[0, :2])
    assert gap > 1.2


@pytest.mark.parametrize(
    ("item", "looks_like", "supporter"),
    [
        (RequestedObject("object", (0.2, 3.9, 1.7), (0.04, 0.7, 0.5)), {"picture": 0.35, "mirror": 0.3}, WALL),
        (RequestedObject("object", (0.2, 3.5, 2.35), (0.4, 0.45, 0.45)), {"ceiling lamp": 0.35, "fan": 0.3}, CEILING),
        (RequestedObject("object", (-1.2, 2.4, 0.4), (0.5, 0.5, 0.8)), {"chair": 0.35, "stool": 0.3}, FLOOR),
    ],
)  # fmt: skip
def test_a_thing_without_a_name_is_held_like_what_it_may_be(item, looks_like, supporter) -> None:
    *known, unnamed = seen((*ROOM[:3], item), R, 1.5)
    meanings = (*looks_like.items(), *((k, 0.05) for k in ("vase", "table", "picture", "chair") if k not in looks_like))
    objects = (*known, replace(unnamed, category=UNKNOWN.name, label=UNKNOWN.name, meanings=meanings))
    assert place_all(gather(objects, K.width, K.height), VIEW, 1.5)[-1].supporter == supporter


def test_no_objects() -> None:
    assert place_all(gather((), 640, 480), VIEW, 1.4) == ()
