"""One object of a scene file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class Part:
    """One object of a file."""

    name: str
    scene: trimesh.Scene
    """Geometry in the world: +Z up, metres."""
    M_world: Float[np.ndarray, "4 4"]
    """The node's frame to the world."""
    key: str | None = None
    """Equal for copies of one geometry; None where unknown."""
    yaw_rad: float = 0.0
    """How far its own axes are turned about up: shapes are taken in along their own axes."""
    front: str | None = None
    """Own axis that its front looks along, where the file says so."""
    category: str | None = None
    room: str | None = None
    """Name of the room whose floor it is, where the file has rooms; None for everything else."""

    @cached_property
    def whole(self) -> trimesh.Trimesh:
        """All geometry as one mesh."""
        return self.scene.to_geometry()

    @property
    def turn(self) -> Float[np.ndarray, "3 3"]:
        """Own axes to the world's."""
        c, s = np.cos(self.yaw_rad), np.sin(self.yaw_rad)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    @property
    def local_scene(self) -> trimesh.Scene:
        """The geometry along the part's own axes."""
        scene, T = self.scene.copy(), np.eye(4)
        T[:3, :3] = self.turn.T
        scene.apply_transform(T)
        return scene
