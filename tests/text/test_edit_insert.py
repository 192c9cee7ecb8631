"""New objects: where they are wished, free, and of the shape that the words name."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.editing.positioning import Positioner
from diorama_core.editing.relations import Relation, is_met
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Scene
from diorama_core.text.compose import compose_room
from diorama_core.text.edit_insert import RUG_MARGIN_M, insert
from diorama_core.text.edit_plan import Insert, Place
from tests.text.edited import assert_sound, done

MOVES = [
    ("floor lamp", Place(relation="beside", targets=["sofa_1"])),
    ("plant", Place(relation="in corner")),
    ("armchair", Place(relation="facing", targets=["sofa_1"])),
    ("armchair", Place(relation="opposite", targets=["sofa_1"])),
    ("vase", Place(relation="on", targets=["coffee_table_1"])),
    ("picture", Place(relation="above", targets=["sideboard_1"])),
    ("rug", Place(relation="under", targets=["coffee_table_1"])),
    ("armchair", Place(relation="beside", targets=["window_1"])),
    ("console table", Place(relation="against wall")),
    ("side table", Place(relation="between", targets=["sofa_1", "piano_1"])),
    ("plant", Place(relation="left of", targets=["tv_stand_1"])),
    ("ceiling lamp", Place(relation="above", targets=["coffee_table_1"])),
]


@pytest.mark.parametrize(("what", "place"), MOVES, ids=[f"{w} {p.relation}" for w, p in MOVES])
def test_new_objects_go_where_they_are_wished(living: Scene, what: str, place: Place) -> None:
    after = done(living, Insert(what=what, places=[place]))
    new = next(o for o in after.objects if not living.has_object(o.id))
    assert is_met(after, new.id, Relation(place.relation, tuple(place.targets)), RoomFrame.of(after))
    assert_sound(living, after)


def test_a_rug_is_as_large_as_what_it_goes_under(living: Scene) -> None:
    under = [Place(relation="under", targets=["coffee_table_1"])]
    outcome = insert(Positioner(built_in_library()), living, Insert(what="rug", places=under))
    rug, table = outcome.scene.object(outcome.touched[0]), living.object("coffee_table_1")
    assert min(rug.size_m[:2]) >= min(table.size_m[:2]) + 2 * RUG_MARGIN_M - 0.1


def test_several_share_what_they_are_beside(living: Scene) -> None:
    beside = Place(relation="beside", targets=["sofa_1", "piano_1"])
    outcome = insert(Positioner(built_in_library()), living, Insert(what="basket", count=2, places=[beside]))
    frame = RoomFrame.of(outcome.scene)
    for object_id, target in zip(outcome.touched, beside.targets, strict=True):
        assert is_met(outcome.scene, object_id, Relation("beside", (target,)), frame)
    assert len({outcome.scene.object(i).shape_id for i in outcome.touched}) == 1


def test_more_chairs_are_like_those_at_the_table_and_stand_there() -> None:
    library = built_in_library()
    scene = compose_room("a large table with four chairs around it", library).scene
    table = next(o for o in scene.objects if o.category == "table")
    before = {o.id for o in scene.objects}
    after = insert(Positioner(library), scene, Insert(what="chair", count=2)).scene
    new = [o for o in after.objects if o.id not in before]
    assert {o.shape_id for o in new} == {o.shape_id for o in scene.objects if o.category == "chair"}
    for chair in new:
        local = np.abs((chair.pose.position - table.pose.position)[:2] @ table.pose.R_world_object[:2, :2])
        assert (local - table.size_m[:2] / 2).max() < 1.2
