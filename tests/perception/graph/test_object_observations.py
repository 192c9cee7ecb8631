from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.perception.graph.object_observations import observed, owner_map
from tests.synthetic_rooms import Shot, box_room, cuboid, look, shoot

ITEMS = (
    cuboid("table", (0.0, 2.6, 0), (0.8, 1.4, 0.75), -90),
    cuboid("lamp", (0.0, 2.6, 0.75), (0.25, 0.25, 0.4)),
    cuboid("picture", (-1.0, 3.97, 1.4), (0.04, 0.6, 0.4), -90),
)
SHOT = shoot(look(0, 14, 1.5, 70, (320, 240)), box_room(-2.2, 2.2, 4.0, 2.6), ITEMS, ("table", "lamp", "picture"))


def seen(shot: Shot = SHOT, depth: bool = True):
    inputs = shot.inputs if depth else replace(shot.inputs, depth_m=None)
    return {o.id: o for o in observed(inputs, shot.objects, shot.geometry)}


@pytest.mark.parametrize("depth", [True, False])
def test_what_is_seen_below_an_object_carries_it(depth: bool) -> None:
    found = seen(depth=depth)
    assert found["lamp"].below.get("table", 0.0) > 0.9
    assert found["lamp"].rim_share_on_objects > 0.9
    assert found["table"].below.get("floor", 0.0) > 0.4
    assert found["table"].hidden_below < 0.3


def test_heights_and_footprints_are_those_of_the_points() -> None:
    found = seen()
    assert found["lamp"].bottom_m == pytest.approx(0.75, abs=0.05)
    assert found["lamp"].top_m == pytest.approx(1.15, abs=0.03)
    np.testing.assert_allclose(found["table"].footprint, [[-0.7, 2.2], [0.7, 3.0]], atol=0.05)


def test_without_depth_the_cuboid_tells() -> None:
    found = seen(depth=False)
    assert found["lamp"].bottom_m == 0.75
    assert found["picture"].behind_m == 0.0


def test_how_far_behind_the_room_is() -> None:
    found = seen()
    assert found["picture"].behind_m < 0.1
    assert found["lamp"].behind_m > 0.7


def test_something_nearer_hides_the_lower_end() -> None:
    box = cuboid("box", (0.0, 1.5, 0), (0.5, 2.4, 0.7), -90)
    shot = shoot(SHOT.camera, SHOT.planes, (*ITEMS, box), ("table", "lamp", "picture", "box"))
    assert seen(shot)["table"].hidden_below > 0.8


def test_smaller_objects_lie_over_larger_ones_and_those_without_a_cuboid_are_left_out() -> None:
    large, small = SHOT.objects[0], SHOT.objects[1]
    both = large.mask | small.mask
    owners = owner_map([replace(large, mask=both), small], both.shape)
    assert (owners[small.mask] == 1).all()
    assert (owners[both & ~small.mask] == 0).all()
    assert (owners[~both] == -1).all()
    fewer = replace(SHOT.geometry, cuboids=SHOT.geometry.cuboids[1:])
    assert [o.id for o in observed(SHOT.inputs, SHOT.objects, fewer)] == ["lamp", "picture"]
