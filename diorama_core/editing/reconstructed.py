"""What was reconstructed from the photo, put into a scene: inserted, in place of an object, or only its kind."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from diorama_core.editing.footprints import footprint_of
from diorama_core.editing.placing import seat
from diorama_core.editing.positioning import Positioner
from diorama_core.geometry.planes import is_in_polygon
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import category
from diorama_core.scene import edits
from diorama_core.scene.room_edits import floor_height
from diorama_core.scene.types import Scene, Support

BELOW_M = 0.05
"""What reaches deeper below the floor is not in the room."""

if TYPE_CHECKING:
    from diorama_core.pipeline.reconstruct_object import Found  # the whole pipeline; editing does without it


def insert(scene: Scene, reconstruction: Found, library: ShapeLibrary) -> Scene:
    """The scene with the found object as a new one, resting on its supporter.

    One that would go through another object, below the floor or out of the room stands on what the photo shows it on,
    else beside it or where there is room.
    """
    item = replace(reconstruction.item, id=edits.fresh_id(scene, reconstruction.item.category))
    edge = None if reconstruction.support is None else replace(reconstruction.support, child=item.id)
    if edge is not None and not (scene.has_object(edge.parent) or scene.has_plane(edge.parent)):
        edge = None
    return _clear(seat(edits.insert(scene, item, edge), library, item.id), item.id, library)


def _clear(scene: Scene, object_id: str, library: ShapeLibrary) -> Scene:
    """The scene with an object that meets no other one and is in the room."""
    positioner = Positioner(library)
    met = [j for pair in positioner.collisions.pairs(scene, [object_id]) for j in pair if j != object_id]
    outside = not _is_in_room(positioner, scene, object_id)
    if not met and not outside:
        return scene
    carriers = [o.id for o in scene.objects if o.id != object_id] if outside else []
    for carrier in dict.fromkeys([*met, *carriers]):
        on_it = move_onto(scene, object_id, carrier, library)
        if on_it is not None and not positioner.collisions.pairs(on_it, [object_id]):
            return on_it
    spot = None if outside else positioner.nearby(scene, object_id)
    if spot is not None:
        return edits.move(scene, object_id, spot.pose)
    item = scene.object(object_id)
    spot = positioner.best(scene, item, near=item.pose.position)
    return scene if spot is None else positioner.put(scene, item, spot)


def _is_in_room(positioner: Positioner, scene: Scene, object_id: str) -> bool:
    """True for an object within the floor's outline and not below it; true in a scene without a floor."""
    item = scene.object(object_id)
    if scene.architecture.floor is None:
        return True
    above = float(item.corners_world[:, 2].min()) > floor_height(scene) - BELOW_M
    return above and positioner.is_inside(scene, object_id)


def move_onto(scene: Scene, object_id: str, carrier_id: str, library: ShapeLibrary) -> Scene | None:
    """An object where the photo shows its foot on top of another one, as large as it is seen; None where it does not.

    What seems to stand on the floor behind a sideboard looks like something smaller that stands nearer, on its top.

    Args:
        scene: with both objects and the photo's camera.
        object_id: of what is moved.
        carrier_id: of what it may stand on.
        library: of the scene's shapes.
    """
    item, carrier, camera = scene.object(object_id), scene.object(carrier_id), scene.camera
    if camera is None or item.box_px is None or not category(carrier.category).supports_objects:
        return None
    left, _, right, bottom = item.box_px
    ray, rise = camera.rays(np.array([[(left + right) / 2, bottom]]))[0], float(carrier.corners_world[:, 2].max())
    rise -= float(camera.position[2])
    if rise * float(ray[2]) <= 0.0:
        return None
    depth = rise / float(ray[2])
    place = camera.position + depth * ray
    if not is_in_polygon(place[None, :2], footprint_of(carrier))[0]:
        return None
    share = depth / float(camera.to_camera(item.pose.position[None])[0, 2])
    position = place + np.array([0.0, 0.0, share * item.size_m[2] / 2])
    pose = replace(item.pose, position=position, scale=share * item.pose.scale)
    moved = edits.attach(edits.move(scene, object_id, pose), Support(object_id, carrier_id))
    return seat(moved, library, object_id)


def replace_object(scene: Scene, object_id: str, reconstruction: Found, library: ShapeLibrary) -> Scene:
    """The scene with a reconstructed object; unchanged where the correction changes nothing.

    Args:
        scene: as it is.
        object_id: of the object.
        reconstruction: the object as it was reconstructed.
        library: where shapes come from.
    """
    if reconstruction.as_built:
        return scene
    changed = edits.swap(scene, object_id, reconstruction.item.candidates[0])
    return seat(_describe(changed, object_id, reconstruction, colour=reconstruction.item.colour), library, object_id)


def rename(scene: Scene, object_id: str, reconstruction: Found) -> Scene:
    """The scene with an object of the found kind, where and in the colour that it was."""
    colour = scene.object(object_id).colour
    swapped = edits.swap(scene, object_id, reconstruction.item.candidates[0], keep_pose=True)
    return _describe(swapped, object_id, reconstruction, colour=colour)


def _describe(
    scene: Scene, object_id: str, reconstruction: Found, *, colour: tuple[float, float, float] | None
) -> Scene:
    new, item = reconstruction.item, scene.object(object_id)
    described = replace(
        item,
        label=new.label,
        category=new.category,
        candidates=new.candidates,
        box_px=new.box_px,
        confidence=new.confidence,
        colour=colour,
        photo_materials=new.photo_materials,
    )
    return replace(scene, objects=tuple(described if o is item else o for o in scene.objects))
