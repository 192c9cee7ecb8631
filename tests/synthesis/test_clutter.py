from __future__ import annotations

import numpy as np
import pytest

from diorama_core.synthesis.clutter import equip_desk, pillows, scatter
from tests.synthesis.box_rooms import furnisher, sound


@pytest.mark.parametrize("seed", range(4))
def test_things_are_left_on_furniture_up_to_the_budget(seed: int) -> None:
    f = furnisher(seed)
    table = f.stand(f.pick("table", where=lambda s: s.size_m[2] > 0.7), np.zeros(2), 0.0)
    shelf = f.against_wall(f.pick("bookshelf"), walls=f.plan.walls[:1], t_m=1.5)
    left = scatter(f, [table, shelf], 6)
    assert left == len(f.objects) - 2 <= 6
    assert left >= 1
    for edge in f.supports[2:]:
        assert edge.parent in {table, shelf, *(o.id for o in f.objects[2:])}
        assert edge.parent_surface is not None
    sound(f)
    assert scatter(f, [table], 0) == 0


@pytest.mark.parametrize("seed", range(4))
def test_a_desk_is_equipped_with_its_screen_at_the_back(seed: int) -> None:
    f = furnisher(seed)
    desk = f.stand(f.pick("desk"), np.zeros(2), 0.0)
    equip_desk(f, desk)
    front = f.object(desk).pose.R_world_object[:2, 0]
    for screen in (o for o in f.objects if o.category == "monitor"):
        assert (screen.pose.position - f.object(desk).pose.position)[:2] @ front < 0.05
        assert screen.pose.R_world_object[:2, 0] @ front > 0.7
    assert len(f.objects) > 1
    sound(f)


@pytest.mark.parametrize("seed", range(3))
def test_pillows_lean_in_the_seat(seed: int) -> None:
    f = furnisher(seed)
    sofa = f.stand(f.pick("sofa"), np.zeros(2), 0.0)
    pillows(f, sofa, 2)
    found = [o for o in f.objects if o.category == "pillow"]
    assert 1 <= len(found) <= 2
    seat = f.object(sofa)
    for pillow in found:
        local = (pillow.pose.position - seat.pose.position) @ seat.pose.R_world_object
        assert (np.abs(local[:2]) < seat.size_m[:2] / 2).all()
        assert pillow.corners_world[:, 2].min() > 0.3
