"""Where an object could go: held up, within the room and clear of what stands there."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.editing.footprints import footprint_of, lie_within, overlapping
from diorama_core.editing.placement_candidates import Candidates, candidates_for
from diorama_core.editing.relations import Relation
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import SceneObject
from diorama_core.synthesis.grammar import furnish_room
from tests.editing.objects import item

SCENE = furnish_room(3, "living", built_in_library(), outline="box", clutter=4)
FRAME = RoomFrame.of(SCENE)


def candidates(what: SceneObject, *relations: Relation) -> list[Candidates]:
    found = candidates_for(SCENE, what, relations, FRAME, built_in_library())
    assert any(c.usable.any() for c in found), "some can be used"
    return found


def test_on_the_floor_they_are_within_the_room_and_clear_of_furniture() -> None:
    (floor,) = candidates(item("cabinet", (0.4, 0.8, 1.0), 0.0, 0.0))
    quads = floor.stances.quads[floor.usable]
    assert lie_within(quads, FRAME.outline).all()
    assert not overlapping(quads, footprint_of(SCENE.object("sofa_1")), 0.004).any()
    assert {s.parent for s in floor.supports if s is not None} <= {FRAME.floor_id, "rug_1"}


def test_seats_may_be_pushed_under_tables_and_cabinets_may_not() -> None:
    table = item("table", (1.0, 1.6, 0.75), *FRAME.middle)
    scene = SCENE.__class__(architecture=SCENE.architecture, objects=(table,))
    for category, under in (("chair", True), ("cabinet", False)):
        what = item(category, (0.5, 0.5, 0.7), 0.0, 0.0)
        (floor,) = candidates_for(scene, what, (), FRAME, built_in_library())
        assert bool(overlapping(floor.stances.quads[floor.usable], footprint_of(table), 0.05).any()) == under


def test_pictures_hang_on_walls_above_what_stands_there() -> None:
    picture = item("picture", (0.04, 0.8, 0.6), 0.0, 0.0)
    (walls,) = candidates(picture, Relation("above", ("sideboard_1",)))
    held = [s for s in walls.supports if s is not None]
    assert all(s.relation == "mounted on" for s in held)
    assert {s.parent for s in held} == {w.id for w in FRAME.walls}
    for k in np.flatnonzero(walls.usable):
        pose = walls.pose(picture, int(k))
        assert FRAME.floor_m < pose.position[2] - 0.3
        edge = walls.supports[k]
        assert edge is not None
        wall = FRAME.wall(edge.parent)
        assert wall is not None
        assert float(wall.off_of(pose.position[:2])) == pytest.approx(0.02)
        assert pose.position[2] + 0.3 < wall.high_m


def test_lamps_hang_from_the_ceiling() -> None:
    lamp = item("ceiling lamp", (0.4, 0.4, 0.5), 0.0, 0.0)
    (ceiling,) = candidates(lamp)
    assert FRAME.ceiling is not None
    top = [ceiling.pose(lamp, int(k)).position[2] + 0.25 for k in np.flatnonzero(ceiling.usable)]
    np.testing.assert_allclose(top, FRAME.ceiling.polygon[:, 2].max() - 0.005)


def test_a_vase_goes_on_what_is_named_or_on_what_carries_things_beside_it_before_the_floor() -> None:
    vase = item("vase", (0.15, 0.15, 0.3), 0.0, 0.0)
    named = candidates(vase, Relation("on", ("coffee_table_1",)))
    assert {s.parent for c in named for s in c.supports if s is not None} == {"coffee_table_1"}
    anywhere = {s.parent for c in candidates(vase) for s in c.supports if s is not None}
    assert "sofa_1" not in anywhere
    assert {"coffee_table_1", "sideboard_1"} <= anywhere
    beside = candidates(vase, Relation("beside", ("sofa_1",)))
    on_floor = [c for c in beside if {s.parent for s in c.supports if s is not None} & {FRAME.floor_id}]
    assert len(on_floor) == 1
    assert on_floor[0].extra.min() > min(
        c.extra[c.usable].min() for c in beside if c is not on_floor[0] and c.usable.any()
    )
