"""Triangles that rays can meet: the one way to Open3D's ray casting."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Float32, Int, Int32, Integer

from diorama_core.io.large_libraries import o3d

RayArray = Float32[np.ndarray, "*n 6"]
"""Origin and direction of each ray; the direction's length is the unit of the hit distance."""
ALL_CORES = 0
"""Threads of Open3D. It keeps the interpreter locked while it casts: ours wait meanwhile, and leave it their cores."""


@dataclass(frozen=True, eq=False)
class RayHits:
    """The first meeting of each ray with the triangles; fields have the shape of the rays given."""

    distance: Float32[np.ndarray, "*n"]
    """In units of the ray's direction; `inf` for a miss."""
    triangle: Int32[np.ndarray, "*n"]
    """-1 for a miss."""
    barycentric: Float32[np.ndarray, "*n 2"]
    """Weights of the triangle's second and third corner."""
    normal: Float32[np.ndarray, "*n 3"]
    """Unit normal of the triangle, by the order of its corners."""

    @property
    def is_hit(self) -> Bool[np.ndarray, "*n"]:
        """Whether the ray met anything."""
        return self.triangle >= 0

    def select(self, which: np.ndarray) -> RayHits:
        """The hits at a mask or at indices."""
        return RayHits(self.distance[which], self.triangle[which], self.barycentric[which], self.normal[which])


class RayScene:
    """Triangles, ready to be met by rays. Build once, cast often.

    Args:
        vertices: corners, in any frame.
        triangles: three of them each.
        threads: that one call casts with.
    """

    def __init__(
        self, vertices: Float[np.ndarray, "n 3"], triangles: Integer[np.ndarray, "m 3"], threads: int = ALL_CORES
    ) -> None:
        self._threads = threads
        self._scene = o3d.t.geometry.RaycastingScene(nthreads=1)
        if len(triangles):
            self._scene.add_triangles(_tensor(vertices), _tensor(triangles, np.uint32))
        self.is_occluded(np.array([[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]]))  # builds the tree here, not under threads

    def first_hits(self, rays: RayArray) -> RayHits:
        """What every ray meets first."""
        answer = self._scene.cast_rays(_tensor(rays), nthreads=self._threads)
        return RayHits(
            answer["t_hit"].numpy(),
            answer["primitive_ids"].numpy().view(np.int32),
            answer["primitive_uvs"].numpy(),
            answer["primitive_normals"].numpy(),
        )

    def is_occluded(
        self, rays: Float[np.ndarray, "*n 6"], near: float = 0.0, far: float = np.inf
    ) -> Bool[np.ndarray, "*n"]:
        """Whether anything is between two distances along each ray, in units of its direction."""
        return self._scene.test_occlusions(_tensor(rays), float(near), float(far), nthreads=self._threads).numpy()

    def all_hits(
        self, rays: Float[np.ndarray, "n 6"]
    ) -> tuple[Int[np.ndarray, "h"], Float[np.ndarray, "h"], Int[np.ndarray, "h"]]:
        """Everything that rays meet: the ray's number, the distance and the triangle."""
        hits = self._scene.list_intersections(_tensor(rays), nthreads=self._threads)
        found = (hits["ray_ids"].numpy().astype(int), hits["t_hit"].numpy().astype(float))
        return *found, hits["primitive_ids"].numpy().astype(int)

    def distances(self, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n"]:
        """How far points are from the nearest triangle."""
        return self._scene.compute_distance(_tensor(points), nthreads=self._threads).numpy()


def _tensor(values: np.ndarray, dtype: type = np.float32) -> Any:
    return o3d.core.Tensor.from_numpy(np.ascontiguousarray(values, dtype=dtype))
