from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.positioning import Positioner
from diorama_core.evaluation.metrics.text_scene import are_in_rows
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from diorama_core.text.compose import Composed, compose_room
from diorama_core.text.placed_rows import place_rows
from diorama_core.text.prompt import RequestedObject, Wish
from diorama_core.text.rows import MAX_IN_ROWS


def in_rows(scene: Scene, category: str, rows: int, each: int) -> bool:
    return are_in_rows([o for o in scene.objects if o.category == category], rows, each)


@pytest.fixture(scope="module")
def classroom() -> Composed:
    prompt = "two rows of three desks facing a whiteboard and a chair at each desk"
    return compose_room(prompt, built_in_library())


def test_desks_stand_in_rows_with_room_for_their_chairs(classroom: Composed) -> None:
    scene = classroom.scene
    assert not classroom.notes
    assert in_rows(scene, "desk", 2, 3)
    assert sum(o.category == "chair" for o in scene.objects) == 6
    board = next(o for o in scene.objects if o.category == "whiteboard")
    for desk in (o for o in scene.objects if o.category == "desk"):
        toward = board.pose.position[:2] - desk.pose.position[:2]
        assert toward @ desk.pose.R_world_object[:2, 0] < -0.5  # over the desk, away from its front


def test_a_member_that_leaves_its_row_is_seen(classroom: Composed) -> None:
    desk = next(o for o in classroom.scene.objects if o.category == "desk")
    aside = replace(desk.pose, position=desk.pose.position + 0.3 * desk.pose.R_world_object[:, 0])
    assert not in_rows(edits.move(classroom.scene, desk.id, aside), "desk", 2, 3)
    assert not in_rows(classroom.scene, "desk", 3, 2)


def test_a_row_stands_along_the_wall() -> None:
    made = compose_room("a row of four chairs along the wall", built_in_library())
    assert not made.notes
    assert in_rows(made.scene, "chair", 1, 4)


def test_rows_without_room_and_wishes_that_the_whole_does_not_meet_are_named(classroom: Composed) -> None:
    library = built_in_library()
    positioner, shapes = Positioner(library), library.in_category("chair")[:2]
    many = RequestedObject("chair", "chairs", MAX_IN_ROWS, rows=1)
    assert place_rows(classroom.scene, many, shapes, positioner, {}) is None
    empty = replace(classroom.scene, objects=(), supports=())
    few = RequestedObject("chair", "chairs", 3, wishes=(Wish("against wall"),), rows=1)
    rows = place_rows(empty, few, shapes, positioner, {})
    assert rows is not None
    assert rows.unmet(rows.scene) == []
    away = replace(rows.block, pose=rows.block.pose.move(rows.block.pose.R_world_object[:, 0]))
    assert [w.kind for w, _ in replace(rows, block=away).unmet(rows.scene)] == ["against wall"]
    assert np.allclose([o.size_m for o in rows.scene.objects], rows.scene.objects[0].size_m)
