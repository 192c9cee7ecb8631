"""Metric depth, normals and focal length from one picture: MoGe-2 and Metric3D v2.

Camera axes are OpenCV's (x right, y down, z forward); depth is z in metres, 0 where unknown; normals are unit and point
toward the camera.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8
from scipy.optimize import minimize_scalar

from diorama_core.errors import UnavailableError
from diorama_core.geometry.depth_grid import smooth_normals_camera
from diorama_core.models.images import IMAGENET_MEAN, IMAGENET_STD, normalise, resize
from diorama_core.models.runtime import SINGLE, Dims, GraphNetwork, NetworkError
from diorama_core.models.seen_depth import SeenDepth
from diorama_core.scene.types import Intrinsics

SAMPLES = 64
"""Points a side from which MoGe-2's camera is recovered."""
USUAL_FOCAL = 0.8
"""Focal length over the longer side that cameras have."""
FOCAL_PRIOR = 1e-8
"""Decides only where the points do not: a flat wall seen squarely fits every focal length."""
MAX_PIXELS = 700 * 700
"""Larger pictures are reduced for MoGe-2: its tokens cover no more detail."""


@dataclass(frozen=True)
class Moge2(GraphNetwork):
    """MoGe-2 (Wang et al. 2025): affine points, normals, validity and metric scale; finds the focal length itself."""

    weights: str = "moge-2"
    tokens: int = 1800
    """Detail, 1200 to 2500."""

    def predict(self, rgb: UInt8[np.ndarray, "h w 3"], intrinsics: Intrinsics | None) -> SeenDepth:
        """Depth, normals and intrinsics; given intrinsics are kept and only the shift is recovered.

        Raises:
            NetworkError: when the network fails, or tells nothing about the picture.
        """
        height, width = rgb.shape[:2]
        factor = min(1.0, (MAX_PIXELS / (height * width)) ** 0.5)
        small = (max(16, round(height * factor)), max(16, round(width * factor)))
        picture = resize(rgb, small).astype(np.float32).transpose(2, 0, 1)[None] / np.float32(255.0)
        session = self.session
        scale = next((n for n in session.outputs if n == "metric_scale"), "scale")
        out = session.run(
            {"image": picture, "num_tokens": np.array(self.tokens, np.int64)},
            {"points": (1, *small, 3), "normal": (1, *small, 3), "mask": (1, *small), scale: SINGLE},
            gaps=True,
        )
        known = None if intrinsics is None else intrinsics.resize(small[1], small[0])
        try:
            seen = recover(out["points"][0], out["normal"][0], out["mask"][0], float(np.ravel(out[scale])[0]), known)
        except UnavailableError as error:
            raise NetworkError(self.graph, str(error)) from error
        return resize_depth(seen, height, width)


def recover(
    points: Float[np.ndarray, "h w 3"],
    normals: Float[np.ndarray, "h w 3"],
    validity: Float[np.ndarray, "h w"],
    metric_scale: float,
    intrinsics: Intrinsics | None = None,
) -> SeenDepth:
    """The camera and metric depth behind affine points: the z-shift and focal length that put every point on its
    pixel's ray, by least squares.

    Args:
        points: Up to scale and a shift along z.
        normals: Camera frame, any sign.
        validity: Probability that a pixel has geometry at all.
        metric_scale: Metres per unit.
        intrinsics: Where known, the focal length is not sought.

    Raises:
        UnavailableError: when hardly any pixel is valid.
    """
    height, width = validity.shape
    valid = (validity > 0.5) & np.isfinite(points).all(axis=-1)
    if valid.sum() < SAMPLES:
        raise UnavailableError("the depth network sees no geometry in this picture; use --profile embedded")
    focal, shift = focal_and_shift(points, valid, None if intrinsics is None else intrinsics.fx)
    k = intrinsics or Intrinsics(width, height, focal, focal, width / 2, height / 2)
    depth = (points[..., 2] + shift) * metric_scale
    depth = np.where(valid & (depth > 0), depth, 0.0).astype(np.float32)
    if not depth.any():
        raise UnavailableError("the depth network's scale is no length; use --profile embedded")
    return SeenDepth(depth, _orient_normals(normals, depth, k), k)


def focal_and_shift(
    points: Float[np.ndarray, "h w 3"], valid: Bool[np.ndarray, "h w"], focal_px: float | None = None
) -> tuple[float, float]:
    """Focal length in pixels and the z-shift, from a subsample of the grid."""
    height, width = valid.shape
    rows = np.unique(np.linspace(0, height - 1, SAMPLES).round().astype(int))
    columns = np.unique(np.linspace(0, width - 1, SAMPLES).round().astype(int))
    keep = valid[np.ix_(rows, columns)]
    chosen = points[np.ix_(rows, columns)][keep].astype(np.float64)
    offsets = np.stack(np.meshgrid(columns + 0.5 - width / 2, rows + 0.5 - height / 2), axis=-1)[keep]
    if len(chosen) < 16:
        raise UnavailableError("the depth network sees too little of this picture; use --profile embedded")
    nearest = float(chosen[:, 2].min())
    spread = max(float(np.ptp(chosen, axis=0).max()), 1e-6)

    def best_focal(shift: float) -> tuple[float, float]:
        plane = chosen[:, :2] / (chosen[:, 2:] + shift)
        focal = focal_px or float((plane * offsets).sum() / max((plane**2).sum(), 1e-12))
        return focal, float(((focal * plane - offsets) ** 2).mean())

    def cost(log_gap: float) -> float:
        focal, misfit = best_focal(float(np.exp(log_gap)) - nearest)
        off_usual = np.log(max(focal, 1e-9) / (USUAL_FOCAL * max(height, width)))
        return misfit + FOCAL_PRIOR * (max(height, width) * off_usual) ** 2

    # The gap between the camera and the nearest point, over many orders of magnitude; a grid finds the valley.
    grid = np.linspace(np.log(1e-3 * spread), np.log(1e3 * spread), 61)
    start = int(np.argmin([cost(g) for g in grid]))
    low, high = grid[max(start - 1, 0)], grid[min(start + 1, len(grid) - 1)]
    gap = minimize_scalar(cost, bounds=(low, high), method="bounded", options={"xatol": 1e-9}).x
    shift = float(np.exp(gap)) - nearest
    focal = best_focal(shift)[0]
    if not np.isfinite(focal) or focal <= 0:
        raise UnavailableError("the depth network's answer fits no camera; use --profile embedded")
    return focal, shift


@dataclass(frozen=True)
class Metric3d(GraphNetwork):
    """Metric3D v2 (Hu et al. 2024): depth for a canonical camera and normals; needs a focal length."""

    weights: str = "metric3d-v2"
    size: tuple[int, int] = (616, 1064)
    """Height and width that the network was trained with."""
    canonical_focal_px: float = 1000.0
    usual_fov_rad: float = 1.05
    """Horizontal, of pictures whose camera is unknown."""

    def predict(self, rgb: UInt8[np.ndarray, "h w 3"], intrinsics: Intrinsics | None) -> SeenDepth:
        """Depth and normals; without intrinsics a usual field of view is assumed.

        Raises:
            NetworkError: when the network fails, or tells nothing about the picture.
        """
        height, width = rgb.shape[:2]
        k = intrinsics or Intrinsics.from_fov(width, height, self.usual_fov_rad)
        pixels, (top, left, inner_h, inner_w) = self.pixels(rgb)
        session = self.session
        out = session.run({session.picture_input: pixels}, {"predicted_depth": (..., *self.size)}, gaps=True)
        normals = out.get("predicted_normal")
        last = normals is not None and normals.shape[-1:] in ((3,), (4,))
        dims: Dims = (..., *self.size, None) if last else (..., None, *self.size)
        session.check("predicted_normal", normals, dims, gaps=True)
        window = (slice(top, top + inner_h), slice(left, left + inner_w))
        fx_resized = k.fx * inner_w / width
        depth = out["predicted_depth"].reshape(self.size)[window].astype(np.float64)
        depth = np.where(np.isfinite(depth) & (depth > 0), depth, 0.0) * fx_resized / self.canonical_focal_px
        normals = _channels_last(out["predicted_normal"].reshape(out["predicted_normal"].shape[-3:]))[window]
        if not (depth > 0).any():
            raise NetworkError(self.graph, "the depth network sees no geometry in this picture; use --profile embedded")
        small = k.resize(inner_w, inner_h)
        depth32 = depth.astype(np.float32)
        return resize_depth(SeenDepth(depth32, _orient_normals(normals, depth32, small), small), height, width, k)

    def pixels(
        self, rgb: UInt8[np.ndarray, "h w 3"]
    ) -> tuple[Float32[np.ndarray, "1 3 H W"], tuple[int, int, int, int]]:
        """0..255, proportions kept, padded with the mean; and where the picture lies: top, left, height, width."""
        height, width = rgb.shape[:2]
        scale = min(self.size[0] / height, self.size[1] / width)
        inner = (max(1, int(height * scale)), max(1, int(width * scale)))
        canvas = np.empty((*self.size, 3), np.float32)
        canvas[:] = (123.675, 116.28, 103.53)
        top, left = (self.size[0] - inner[0]) // 2, (self.size[1] - inner[1]) // 2
        canvas[top : top + inner[0], left : left + inner[1]] = resize(rgb, inner)
        return np.ascontiguousarray(canvas.transpose(2, 0, 1)[None]), (top, left, *inner)


def _channels_last(normals: np.ndarray) -> np.ndarray:
    return normals if normals.shape[-1] in (3, 4) else normals.transpose(1, 2, 0)


def _orient_normals(
    normals: Float[np.ndarray, "h w c"], depth_m: Float32[np.ndarray, "h w"], k: Intrinsics
) -> Float32[np.ndarray, "h w 3"]:
    """Unit normals turned toward the camera; zero where depth is unknown."""
    n = normals[..., :3].astype(np.float64)
    length = np.linalg.norm(n, axis=-1, keepdims=True)
    n = np.where(length > 1e-6, n / np.maximum(length, 1e-6), 0.0)
    x = (np.arange(k.width) + 0.5 - k.cx) / k.fx
    y = (np.arange(k.height) + 0.5 - k.cy) / k.fy
    away = n[..., 0] * x[None, :] + n[..., 1] * y[:, None] + n[..., 2] > 0
    n = np.where(away[..., None], -n, n)
    return np.where(depth_m[..., None] > 0, n, 0.0).astype(np.float32)


def resize_depth(seen: SeenDepth, height: int, width: int, intrinsics: Intrinsics | None = None) -> SeenDepth:
    """Depth resized to the picture's own size: nearest pixels, since depth must not be averaged across edges.

    Args:
        seen: The network's depth.
        height: Of the picture, pixels.
        width: Likewise.
        intrinsics: Of the picture, where they are known.
    """
    if seen.depth_m.shape == (height, width):
        return seen if intrinsics is None else SeenDepth(seen.depth_m, seen.normals_camera, intrinsics)
    size = (width, height)
    return SeenDepth(
        cv2.resize(seen.depth_m, size, interpolation=cv2.INTER_NEAREST_EXACT),
        cv2.resize(seen.normals_camera, size, interpolation=cv2.INTER_NEAREST_EXACT),
        intrinsics or seen.intrinsics.resize(width, height),
    )


SIDE = 504
"""Side of the square that the graph was traced with."""
CANONICAL_FOCAL_PX = 300.0
"""Focal length of the camera for which the network answers in metres."""
SKY = 0.5
"""Score from which a pixel shows the sky, which has no depth."""


@dataclass(frozen=True)
class DepthAnything3(GraphNetwork):
    """Canonical depth and sky of a picture that is stretched to a square; normals follow from the depth."""

    weights: str = "da3-metric"
    usual_fov_rad: float = 1.05
    """Horizontal, of pictures whose camera is unknown."""

    def predict(self, rgb: UInt8[np.ndarray, "h w 3"], intrinsics: Intrinsics | None) -> SeenDepth:
        """Depth and normals; without intrinsics a usual field of view is assumed.

        Raises:
            NetworkError: when the network fails, or tells nothing about the picture.
        """
        height, width = rgb.shape[:2]
        k = intrinsics or Intrinsics.from_fov(width, height, self.usual_fov_rad)
        session = self.session
        side = session.side_px("image", SIDE)
        out = session.run({"image": self.pixels(rgb, side)}, {"depth": (1, 1, side, side), "sky": (1, 1, side, side)})
        square = k.resize(side, side)
        # Metres for the focal length of the picture as the network saw it; stretched, its two sides have two.
        metres = out["depth"][0, 0] * np.float32((square.fx + square.fy) / 2 / CANONICAL_FOCAL_PX)
        depth = np.where((out["sky"][0, 0] < SKY) & (metres > 0), metres, 0.0).astype(np.float32)
        if not (depth > 0).any():
            raise NetworkError(self.graph, "the depth network sees no geometry in this picture; use --profile embedded")
        normals = smooth_normals_camera(depth, square).astype(np.float32)
        return resize_depth(SeenDepth(depth, normals, square), height, width, k)

    def pixels(self, rgb: UInt8[np.ndarray, "h w 3"], side: int = SIDE) -> Float32[np.ndarray, "1 3 side side"]:
        """Stretched to the square, ImageNet statistics."""
        return normalise(resize(rgb, (side, side)), IMAGENET_MEAN, IMAGENET_STD)
