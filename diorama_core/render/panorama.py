"""The light that comes from all sides to the middle of a room, as an environment map.

A latitude-longitude map as OpenEXR defines it: the first row is up, the middle column looks along -Y of the world, and
columns go on to the right as one turns to the right (+X is at a quarter of the width).
"""

from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8

from diorama_core.geometry.openings import with_openings
from diorama_core.geometry.sphere import directions
from diorama_core.library.record import ShapeLibrary
from diorama_core.progress import SILENT, Progress
from diorama_core.render.lighting import Effort, ambient
from diorama_core.render.picture import light_of, looking_along
from diorama_core.render.raycast import PinholeView, pixel_centres
from diorama_core.render.shading import shoot
from diorama_core.render.world import scene_world
from diorama_core.scene.types import Camera, Intrinsics, Scene, rigid

WIDTH_PX = 512
EFFORT = Effort(window_rays=2, sky_rays=4)
SIDES = np.concatenate([np.eye(3), -np.eye(3)])
"""Directions in which the faces of a cube are seen from its middle."""
OVERLAP = 1.05
"""Half width of a face at unit depth: a little more than the cube's, so that no seam is read beyond a border."""
EYE_SHARE, ABOVE_M = 0.6, 0.2
"""Height of the middle, as a share of the room's, and how far it keeps above a thing that is there."""


def panorama(
    scene: Scene,
    library: ShapeLibrary,
    *,
    width: int = WIDTH_PX,
    textures: Mapping[str, UInt8[np.ndarray, "_ _ _"]] | None = None,
    effort: Effort = EFFORT,
    progress: Progress = SILENT,
) -> Float32[np.ndarray, "h w 3"]:
    """Linear radiance from every direction, half as high as wide; 1 is a white surface in the room's light.

    Args:
        scene: What is around; hidden objects are left out, what is beyond the room's open sides is its even light.
        library: Where its shapes are.
        width: Pixels.
        textures: Pictures of the planes by `Plane.texture`, and of the objects' materials from the photo.
        effort: Rays per pixel.
        progress: Where it is reported and cancelling is noticed.

    Raises:
        Cancelled: when asked to stop.
    """
    opened = with_openings(scene)
    world = scene_world(opened, library, textures=textures)
    centre, side = middle(scene), max(8, round(0.3 * width))
    away = directions(width)
    seen = np.zeros((*away.shape[:2], 3), np.float32)
    face_of = np.argmax(away @ SIDES.T, axis=-1)
    for number, forward in enumerate(SIDES):
        view = PinholeView(_face(centre, forward, side))
        light, blockers = light_of(scene, opened, library, world, view)
        progress.report(number / len(SIDES), "looking around the room")
        shot = shoot(world, blockers, view, light, effort, Progress(token=progress.token))
        beyond = ambient(view.rays(pixel_centres(side, side))[..., 3:].reshape(-1, 3), light).reshape(side, side, 3)
        radiance = shot.radiance + beyond * (1.0 - shot.coverage[..., None])
        p = away @ view.camera.T_world_camera[:3, :3]
        is_of_face = face_of == number
        at = 0.5 * side * (p[..., :2] / (OVERLAP * np.where(is_of_face, p[..., 2], 1.0)[..., None]) + 1.0) - 0.5
        picture = cv2.remap(radiance, at.astype(np.float32), None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        seen = np.where(is_of_face[..., None], picture, seen)
    colour = scene.light.colour if scene.light is not None and scene.light_settings.hour is None else (1.0, 1.0, 1.0)
    return np.asarray(np.maximum(seen, 0.0) * np.asarray(colour, np.float32))


def middle(scene: Scene) -> Float[np.ndarray, "3"]:
    """A place in the middle of the room, above what stands there."""
    planes = scene.architecture.planes
    corners = [p.polygon for p in planes] or [o.corners_world for o in scene.objects] or [np.zeros((1, 3))]
    low, high = np.concatenate(corners).min(axis=0), np.concatenate(corners).max(axis=0)
    place = np.array([*(low + high)[:2] / 2, low[2] + EYE_SHARE * (high[2] - low[2])])
    for item in scene.objects:
        ends = item.corners_world
        within = (ends.min(axis=0) <= place) & (place <= ends.max(axis=0))
        if not item.hidden and within.all():
            place[2] = min(float(ends[:, 2].max()) + ABOVE_M, high[2])
    return place


def _face(centre: Float[np.ndarray, "3"], forward: Float[np.ndarray, "3"], side: int) -> Camera:
    up = np.array([0.0, 1.0, 0.0]) if forward[2] else np.array([0.0, 0.0, 1.0])
    focal = 0.5 * side / OVERLAP
    return Camera(Intrinsics(side, side, focal, focal, side / 2, side / 2), rigid(looking_along(forward, up), centre))
