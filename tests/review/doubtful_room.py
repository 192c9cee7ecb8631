"""The small room as a build would believe it: unsure of one chair, of what holds the lamp, and of nothing else."""

from __future__ import annotations

from dataclasses import replace

from diorama_core.scene.belief import Belief
from diorama_core.scene.types import Scene
from tests.app.small_room import furnished_scene

BELIEFS = {
    "table_1": Belief(kinds=(("table", 1.0),), supporters=(("floor", 1.0),)),
    "lamp_1": Belief(kinds=(("lamp", 1.0),), supporters=(("table_1", 0.6), ("floor", 0.4))),
    "chair_1": Belief(
        kinds=(("chair", 0.55), ("table", 0.45)), fronts=(0.7, 0.1, 0.2, 0.0), supporters=(("floor", 1.0),)
    ),
    "chair_2": Belief(kinds=(("chair", 0.9), ("table", 0.1)), supporters=(("floor", 1.0),)),
    "picture_1": Belief(present=0.5, kinds=(("picture", 1.0),), supporters=(("wall_3", 1.0),)),
}


def believed(scene: Scene, beliefs: dict[str, Belief]) -> Scene:
    """The scene with these beliefs of its objects."""
    return replace(scene, objects=tuple(replace(o, belief=beliefs.get(o.id)) for o in scene.objects))


def doubtful_scene() -> Scene:
    """The furnished scene with `BELIEFS`."""
    return believed(furnished_scene(), BELIEFS)
