"""Flat things that were seen on another wall than the one that gave them their distance.

Where a picture hangs decides how far away it is and how large: where its sides in the photo meet the wall. With a wrong
wall it was twice as far, or turned by a right angle.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.library import taxonomy
from diorama_core.scene.frames import UP_WORLD
from diorama_core.scene.types import Camera, Plane, Pose, Scene, SceneObject

FLAT = 0.25
"""Depth of flat things, of their width and height at most."""
BORDER_PX = 2.0
"""Boxes that end nearer to the picture's border go on beyond it."""
FARTHER = 1.3
"""Distances that change by a smaller factor, either way, are left to the layout: it changes sizes by as much."""
MIN_CLOSING = 0.1
"""Lines of sight that meet a wall at a smaller cosine tell little about where on it."""


def moved_to_wall(scene: Scene, item: SceneObject, wall: Plane) -> Scene:
    """The scene with a flat thing where its box in the photo is on a wall; unchanged where that is not told.

    Args:
        scene: with its camera; distances were reasoned from a photo alone.
        item: what hangs on the wall, with its box.
        wall: the wall on which it was seen.
    """
    depth, width, height = item.size_m
    flat = depth <= FLAT * min(width, height) and taxonomy.resolve(item.category).category.mount == "wall"
    found = _extent_on(item, wall, scene.camera) if scene.camera is not None and flat else None
    if found is None:
        return scene
    centre, size_m = found
    along = np.cross(UP_WORLD, wall.normal)
    R = np.column_stack([wall.normal, along, UP_WORLD])
    candidates = tuple(
        replace(c, pose=Pose(R, centre, size_m / np.asarray(c.shape_size_m, np.float64))) for c in item.candidates
    )
    pose = Pose(R, centre, size_m / np.asarray(item.shape_size_m, np.float64))
    moved = replace(item, pose=pose, candidates=candidates)
    return replace(scene, objects=tuple(moved if o.id == item.id else o for o in scene.objects))


def _extent_on(
    item: SceneObject, wall: Plane, camera: Camera
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]] | None:
    """Centre and size (depth, width, height) of a flat thing whose box in the photo is on a wall; None where its sides
    do not meet the wall, or it is about as far away as it was.
    """
    if item.box_px is None:
        return None
    x1, y1, x2, y2 = item.box_px
    eye, k = camera.position, camera.intrinsics
    rays = camera.rays(np.array([[x1, y1], [x2, y1], [x1, y2], [x2, y2]]))
    closing = -(rays @ wall.normal)
    if (closing < MIN_CLOSING * np.linalg.norm(rays, axis=1)).any():
        return None
    hits = eye + ((float(eye @ wall.normal) - wall.offset) / closing)[:, None] * rays
    across = hits @ np.cross(UP_WORLD, wall.normal)
    # Seen aslant, the nearer end reaches farther up and down than the other one.
    sides = np.array([across[[0, 2]].mean(), across[[1, 3]].mean()])
    ends = np.array([hits[2:, 2].max(), hits[:2, 2].min()])
    share = float(np.linalg.norm(hits.mean(axis=0) - eye) / np.linalg.norm(item.pose.position - eye))
    if 1.0 / FARTHER < share < FARTHER:
        return None
    left, right = _continued(
        sides, (bool(x1 <= BORDER_PX), bool(x2 >= k.width - BORDER_PX)), share * float(item.size_m[1])
    )
    low, high = _continued(
        ends, (bool(y2 >= k.height - BORDER_PX), bool(y1 <= BORDER_PX)), share * float(item.size_m[2])
    )
    if left == right or low >= high:
        return None
    size_m = np.array([share * float(item.size_m[0]), abs(right - left), high - low])
    along = np.cross(UP_WORLD, wall.normal)
    centre = 0.5 * (left + right) * along + 0.5 * (low + high) * UP_WORLD
    return centre + (wall.offset + 0.5 * size_m[0]) * wall.normal, size_m


def _continued(ends: Float[np.ndarray, "2"], cut: tuple[bool, bool], usual_m: float) -> tuple[float, float]:
    """Two ends of an extent, those that the picture's border cuts so much farther out that it is as long as usual."""
    first, second = float(ends[0]), float(ends[1])
    beyond = max(usual_m - abs(second - first), 0.0) * (1.0 if second >= first else -1.0)
    if not any(cut):
        return first, second
    share = beyond / sum(cut)
    return first - share * cut[0], second + share * cut[1]
