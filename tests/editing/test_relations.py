"""Relations as costs: none where they hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.relations import MET, Relation, RelationKind, Stances, relation_cost
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Pose
from diorama_core.synthesis.grammar import furnish_room
from tests.editing.objects import SOFA, item

FRAME = RoomFrame.of(furnish_room(3, "living", built_in_library(), outline="box", clutter=0))
CASES: list[tuple[RelationKind, tuple[float, float, float], bool]] = [
    ("beside", (0.0, 1.3, 0.0), True),
    ("beside", (1.2, 0.0, 0.0), False),
    ("in front of", (1.1, 0.0, 0.0), True),
    ("in front of", (-1.1, 0.0, 0.0), False),
    ("behind", (-1.1, 0.0, 0.0), True),
    ("right of", (0.0, 1.3, 0.0), True),
    ("left of", (0.0, 1.3, 0.0), False),
    ("left of", (0.0, -1.3, 0.0), True),
    ("facing", (2.0, 0.5, np.pi), True),
    ("facing", (2.0, 0.5, 0.0), False),
    ("opposite", (2.0, 0.0, np.pi), True),
    ("opposite", (2.0, 0.0, 0.0), False),
    ("opposite", (0.0, 2.0, np.pi), False),
    ("near", (0.0, 1.6, 0.0), True),
    ("near", (0.0, 3.5, 0.0), False),
    ("aligned with", (1.5, 0.0, 0.0), True),
    ("aligned with", (1.5, 0.7, 0.6), False),
]


@pytest.mark.parametrize(("kind", "at", "met"), CASES)
def test_relations_cost_where_they_do_not_hold(kind: RelationKind, at: tuple[float, float, float], met: bool) -> None:
    stances = Stances.of(item("armchair", (0.5, 0.5, 0.9), *at))
    cost = relation_cost(Relation(kind, ("sofa",)), stances, "armchair", {"sofa": SOFA}, FRAME)
    assert bool(cost[0] <= MET) == met, cost


def test_relations_to_the_room() -> None:
    wall = FRAME.walls[0]
    middle = wall.start + 0.5 * wall.length_m * wall.direction + 0.3 * wall.inward
    at_wall = item("desk", (0.6, 1.2, 0.75), *middle, wall.yaw_rad)
    corner = FRAME.corners[0] + 0.4 * (FRAME.middle - FRAME.corners[0]) / np.linalg.norm(
        FRAME.middle - FRAME.corners[0]
    )
    in_corner = item("plant", (0.3, 0.3, 0.9), *corner)
    for one, kind in ((at_wall, "against wall"), (in_corner, "in corner")):
        assert relation_cost(Relation(kind), Stances.of(one), one.category, {}, FRAME)[0] <= MET
        moved = replace(one, pose=Pose.upright([*FRAME.middle, 0.5], 0.3))
        assert relation_cost(Relation(kind), Stances.of(moved), one.category, {}, FRAME)[0] > MET
    assert len(FRAME.corners) == len(FRAME.walls) == 4


def cost_of(kind: RelationKind, one, target, **more) -> float:
    relation = Relation(kind, (target.id,), **more)
    return float(relation_cost(relation, Stances.of(one), one.category, {target.id: target}, FRAME)[0])


def test_a_bench_lies_across_the_foot_of_a_bed() -> None:
    bed = item("bed", (2.0, 1.5, 0.5), 0.0, 0.0)
    across, along = (
        item("bench", (0.4, 1.2, 0.45), 1.3 + far, 0.0, yaw) for far, yaw in ((0.0, 0.0), (0.4, np.pi / 2))
    )
    assert cost_of("in front of", across, bed) + 0.3 < cost_of("in front of", along, bed)


def test_footstools_are_near_and_nobody_sits_in_the_fire() -> None:
    chair, fire = item("armchair", (0.8, 0.8, 0.9), 0.0, 0.0), item("fireplace", (0.4, 1.4, 1.2), 0.0, 0.0)
    near, far = (item("ottoman", (0.5, 0.5, 0.4), x, 0.0) for x in (0.85, 1.5))
    assert cost_of("in front of", near, chair) < cost_of("in front of", far, chair)
    hot, warm = (item("armchair", (0.8, 0.8, 0.9), x, 0.0, np.pi) for x in (0.7, 1.5))
    assert cost_of("in front of", warm, fire) < cost_of("in front of", hot, fire)


def test_seats_look_across_a_long_table_and_not_at_its_corners() -> None:
    table = item("table", (0.9, 2.4, 0.74), 0.0, 0.0)
    straight = item("chair", (0.5, 0.45, 0.9), 0.72, 0.9, np.pi)
    turned = item("chair", (0.5, 0.45, 0.9), 0.72, 0.9, np.pi + 0.8)
    corner = item("chair", (0.5, 0.45, 0.9), 0.8, 1.5, np.pi)
    assert cost_of("around", straight, table) <= MET
    assert cost_of("around", straight, table) < min(cost_of("around", turned, table), cost_of("around", corner, table))
    assert cost_of("around", corner, table) > MET


def test_one_of_several_has_its_own_place() -> None:
    table = item("table", (0.9, 2.4, 0.74), 0.0, 0.0)
    here, there = (item("chair", (0.5, 0.45, 0.9), 0.72, y, np.pi) for y in (0.6, -0.6))
    place = (0.6, 0.6)
    assert cost_of("around", here, table, seat_m=place) < cost_of("around", there, table, seat_m=place) - 0.5
    left, right = (item("armchair", (0.8, 0.8, 0.9), 2.5, y, np.pi) for y in (0.5, -0.5))
    assert cost_of("opposite", left, SOFA, aside_m=0.5) < cost_of("opposite", right, SOFA, aside_m=0.5) - 0.3


def test_between_two_beds_is_at_their_heads_too() -> None:
    beds = {i: item("bed", (2.0, 1.0, 0.5), 0.0, y) for i, y in (("a", -0.9), ("b", 0.9))}
    at_heads, off = (item("night stand", (0.4, 0.5, 0.5), x, 0.0) for x in (-0.75, -1.6))
    costs = [
        float(relation_cost(Relation("between", ("a", "b")), Stances.of(o), "night stand", beds, FRAME)[0])
        for o in (at_heads, off)
    ]
    assert costs[0] <= MET < costs[1]
