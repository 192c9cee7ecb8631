"""Groups of furniture as people arrange them, with boxes for furniture."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from diorama_core.synthesis import groups
from diorama_core.synthesis.furnisher import Furnisher
from tests.synthesis.box_rooms import furnisher, sound

SEEDS = range(5)


def of(f: Furnisher, *categories: str) -> list:
    return [o for o in f.objects if o.category in categories]


def front(item) -> np.ndarray:
    return item.pose.R_world_object[:2, 0]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_seating_group_has_its_table_before_the_sofa(seed: int) -> None:
    f = furnisher(seed)
    sofa = f.object(groups.seating(f))
    sound(f)
    for table in of(f, "coffee table"):
        ahead = (table.pose.position - sofa.pose.position)[:2] @ front(sofa)
        assert 0.4 < ahead < 2.0
    for screen in of(f, "television"):
        toward = (screen.pose.position - sofa.pose.position)[:2]
        assert toward @ front(sofa) / np.linalg.norm(toward) > 0.7
        assert front(screen) @ front(sofa) < -0.7


@pytest.mark.parametrize("seed", SEEDS)
def test_chairs_stand_around_the_dining_table_and_face_it(seed: int) -> None:
    f = furnisher(seed)
    table = f.object(groups.dining(f, np.zeros(2)))
    chairs = of(f, "chair")
    assert 1 <= len(chairs) <= 8
    for chair in chairs:
        toward = (table.pose.position - chair.pose.position)[:2]
        assert toward @ front(chair) > 0
    sound(f)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_workplace_has_a_desk_at_a_wall_and_a_seat_at_the_desk(seed: int) -> None:
    f = furnisher(seed)
    desk = f.object(groups.workplace(f))
    (seat,) = of(f, "office chair", "chair")
    assert front(seat) @ (desk.pose.position - seat.pose.position)[:2] > 0
    assert np.linalg.norm((desk.pose.position - seat.pose.position)[:2]) < 1.3
    assert groups.wall_at_back(f, desk.id) is not None
    sound(f)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_bed_stands_at_a_wall_with_night_stands_at_its_head(seed: int) -> None:
    f = furnisher(seed)
    bed = f.object(groups.sleeping(f))
    wall, t = groups.wall_at_back(f, bed.id)
    assert 0 < t < wall.length_m
    for stand in of(f, "night stand"):
        offset = (stand.pose.position - bed.pose.position)[:2]
        assert offset @ front(bed) < 0
        assert abs(offset @ wall.direction) > bed.size_m[1] / 2
    sound(f)


def test_pictures_hang_above_what_stands_there_and_not_behind_it() -> None:
    f = furnisher()
    sofa = f.against_wall(f.pick("sofa"), walls=f.plan.walls[:1], t_m=2.5)
    picture = f.object(groups.picture_above(f, sofa, "picture"))
    assert picture.corners_world[:, 2].min() >= f.object(sofa).corners_world[:, 2].max()
    assert abs((picture.pose.position - f.object(sofa).pose.position)[:2] @ f.plan.walls[0].direction) < 0.3
    groups.pictures(f, 4, "picture")
    assert len(of(f, "picture")) >= 2
    sound(f)


def test_a_row_stands_side_by_side_along_a_wall() -> None:
    f = furnisher()
    wall = f.plan.walls[0]
    row = [f.object(i) for i in groups.row_along_wall(f, wall, ("cabinet", "wardrobe", "cabinet"))]
    assert len(row) == 3
    reach = [o.corners_world[:, :2] @ wall.direction for o in row]
    spans = sorted((float(r.min()), float(r.max())) for r in reach)
    assert all(b[0] - a[1] < 0.05 for a, b in pairwise(spans))
    sound(f)


def test_storage_corners_light_and_shelves() -> None:
    f = furnisher(2)
    assert len(groups.storage(f, 2, "bookshelf", "cabinet")) == 2
    groups.corner_objects(f, 2, "plant", "floor lamp")
    lamp = groups.ceiling_light(f)
    assert f.object(lamp).category == "ceiling lamp"
    for item in of(f, "plant", "floor lamp"):
        away = np.abs(np.abs(item.pose.position[:2]) - [2.5, 2.0])
        assert away.max() < 1.2, "in a corner"
    sound(f)


def test_places_in_an_objects_own_directions() -> None:
    f = furnisher()
    box = f.stand(f.pick("box"), np.array([0.5, 0.3]), np.pi / 2)
    np.testing.assert_allclose(groups.local_xy(f, box, 1.0, 0.0), [0.5, 1.3], atol=1e-9)
    np.testing.assert_allclose(groups.local_xy(f, box, 0.0, 1.0), [-0.5, 0.3], atol=1e-9)
    lengths = [w.length_m for w in groups.long_walls(f)]
    assert lengths == sorted(lengths, reverse=True)
    assert all(w.length_m >= 4.5 for w in groups.long_walls(f, 4.5))
