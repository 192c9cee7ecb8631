from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.editing.hand_placed import ids_to_keep, mark_by_hand
from diorama_core.scene import edits
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.types import Scene
from tests.app.small_room import furnished_scene


def _moved(scene: Scene, object_id: str, by: tuple[float, float, float]) -> Scene:
    return mark_by_hand(scene, edits.move(scene, object_id, scene.object(object_id).pose.move(by)))


def _by_hand(scene: Scene) -> set[str]:
    return {o.id for o in scene.objects if o.by_hand}


def test_what_is_moved_is_noted_and_what_rides_on_it_is_not() -> None:
    moved = _moved(furnished_scene(), "table_1", (0.3, 0.0, 0.0))
    assert moved.object("lamp_1").pose != furnished_scene().object("lamp_1").pose
    assert _by_hand(moved) == {"table_1"}
    assert _by_hand(scene_from_json(scene_to_json(moved).encode())) == {"table_1"}


def test_a_size_and_a_turn_are_noted_and_a_colour_is_not() -> None:
    scene = furnished_scene()
    larger = edits.resize(scene, "table_1", 1.2 * scene.object("table_1").size_m)
    assert _by_hand(mark_by_hand(scene, larger)) == {"table_1"}
    assert _by_hand(mark_by_hand(scene, edits.recolour(scene, "lamp_1", (1.0, 0.0, 0.0)))) == set()


def test_what_carries_something_placed_stays_too() -> None:
    assert ids_to_keep(_moved(furnished_scene(), "lamp_1", (0.05, 0.0, 0.0))) == {"lamp_1", "table_1"}


def _against(scene: Scene, object_id: str, wall: str) -> Scene:
    edge = scene.support_of(object_id)
    assert edge is not None
    return edits.attach(scene, replace(edge, adheres_to=(wall,)))


def test_dragging_away_from_a_wall_clears_against() -> None:
    scene = _against(furnished_scene(), "chair_1", "wall_3")
    inward = scene.plane("wall_3").normal
    along = np.array([-inward[1], inward[0], 0.0])
    assert _moved(scene, "chair_1", tuple(0.3 * along)).support_of("chair_1").adheres_to == ("wall_3",)
    assert _moved(scene, "chair_1", tuple(0.3 * inward)).support_of("chair_1").adheres_to == ()


def test_an_edit_that_says_against_which_wall_is_believed() -> None:
    scene = furnished_scene()
    said = _against(scene, "chair_1", "wall_3")
    moved = edits.move(said, "chair_1", said.object("chair_1").pose.move(0.3 * said.plane("wall_3").normal))
    assert mark_by_hand(scene, moved).support_of("chair_1").adheres_to == ("wall_3",)
