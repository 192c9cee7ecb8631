from __future__ import annotations

import numpy as np
import pytest

from diorama_core.synthesis.furnisher import WALL_GAP_M, Furnisher, Spread
from diorama_core.synthesis.plan import footprint
from tests.synthesis.box_rooms import LIBRARY, PLAN, furnisher, sound


@pytest.fixture
def f() -> Furnisher:
    return furnisher()


def test_shapes_are_picked_by_category_and_condition(f) -> None:
    assert f.pick("sofa").category == "sofa"
    assert f.pick("nothing of the kind") is None
    low = f.pick("table", where=lambda s: s.size_m[2] < 0.5)
    assert low.size_m[2] < 0.5
    spread = Furnisher(PLAN, LIBRARY, np.random.default_rng(1), Spread(0.05, 0.02))
    sizes = np.array([spread.scale(f.pick("bed").shape).scale for _ in range(50)])
    assert 0.02 < np.log(sizes).std() < 0.1
    assert (np.abs(np.log(sizes)) <= 0.1 + 1e-9).all()


def test_objects_stand_on_the_floor_where_it_is_free(f) -> None:
    wardrobe = f.pick("wardrobe")
    first = f.stand(wardrobe, np.array([0.0, 0.0]), 0.0)
    assert f.object(first).pose.position == pytest.approx([0.0, 0.0, 1.0])
    assert f.stand(wardrobe, np.array([0.3, 0.0]), 0.0) is None
    assert not f.is_free(wardrobe, np.array([0.3, 0.0]), 0.0)
    assert f.stand(wardrobe, np.array([2.4, 0.0]), 0.0) is None, "through the wall"
    assert f.stand(wardrobe, np.array([1.0, 0.0]), 0.0) is not None
    sound(f)


def test_floor_that_is_kept_free_stays_free_of_what_is_higher(f) -> None:
    rug, box = f.pick("rug"), f.pick("box")
    f.keep_free(footprint(np.array([1.0, 1.0, 0.0]), np.zeros(2), 0.0), above_m=0.05)
    assert f.stand(box, np.zeros(2), 0.0) is None
    assert f.stand(rug, np.zeros(2), 0.0) is not None
    f.forget_last_zone()
    on_rug = f.stand(box, np.zeros(2), 0.0)
    assert f.supports[-1].parent == f.objects[0].id
    assert f.object(on_rug).corners_world[:, 2].min() == pytest.approx(0.01, abs=1e-6)


def test_the_floor_before_an_object_is_kept_free(f) -> None:
    f.stand(f.pick("wardrobe"), np.zeros(2), 0.0, free_front_m=0.8)
    assert f.stand(f.pick("box"), np.array([0.7, 0.0]), 0.0) is None
    assert f.stand(f.pick("box"), np.array([-0.7, 0.0]), 0.0) is not None


def test_against_a_wall_the_back_is_flush(f) -> None:
    wall = f.plan.walls[0]
    placed = f.against_wall(f.pick("bookshelf"), walls=[wall], t_m=wall.length_m / 2)
    item = f.object(placed)
    behind = (item.corners_world[:, :2] - wall.start) @ wall.inward
    assert behind.min() == pytest.approx(WALL_GAP_M, abs=1e-6)
    assert item.pose.R_world_object[:2, 0] @ wall.inward == pytest.approx(1.0)
    assert f.supports[-1].adheres_to == (wall.id,)
    sound(f)


def test_objects_hang_on_walls_and_from_the_ceiling(f) -> None:
    wall = f.plan.walls[1]
    picture = f.hang(f.pick("picture"), wall, 1.5, 1.6)
    edge = f.supports[-1]
    assert (edge.parent, edge.relation) == (wall.id, "mounted on")
    assert f.object(picture).pose.position[2] == pytest.approx(1.6)
    assert f.hang(f.pick("picture"), wall, 1.6, 1.6) is None, "over another"
    lamp = f.hang_from_ceiling(f.pick("ceiling lamp"), np.zeros(2))
    assert f.object(lamp).corners_world[:, 2].max() == pytest.approx(2.6, abs=0.011)
    assert f.supports[-1].parent == "ceiling"
    sound(f)


def test_objects_rest_on_surfaces_beside_each_other(f) -> None:
    table = f.stand(f.pick("table", where=lambda s: s.size_m[2] > 0.7), np.zeros(2), 0.0)
    cup = f.pick("cup")
    first = f.rest(cup, table, 0, np.zeros(2))
    assert f.supports[-1].parent == table
    assert f.object(first).corners_world[:, 2].min() == pytest.approx(f.object(table).size_m[2], abs=2e-3)
    assert f.rest(cup, table, 0, np.array([0.02, 0.0])) is None
    assert f.rest(cup, table, 0, np.array([5.0, 0.0])) is None, "off the table"
    assert f.rest(cup, table, 0, np.array([0.2, 0.0])) is not None
    sound(f)


def test_anywhere_finds_a_free_place_until_there_is_none(f) -> None:
    placed = 0
    while f.anywhere(f.pick("wardrobe")) is not None:
        placed += 1
        assert placed < 40
    assert placed >= 6
    sound(f)
