"""An object made longer, wider or higher by one of its faces, or larger as a whole by a corner. Pure functions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Pose, Scene, SceneObject

STEP_M = 0.05
SMALLEST_M = 0.01
GROWN_MIN, GROWN_MAX = 0.05, 20.0


@dataclass(frozen=True)
class Handle:
    """Where an object is taken hold of to change its size."""

    name: str
    along: tuple[float, float, float]
    """In units of half the object's extents along its own axes."""

    @property
    def axis(self) -> int | None:
        """The axis it changes; None when it changes all in proportion."""
        return int(np.abs(self.along).argmax()) if np.count_nonzero(self.along) == 1 else None


HANDLES = (
    Handle("front", (1.0, 0.0, 0.0)),
    Handle("back", (-1.0, 0.0, 0.0)),
    Handle("left", (0.0, 1.0, 0.0)),
    Handle("right", (0.0, -1.0, 0.0)),
    Handle("top", (0.0, 0.0, 1.0)),
    Handle("corner", (1.0, 1.0, 1.0)),
)
"""Not the underside: it stays on what holds the object up."""


def handle_place(item: SceneObject, handle: Handle, margin_m: float) -> Float[np.ndarray, "3"]:
    """Where a handle is in the object's own frame, a little outside."""
    along = np.asarray(handle.along)
    return along * (item.size_m / 2 + margin_m)


def stretch(scene: Scene, object_id: str, handle: Handle, by_m: float, *, snap: bool) -> Scene:
    """The scene with an object's handle pulled outward by a length.

    The opposite face stays where it is, for the corner the middle of the underside. What stands on the object rises
    and sinks with its top and keeps its place otherwise.

    Args:
        scene: as it is.
        object_id: of the object.
        handle: what is pulled.
        by_m: outward.
        snap: whether lengths are rounded.

    Raises:
        EditRefused: the object is locked, or would be larger than a scene allows.
    """
    item = scene.object(object_id)
    size = _pull(item.size_m, handle, by_m, snap=snap)
    grown, R = size - item.size_m, item.pose.R_world_object
    shift = R[:, 2] * grown[2] / 2 if handle.axis is None else R @ (np.asarray(handle.along) * grown) / 2
    pose = Pose(R, item.pose.position + shift, size / np.asarray(item.shape_size_m))
    rise = R[:, 2] * grown[2]
    riding = {i: scene.object(i).pose.move(rise) for i in descendants(scene, object_id)}
    return edits.place(edits.move(scene, object_id, pose), riding)


def pull_m(
    item: SceneObject,
    handle: Handle,
    grabbed: Float[np.ndarray, "3"],
    eye: Float[np.ndarray, "3"],
    direction: Float[np.ndarray, "3"],
) -> float:
    """How far a handle was pulled outward when the hand that grabbed it there is now on this ray.

    Args:
        item: the object.
        handle: what is pulled.
        grabbed: where, world, metres.
        eye: of the ray, world, metres.
        direction: of the ray.
    """
    outward = item.pose.R_world_object @ (np.asarray(handle.along) * item.size_m)
    outward = outward / np.linalg.norm(outward)
    # The point of the handle's line that is nearest to the ray.
    d = np.asarray(direction) / np.linalg.norm(direction)
    between = np.asarray(grabbed) - np.asarray(eye)
    slant = float(outward @ d)
    if 1.0 - slant * slant < 1e-4:
        return 0.0  # seen end-on, the hand does not say how far
    return float((slant * (d @ between) - outward @ between) / (1.0 - slant * slant))


def new_poses(before: Scene, after: Scene) -> Mapping[str, Pose]:
    """Poses that differ."""
    start = {o.id: o for o in before.objects}
    return {o.id: o.pose for o in after.objects if o is not start.get(o.id)}


def _pull(size_m: np.ndarray, handle: Handle, by_m: float, *, snap: bool) -> np.ndarray:
    axis = handle.axis
    if axis is None:
        half = np.linalg.norm(size_m) / 2
        factor = float(np.clip(1.0 + by_m / (2 * half), GROWN_MIN, GROWN_MAX))
        if snap:
            factor = max(round(factor * size_m[2] / STEP_M), 1) * STEP_M / size_m[2]
        return size_m * factor
    new = np.array(size_m)
    new[axis] += by_m
    if snap:
        new[axis] = max(round(new[axis] / STEP_M), 1) * STEP_M
    new[axis] = max(new[axis], SMALLEST_M)
    return new
