"""Measured depth as a calm surface: points and normals from small planes fitted in inverse depth.

A plane's inverse depth is linear in the pixel, and a sensor's relative error is about the same everywhere in it, so a
least-squares fit in a window is a handful of box filters. Windows are as small as the measured noise allows, and each
pixel takes the best of the windows around it, which keeps corners and edges sharp.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32

from diorama_core.architecture.walls.settings import SETTINGS, WallSettings
from diorama_core.geometry.casting import pixel_centres
from diorama_core.scene.types import Camera, Intrinsics

RADII_PX = (2, 4, 8)
"""Half sizes of the windows, smallest first."""
ENOUGH_RAD = np.deg2rad(4.0)
"""A window is large enough when noise turns its normal by no more than this."""


@dataclass(frozen=True, eq=False)
class MeasuredSurface:
    """Measured points of the picture, in the world, flattened."""

    camera_position: Float[np.ndarray, "3"]
    points: Float[np.ndarray, "n 3"]
    normals: Float[np.ndarray, "n 3"]
    """Toward the camera; zero where unknown."""
    depth_m: Float[np.ndarray, "n"]
    area_m2: Float[np.ndarray, "n"]
    """Surface that each pixel sees."""
    is_object: Bool[np.ndarray, "n"]
    """Pixels of objects that were pointed at."""
    noise: float = 0.0
    """Typical relative error of the depths as they were measured."""
    grid_rows: int = 240
    grid_columns: int = 320
    """Size of the grid from which the points come, unmeasured pixels included."""

    def world_plane(self, members: Bool[np.ndarray, "n"]) -> tuple[Float[np.ndarray, "3"], float]:
        """Least-squares plane through members, in inverse depth: normal toward the camera, and offset."""
        local = self.points[members] - self.camera_position
        q = 1.0 / np.maximum(self.depth_m[members], 1e-6)
        # Rays of unit depth span the same linear model whatever the camera's rotation.
        rays = local * q[:, None]
        abc = np.linalg.lstsq(rays, q, rcond=None)[0]
        length = float(np.linalg.norm(abc))
        normal = -abc / max(length, 1e-12)
        return normal, float(normal @ self.camera_position) - 1.0 / max(length, 1e-12)


def measure_surface(
    depth_m: Float32[np.ndarray, "h w"],
    camera: Camera,
    is_object: Bool[np.ndarray, "h w"],
    settings: WallSettings = SETTINGS,
) -> MeasuredSurface:
    """World points, normals and areas of the measured pixels on a grid of at most `GRID_PX`.

    Args:
        depth_m: z in the camera, 0 where unknown.
        camera: Its intrinsics are those of the depth map.
        is_object: Pixels of objects that were pointed at.
    """
    depth, k = downsample_depth(depth_m, camera.intrinsics, settings.grid_px, settings)
    calm, normals_camera, noise = calm_planes(depth, k, settings)
    valid = calm > 0
    pixels = pixel_centres(k.width, k.height)
    rays = np.stack([(pixels[..., 0] - k.cx) / k.fx, (pixels[..., 1] - k.cy) / k.fy, np.ones(depth.shape)], axis=-1)
    local = rays * calm[..., None]
    R = camera.T_world_camera[:3, :3]
    facing = np.abs((normals_camera * rays).sum(axis=-1)) / np.linalg.norm(rays, axis=-1)
    area = calm**2 / (k.fx * k.fy) / np.maximum(facing, 0.2)
    rows = ((np.arange(depth.shape[0]) + 0.5) * is_object.shape[0] / depth.shape[0]).astype(int)
    columns = ((np.arange(depth.shape[1]) + 0.5) * is_object.shape[1] / depth.shape[1]).astype(int)
    return MeasuredSurface(
        camera_position=camera.position,
        points=(local @ R.T + camera.position)[valid],
        normals=(normals_camera @ R.T)[valid],
        depth_m=calm[valid],
        area_m2=area[valid],
        is_object=is_object[np.ix_(rows, columns)][valid],
        noise=noise,
        grid_rows=depth.shape[0],
        grid_columns=depth.shape[1],
    )


def downsample_depth(
    depth_m: Float32[np.ndarray, "h w"], intrinsics: Intrinsics, max_side: int, settings: WallSettings = SETTINGS
) -> tuple[Float[np.ndarray, "hs ws"], Intrinsics]:
    """The map at about `max_side` pixels: blocks are averaged in inverse depth where they hold one surface.

    Elsewhere a block takes its middle sample, so that nothing is measured between two surfaces.

    Args:
        depth_m: z in camera in metres; 0 and NaN where missing.
        intrinsics: of the map.
        max_side: of the result, pixels.
        settings: when a block counts as one surface.
    """
    height, width = depth_m.shape
    block = max(1, round(max(height, width) / max_side))
    depth = np.where(np.isfinite(depth_m) & (depth_m > 0), depth_m, 0.0).astype(np.float64)
    if block == 1:
        return depth, intrinsics
    rows, columns = max(1, height // block), max(1, width // block)
    blocks = depth[: rows * block, : columns * block].reshape(rows, block, columns, block)
    tiles = blocks.transpose(0, 2, 1, 3).reshape(rows, columns, block * block)
    known = tiles > 0
    low = np.where(known, tiles, np.inf).min(axis=-1)
    high = tiles.max(axis=-1)
    inverse = np.where(known, 1.0 / np.maximum(tiles, 1e-9), 0.0).sum(axis=-1) / np.maximum(known.sum(axis=-1), 1)
    one_surface = (known.sum(axis=-1) * 2 >= block * block) & (high < (1.0 + settings.alike_share) * low)
    middle = tiles[..., (block // 2) * block + block // 2]
    small = np.where(one_surface, 1.0 / np.maximum(inverse, 1e-9), middle)
    k = intrinsics
    scaled = Intrinsics(columns, rows, k.fx / block, k.fy / block, k.cx / block, k.cy / block)
    return small, scaled


def calm_planes(
    depth_m: Float[np.ndarray, "h w"], k: Intrinsics, settings: WallSettings = SETTINGS
) -> tuple[Float[np.ndarray, "h w"], Float[np.ndarray, "h w 3"], float]:
    """Depth freed of noise where surfaces are flat, normals toward the camera (zero where unknown), and the noise."""
    valid = depth_m > 0
    normals = np.zeros((*depth_m.shape, 3))
    if not valid.any():
        return depth_m, normals, 0.0
    q = np.where(valid, 1.0 / np.maximum(depth_m, 1e-9), 0.0)
    pixels = pixel_centres(k.width, k.height)
    x, y = (pixels[..., 0] - k.cx) / k.fx, (pixels[..., 1] - k.cy) / k.fy
    smallest = _window_fits(q, valid, x, y, RADII_PX[0], settings)
    noise = _noise(smallest, q, valid)
    calm, settled = depth_m.copy(), np.zeros(depth_m.shape, dtype=bool)
    for radius in RADII_PX:
        fit = smallest if radius == RADII_PX[0] else _window_fits(q, valid, x, y, radius, settings)
        abc, spread = _best_around(fit, radius)
        value = abc[..., 0] * x + abc[..., 1] * y + abc[..., 2]
        length = np.linalg.norm(abc, axis=-1)
        flat = valid & (spread < (1.5 * noise + settings.flatness) * q) & (value > 1e-6) & (length > 1e-9)
        flat &= np.abs(value - q) < (4.0 * noise + 2.0 * settings.flatness) * q
        window = 2 * radius + 1
        turn = noise * q / (window * window / np.sqrt(12.0) / k.fx) / np.maximum(length, 1e-9)
        use = flat & ~settled
        normals[use] = -abc[use] / length[use, None]
        calm[use] = 1.0 / value[use]
        settled |= flat & (turn < ENOUGH_RAD)
    return calm, normals, noise


def _window_fits(
    q: Float[np.ndarray, "h w"],
    valid: Bool[np.ndarray, "h w"],
    x: Float[np.ndarray, "h w"],
    y: Float[np.ndarray, "h w"],
    radius: int,
    settings: WallSettings,
) -> tuple[Float[np.ndarray, "h w 3"], Float[np.ndarray, "h w"]]:
    """`q = a x + b y + c` in the window around each pixel, and the standard deviation from it (`inf`: no fit)."""
    w = valid.astype(np.float64)

    def mean(values: np.ndarray) -> np.ndarray:
        return np.asarray(cv2.blur(values * w, (2 * radius + 1,) * 2, borderType=cv2.BORDER_CONSTANT))

    share = np.asarray(cv2.blur(w, (2 * radius + 1,) * 2, borderType=cv2.BORDER_CONSTANT))
    safe = np.maximum(share, 1e-9)
    mx, my, mq = (mean(v) / safe for v in (x, y, q))
    xx, yy, xy = mean(x * x) / safe - mx * mx, mean(y * y) / safe - my * my, mean(x * y) / safe - mx * my
    xq, yq, qq = mean(x * q) / safe - mx * mq, mean(y * q) / safe - my * mq, mean(q * q) / safe - mq * mq
    determinant = xx * yy - xy * xy
    sound = (share >= settings.min_share) & (determinant > 1e-3 * np.maximum(xx, yy) ** 2) & (determinant > 0)
    d = np.where(sound, determinant, 1.0)
    a, b = (xq * yy - yq * xy) / d, (yq * xx - xq * xy) / d
    rest = np.sqrt(np.maximum(qq - a * xq - b * yq, 0.0))
    abc = np.stack([a, b, mq - a * mx - b * my], axis=-1)
    return np.where(sound[..., None], abc, 0.0), np.where(sound, rest, np.inf)


def _noise(
    fit: tuple[Float[np.ndarray, "h w 3"], Float[np.ndarray, "h w"]],
    q: Float[np.ndarray, "h w"],
    valid: Bool[np.ndarray, "h w"],
) -> float:
    """Relative deviation that most windows share; corners and clutter deviate more."""
    known = valid & np.isfinite(fit[1])
    if not known.any():
        return 0.0
    samples = (2 * RADII_PX[0] + 1) ** 2
    return float(np.quantile(fit[1][known] / q[known], 0.4)) * float(np.sqrt(samples / (samples - 3)))


def _best_around(
    fit: tuple[Float[np.ndarray, "h w 3"], Float[np.ndarray, "h w"]], radius: int
) -> tuple[Float[np.ndarray, "h w 3"], Float[np.ndarray, "h w"]]:
    """Fit that deviates least of those to the windows centred on a pixel and up to `radius` beside it."""
    best_abc, best = fit
    for rows, columns in ((0, radius), (0, -radius), (radius, 0), (-radius, 0)):
        abc, spread = (_shift(v, rows, columns) for v in fit)
        # Off-centre windows are taken only where they are clearly better, or noise would choose.
        better = spread < 0.7 * best
        best = np.where(better, spread, best)
        best_abc = np.where(better[..., None], abc, best_abc)
    return best_abc, best


def _shift(values: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """Values of the pixel that many rows and columns away; outside the picture the border repeats."""
    height, width = values.shape[:2]
    i = np.clip(np.arange(height) + rows, 0, height - 1)
    j = np.clip(np.arange(width) + columns, 0, width - 1)
    return np.asarray(values[np.ix_(i, j)])
