"""Fast views of one shape under many poses: rays are moved into the shape's frame, never the mesh into the world.

A pose is a point of a batch: rotation `R` (p 3 3), `position` (p 3) and per-axis `scale` (p 3), with
`p_world = R @ (scale * p_object) + position` as in `scene.types.Pose`. A ray `o + t d` keeps its parameter t under
that map, so with directions of unit depth (`Camera.rays`) the hit parameter is z in the camera, in metres.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import trimesh
from jaxtyping import Bool, Float, Float32, Int, Int32
from scipy.spatial import ConvexHull, QhullError

from diorama_core.geometry.projection import NEAR_M, edges_of_cuboid, frustum_slack
from diorama_core.geometry.ray_scene import RayScene
from diorama_core.scene.types import Camera, Pose, box_corners

_MIN_EXTENT_M = 1e-4
_HULL_DIRECTIONS = 48


@dataclass(frozen=True, eq=False)
class PoseBatch:
    """Many poses of one shape."""

    R: Float[np.ndarray, "p 3 3"]
    position: Float[np.ndarray, "p 3"]
    scale: Float[np.ndarray, "p 3"]

    def __len__(self) -> int:
        return len(self.R)

    def __getitem__(self, chosen: slice | np.ndarray) -> PoseBatch:
        return PoseBatch(self.R[chosen], self.position[chosen], self.scale[chosen])

    @classmethod
    def single(cls, pose: Pose) -> PoseBatch:
        """One pose alone."""
        return cls(pose.R_world_object[None], pose.position[None], pose.scale[None])

    def and_also(self, other: PoseBatch) -> PoseBatch:
        """These poses and then those."""
        return PoseBatch(
            np.concatenate([self.R, other.R]),
            np.concatenate([self.position, other.position]),
            np.concatenate([self.scale, other.scale]),
        )

    def apply(self, points_object: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "p n 3"]:
        """Shape points in the world under every pose."""
        return self.apply_by_coordinate(points_object).transpose(1, 2, 0)

    def apply_by_coordinate(self, points_object: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "3 p n"]:
        """Points of all poses by coordinate: one product for all poses, and the points side by side in memory."""
        rows = (self.R * self.scale[:, None, :]).transpose(1, 0, 2).reshape(-1, 3)
        return (rows @ points_object.T).reshape(3, len(self), len(points_object)) + self.position.T[..., None]


@dataclass(frozen=True, eq=False)
class ShapeHits:
    """What the rays of one window meet, for every pose; infinite depth where they meet nothing."""

    depth_m: Float[np.ndarray, "p r"]
    normals_object: Float[np.ndarray, "p r 3"]
    """Normals of the faces met, in the shape's own frame at scale 1."""
    triangles: Int32[np.ndarray, "p r"]
    """Which faces are met; of no use where nothing is."""
    directions_world: Float[np.ndarray, "r 3"]
    poses: PoseBatch

    def select_rays(self, chosen: Int[np.ndarray, "k"]) -> ShapeHits:
        """Hits of some rays alone."""
        return ShapeHits(
            self.depth_m[:, chosen],
            self.normals_object[:, chosen],
            self.triangles[:, chosen],
            self.directions_world[chosen],
            self.poses,
        )

    @cached_property
    def is_hit(self) -> Bool[np.ndarray, "p r"]:
        """Whether the shape is met."""
        return np.isfinite(self.depth_m)

    @cached_property
    def normals_world(self) -> Float[np.ndarray, "p r 3"]:
        """Unit, turned toward the camera; zero where nothing is met."""
        to_world = self.poses.R / self.poses.scale[:, None, :]
        normals = self.normals_object @ to_world.transpose(0, 2, 1)
        normals = normals / np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-12)
        away = (normals * self.directions_world).sum(axis=-1) > 0
        return np.where(self.is_hit[..., None], np.where(away[..., None], -normals, normals), 0.0)

    def normals_along(self, others_world: Float[np.ndarray, "r 3"]) -> Float[np.ndarray, "p r"]:
        """Products of `normals_world` with another vector of every ray, without making them."""
        to_world = self.poses.R / self.poses.scale[:, None, :]
        normals = self.normals_object @ to_world.transpose(0, 2, 1)
        lengths = np.sqrt(np.einsum("pri,pri->pr", normals, normals))
        along = np.einsum("pri,ri->pr", normals, others_world) / np.maximum(lengths, 1e-12)
        away = np.einsum("pri,ri->pr", normals, self.directions_world) > 0
        return np.where(self.is_hit, np.where(away, -along, along), 0.0)


class ShapeCaster:
    """A mesh prepared for rays."""

    def __init__(self, mesh: trimesh.Trimesh) -> None:
        vertices = np.asarray(mesh.vertices, dtype=np.float64)
        extent = np.ptp(np.ascontiguousarray(vertices.T), axis=1) if len(vertices) else np.ones(3)
        self.size_m: Float[np.ndarray, "3"] = np.maximum(extent, _MIN_EXTENT_M)
        self._vertices = vertices
        self._scene = RayScene(vertices, np.asarray(mesh.faces))

    @cached_property
    def corners(self) -> Float[np.ndarray, "8 3"]:
        """Extents of the box that bounds it."""
        if not len(self._vertices):
            return box_corners(self.size_m)
        low, high = self._vertices.min(axis=0), self._vertices.max(axis=0)
        return box_corners(high - low) + (high + low) / 2

    @cached_property
    def hull(self) -> tuple[Float[np.ndarray, "h 3"], Int[np.ndarray, "e 2"]]:
        """Corners and edges of the (slightly simplified) convex hull."""
        return _hull(self._vertices, self.size_m)

    @cached_property
    def round_from_above(self) -> bool:
        """Whether the outline from above is a circle, whatever the legs: things like it are not made oval."""
        return is_circle(self._vertices[:, :2])

    def covers(
        self, origin_world: Float[np.ndarray, "3"], directions_world: Float[np.ndarray, "r 3"], poses: PoseBatch
    ) -> Bool[np.ndarray, "p r"]:
        """Whether every ray meets the shape under every pose: faster than `cast`, where that is all.

        Args:
            origin_world: of all rays (m).
            directions_world: of any length.
            poses: of the shape, p of them.
        """
        rays = _rays(origin_world, directions_world, poses)
        return self._scene.is_occluded(rays, NEAR_M)

    def cast(
        self, origin_world: Float[np.ndarray, "3"], directions_world: Float[np.ndarray, "r 3"], poses: PoseBatch
    ) -> ShapeHits:
        """First hits of every ray with the shape under every pose.

        Args:
            origin_world: of all rays (m).
            directions_world: of any length.
            poses: of the shape, p of them.
        """
        rays = _rays(origin_world, directions_world, poses)
        hits = self._scene.first_hits(rays)
        depth = hits.distance.astype(np.float64)
        depth[~(depth > NEAR_M)] = np.inf
        return ShapeHits(depth, hits.normal, hits.triangle, directions_world, poses)

    def bounds_px(self, camera: Camera, poses: PoseBatch) -> Float[np.ndarray, "p 4"]:
        """Boxes x1, y1, x2, y2 of the posed shape in the photo, clipped to it; NaN where it is out of sight."""
        corners, edges = self.hull
        T = camera.T_camera_world
        points = T[:3, :3] @ poses.apply_by_coordinate(corners).reshape(3, -1) + T[:3, 3:]
        return clip_bounds(camera, points.reshape(3, len(poses), len(corners)), edges)


def _rays(
    origin_world: Float[np.ndarray, "3"], directions_world: Float[np.ndarray, "r 3"], poses: PoseBatch
) -> Float32[np.ndarray, "p r 6"]:
    """The rays in the shape's own frame, for every pose."""
    to_object = poses.R.transpose(0, 2, 1) / poses.scale[:, :, None]
    origins = to_object @ (origin_world - poses.position)[..., None]
    directions = directions_world @ to_object.transpose(0, 2, 1)
    rays = np.empty((len(poses), len(directions_world), 6), np.float32)
    for axis in range(3):  # one coordinate of all rays at once: three of one ray are too few for numpy's loops
        rays[..., axis] = origins[:, axis]
        rays[..., 3 + axis] = directions[..., axis]
    return rays


@cache
def _directions() -> Float[np.ndarray, "d 3"]:
    """Evenly spread directions (a Fibonacci sphere), after the six axes."""
    index = np.arange(_HULL_DIRECTIONS) + 0.5
    z = 1 - 2 * index / _HULL_DIRECTIONS
    angle = np.pi * (1 + 5**0.5) * index
    ring = np.sqrt(1 - z**2)
    sphere = np.stack([ring * np.cos(angle), ring * np.sin(angle), z], axis=1)
    return np.concatenate([np.eye(3), -np.eye(3), sphere])


def _hull(vertices: np.ndarray, size_m: np.ndarray) -> tuple[Float[np.ndarray, "h 3"], Int[np.ndarray, "e 2"]]:
    """Corners and edges of the hull of the extreme vertices; the bounding box for flat or broken shapes."""
    if len(vertices) >= 4:
        extreme = np.unique(np.argmax(_directions() @ (vertices / size_m).T, axis=1))
        try:
            hull = ConvexHull(vertices[extreme] / size_m)
        except (QhullError, ValueError):
            hull = None
        if hull is not None:
            sides = hull.simplices[:, [0, 1, 1, 2, 0, 2]].reshape(-1, 2)
            return vertices[extreme], np.unique(np.sort(sides, axis=1), axis=0)
    middle = (vertices.max(axis=0) + vertices.min(axis=0)) / 2 if len(vertices) else np.zeros(3)
    return box_corners(size_m) + middle, edges_of_cuboid()


def clip_bounds(
    camera: Camera, points_camera: Float[np.ndarray, "3 p n"], edges: Int[np.ndarray, "e 2"]
) -> Float[np.ndarray, "p 4"]:
    """Boxes of the edges' visible parts: clipped to the near plane and to the photo; NaN where nothing is visible."""
    slack = frustum_slack(points_camera, camera.intrinsics)
    inside = np.logical_and.reduce(slack >= 0, axis=(0, 2))
    if inside.all():
        return _ends(_pixels(camera, points_camera))
    bounds = np.empty((points_camera.shape[1], 4))
    bounds[inside] = _ends(_pixels(camera, points_camera[:, inside]))
    bounds[~inside] = _cut_bounds(camera, points_camera[:, ~inside], slack[:, ~inside], edges)
    return bounds


def _ends(pixels: Float[np.ndarray, "2 p n"]) -> Float[np.ndarray, "p 4"]:
    return np.concatenate([pixels.min(axis=-1), pixels.max(axis=-1)]).T


def _pixels(camera: Camera, points_camera: Float[np.ndarray, "3 *n"]) -> Float[np.ndarray, "2 *n"]:
    k, (x, y, z) = camera.intrinsics, points_camera
    depth = np.maximum(z, NEAR_M / 2)
    return np.stack([k.fx * x / depth + k.cx, k.fy * y / depth + k.cy])


def _cut_bounds(
    camera: Camera,
    points_camera: Float[np.ndarray, "3 p n"],
    slack: Float[np.ndarray, "5 p n"],
    edges: Int[np.ndarray, "e 2"],
) -> Float[np.ndarray, "p 4"]:
    """As `clip_bounds`, for shapes that leave the view; `slack` is positive inside each of its five planes."""
    first, second = edges.T
    slack = slack[(slack < 0).any(axis=(1, 2))]  # the other planes cut nothing
    a, b = slack[..., first], slack[..., second]
    with np.errstate(divide="ignore", invalid="ignore"):
        cut = a / (a - b)
    enter = np.where((a < 0) & (b >= 0), cut, 0.0).max(axis=0)
    leave = np.where((b < 0) & (a >= 0), cut, 1.0).min(axis=0)
    visible = (enter <= leave) & ~((a < 0) & (b < 0)).any(axis=0)
    start, way = points_camera[..., first], points_camera[..., second] - points_camera[..., first]
    uv = _pixels(camera, np.stack([start + way * enter, start + way * leave], axis=1))
    low = np.where(visible, uv, np.inf).min(axis=(1, 3))
    high = np.where(visible, uv, -np.inf).max(axis=(1, 3))
    bounds = np.concatenate([low, high]).T
    bounds[~np.isfinite(bounds).all(axis=-1)] = np.nan
    return bounds


_CIRCLE = 0.975
"""Isoperimetric quotient (4 pi area / perimeter squared) above which a convex outline is a circle: of a square .79."""
_AS_WIDE_AS_DEEP = 1.03
"""Ratio of the sides of a box around what may still be a circle."""
_MIN_POINTS = 8


def is_circle(points_xy: Float[np.ndarray, "n 2"]) -> bool:
    """Whether the convex outline of points of a plane is about a circle, not an ellipse."""
    if len(points_xy) < _MIN_POINTS:
        return False
    extent = np.ptp(points_xy, axis=0)
    if extent.min() <= 0.0 or extent.max() > _AS_WIDE_AS_DEEP * extent.min():
        return False
    try:
        hull = ConvexHull(points_xy)
    except QhullError:
        return False
    area, perimeter = hull.volume, hull.area  # of plane hulls
    return bool(4.0 * np.pi * area > _CIRCLE * perimeter**2)
