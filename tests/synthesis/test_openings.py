from __future__ import annotations

import numpy as np
import pytest

from diorama_core.geometry.openings import STANDS_OUT_M
from diorama_core.synthesis.openings import DOOR_SWING_M, add_door, add_window
from tests.synthesis.box_rooms import furnisher, sound


@pytest.mark.parametrize("seed", range(4))
def test_a_door_stands_on_the_floor_near_an_end_of_a_wall(seed: int) -> None:
    f = furnisher(seed)
    door = f.object(add_door(f))
    edge = f.supports[-1]
    wall = next(w for w in f.plan.walls if w.id == edge.parent)
    assert door.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    assert door.size_m[0] <= STANDS_OUT_M + 1e-9
    t = (door.pose.position[:2] - wall.start) @ wall.direction
    assert min(t, wall.length_m - t) < door.size_m[1] / 2 + 0.55
    sound(f)
    # Nobody puts a box where the door swings.
    before = door.pose.position[:2] + wall.inward * DOOR_SWING_M / 2
    assert f.stand(f.pick("box"), before, 0.0) is None


def test_a_short_wall_gets_no_door() -> None:
    f = furnisher()
    wall = f.plan.walls[0]
    short = type(wall)("wall_0", wall.start, wall.start + wall.direction)
    assert add_door(f, short) is None
    assert f.objects == []


@pytest.mark.parametrize("seed", range(4))
def test_a_window_hangs_below_its_top_and_a_radiator_below_it(seed: int) -> None:
    f = furnisher(seed)
    wall = f.plan.walls[2]
    window = f.object(add_window(f, wall, dressed=0.0))
    assert window.corners_world[:, 2].max() == pytest.approx(2.2, abs=0.01)
    assert f.supports[0].parent == wall.id
    for radiator in (o for o in f.objects if o.category == "radiator"):
        assert radiator.corners_world[:, 2].max() < window.corners_world[:, 2].min()
    sound(f)


@pytest.mark.xfail(
    strict=True,
    reason="curtains are asked 7 cm beside a window, walls keep 12 cm between what hangs on them: none ever hangs; "
    "mending it changes the rooms of every benchmark",
)
def test_a_dressed_window_has_a_curtain_on_each_side() -> None:
    f = furnisher()
    wall = f.plan.walls[2]
    window = f.object(add_window(f, wall, dressed=1.0))
    curtains = [o for o in f.objects if o.category == "curtain"]
    assert len(curtains) == 2
    sides = [np.sign((c.pose.position - window.pose.position)[:2] @ wall.direction) for c in curtains]
    assert sorted(sides) == [-1.0, 1.0]
    sound(f)


def test_tall_furniture_keeps_clear_of_a_window_and_low_furniture_need_not() -> None:
    f = furnisher()
    wall = f.plan.walls[0]
    add_window(f, wall, wall.length_m / 2, dressed=0.0)
    radiators = [o.id for o in f.objects if o.category == "radiator"]
    tall = f.pick("bookshelf", where=lambda s: s.size_m[2] > 1.5)
    assert f.against_wall(tall, walls=[wall], t_m=wall.length_m / 2) is None
    for radiator in radiators:
        f.bodies.remove(radiator)
    assert f.against_wall(f.pick("cabinet"), walls=[wall], t_m=wall.length_m / 2) is not None
