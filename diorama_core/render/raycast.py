"""Ray-casting on the processor: rays of a view, what each ray meets first, and what every pixel sees as images and
bands of rows.

Triangles of everything that is seen go into one acceleration structure, so that a hit's triangle index alone tells
the object, its material and its texture coordinates. Rays are scaled so that the hit distance is the depth.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
import trimesh
from jaxtyping import Bool, Float, Float32, Int, Int32

from diorama_core.geometry.ray_scene import RayArray, RayHits, RayScene
from diorama_core.geometry.vectors import face_normals, facing
from diorama_core.scene.types import Camera


@dataclass(frozen=True, eq=False)
class Buffers:
    """What a view sees, per pixel."""

    depth_m: Float32[np.ndarray, "h w"]
    """Depth along the viewing axis (z in camera), 0 where nothing is hit."""
    normals_world: Float32[np.ndarray, "h w 3"]
    """Unit normals of the faces hit, toward the viewer; 0 where nothing is hit."""
    instance: Int32[np.ndarray, "h w"]
    """Index of the mesh hit; -1 where nothing is."""

    @cached_property
    def silhouette(self) -> Bool[np.ndarray, "h w"]:
        """Where anything is hit."""
        return self.instance >= 0


@dataclass(frozen=True)
class OrthographicView:
    """A parallel projection: camera axes as of a pinhole, rays parallel to +z of the camera."""

    T_world_camera: Float[np.ndarray, "4 4"]
    width: int
    height: int
    metres_per_pixel: float

    def rays(self, pixels: Float[np.ndarray, "*n 2"]) -> RayArray:
        """Rays through image positions, one unit of distance being one metre of depth."""
        uv = (np.asarray(pixels, dtype=np.float64) - 0.5 * np.array([self.width, self.height])) * self.metres_per_pixel
        R, t = self.T_world_camera[:3, :3], self.T_world_camera[:3, 3]
        origins = uv @ R[:, :2].T + t
        return np.concatenate([origins, np.broadcast_to(R[:, 2], origins.shape)], axis=-1).astype(np.float32)


@dataclass(frozen=True)
class PinholeView:
    """A camera as a source of rays."""

    camera: Camera

    @property
    def width(self) -> int:
        """Pixels across."""
        return self.camera.intrinsics.width

    @property
    def height(self) -> int:
        """Pixels down."""
        return self.camera.intrinsics.height

    def rays(self, pixels: Float[np.ndarray, "*n 2"]) -> RayArray:
        """Rays through image positions, one unit of distance being one metre of depth."""
        directions = self.camera.rays(pixels)
        origins = np.broadcast_to(self.camera.position, directions.shape)
        return np.concatenate([origins, directions], axis=-1).astype(np.float32)


View = PinholeView | OrthographicView
"""Anything that turns image positions into rays."""


def pixel_centres(width: int, height: int, first_row: int = 0) -> Float[np.ndarray, "h w 2"]:
    """Image positions (x, y) of all pixel centres, from a row on."""
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(first_row, height) + 0.5)
    return np.stack([x, y], axis=-1)


class MeshCaster:
    """Posed meshes to be seen from many cameras: depth, normals and instance ids without any shading.

    Args:
        meshes: Each mesh with the 4x4 matrix (scale allowed) that maps its vertices to the world; the instance id
            is the index in this sequence.
    """

    def __init__(self, meshes: Sequence[tuple[trimesh.Trimesh, Float[np.ndarray, "4 4"]]]) -> None:
        vertices, triangles, owners, start = [np.zeros((0, 3))], [np.zeros((0, 3), int)], [np.zeros(0, int)], 0
        for index, (mesh, matrix) in enumerate(meshes):
            vertices.append(np.asarray(mesh.vertices) @ matrix[:3, :3].T + matrix[:3, 3])
            triangles.append(np.asarray(mesh.faces) + start)
            owners.append(np.full(len(mesh.faces), index))
            start += len(mesh.vertices)
        points, faces = np.concatenate(vertices).astype(np.float32), np.concatenate(triangles).astype(np.int32)
        self._caster = RayScene(points, faces)
        self._owner = np.concatenate(owners).astype(np.int32)
        self._normals = face_normals(points, faces)

    def first_hits(self, rays: RayArray) -> RayHits:
        """What every ray meets first."""
        return self._caster.first_hits(rays)

    def instances(self, rays: RayArray) -> Int32[np.ndarray, "*n"]:
        """Which mesh every ray meets first; -1 where it meets none."""
        return self._instances(self._caster.first_hits(rays))

    def _instances(self, hits: RayHits) -> Int32[np.ndarray, "*n"]:
        instance = np.full(hits.is_hit.shape, -1, dtype=np.int32)
        instance[hits.is_hit] = self._owner[hits.triangle[hits.is_hit]]
        return instance

    def buffers(self, view: Camera | View) -> Buffers:
        """Depth, normals and instance ids from one camera."""
        view = PinholeView(view) if isinstance(view, Camera) else view
        rays = view.rays(pixel_centres(view.width, view.height))
        hits = self._caster.first_hits(rays)
        is_hit = hits.is_hit
        depth = np.where(is_hit, hits.distance, 0).astype(np.float32)
        normals = np.zeros((*is_hit.shape, 3), dtype=np.float32)
        normals[is_hit] = facing(self._normals[hits.triangle[is_hit]], rays[is_hit][:, 3:])
        return Buffers(depth, normals, self._instances(hits))


@dataclass(frozen=True, eq=False)
class Grid:
    """The first places of all pixels; 0 where nothing is seen (`instance` -1)."""

    found: Bool[np.ndarray, "h w"]
    points: Float32[np.ndarray, "h w 3"]
    normals: Float32[np.ndarray, "h w 3"]
    """Smooth shading normals, toward the viewer."""
    flat_normals: Float32[np.ndarray, "h w 3"]
    """Normals of the triangles, toward the viewer."""
    instance: Int[np.ndarray, "h w"]
    depth: Float32[np.ndarray, "h w"]
    """Along the viewing axis."""
    pixel_m: Float32[np.ndarray, "h w"]
    """Width that a pixel covers at its depth."""
    photographed: Bool[np.ndarray, "h w"]
    """Whether the colour of what is seen already holds the light of the room."""

    def part(self, rows: slice, columns: slice = slice(None)) -> Grid:
        """Some rows and columns, as a view of the same memory."""
        return Grid(**{image.name: getattr(self, image.name)[rows, columns] for image in fields(self)})


def pixel_footprint(view: View, depth: Float32[np.ndarray, "h w"]) -> Float32[np.ndarray, "h w"]:
    """Width in metres that a pixel covers at its depth."""
    middle = np.array([[view.width / 2, view.height / 2], [view.width / 2 + 1, view.height / 2]])
    a, b = view.rays(middle).astype(np.float64)
    at_zero, per_metre = np.linalg.norm(b[:3] - a[:3]), np.linalg.norm(b[3:] - a[3:])
    return (at_zero + per_metre * depth).astype(np.float32)


def bands(height: int, rows: int = 48) -> list[slice]:
    """Rows in groups small enough for the processor's cache."""
    return [slice(start, min(start + rows, height)) for start in range(0, height, rows)]
