"""An object of a size, where tests of editing put it."""

from __future__ import annotations

from diorama_core.scene.types import Pose, SceneObject


def item(category: str, size: tuple[float, float, float], x: float, y: float, yaw: float = 0.0) -> SceneObject:
    """On the floor."""
    return SceneObject(category, category, category, "shape", size, Pose.upright([x, y, size[2] / 2], yaw))


SOFA = item("sofa", (0.9, 2.0, 0.8), 0.0, 0.0)
"""It faces +x; its own left is +y."""
