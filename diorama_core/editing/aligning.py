"""Several objects at once: align, distribute, mirror. Pure functions over the scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from diorama_core.errors import EditRefused
from diorama_core.library.hands import other_hand
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Pose, Scene, yaw_rotation

Anchor = Literal["low", "middle", "high"]


def align(scene: Scene, ids: Sequence[str], axis: Float[np.ndarray, "3"], anchor: Anchor) -> Scene:
    """Bring the low ends, middles or high ends of objects (along a level world axis) in line with the last one's.

    Args:
        scene: as it is.
        ids: of the objects.
        axis: world, level.
        anchor: which ends.
    """
    chosen = _movable(scene, ids, least=2)
    spans = {i: _span(scene, i, axis) for i in chosen}
    target = _anchor_value(_span(scene, ids[-1], axis), anchor)
    for i in chosen:
        scene = _shift(scene, i, axis, target - _anchor_value(spans[i], anchor))
    return scene


def distribute(scene: Scene, ids: Sequence[str], axis: Float[np.ndarray, "3"]) -> Scene:
    """Make the gaps between objects along an axis equal; the outermost two stay."""
    chosen = _movable(scene, ids, least=3)
    ordered = sorted(chosen, key=lambda i: float(np.mean(_span(scene, i, axis))))
    spans = [_span(scene, i, axis) for i in ordered]
    widths = [high - low for low, high in spans]
    gap = (spans[-1][1] - spans[0][0] - sum(widths)) / (len(ordered) - 1)
    at = spans[0][0]
    for i, span, width in zip(ordered, spans, widths, strict=True):
        scene = _shift(scene, i, axis, at - span[0])
        at += width + gap
    return scene


def widest_axis(scene: Scene, ids: Sequence[str]) -> Float[np.ndarray, "3"]:
    """The level world axis along which objects are spread most."""
    places = np.array([scene.object(i).pose.position for i in ids])
    spread = np.ptp(places[:, :2], axis=0)
    return np.array([1.0, 0.0, 0.0]) if spread[0] >= spread[1] else np.array([0.0, 1.0, 0.0])


def mirror(scene: Scene, ids: Sequence[str], axis: Float[np.ndarray, "3"], library: ShapeLibrary) -> Scene:
    """Reflect the arrangement of objects about its own middle: places, headings, and shapes with a left and a right.

    What stands on them is reflected with them. One's own models with a left and a right keep them: only built-in
    designs can be built the other way round.

    Args:
        scene: as it is.
        ids: of the objects.
        axis: world, level.
        library: where shapes come from.
    """
    chosen = _movable(scene, ids, least=1)
    spans = np.array([_span(scene, i, axis) for i in chosen])
    middle = float((spans[:, 0].min() + spans[:, 1].max()) / 2)
    riding = {d for i in chosen for d in descendants(scene, i)}
    image = {o.id: reflect(o.pose, axis, middle) for o in scene.objects if o.id in {*chosen, *riding}}
    for i in chosen:
        scene = edits.move(scene, i, image[i])
    scene = edits.place(scene, {i: image[i] for i in riding})
    shapes = {i: other_hand(library, scene.object(i).shape_id) for i in image}
    objects = tuple(replace(o, shape_id=shapes.get(o.id) or o.shape_id) for o in scene.objects)
    return replace(scene, objects=objects)


def reflect(pose: Pose, axis: Float[np.ndarray, "3"], at: float) -> Pose:
    """A pose whose place and heading are mirrored in the vertical plane `axis . p = at`."""
    position = pose.position + 2 * (at - float(axis @ pose.position)) * axis
    front = pose.R_world_object[:, 0]
    seen = front - 2 * float(axis @ front) * axis
    turn = float(np.arctan2(seen[1], seen[0]) - np.arctan2(front[1], front[0]))
    return replace(pose, R_world_object=yaw_rotation(turn) @ pose.R_world_object, position=position)


def _movable(scene: Scene, ids: Sequence[str], least: int) -> list[str]:
    """The objects that move by themselves: not those that ride on another chosen one."""
    if len(ids) < least:
        raise EditRefused(f"select {'two' if least == 2 else 'three'} or more objects first (Shift-click adds one)")
    riding = {d for i in ids for d in descendants(scene, i)}
    return [i for i in ids if i not in riding]


def _span(scene: Scene, object_id: str, axis: np.ndarray) -> tuple[float, float]:
    along = scene.object(object_id).corners_world @ axis
    return float(along.min()), float(along.max())


def _anchor_value(span: tuple[float, float], anchor: Anchor) -> float:
    return {"low": span[0], "middle": (span[0] + span[1]) / 2, "high": span[1]}[anchor]


def _shift(scene: Scene, object_id: str, axis: np.ndarray, by: float) -> Scene:
    if abs(by) < 1e-9:
        return scene
    return edits.move(scene, object_id, scene.object(object_id).pose.move(by * axis))
