"""Pose templates: one shape seen from all around, with the place on the shape that every pixel shows.

The views are those of the paper (supplement, "Implementation details"): the shape is scaled so that its longest side
is 0.85, centred, and seen from a distance of 1.1 with a field of view of 60 degrees; five elevations, an azimuth every
ten degrees, 224 x 224 pixels, gray, so that geometry and not colour is compared.

What is kept of a view is its depth (16 bits over the range that the view can have, some hundredths of a millimetre) and
its normals (16 bits, about a degree). Grays, masks, metric depth and object coordinates follow from these two.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import cv2
import numpy as np
import trimesh
from jaxtyping import Bool, Float, Float32, Int, Int32, UInt8, UInt16, UInt32
from scipy.spatial import ConvexHull, QhullError

from diorama_core.errors import LibraryError
from diorama_core.geometry.ray_scene import RayScene
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.types import Camera, Intrinsics

_DEPTH_STEPS = 65534
_NORMAL_STEPS = 255
_LIGHT_CAMERA = np.array([-0.32, -0.55, -0.77])
"""Toward the light: over the viewer's left shoulder (camera axes: y down, z away)."""
_AMBIENT, _DIRECT, _HEADLIGHT = 0.16, 0.5, 0.3


@dataclass(frozen=True)
class TemplateGrid:
    """From where a shape is seen. View `i` has elevation `i // azimuths` and azimuth `i % azimuths`.

    Azimuth 0 looks at the shape's front; positive azimuths walk to the shape's own left (its +Y).
    """

    elevations_deg: tuple[float, ...] = (0.0, 15.0, 30.0, 45.0, 60.0)
    azimuths: int = 36
    size_px: int = 224
    longest_side: float = 0.85
    """Length of the shape, in template units."""
    distance: float = 1.1
    """Distance of the camera from the shape's centre, in template units."""
    fov_deg: float = 60.0

    def __len__(self) -> int:
        return len(self.elevations_deg) * self.azimuths

    @property
    def key(self) -> str:
        """Names the grid in file names; other views, other key."""
        elevations = "-".join(f"{e:g}" for e in self.elevations_deg)
        return f"e{elevations}a{self.azimuths}s{self.size_px}l{self.longest_side:g}d{self.distance:g}f{self.fov_deg:g}"

    @property
    def intrinsics(self) -> Intrinsics:
        """Intrinsics of every view."""
        return Intrinsics.from_fov(self.size_px, self.size_px, np.radians(self.fov_deg))

    @property
    def depth_range(self) -> tuple[float, float]:
        """Least and greatest depth that a shape's bounding box can have in any view, in template units."""
        reach = 0.5 * np.sqrt(3.0) * self.longest_side + 1e-3
        return self.distance - reach, self.distance + reach

    @cached_property
    def azimuths_rad(self) -> Float[np.ndarray, "v"]:
        """Azimuth of every view."""
        return np.tile(np.arange(self.azimuths) * 2 * np.pi / self.azimuths, len(self.elevations_deg))

    @cached_property
    def elevations_rad(self) -> Float[np.ndarray, "v"]:
        """Elevation of every view."""
        return np.repeat(np.radians(self.elevations_deg), self.azimuths)

    @cached_property
    def R_object_camera(self) -> Float[np.ndarray, "v 3 3"]:
        """Rotation of every view: camera axes (x right, y down, z forward) as columns, in the object's frame."""
        azimuth, elevation = self.azimuths_rad, self.elevations_rad
        forward = -np.stack(
            [np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)], axis=-1
        )
        right = np.stack([-np.sin(azimuth), np.cos(azimuth), np.zeros(len(self))], axis=-1)
        return np.stack([right, np.cross(forward, right), forward], axis=-1)

    @cached_property
    def rays_camera(self) -> Float[np.ndarray, "h w 3"]:
        """Directions through the pixel centres, one unit of depth long."""
        k, centres = self.intrinsics, np.arange(self.size_px) + 0.5
        x, y = np.meshgrid((centres - k.cx) / k.fx, (centres - k.cy) / k.fy)
        return np.stack([x, y, np.ones_like(x)], axis=-1)


PAPER_GRID = TemplateGrid()
"""The 180 views of the paper."""


@dataclass(frozen=True, eq=False)
class Templates:
    """All views of one shape. The object frame is the shape's canonical one at scale 1, in metres."""

    grid: TemplateGrid
    centre_object: Float[np.ndarray, "3"]
    """Centre of the bounding box; the origin for shapes in the canonical frame."""
    size_m: Float[np.ndarray, "3"]
    """Size of the bounding box."""
    depth_codes: UInt16[np.ndarray, "v h w"]
    """Depth in steps of the grid's depth range, from 1; 0 where nothing is seen."""
    normal_codes: UInt16[np.ndarray, "v h w"]
    """Normals in the camera's frame, octahedral, a byte for each coordinate."""

    def __len__(self) -> int:
        return len(self.grid)

    @property
    def unit_m(self) -> float:
        """Metres in one template unit."""
        return float(np.max(self.size_m)) / self.grid.longest_side

    @property
    def mask(self) -> Bool[np.ndarray, "v h w"]:
        """Where the shape is seen, in every view. Nothing of a sheet thinner than a pixel may be seen on its edge."""
        return self.depth_codes > 0

    @cached_property
    def gray(self) -> UInt8[np.ndarray, "v h w"]:
        """Every view as a picture, lit from the viewer; 0 (and only there) where nothing is seen."""
        gray = _grays()[self.normal_codes]
        gray[self.depth_codes == 0] = 0
        return gray

    @property
    def T_object_camera(self) -> Float[np.ndarray, "v 4 4"]:
        """Camera poses: `p_object = T_object_camera[view] @ p_camera`, metres."""
        T = np.tile(np.eye(4), (len(self), 1, 1))
        T[:, :3, :3] = self.grid.R_object_camera
        T[:, :3, 3] = self._positions
        return T

    def camera(self, view: int) -> Camera:
        """The camera of one view, posed in the object's frame."""
        return Camera(self.grid.intrinsics, self.T_object_camera[view])

    def depth_m(self, view: int) -> Float32[np.ndarray, "h w"]:
        """Depth along the viewing axis in metres at scale 1; 0 where nothing is seen."""
        near, far = self.grid.depth_range
        codes = self.depth_codes[view]
        depth = (near + (codes.astype(np.float32) - 1) * ((far - near) / _DEPTH_STEPS)) * self.unit_m
        return np.where(codes > 0, depth, 0).astype(np.float32)

    def normals_camera(self, view: int) -> Float32[np.ndarray, "h w 3"]:
        """Unit normals in the camera's frame, toward the viewer; 0 where nothing is seen."""
        normals = _normals()[self.normal_codes[view]]
        normals[self.depth_codes[view] == 0] = 0
        return normals

    def normals_object(self, view: int) -> Float32[np.ndarray, "h w 3"]:
        """Unit normals in the object's frame, toward the viewer; 0 where nothing is seen."""
        return self.normals_camera(view) @ self.grid.R_object_camera[view].T.astype(np.float32)

    def points_object(self, view: int) -> Float32[np.ndarray, "h w 3"]:
        """The point of the shape that every pixel shows, in metres at scale 1; NaN where nothing is seen."""
        R = self.grid.R_object_camera[view]
        depth = self.depth_m(view)[..., None]
        points = self._positions[view] + depth * (self.grid.rays_camera @ R.T)
        return np.where(depth > 0, points, np.nan).astype(np.float32)

    def points_at(self, view: int, pixels: Int[np.ndarray, "n 2"]) -> Float32[np.ndarray, "n 3"]:
        """As `points_object`, at integer pixels (x, y) only."""
        x, y = pixels[:, 0], pixels[:, 1]
        near, far = self.grid.depth_range
        codes = self.depth_codes[view, y, x]
        depth = (near + (codes.astype(np.float64) - 1) * ((far - near) / _DEPTH_STEPS)) * self.unit_m
        points = self._positions[view] + depth[:, None] * (
            self.grid.rays_camera[y, x] @ self.grid.R_object_camera[view].T
        )
        return np.where(codes[:, None] > 0, points, np.nan).astype(np.float32)

    @cached_property
    def _positions(self) -> Float[np.ndarray, "v 3"]:
        return self.centre_object - self.grid.R_object_camera[..., 2] * self.grid.distance * self.unit_m


def render_templates(
    mesh: trimesh.Trimesh,
    grid: TemplateGrid = PAPER_GRID,
    progress: Progress = SILENT,
) -> Templates:
    """Cast all views of a mesh on one core.

    Args:
        mesh: In the canonical frame, metres.
        grid: Which views.
        progress: Reports and cancellation, after every view.

    Raises:
        LibraryError: when the mesh has no triangles or no extent.
        Cancelled: On request.
    """
    return _cast_views(mesh, grid, progress, None)


def templates_with_faces(
    mesh: trimesh.Trimesh, grid: TemplateGrid = PAPER_GRID
) -> tuple[Templates, Int32[np.ndarray, "v h w"]]:
    """As `render_templates`, and which of the mesh's faces every pixel of every view shows; -1 where none."""
    face_ids = np.full((len(grid), grid.size_px, grid.size_px), -1, np.int32)
    return _cast_views(mesh, grid, Progress(), face_ids), face_ids


def _cast_views(
    mesh: trimesh.Trimesh, grid: TemplateGrid, progress: Progress, face_ids: Int32[np.ndarray, "v h w"] | None
) -> Templates:
    """All views; fills `face_ids` where they are asked for."""
    low, high = _bounds(mesh)
    centre, size = (low + high) / 2, high - low
    unit = float(size.max()) / grid.longest_side
    vertices = ((np.asarray(mesh.vertices) - centre) / unit).astype(np.float32)
    caster = _UnitCaster(vertices, np.asarray(mesh.faces, np.uint32), grid)
    depth = np.zeros((len(grid), grid.size_px, grid.size_px), np.uint16)
    normals = np.zeros_like(depth)
    for view in range(len(grid)):
        progress.report(view / len(grid), "views of a shape")
        caster.cast(view, depth[view], normals[view], None if face_ids is None else face_ids[view])
    return Templates(grid, centre, size, depth, normals)


def _bounds(mesh: trimesh.Trimesh) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    if not len(mesh.faces):
        raise LibraryError("a shape without triangles has no views; add a model with a surface")
    low, high = np.asarray(mesh.bounds, dtype=np.float64)
    if not (np.isfinite(low).all() and np.isfinite(high).all() and (high - low).max() > 0):
        raise LibraryError("a shape without extent has no views; add a model with a surface")
    return low, high


class _UnitCaster:
    """Triangles in template units around the origin, seen from the grid's cameras."""

    def __init__(
        self, vertices: Float32[np.ndarray, "n 3"], faces: UInt32[np.ndarray, "m 3"], grid: TemplateGrid
    ) -> None:
        self._grid = grid
        self._scene = RayScene(vertices, faces, threads=1)
        self._hull = _hull_points(vertices)
        self._rays = grid.rays_camera.reshape(-1, 3)

    def cast(
        self,
        view: int,
        depth: UInt16[np.ndarray, "h w"],
        normals: UInt16[np.ndarray, "h w"],
        face_ids: Int32[np.ndarray, "h w"] | None,
    ) -> None:
        """Fill one view's codes, and the faces seen where they are asked for.

        Args:
            view: Its number.
            depth: Quantised.
            normals: Quantised.
            face_ids: -1 for none; None where they are not asked for.
        """
        grid, R = self._grid, self._grid.R_object_camera[view]
        pixels = self._worth_casting(R)
        rays = np.empty((len(pixels), 6), np.float32)
        rays[:, :3] = -R[:, 2] * grid.distance
        rays[:, 3:] = self._rays[pixels] @ R.T
        hits = self._scene.first_hits(rays)
        distance = hits.distance
        seen = np.flatnonzero(np.isfinite(distance))
        depth.reshape(-1)[pixels[seen]] = _depth_codes(distance[seen], grid)
        facing = hits.normal[seen] @ R.astype(np.float32)
        normals.reshape(-1)[pixels[seen]] = _normal_codes(facing, self._rays[pixels[seen]])
        if face_ids is not None:
            face_ids.reshape(-1)[pixels[seen]] = hits.triangle[seen]

    def _worth_casting(self, R: Float[np.ndarray, "3 3"]) -> Int[np.ndarray, "p"]:
        """Pixels inside the outline of the convex hull: no other ray can meet the shape."""
        k, size = self._grid.intrinsics, self._grid.size_px
        camera = self._hull @ R + [0.0, 0.0, self._grid.distance]
        uv = camera[:, :2] / camera[:, 2:] * [k.fx, k.fy] + [k.cx, k.cy]
        outline = cv2.convexHull(uv.astype(np.float32)).reshape(-1, 2)
        inside = np.zeros((size, size), np.uint8)
        cv2.fillConvexPoly(inside, np.rint(outline).astype(np.int32), 1)
        return np.flatnonzero(cv2.dilate(inside, np.ones((5, 5), np.uint8)))


def _hull_points(vertices: Float32[np.ndarray, "n 3"]) -> Float[np.ndarray, "h 3"]:
    """Corners of the convex hull; all points of flat shapes, which have none."""
    points = np.unique(vertices, axis=0).astype(np.float64)
    try:
        return points[ConvexHull(points).vertices]
    except (QhullError, ValueError):
        return points


def _depth_codes(depth: Float32[np.ndarray, "n"], grid: TemplateGrid) -> UInt16[np.ndarray, "n"]:
    near, far = grid.depth_range
    steps = (np.clip(depth, near, far) - near) * (_DEPTH_STEPS / (far - near))
    return (np.rint(steps) + 1).astype(np.uint16)


def _normal_codes(normals: Float32[np.ndarray, "n 3"], rays: Float[np.ndarray, "n 3"]) -> UInt16[np.ndarray, "n"]:
    """Octahedral coordinates (Cigolla et al., 2014) of the normals, turned against the rays."""
    away = np.einsum("ij,ij->i", normals, rays) > 0
    toward = np.where(away[:, None], -normals, normals)
    flat = toward / np.maximum(np.abs(toward).sum(axis=1, keepdims=True), 1e-12)
    x, y = flat[:, 0], flat[:, 1]
    behind = flat[:, 2] > 0  # the far half is folded outward
    u = np.where(behind, (1 - np.abs(y)) * np.where(x >= 0, 1, -1), x)
    v = np.where(behind, (1 - np.abs(x)) * np.where(y >= 0, 1, -1), y)
    code_u, code_v = (np.rint((w + 1) * (0.5 * _NORMAL_STEPS)).astype(np.uint16) for w in (u, v))
    return code_u << 8 | code_v


@cache
def _normals() -> Float32[np.ndarray, "c 3"]:
    """The unit normal that each code stands for."""
    codes = np.arange(65536)
    u, v = (w * (2.0 / _NORMAL_STEPS) - 1 for w in (codes >> 8, codes & 255))
    z = np.abs(u) + np.abs(v) - 1  # negative: toward the viewer
    x = np.where(z > 0, (1 - np.abs(v)) * np.where(u >= 0, 1, -1), u)
    y = np.where(z > 0, (1 - np.abs(u)) * np.where(v >= 0, 1, -1), v)
    normals = np.stack([x, y, z], axis=-1)
    return (normals / np.linalg.norm(normals, axis=-1, keepdims=True)).astype(np.float32)


@cache
def _grays() -> UInt8[np.ndarray, "c"]:
    """The gray of a surface with each normal; at least 1, so that 0 means background."""
    normals = _normals()
    direct = np.clip(normals @ (_LIGHT_CAMERA / np.linalg.norm(_LIGHT_CAMERA)), 0, 1)
    headlight = np.clip(-normals[:, 2], 0, 1)
    light = _AMBIENT + _DIRECT * direct + _HEADLIGHT * headlight
    return np.clip(np.rint(255 * light), 1, 255).astype(np.uint8)
