"""Copy and paste: objects with what stands on them and how they hold each other up; also from project to project."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.rooms import room_around
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Scene, SceneObject, Support

BESIDE_M = (0.3, 0.3, 0.0)
GAP_M = 0.05
"""Between copies and what they stand beside."""
TOUCHING_M = 0.03
"""Boxes that reach no further into each other only touch: a table on its rug."""
SLACK_M = 0.02
WAYS = ((0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
"""In sizes of what is copied."""


@dataclass(frozen=True)
class Clip:
    """What was copied."""

    objects: tuple[SceneObject, ...]
    supports: tuple[Support, ...]
    """Support edges of the copied objects; parents may lie outside."""

    @property
    def centre(self) -> Float[np.ndarray, "3"]:
        """Middle of the copied objects."""
        return np.mean([o.pose.position for o in self.objects], axis=0)


def clip_of(scene: Scene, ids: Iterable[str]) -> Clip:
    """Objects and everything they support, in scene order."""
    chosen = {i for one in ids for i in (one, *descendants(scene, one))}
    return Clip(
        tuple(o for o in scene.objects if o.id in chosen), tuple(s for s in scene.supports if s.child in chosen)
    )


def paste_at(scene: Scene, clip: Clip, target_world: Float[np.ndarray, "3"]) -> tuple[Scene, tuple[str, ...]]:
    """The scene with copies on the floor, around the place nearest to a point from which all of them are inside.

    Returns:
        The scene and the ids of the copies that do not ride on others.
    """
    corners = np.concatenate([o.corners_world for o in clip.objects])
    low, high = corners.min(axis=0), corners.max(axis=0)
    floor = room_around(scene, target_world).architecture.floor
    level, place = 0.0, np.asarray(target_world[:2], dtype=np.float64)
    if floor is not None:
        level = float(floor.offset / max(floor.normal[2], 1e-6))
        half = (high - low)[:2] / 2
        first, last = floor.polygon[:, :2].min(axis=0) + half, floor.polygon[:, :2].max(axis=0) - half
        place = np.where(first <= last, np.clip(place, first, last), (first + last) / 2)
    middle = (low + high)[:2] / 2
    inner = {s.child: s for s in clip.supports if s.parent in {o.id for o in clip.objects}}
    objects = tuple(_move(o, clip, inner, np.append(place - middle, 0.0), level) for o in clip.objects)
    scene, heads = paste_clip(scene, Clip(objects, tuple(inner.values())), np.zeros(3))
    if floor is not None:
        for object_id in heads:
            scene = edits.attach(scene, Support(object_id, floor.id))
    return scene, heads


def _move(
    item: SceneObject, clip: Clip, inner: dict[str, Support], shift: Float[np.ndarray, "3"], level: float
) -> SceneObject:
    """An object moved across, and down to the floor with whatever of the clip it stands on."""
    base = item.id
    while base in inner:
        base = inner[base].parent
    lowest = next(float(o.corners_world[:, 2].min()) for o in clip.objects if o.id == base)
    return replace(item, pose=item.pose.move(shift + np.array([0.0, 0.0, level - lowest])))


def free_offset(scene: Scene, clip: Clip) -> Float[np.ndarray, "3"]:
    """How far copies move to stand beside their originals, clear of everything and on the floor where that is possible.

    Boxes along the axes of the room are compared; places around are tried, near ones first.

    Returns:
        World offset (m); `BESIDE_M` where all places are taken.
    """
    pasted = {o.id for o in clip.objects}
    boxes = [(o.corners_world.min(axis=0), o.corners_world.max(axis=0)) for o in scene.objects if not o.hidden]
    copies = [(o.corners_world.min(axis=0), o.corners_world.max(axis=0)) for o in clip.objects]
    carried = {s.child: s.parent for s in clip.supports}
    heads = [o for o in clip.objects if carried.get(o.id) not in pasted]
    low = np.min([o.corners_world.min(axis=0) for o in heads], axis=0)
    high = np.max([o.corners_world.max(axis=0) for o in heads], axis=0)
    parents = {carried.get(o.id) for o in heads}
    parent = parents.pop() if len(parents) == 1 else None
    allowed = _extent_below(scene, heads, parent)
    along = _wall_direction(scene, parent)
    if along is None:
        step = np.append((high - low)[:2] + GAP_M, 0.0)
        ways = [np.append(way, 0.0) * step for way in WAYS]
    else:
        reached = np.concatenate([o.corners_world for o in heads]) @ along
        ways = [side * (float(np.ptp(reached)) + GAP_M) * along for side in (1.0, -1.0)]
    offsets = [reach * way for reach in (1.0, 1.5, 2.0) for way in ways]

    def fits(offset: Float[np.ndarray, "3"]) -> bool:
        within = allowed is None or bool(
            ((low + offset)[:2] >= allowed[0] - SLACK_M).all() and ((high + offset)[:2] <= allowed[1] + SLACK_M).all()
        )
        return within and not any(
            bool((np.minimum(high_a + offset, high_b) - np.maximum(low_a + offset, low_b) > TOUCHING_M).all())
            for low_a, high_a in copies
            for low_b, high_b in boxes
        )

    return next((offset for offset in offsets if fits(offset)), np.array(BESIDE_M))


def _wall_direction(scene: Scene, parent: str | None) -> Float[np.ndarray, "3"] | None:
    """The level direction of the wall that all copies hang on; None where they do not hang on one."""
    if parent is None or not scene.has_plane(parent) or scene.plane(parent).role != "wall":
        return None
    direction = np.cross((0.0, 0.0, 1.0), scene.plane(parent).normal)
    return np.asarray(direction / np.linalg.norm(direction), dtype=np.float64)


def _extent_below(
    scene: Scene, heads: list[SceneObject], parent: str | None
) -> tuple[Float[np.ndarray, "2"], Float[np.ndarray, "2"]] | None:
    """The extent (m) of what copies may stand on: their common supporter, or the floor; None where there is neither."""
    if parent is not None and scene.has_object(parent):
        corners = scene.object(parent).corners_world
    elif (floor := room_around(scene, heads[0].pose.position).architecture.floor) is not None:
        corners = floor.polygon
    else:
        return None
    return corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)


def paste_clip(scene: Scene, clip: Clip, offset_world: object = BESIDE_M) -> tuple[Scene, tuple[str, ...]]:
    """The scene with copies, shifted, under ids of their own.

    What stood on something outside the clip stands on the same supporter where that exists, else on the floor.

    Returns:
        The scene and the ids of the copies that do not ride on others.
    """
    shift = np.asarray(offset_world, dtype=np.float64)
    names: dict[str, str] = {}
    for item in clip.objects:
        names[item.id] = edits.fresh_id(scene, item.category)
        copy = replace(
            item, id=names[item.id], pose=item.pose.move(shift), locked=False, hidden=False, mask_id=None, box_px=None
        )
        scene = edits.insert(scene, copy)
    edges = {s.child: s for s in clip.supports}
    for item in clip.objects:
        edge = edges.get(item.id)
        if edge is None:
            continue
        known = scene.has_object(edge.parent) or scene.has_plane(edge.parent)
        parent = names.get(edge.parent) or (edge.parent if known else None)
        if parent is None and (floor := room_around(scene, item.pose.position + shift).architecture.floor) is not None:
            parent, edge = floor.id, replace(edge, parent_surface=None, child_face=None, relation="placed on")
        if parent is not None:
            adheres = tuple(w for w in edge.adheres_to if scene.has_plane(w))
            scene = edits.attach(scene, replace(edge, child=names[item.id], parent=parent, adheres_to=adheres))
    heads = tuple(names[o.id] for o in clip.objects if o.id not in edges or edges[o.id].parent not in names)
    return scene, heads
