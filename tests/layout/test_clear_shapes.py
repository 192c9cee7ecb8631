from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.arrangement.support_hypotheses import MEASURED
from diorama_core.layout.clear_shapes import clear_shapes
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.report import part_overlaps
from diorama_core.scene.types import Candidate, Pose, Scene
from diorama_core.synthesis.layout_rooms import COMPOUNDS, BoxLibrary, block
from tests.layout.small_rooms import Room

LIBRARY = BoxLibrary((*COMPOUNDS, block("table", 0.9, 1.4, 0.74, top=True)))
CLOSED, OPEN = "table_26", "table_0"
"""One is solid, the other has room between its legs."""


@pytest.fixture
def room() -> Room:
    return Room(LIBRARY)


def candidate(shape_id: str, score: float) -> Candidate:
    size = LIBRARY.shape(shape_id).size_m
    return Candidate(shape_id, size, score, Pose.upright((0.0, 1.0, size[2] / 2), 0.0))


def desk_with_a_box_below(room: Room, scores: tuple[float, float] = (0.5, 0.4), **more) -> Scene:
    candidates = (candidate(CLOSED, scores[0]), candidate(OPEN, scores[1]))
    room.put(CLOSED, (0.0, 1.0, LIBRARY.shape(CLOSED).size_m[2] / 2), id="desk", candidates=candidates, **more)
    room.put("box_24", (0.0, 1.0, 0.15), id="computer")
    return room.scene()


def overlaps(scene: Scene) -> dict[tuple[int, int], float]:
    problem = build_problem(scene, LIBRARY)
    return part_overlaps(problem)


def test_a_desk_takes_the_shape_that_has_room_for_what_is_below_it(room: Room) -> None:
    scene = desk_with_a_box_below(room)
    changed, reasons = clear_shapes(scene, LIBRARY, MEASURED)
    assert changed.object("desk").shape_id == OPEN
    assert overlaps(scene)
    assert not overlaps(changed)
    assert reasons == ("shape changed: desk leaves room for computer",)


def test_what_the_picture_says_plainly_outweighs_a_neighbour(room: Room) -> None:
    scene = desk_with_a_box_below(room, scores=(0.9, 0.001))
    assert clear_shapes(scene, LIBRARY, MEASURED) == (scene, ())


def test_a_locked_desk_stays(room: Room) -> None:
    scene = desk_with_a_box_below(room, locked=True)
    assert clear_shapes(scene, LIBRARY, MEASURED) == (scene, ())


def test_desks_of_one_shape_stay_of_one_shape(room: Room) -> None:
    scene = desk_with_a_box_below(room)
    desk = scene.object("desk")
    away = np.array([2.0, 0.0, 0.0])
    beside = tuple(
        replace(c, pose=Pose(c.pose.R_world_object, c.pose.position + away, c.pose.scale)) for c in desk.candidates
    )
    twin = replace(desk, id="twin", label="twin", pose=beside[0].pose, candidates=beside)
    changed, reasons = clear_shapes(replace(scene, objects=(*scene.objects, twin)), LIBRARY, MEASURED)
    assert {o.shape_id for o in changed.objects if o.id != "computer"} == {OPEN}
    assert len(reasons) == 2
    assert "of one shape" in reasons[1]


def test_nothing_that_is_clear_changes(room: Room) -> None:
    room.put(CLOSED, (0.0, 1.0, 0.4), candidates=(candidate(CLOSED, 0.1), candidate(OPEN, 0.9)))
    scene = room.scene()
    assert clear_shapes(scene, LIBRARY, MEASURED) == (scene, ())


def test_a_thing_stays_of_its_kind(room: Room) -> None:
    closed = "cabinet_10"
    height = LIBRARY.shape(closed).size_m[2]
    candidates = (candidate(closed, 0.5), candidate(OPEN, 0.4))
    room.put(closed, (0.0, 1.0, height / 2), id="desk", candidates=candidates)
    room.put("box_24", (0.0, 1.0, 0.15), id="computer")
    assert clear_shapes(room.scene(), LIBRARY, MEASURED) == (room.scene(), ())
