"""What every pixel of a view sees, as images, and bands of their rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int

from diorama_core.render.raycast import View


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
        return Grid(
            self.found[rows, columns],
            self.points[rows, columns],
            self.normals[rows, columns],
            self.flat_normals[rows, columns],
            self.instance[rows, columns],
            self.depth[rows, columns],
            self.pixel_m[rows, columns],
            self.photographed[rows, columns],
        )


def pixel_footprint(view: View, depth: Float32[np.ndarray, "h w"]) -> Float32[np.ndarray, "h w"]:
    """Width in metres that a pixel covers at its depth."""
    middle = np.array([[view.width / 2, view.height / 2], [view.width / 2 + 1, view.height / 2]])
    a, b = view.rays(middle).astype(np.float64)
    at_zero, per_metre = np.linalg.norm(b[:3] - a[:3]), np.linalg.norm(b[3:] - a[3:])
    return (at_zero + per_metre * depth).astype(np.float32)


def bands(height: int, rows: int = 48) -> list[slice]:
    """Rows in groups small enough for the processor's cache."""
    return [slice(start, min(start + rows, height)) for start in range(0, height, rows)]
