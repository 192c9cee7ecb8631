"""Metric camera, cuboids and support edges from measured depth: what stands on what, from where the boxes are."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import CameraEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.geometry.depth_grid import points_camera, reduce, smooth_normals_camera
from diorama_core.library.taxonomy import Category, resolve
from diorama_core.perception.measured.boxes import TurnedExtent, complete_extent, fit_extent, to_cuboid
from diorama_core.perception.measured.cloud import MIN_POINTS, SETTINGS, MeasuredSettings, object_points
from diorama_core.perception.measured.supports import resting_heights, supports_of_boxes
from diorama_core.progress import Progress
from diorama_core.provenance import ScaleSource
from diorama_core.scene.types import Camera, Support


def extend_to_supporters(
    extents: dict[str, TurnedExtent],
    categories: dict[str, Category],
    edges: tuple[Support, ...],
    settings: MeasuredSettings = SETTINGS,
) -> dict[str, TurnedExtent]:
    """The boxes reaching down to what holds them: the floor, or the supporter's top or seat.

    What people put on furniture and is seen well above the floor stays as it is: nobody marked what is below it.

    Args:
        extents: measured boxes by object id, in the world (m).
        categories: by object id.
        edges: what stands on what.
        settings: how far above the floor a thing may be and still stand on it.
    """
    out = dict(extents)
    for edge in edges:
        extent = extents[edge.child]
        if edge.parent == "floor" and categories[edge.child].mount == "surface" and extent.low[2] > settings.on_floor_m:
            continue
        if edge.parent == "floor":
            out[edge.child] = _with_bottom(extent, 0.0)
        elif edge.parent in extents:
            bottom = float(extent.low[2])
            heights = resting_heights(extents[edge.parent], categories[edge.parent], bottom)
            out[edge.child] = _with_bottom(extent, min(heights, key=lambda h: abs(h - bottom)))
    return out


def _with_bottom(extent: TurnedExtent, bottom_m: float) -> TurnedExtent:
    low, high = extent.low.copy(), extent.high.copy()
    low[2] = bottom_m
    high[2] = max(high[2], bottom_m + 0.02)
    return replace(extent, low=low, high=high)


@dataclass(frozen=True)
class MeasuredGeometry:
    """Objects from depth: clouds of the masked pixels, upright boxes around them, completed by usual sizes."""

    settings: MeasuredSettings = SETTINGS

    def measure(
        self, inputs: Inputs, camera: CameraEstimate, objects: tuple[DetectedObject, ...], progress: Progress
    ) -> ObjectGeometry:
        """The posed camera, a cuboid for every object, and what stands on what.

        Args:
            inputs, camera, objects, progress: as documented in `protocols.GeometryStage`.

        Raises:
            ValueError: when the inputs hold no measured depth.
        """
        if inputs.depth_m is None:
            raise ValueError("MeasuredGeometry needs measured depth; use SingleViewMetrology for a photo alone")
        progress.report(0.0, "Reading the measured depth")
        posed, scale = place_camera(camera, inputs.depth_m, self.settings)
        depth = inputs.depth_m
        world = points_camera(depth, posed.intrinsics) @ posed.T_world_camera[:3, :3].T + posed.position
        extents: dict[str, TurnedExtent] = {}
        sureness: dict[str, float] = {}
        categories = {o.id: resolve(o.category).category for o in objects}
        for index, detected in enumerate(objects):
            progress.report(0.1 + 0.8 * index / len(objects), f"Measuring the {detected.label}")
            extents[detected.id], sureness[detected.id] = measure_extent(
                detected, categories[detected.id], world, depth, posed, self.settings
            )
        edges = supports_of_boxes(objects, extents, categories, depth, self.settings)
        standing = extend_to_supporters(extents, categories, edges, self.settings)
        cuboids = tuple(
            to_cuboid(key, extent, categories[key], posed.position, sureness[key]) for key, extent in standing.items()
        )
        progress.report(1.0, "Objects are measured")
        return ObjectGeometry(posed, cuboids, edges, scale, camera.confidence)


def place_camera(
    camera: CameraEstimate, depth_m: Float[np.ndarray, "h w"], settings: MeasuredSettings
) -> tuple[Camera, ScaleSource]:
    """The camera over the world's origin, and where its height comes from."""
    best = camera.best
    height, scale = camera.height_m, ScaleSource.DEPTH
    if height is None:
        height = floor_distance(depth_m, camera)
    if height is None:
        height, scale = settings.assumed_height_m, ScaleSource.DEPTH_WITHOUT_FLOOR
    T = np.eye(4)
    T[:3, :3], T[2, 3] = best.R_world_camera, height
    return Camera(best.intrinsics, T), scale


def floor_distance(depth_m: Float[np.ndarray, "h w"], camera: CameraEstimate) -> float | None:
    """How far the lowest large level surface lies below the camera; none when there is no such surface."""
    small, k = reduce(np.asarray(depth_m, dtype=np.float32), camera.best.intrinsics, 320)
    R = camera.best.R_world_camera
    points, normals = points_camera(small, k) @ R.T, smooth_normals_camera(small, k) @ R.T
    level = (normals[..., 2] > 0.9) & (small > 0) & (points[..., 2] < -0.3)
    drops = -points[level][:, 2]
    if len(drops) < 0.01 * small.size:
        return None
    histogram = np.convolve(np.bincount((drops / 0.03).astype(int)), np.ones(3), mode="same")
    strong = np.flatnonzero(histogram > 0.25 * histogram.max())
    centre = (strong.max() + 0.5) * 0.03
    return float(np.median(drops[np.abs(drops - centre) < 0.06]))


def measure_extent(
    detected: DetectedObject,
    category: Category,
    points_world: Float[np.ndarray, "h w 3"],
    depth_m: Float[np.ndarray, "h w"],
    camera: Camera,
    settings: MeasuredSettings,
) -> tuple[TurnedExtent, float]:
    """The box of one object and how far it can be trusted.

    Args:
        detected: the object, with a mask of shape (h, w).
        category: of the object.
        points_world: measured points of every pixel (m).
        depth_m: z in camera in metres; 0 where missing.
        camera: in the world.
        settings: how points are chosen, and what a guess is worth.
    """
    points = object_points(detected, points_world, depth_m, settings)
    flat = category.priors[0].height_m < 0.1
    above = points[points[:, 2] > 0.03] if not flat else points
    points = above if len(above) >= MIN_POINTS else points
    if len(points) < MIN_POINTS:
        return _usual_extent(detected, category, depth_m, camera), settings.guess_confidence
    seen = fit_extent(points, category)
    width = detected.mask.shape[1]
    cut_off = np.array([detected.box[0] < 2, detected.box[2] > width - 2, detected.box[1] < 2])
    behind = _ring_points(
        detected.mask, points_world, depth_m, float(np.median(camera.to_camera(points)[:, 2])), settings
    )
    whole = complete_extent(seen, category, camera.position, cut_off, behind, points)
    share_seen = float(np.prod(seen.size[:2]) / np.prod(whole.size[:2]))
    confidence = (0.4 + 0.5 * min(1.0, len(points) / settings.full_points)) * (0.6 + 0.4 * share_seen)
    return whole, confidence


def _ring_points(
    mask: Bool[np.ndarray, "h w"],
    points_world: Float[np.ndarray, "h w 3"],
    depth_m: Float[np.ndarray, "h w"],
    object_depth_m: float,
    settings: MeasuredSettings,
) -> Float[np.ndarray, "m 3"]:
    """Points seen just around a mask that lie behind the object."""
    radius = max(3, round(settings.ring_px * max(mask.shape)))
    kernel = np.ones((2 * radius + 1, 2 * radius + 1), np.uint8)
    ring = cv2.dilate(mask.astype(np.uint8), kernel).astype(bool) & ~mask
    return points_world[ring & (depth_m > object_depth_m)]


def _usual_extent(
    detected: DetectedObject, category: Category, depth_m: Float[np.ndarray, "h w"], camera: Camera
) -> TurnedExtent:
    """A box of usual size where the depth has a hole: at the depth around the mask, else as far as its height tells."""
    x1, y1, x2, y2 = detected.box
    prior = category.priors[0]
    rows, columns = slice(int(y1), int(np.ceil(y2))), slice(int(x1), int(np.ceil(x2)))
    near = depth_m[rows, columns]
    near = near[near > 0]
    by_height = camera.intrinsics.fy * prior.height_m / max(y2 - y1, 1.0)
    distance = float(np.median(near)) if len(near) else by_height
    centre = camera.position + distance * camera.rays(np.array([0.5 * (x1 + x2), 0.5 * (y1 + y2)]))
    half = 0.5 * np.array([prior.depth_m, prior.width_m, prior.height_m])
    return TurnedExtent(0.0, centre - half, centre + half)
