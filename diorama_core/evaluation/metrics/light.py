"""How far the direction is off from which most of a room's light comes."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.io.srgb import luminance
from diorama_core.render.lighting import Lighting, unshadowed
from diorama_core.scene.types import Camera, RoomLight

_TURNS, _LEVELS = 24, 12


def main_light(light: Lighting, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "3"]:
    """What a light is at some places on average, in the terms of `RoomLight`: direction times strength.

    Args:
        light: Any.
        points: In the world.
    """
    height = (np.arange(_LEVELS) + 0.5) / _LEVELS * 2 - 1
    turn = (np.arange(_TURNS) + 0.5) / _TURNS * 2 * np.pi
    h, t = (grid.ravel() for grid in np.meshgrid(height, turn))
    across = np.sqrt(1 - h**2)
    normals = np.stack([across * np.cos(t), across * np.sin(t), h], axis=1).astype(np.float32)
    fallen = [
        luminance(unshadowed(np.broadcast_to(p, normals.shape).astype(np.float32), normals, light)) for p in points
    ]
    design = np.column_stack([np.ones(len(normals)), normals])
    even, *sloped = np.linalg.lstsq(design, np.mean(fallen, axis=0), rcond=None)[0]
    return np.array(sloped) / max(float(even), 1e-9)


def light_error_deg(
    true: Float[np.ndarray, "3"], true_camera: Camera, found: RoomLight | None, camera: Camera
) -> float | None:
    """Angle between both directions as the photo sees them; None where no light was found.

    Args:
        true: Direction to the light, world.
        true_camera: Of the true scene.
        found: The estimate; None without.
        camera: Of the estimate.
    """
    if found is None:
        return None
    seen = camera.T_world_camera[:3, :3].T @ np.array(found.direction)
    wanted = true_camera.T_world_camera[:3, :3].T @ true
    cosine = float(seen @ wanted) / max(float(np.linalg.norm(seen) * np.linalg.norm(wanted)), 1e-9)
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
