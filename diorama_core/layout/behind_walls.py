"""Objects that would stand on the floor behind a wall: they are before it, on something that carries them.

From a photo alone the line of sight to an object's foot ends on the floor unless something is known to be there. Where
it goes through a wall that is seen it ends earlier: on a marked object, or on one that nobody marked.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.arrangement.noise import ObservationNoise
from diorama_core.arrangement.surfaces import (
    carries_things,
    is_soft,
    label_of,
    object_surfaces,
    outside_m,
    plane_surface,
)
from diorama_core.library import taxonomy
from diorama_core.library.company import SELDOM_CARRIED, often_carried
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.types import Plane, Pose, Scene, SceneObject, Support

NEVER_HANGS = taxonomy.having("never_hangs")
"""What stands on the floor wherever it is."""
BEHIND = 0.9
"""An object is behind a wall that is nearer than this share of its distance."""
_ODDEST = 2
"""Everything speaks against a carrier."""
UPRIGHT = 0.98
"""Surfaces whose normals, and objects whose up axes, have a smaller z carry nothing and rest on nothing."""


def before_wall(
    scene: Scene, library: ShapeLibrary, item: SceneObject, noise: ObservationNoise
) -> tuple[Scene, str] | None:
    """The scene with an object before the wall behind which it would stand, and what to say of it.

    It rests on the object on which the line of sight to its foot ends. What people put on furniture is at the wall
    where nothing that is known carries it. None where the object is in the room, or must be on the floor.
    """
    wall = wall_before(scene, item)
    if wall is None:
        return None
    behind = f"{item.label} would be behind {label_of(scene, wall.id)}"
    nearer = _nearer_in_sight(scene, library, item, noise)
    if nearer is not None:
        share, parent = nearer
        held = edits.attach(_along_sight(scene, item, share), Support(item.id, parent))
        return held, f"support changed: {behind} and rests on {label_of(scene, parent)}"
    if not taxonomy.lies_on_furniture(taxonomy.resolve(item.category).category.name):
        return None  # a cabinet whose foot is hidden would hang in the air
    at_wall = edits.attach(
        _along_sight(scene, item, _share_before(scene, item, wall)), Support(item.id, wall.id, "mounted on")
    )
    return at_wall, f"please check: {behind}; what carries it is not marked, so it is at the wall"


def wall_before(scene: Scene, item: SceneObject) -> Plane | None:
    """The seen wall that the line of sight to an object's centre goes through; None where the object is in the room."""
    if scene.camera is None:
        return None
    eye, sight = scene.camera.position, item.pose.position - scene.camera.position
    for wall in scene.architecture.by_role("wall"):
        closing = float(wall.normal @ sight)
        if wall.seen and closing < 0.0:
            share = (wall.offset - float(wall.normal @ eye)) / closing
            if 0.0 < share < BEHIND and outside_m(plane_surface(wall), eye + share * sight) == 0.0:
                return wall
    return None


def _share_before(scene: Scene, item: SceneObject, wall: Plane) -> float:
    """The share of its distance at which an object touches a wall from the room."""
    assert scene.camera is not None, "there is a line of sight"
    eye = scene.camera.position
    farthest = float(((item.corners_world - eye) @ wall.normal).min())
    return (wall.offset - float(eye @ wall.normal)) / farthest


def _nearer_in_sight(
    scene: Scene, library: ShapeLibrary, item: SceneObject, noise: ObservationNoise
) -> tuple[float, str] | None:
    """The object on which the line of sight to an object's foot ends, and at which share of the distance.

    It ends on one of its places, or beside it but in the object's box in the photo: shapes are not what they stand for.
    Odd company carries it only where nothing else does.
    """
    if scene.camera is None or item.category in NEVER_HANGS:
        return None
    eye = scene.camera.position
    sight = item.pose.apply(np.array([[0.0, 0.0, -0.5 * item.shape_size_m[2]]]))[0] - eye
    pixel = scene.camera.project(eye + sight)
    found: list[tuple[int, float, float, str]] = []
    for other in scene.objects:
        if other.id == item.id or not carries_things(other):
            continue
        x1, y1, x2, y2 = other.box_px or (np.inf, np.inf, -np.inf, -np.inf)
        in_box = bool(x1 <= pixel[0] <= x2 and y1 <= pixel[1] <= y2)
        odd = _oddity(item, other)
        if odd == _ODDEST and taxonomy.resolve(item.category).category.mount == "floor":
            continue  # a coat rack is on no chair
        for surface in object_surfaces(library.shape(other.shape_id), other):
            world = surface.in_world(other.pose)
            if float(world.normal @ UP_WORLD) < UPRIGHT or float(sight @ world.normal) >= 0.0:
                continue
            share = (world.level - float(eye @ world.normal)) / float(sight @ world.normal)
            beside = outside_m(world, eye + share * sight)
            if 0.0 < share < 1.0 and (in_box or beside <= 2.0 * noise.across_m):
                found.append((odd, beside, share, other.id))
    return min(found)[2:] if found else None


def _oddity(item: SceneObject, other: SceneObject) -> int:
    """How much speaks against a carrier: seats carry what is soft, and some things are hardly ever on others."""
    seat = taxonomy.resolve(other.category).category.seat_height_m is not None
    return (seat and not is_soft(item)) + (often_carried(item.category, other.category) <= SELDOM_CARRIED)


def _along_sight(scene: Scene, item: SceneObject, share: float) -> Scene:
    """The scene with an object so much nearer and smaller: it looks alike in the photo."""
    assert scene.camera is not None, "there is a line of sight"
    eye = scene.camera.position

    def nearer(pose: Pose) -> Pose:
        return Pose(pose.R_world_object, eye + share * (pose.position - eye), share * pose.scale)

    candidates = tuple(replace(c, pose=nearer(c.pose)) for c in item.candidates)
    moved = replace(item, pose=nearer(item.pose), candidates=candidates)
    return replace(scene, objects=tuple(moved if o.id == item.id else o for o in scene.objects))
