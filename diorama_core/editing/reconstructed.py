"""What was reconstructed from the photo, put into a scene: inserted, in place of an object, or only its kind."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from diorama_core.editing.placing import seated
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.types import Scene, SceneObject

if TYPE_CHECKING:
    from diorama_core.pipeline.reconstruct_object import Found  # the whole pipeline; editing does without it


def inserted(scene: Scene, found: Found, library: ShapeLibrary) -> Scene:
    """The scene with the found object as a new one, resting on its supporter."""
    item = replace(found.item, id=edits.fresh_id(scene, found.item.category))
    edge = None if found.support is None else replace(found.support, child=item.id)
    if edge is not None and not (scene.has_object(edge.parent) or scene.has_plane(edge.parent)):
        edge = None
    return seated(edits.insert(scene, item, edge), library, item.id)


def replaced(scene: Scene, object_id: str, found: Found, library: ShapeLibrary) -> Scene:
    """The scene with a reconstructed object; unchanged where the correction changes nothing."""
    if found.as_built:
        return scene
    changed = edits.swap(scene, object_id, found.item.candidates[0])
    return seated(_described(changed, object_id, found, colour=found.item.colour), library, object_id)


def renamed(scene: Scene, object_id: str, found: Found) -> Scene:
    """The scene with an object of the found kind, where and in the colour that it was."""
    colour = scene.object(object_id).colour
    swapped = edits.swap(scene, object_id, found.item.candidates[0], keep_pose=True)
    return _described(swapped, object_id, found, colour=colour)


def _described(scene: Scene, object_id: str, found: Found, *, colour: tuple[float, float, float] | None) -> Scene:
    def described(item: SceneObject) -> SceneObject:
        new = found.item
        return replace(
            item,
            label=new.label,
            category=new.category,
            candidates=new.candidates,
            box_px=new.box_px,
            confidence=new.confidence,
            colour=colour,
            photo_materials=new.photo_materials,
        )

    return replace(scene, objects=tuple(described(o) if o.id == object_id else o for o in scene.objects))
