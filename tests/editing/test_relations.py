"""Relations as costs: none where they hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.relations import MET, Relation, RelationKind, Stances, relation_cost
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Pose
from diorama_core.synthesis.grammar import furnished_room
from tests.editing.objects import SOFA, item

FRAME = RoomFrame.of(furnished_room(3, "living", built_in_library(), outline="box", clutter=0))
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
    middle = wall.start + 0.5 * wall.length_m * wall.along + 0.3 * wall.inward
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
    assert FRAME.nearest_wall(middle) is wall
