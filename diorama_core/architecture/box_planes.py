"""From the numbers of a room box to its bounded planes."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.casting import camera_rays
from diorama_core.scene.types import Camera, Plane, PlaneRole

MIN_VISIBLE_SHARE = 0.004
"""A wall seen in less of the picture than this is left out."""
BEHIND_CAMERA_M = 0.4
MAX_BEHIND_CAMERA_M = 3.0

BoxFace = tuple[str, PlaneRole]
FACES: tuple[BoxFace, ...] = (
    ("floor", "floor"), ("back", "wall"), ("left", "wall"), ("right", "wall"), ("ceiling", "ceiling"),
)  # fmt: skip


def visible_shares(box: Float[np.ndarray, "4"], camera: Camera) -> dict[str, float]:
    """The share of the picture in which each face of the box is seen when the room is empty."""
    hit = _hit_faces(box, camera)[0]
    return {name: float((hit == index).mean()) for index, (name, _) in enumerate(FACES)}


def _hit_faces(box: Float[np.ndarray, "4"], camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """For a coarse grid of pixels: the face seen (index into FACES) and the world point on it."""
    step = max(1, max(camera.intrinsics.width, camera.intrinsics.height) // 120)
    origin, rays = camera_rays(camera, step)
    d = rays.reshape(-1, 3)
    d = np.where(np.abs(d) < 1e-9, 1e-9, d)
    x0, x1, y1, top = box
    tx = np.where(d[:, 0] > 0, x1 - origin[0], x0 - origin[0]) / d[:, 0]
    ty = np.where(d[:, 1] > 0, (y1 - origin[1]) / d[:, 1], np.inf)
    tz = np.where(d[:, 2] > 0, top - origin[2], -origin[2]) / d[:, 2]
    nearest = np.stack([tx, ty, tz]).argmin(axis=0)
    t = np.minimum(np.minimum(tx, ty), tz)
    face = np.choose(nearest, [np.where(d[:, 0] > 0, 3, 2), np.ones(len(d), int), np.where(d[:, 2] > 0, 4, 0)])
    return face, origin + t[:, None] * d


def back_edge(box: Float[np.ndarray, "4"], camera: Camera) -> float:
    """y at which floor and side walls end behind the camera, so that they fill the picture."""
    reach = float(_hit_faces(box, camera)[1][:, 1].min()) - 0.1
    y = float(camera.position[1])
    return max(min(reach, y - BEHIND_CAMERA_M), y - MAX_BEHIND_CAMERA_M)


def box_polygons(box: Float[np.ndarray, "4"], y0: float) -> dict[str, Float[np.ndarray, "4 3"]]:
    """Corners of each face, counter-clockwise seen from inside; walls start at their lower left."""
    x0, x1, y1, top = (float(v) for v in box)
    return {
        "floor": np.array([[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0]]),
        "back": np.array([[x0, y1, 0], [x1, y1, 0], [x1, y1, top], [x0, y1, top]]),
        "left": np.array([[x0, y0, 0], [x0, y1, 0], [x0, y1, top], [x0, y0, top]]),
        "right": np.array([[x1, y1, 0], [x1, y0, 0], [x1, y0, top], [x1, y1, top]]),
        "ceiling": np.array([[x0, y0, top], [x0, y1, top], [x1, y1, top], [x1, y0, top]]),
    }


def box_planes(
    box: Float[np.ndarray, "4"], camera: Camera, confidences: dict[str, float], with_ceiling: bool
) -> tuple[Plane, ...]:
    """Floor, the walls that are seen (at least one), and the ceiling when it is seen or asked for.

    Args:
        box: x0, x1, y1, ceiling height.
        camera: The photo's.
        confidences: Of each face, by name.
        with_ceiling: Keep the ceiling even when it is out of the picture.
    """
    shares = visible_shares(box, camera)
    polygons = box_polygons(box, back_edge(box, camera))
    walls = [name for name in ("back", "left", "right") if shares[name] >= MIN_VISIBLE_SHARE] or ["back"]
    planes = [Plane("floor", "floor", polygons["floor"], confidence=confidences["floor"])]
    planes += [Plane(f"wall_{i}", "wall", polygons[n], confidence=confidences[n]) for i, n in enumerate(walls, 1)]
    if with_ceiling or shares["ceiling"] >= MIN_VISIBLE_SHARE:
        planes.append(Plane("ceiling", "ceiling", polygons["ceiling"], confidence=confidences["ceiling"]))
    return tuple(planes)
