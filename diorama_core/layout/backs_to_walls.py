"""Furniture whose back is at a wall, as far as a photo alone can tell, stands against it.

Cabinets, beds and the like hardly ever turn their backs to a gap of a hand's breadth. Distances that were reasoned are
less sure than that, so it is the gap that is an error; so is all of the distance behind a wall that was seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.layout.behind_walls import wall_before
from diorama_core.arrangement.noise import ObservationNoise
from diorama_core.library.taxonomy import AGAINST_WALLS
from diorama_core.scene import edits
from diorama_core.scene.types import Plane, Scene, SceneObject

PARALLEL = 0.9
"""Least cosine between a front and the normal of the wall behind it."""


def with_backs_to_walls(scene: Scene, noise: ObservationNoise) -> Scene:
    """The scene with furniture against the seen walls that its backs are nearest to, within what positions are off, and
    against those behind which it would stand.

    What stands against a wall already stays as it is.

    Args:
        scene: as observed.
        noise: of the observed positions.
    """
    floor = scene.architecture.floor
    if floor is None:
        return scene
    for item in scene.objects:
        edge = scene.support_of(item.id)
        if item.category not in AGAINST_WALLS or edge is None or edge.parent != floor.id or edge.adheres_to:
            continue
        gaps = {
            wall.id: _gap_m(item, wall)
            for wall in scene.architecture.by_role("wall")
            if wall.seen and _is_behind(item, wall)
        }
        nearest = min(gaps, key=lambda name: (abs(gaps[name]), name), default=None)
        if nearest is None:
            continue
        tolerance = noise.tolerance_m(scene.camera, item.pose.position, scene.plane(nearest).normal)
        before = wall_before(scene, item)
        if abs(gaps[nearest]) <= tolerance or (gaps[nearest] < 0.0 and before is not None and before.id == nearest):
            scene = edits.attach(scene, replace(edge, adheres_to=(nearest,)))
    return scene


def _gap_m(item: SceneObject, wall: Plane) -> float:
    """From a wall to the middle of an object's back."""
    back = item.pose.position - 0.5 * item.size_m[0] * item.pose.R_world_object[:, 0]
    return float(back @ wall.normal) - wall.offset


def _is_behind(item: SceneObject, wall: Plane) -> bool:
    """Whether an object turns its back to a wall and stands between its ends."""
    along = np.cross([0.0, 0.0, 1.0], wall.normal)
    spread, place = wall.polygon @ along, float(item.pose.position @ along)
    facing = float(item.pose.R_world_object[:, 0] @ wall.normal)
    return facing >= PARALLEL and float(spread.min()) <= place <= float(spread.max())
