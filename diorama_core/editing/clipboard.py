"""Copy and paste: objects with what stands on them and how they hold each other up; also from project to project."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Scene, SceneObject, Support

BESIDE_M = (0.3, 0.3, 0.0)


@dataclass(frozen=True)
class Clip:
    """What was copied."""

    objects: tuple[SceneObject, ...]
    supports: tuple[Support, ...]
    """Of the copied objects; parents may lie outside."""

    @property
    def centre(self) -> Float[np.ndarray, "3"]:
        """Middle of the copied objects."""
        return np.mean([o.pose.position for o in self.objects], axis=0)


def copied(scene: Scene, ids: Iterable[str]) -> Clip:
    """Objects and everything they support, in scene order."""
    chosen = {i for one in ids for i in (one, *descendants(scene, one))}
    return Clip(
        tuple(o for o in scene.objects if o.id in chosen), tuple(s for s in scene.supports if s.child in chosen)
    )


def pasted_at(scene: Scene, clip: Clip, target_world: Float[np.ndarray, "3"]) -> tuple[Scene, tuple[str, ...]]:
    """The scene with copies on the floor, around the place nearest to a point from which all of them are inside.

    Returns:
        The scene and the ids of the copies that do not ride on others.
    """
    corners = np.concatenate([o.corners_world for o in clip.objects])
    low, high = corners.min(axis=0), corners.max(axis=0)
    floor = scene.architecture.floor
    level, place = 0.0, np.asarray(target_world[:2], dtype=np.float64)
    if floor is not None:
        level = float(floor.offset / max(floor.normal[2], 1e-6))
        half = (high - low)[:2] / 2
        first, last = floor.polygon[:, :2].min(axis=0) + half, floor.polygon[:, :2].max(axis=0) - half
        place = np.where(first <= last, np.clip(place, first, last), (first + last) / 2)
    middle = (low + high)[:2] / 2
    inner = {s.child: s for s in clip.supports if s.parent in {o.id for o in clip.objects}}
    objects = tuple(_moved(o, clip, inner, np.append(place - middle, 0.0), level) for o in clip.objects)
    scene, heads = pasted(scene, Clip(objects, tuple(inner.values())), np.zeros(3))
    if floor is not None:
        for object_id in heads:
            scene = edits.attach(scene, Support(object_id, floor.id))
    return scene, heads


def _moved(
    item: SceneObject, clip: Clip, inner: dict[str, Support], shift: Float[np.ndarray, "3"], level: float
) -> SceneObject:
    """An object moved across, and down to the floor with whatever of the clip it stands on."""
    base = item.id
    while base in inner:
        base = inner[base].parent
    lowest = next(float(o.corners_world[:, 2].min()) for o in clip.objects if o.id == base)
    return replace(item, pose=item.pose.moved(shift + np.array([0.0, 0.0, level - lowest])))


def pasted(scene: Scene, clip: Clip, offset_world: object = BESIDE_M) -> tuple[Scene, tuple[str, ...]]:
    """The scene with copies, shifted, under ids of their own.

    What stood on something outside the clip stands on the same supporter where that exists, else on the floor.

    Returns:
        The scene and the ids of the copies that do not ride on others.
    """
    shift = np.asarray(offset_world, dtype=np.float64)
    names: dict[str, str] = {}
    floor = scene.architecture.floor
    for item in clip.objects:
        names[item.id] = edits.fresh_id(scene, item.category)
        copy = replace(
            item, id=names[item.id], pose=item.pose.moved(shift), locked=False, hidden=False, mask_id=None, box_px=None
        )
        scene = edits.insert(scene, copy)
    edges = {s.child: s for s in clip.supports}
    for item in clip.objects:
        edge = edges.get(item.id)
        if edge is None:
            continue
        known = scene.has_object(edge.parent) or scene.has_plane(edge.parent)
        parent = names.get(edge.parent) or (edge.parent if known else None)
        if parent is None and floor is not None:
            parent, edge = floor.id, replace(edge, parent_surface=None, child_face=None, relation="placed on")
        if parent is not None:
            adheres = tuple(w for w in edge.adheres_to if scene.has_plane(w))
            scene = edits.attach(scene, replace(edge, child=names[item.id], parent=parent, adheres_to=adheres))
    heads = tuple(names[o.id] for o in clip.objects if o.id not in edges or edges[o.id].parent not in names)
    return scene, heads
