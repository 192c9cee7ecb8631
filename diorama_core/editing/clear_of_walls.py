"""What is put near a wall stands before it, not through it."""

from __future__ import annotations

import numpy as np

from diorama_core.geometry.planes import in_plane_polygon
from diorama_core.scene.types import Pose, Scene, SceneObject

UPRIGHT = 0.3
"""A wall's normal rises by less."""


def clear_of_walls(scene: Scene, item: SceneObject) -> Pose:
    """The pose of an object, pushed into the room where it would reach through a wall that its middle is before.

    A page does the same with the ghost of what is being placed (`static/ghost.js`).
    """
    pose = item.pose
    half = item.size_m / 2
    for wall in scene.architecture.by_role("wall"):
        if abs(float(wall.normal[2])) > UPRIGHT:
            continue
        reach = float(np.abs(wall.normal @ pose.R_world_object) @ half)
        gap = float(pose.position @ wall.normal) - wall.offset
        heights = wall.polygon[:, 2]
        foot = pose.position - gap * wall.normal
        foot[2] = np.clip(foot[2], float(heights.min()) + UPRIGHT, float(heights.max()) - UPRIGHT)
        if -reach < gap < reach and in_plane_polygon(foot[None], wall)[0]:
            pose = pose.moved((reach - gap) * wall.normal)
    return pose
