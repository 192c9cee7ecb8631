"""Moves: what moves takes its load along, is held up, free and in the room."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.editing.footprints import footprint_of, lie_within
from diorama_core.editing.positioning import Positioner
from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from diorama_core.text.edit_places import lift_onto, shift
from diorama_core.text.edit_plan import Move, Place, Remove, Resize, Shift, Turn
from tests.text.edited import apart_m, assert_sound, done


def test_moved_objects_take_their_load_along(living: Scene) -> None:
    after = done(living, Move(objects=["sideboard_1"], places=[Place(relation="against wall")]))
    moved = after.object("sideboard_1").pose.position - living.object("sideboard_1").pose.position
    lamp = after.object("lamp_1").pose.position - living.object("lamp_1").pose.position
    if np.isclose(after.object("sideboard_1").pose.yaw_rad, living.object("sideboard_1").pose.yaw_rad):
        np.testing.assert_allclose(moved, lamp, atol=1e-6)
    assert_sound(living, after)


def test_turns_and_sizes_keep_things_free(living: Scene) -> None:
    turned = done(living, Turn(objects=["plant_1"], degrees=45.0))
    assert turned.object("plant_1").pose.yaw_rad != living.object("plant_1").pose.yaw_rad
    larger = done(living, Resize(objects=["coffee_table_1"], factor=1.1))
    assert larger.object("coffee_table_1").size_m[2] > living.object("coffee_table_1").size_m[2]
    for after in (turned, larger):
        assert_sound(living, after)


def test_what_is_moved_by_a_length_goes_that_far_or_says_that_it_stepped_aside(living: Scene) -> None:
    positioner = Positioner(built_in_library())
    before = living.object("plant_1").pose.position
    for way in (0.1, -0.1, 0.3, -0.3):
        outcome = shift(positioner, living, Shift(objects=["plant_1"], right_m=way))
        gone = outcome.scene.object("plant_1").pose.position - before
        assert outcome.notes or np.linalg.norm(gone[:2]) == pytest.approx(abs(way), abs=1e-6)
        assert_sound(living, outcome.scene)


def test_things_go_nearer_to_others_and_what_hangs_up_and_down(living: Scene) -> None:
    positioner, pair = Positioner(built_in_library()), ("piano_1", "plant_1")
    away = shift(positioner, living, Shift(objects=["plant_1"], toward="piano_1", toward_m=-0.1))
    assert away.notes or apart_m(away.scene, *pair) == pytest.approx(apart_m(living, *pair) + 0.1, abs=1e-6)
    assert away.lines == ("move plant 1 0.1 m away from piano 1",)
    raised = shift(positioner, living, Shift(objects=["picture_1"], up_m=0.05))
    rise = raised.scene.object("picture_1").pose.position - living.object("picture_1").pose.position
    np.testing.assert_allclose(rise, [0.0, 0.0, 0.05], atol=1e-9)
    assert_sound(living, raised.scene)
    with pytest.raises(EditRefused, match="does not hang"):
        shift(positioner, living, Shift(objects=["sofa_1"], up_m=0.2))
    with pytest.raises(EditRefused, match="leave its wall"):
        shift(positioner, living, Shift(objects=["picture_1"], up_m=2.0))


def test_nothing_is_moved_off_what_it_stands_on(living: Scene) -> None:
    edge = living.support_of("lamp_1")
    assert edge is not None
    front = living.object(edge.parent).pose.R_world_object[:, 0]
    off = Shift(objects=["lamp_1"], right_m=0.5 * float(front[0]), away_m=0.5 * float(front[1]))
    with pytest.raises(EditRefused, match="fall off"):
        shift(Positioner(built_in_library()), living, off)


def test_a_rug_lifts_what_stands_wholly_on_it(living: Scene) -> None:
    rug = living.object("rug_1")
    on_floor = done(living, Remove(objects=["rug_1"]))
    floor = living.support_of("rug_1")
    again = lift_onto(edits.insert(on_floor, rug, floor), "rug_1")
    held = set(again.children_of("rug_1"))
    assert held
    for object_id in held:
        assert lie_within(footprint_of(again.object(object_id))[None], footprint_of(rug))[0]
        assert again.object(object_id).corners_world[:, 2].min() == pytest.approx(rug.corners_world[:, 2].max())


def test_locked_objects_stay(living: Scene) -> None:
    locked = edits.set_locked(living, "sofa_1", True)
    with pytest.raises(EditRefused, match="locked"):
        done(locked, Move(objects=["sofa_1"], places=[Place(relation="in corner")]))
