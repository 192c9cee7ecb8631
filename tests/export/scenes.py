"""Scenes of different sources for tests of exported files."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from diorama_core.export.gathering import ExportOptions, ExportScene, gather
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import CancelToken, Progress
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from diorama_core.scene.types import Architecture, Pose, Scene, SceneObject, Support
from diorama_core.synthesis.layout_rooms import box_library, generate_room
from tests.app.small_room import photo_camera, room_planes
from tests.primitives import PrimitiveLibrary, box_room, furnished_room

_EXAMPLE = Path(__file__).resolve().parents[2] / "assets" / "example" / "project"
DESK = "desk-writing-oak"
"""With three drawers."""
SOURCES = ("example", "primitives", "fittings", "boxes", "empty shell")


@cache
def gathered(source: str, **options: object) -> ExportScene:
    """One of `SOURCES`, gathered once for all tests of a process: nothing of it is changed."""
    scene, library = scene_of(source)
    textures = Project(_EXAMPLE).textures(scene) if source == "example" else {}
    return gather(scene, library, textures=textures, options=ExportOptions(**options), name=source)


def desk_in_dresser() -> ExportScene:
    """The room with fittings, its desk in the midst of its dresser."""
    scene, library = scene_of("fittings")
    desk, dresser = scene.object("desk_1"), scene.object("dresser_1")
    inside = replace(desk.pose, position=np.array([*dresser.pose.position[:2], desk.pose.position[2]]))
    return gather(edits.move(scene, desk.id, inside), library, options=ExportOptions(joints=True))


def stopping_at(fraction: float) -> Progress:
    """Progress that asks to stop when so much is done."""
    token = CancelToken()
    return Progress(lambda event: token.cancel() if event.fraction >= fraction else None, token)


@cache
def scene_of(source: str) -> tuple[Scene, ShapeLibrary]:
    if source == "example":
        return Project(_EXAMPLE).load_scene(), built_in_library()
    if source == "primitives":
        return furnished_room(PrimitiveLibrary()), PrimitiveLibrary()
    if source == "fittings":
        return fitted_room(built_in_library()), built_in_library()
    if source == "boxes":
        return generate_room(3, 12).truth, box_library()
    return Scene(None, Architecture(box_room().planes)), PrimitiveLibrary()


def fitted_room(library: ShapeLibrary) -> Scene:
    """A window and a door in the far wall, a dresser with a lamp, and a desk with a laptop and a swivel chair."""
    objects: list[SceneObject] = []
    supports: list[Support] = []

    def put(
        name: str, category: str, at: tuple[float, float], yaw: float, on: str, z: float, **edge: str
    ) -> SceneObject:
        shape = library.shape(DESK) if category == "desk" else library.in_category(category)[0]
        centre_z = z + shape.size_m[2] / 2
        pose = Pose.upright((*at, centre_z), yaw)
        item = SceneObject(name, category, category, shape.id, shape.size_m, pose)
        objects.append(item)
        supports.append(Support(name, on, **edge))
        return item

    wall_y = 3.4
    back = -np.pi / 2
    for name, category, x, z in (("window_1", "window", -1.0, 0.9), ("door_1", "door", 1.2, 0.0)):
        depth = library.in_category(category)[0].size_m[0]
        put(name, category, (x, wall_y - depth / 2), back, "wall_3", z, relation="mounted on")
    dresser = put("dresser_1", "dresser", (-1.8, 1.0), 0.0, "floor", 0.0)
    put("lamp_1", "lamp", (-1.8, 1.0), 0.3, "dresser_1", float(dresser.size_m[2]))
    desk = put("desk_1", "desk", (0.0, 2.4), back, "floor", 0.0)
    top = max((s.height_m for s in library.shape(desk.shape_id).surfaces), default=desk.size_m[2] / 2)
    put("laptop_1", "laptop", (0.0, 2.4), back, "desk_1", top + float(desk.size_m[2]) / 2)
    put("chair_1", "office chair", (0.0, 1.3), np.pi / 2, "floor", 0.0)
    put("rug_1", "rug", (0.9, 0.6), 0.0, "floor", 0.0)
    return Scene(photo_camera(), Architecture(room_planes()), tuple(objects), tuple(supports))
