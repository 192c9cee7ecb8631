"""An empty furnished room of straight edges, as a camera of known pose sees it: lines, pictures and depth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diorama_core.perception.camera.frames import facing_direction, up_in_camera, world_frame
from diorama_core.scene.types import Intrinsics

NEAR_M = 0.1


@dataclass(frozen=True)
class View:
    """A posed camera; the heading turns the camera to the left of world +Y."""

    intrinsics: Intrinsics
    R_world_camera: np.ndarray
    position: np.ndarray


def view(
    *, pitch_deg: float, roll_deg: float, heading_deg: float, focal: float = 0.8, height_m: float = 1.4,
    size: tuple[int, int] = (640, 480),
) -> View:  # fmt: skip
    """`focal` is over the longer side; the principal point is the middle."""
    up = up_in_camera(np.deg2rad(pitch_deg), np.deg2rad(roll_deg))
    forward = facing_direction(up)
    turn = np.deg2rad(heading_deg)
    along = np.cos(turn) * forward - np.sin(turn) * np.cross(forward, up)
    R = np.stack([np.cross(along, up), along, up])
    f = focal * max(size)
    return View(Intrinsics(*size, f, f, size[0] / 2, size[1] / 2), R, np.array([0.0, 0.0, height_m]))


def room_frame(v: View) -> np.ndarray:
    """The view's rotation in the world's convention (+Y nearest to the viewing direction)."""
    return world_frame(v.R_world_camera[2], v.R_world_camera[1])


def degrees_between(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.rad2deg(np.arccos(np.clip(a @ b, -1, 1))))


def rays(v: View) -> np.ndarray:
    """World directions of unit depth through all pixels."""
    k = v.intrinsics
    x, y = np.meshgrid((np.arange(k.width) + 0.5 - k.cx) / k.fx, (np.arange(k.height) + 0.5 - k.cy) / k.fy)
    return np.stack([x, y, np.ones_like(x)], axis=-1) @ v.R_world_camera.T


def box_edges(low: tuple[float, ...], high: tuple[float, ...]) -> np.ndarray:
    """The twelve edges of an axis-aligned box as (12, 2, 3)."""
    corners = np.array([[(high if i >> axis & 1 else low)[axis] for axis in range(3)] for i in range(8)])
    pairs = [(i, i | 1 << axis) for i in range(8) for axis in range(3) if not i >> axis & 1]
    return np.array([[corners[a], corners[b]] for a, b in pairs])


ROOM = ((-2.2, -1.5, 0.0), (2.4, 4.2, 2.6))
FURNITURE = (
    ((-2.0, 3.0, 0.0), (-1.0, 4.0, 1.9)),
    ((-0.6, 2.2, 0.0), (0.9, 3.0, 0.72)),
    ((1.4, 2.8, 0.0), (2.3, 4.1, 0.85)),
    ((-0.4, 4.18, 1.2), (0.9, 4.2, 2.0)),
)


def segments_px(v: View, noise_px: float = 0.0, seed: int = 0) -> np.ndarray:
    """The visible parts of the room's and the furniture's edges, x1, y1, x2, y2."""
    rng = np.random.default_rng(seed)
    edges = np.concatenate([box_edges(*ROOM), *(box_edges(*b) for b in FURNITURE)])
    # cut long edges into pieces, as a detector finds them
    steps = np.linspace(0, 1, 7)
    pieces = edges[:, None, 0] + steps[None, :, None] * (edges[:, 1] - edges[:, 0])[:, None]
    ends = np.stack([pieces[:, :-1], pieces[:, 1:]], axis=2).reshape(-1, 2, 3)
    camera = (ends - v.position) @ v.R_world_camera
    camera = camera[(camera[..., 2] > NEAR_M).all(axis=1)]
    k = v.intrinsics
    pixels = camera[..., :2] / camera[..., 2:] * [k.fx, k.fy] + [k.cx, k.cy]
    inside = ((pixels > 2) & (pixels < np.array([k.width, k.height]) - 2)).all(axis=(1, 2))
    long = np.linalg.norm(pixels[:, 1] - pixels[:, 0], axis=1) > 0.025 * np.hypot(k.width, k.height)
    retained = pixels[inside & long]
    return (retained + rng.normal(0, noise_px, retained.shape)).reshape(-1, 4)


def depth(v: View, boxes: tuple = FURNITURE, noise: float = 0.0, seed: int = 0) -> np.ndarray:
    """Depth in metres of the room with boxes in it, by slabs; `noise` grows with the square of depth."""
    along = rays(v)
    along = np.where(np.abs(along) < 1e-9, 1e-9, along)

    def slabs(low: tuple[float, ...], high: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
        first, second = (np.array(low) - v.position) / along, (np.array(high) - v.position) / along
        return np.minimum(first, second).max(axis=-1), np.maximum(first, second).min(axis=-1)

    nearest = slabs(*ROOM)[1]
    for low, high in boxes:
        enter, leave = slabs(low, high)
        nearest = np.where((enter < leave) & (enter > 0), np.minimum(nearest, enter), nearest)
    shaken = nearest + noise * nearest**2 * np.random.default_rng(seed).normal(size=nearest.shape)
    return shaken.astype(np.float32)


def shaded_picture(v: View, boxes: tuple = FURNITURE) -> np.ndarray:
    """The room in flat greys by surface direction, so that edges show."""
    z = depth(v, boxes)
    points = rays(v) * z[..., None] + v.position
    tone = np.full(z.shape, 30.0)
    distance = np.full(z.shape, np.inf)
    faces = [(axis, side[axis]) for box in (ROOM, *boxes) for side in box for axis in range(3)]
    for n, (axis, value) in enumerate(faces):
        d = np.abs(points[..., axis] - value)
        tone = np.where(d < distance - 1e-4, (40 + 17 * n) % 216 + 30, tone)
        distance = np.minimum(distance, d)
    return np.repeat(tone[..., None], 3, axis=-1).astype(np.uint8)
