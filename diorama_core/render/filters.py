"""Filters over pictures: gathering interleaved light without crossing edges, and tones for the screen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.geometry.vectors import dot
from diorama_core.io.srgb import linear_to_srgb
from diorama_core.render.lighting import TILE


@dataclass(frozen=True, eq=False)
class Neighbours:
    """For each pixel, which of its 5 x 5 neighbours lie on the same smooth surface, with their weights."""

    weights: tuple[tuple[int, int, Float32[np.ndarray, "h w"]], ...]
    """Row offset, column offset, weight (0 where the neighbour lies elsewhere or outside)."""
    total: Float32[np.ndarray, "h w"]

    @classmethod
    def of(
        cls,
        points: Float32[np.ndarray, "h w 3"],
        normals: Float32[np.ndarray, "h w 3"],
        is_hit: Bool[np.ndarray, "h w"],
        tolerance_m: Float32[np.ndarray, "h w"],
    ) -> Neighbours:
        """The outer rows and columns count half, so that exactly the samples of one 4 x 4 block are gathered.

        Args:
            points: Where each pixel's place is in the world.
            normals: Its normal.
            is_hit: Whether the pixel sees anything.
            tolerance_m: How far a neighbour may leave the pixel's tangent plane.
        """
        half, weights = TILE // 2, []
        total = np.zeros(is_hit.shape, np.float32)
        for dy in range(-half, half + 1):
            for dx in range(-half, half + 1):
                share = (0.5 if abs(dy) == half else 1.0) * (0.5 if abs(dx) == half else 1.0)
                here, shifted = _shift(is_hit.shape, dy, dx)
                leave = np.abs(dot(points[shifted] - points[here], normals[here]))
                turn = dot(normals[here], normals[shifted])
                same = is_hit[shifted] & (leave < tolerance_m[here]) & (turn > 0.85)
                weight = np.zeros(is_hit.shape, np.float32)
                weight[here] = same * np.float32(share)
                total += weight
                weights.append((dy, dx, weight))
        return cls(tuple(weights), np.maximum(total, 1e-6))

    def mean(self, light: Float32[np.ndarray, "h w c"]) -> Float32[np.ndarray, "h w c"]:
        """Interleaved light, gathered without crossing edges."""
        channels = np.ascontiguousarray(np.moveaxis(light, -1, 0))
        gathered = np.zeros_like(channels)
        for dy, dx, weight in self.weights:
            here, shifted = _shift(weight.shape, dy, dx)
            gathered[:, here[0], here[1]] += weight[here] * channels[:, shifted[0], shifted[1]]
        return np.ascontiguousarray(np.moveaxis(gathered / self.total, 0, -1))


def _shift(shape: tuple[int, ...], dy: int, dx: int) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """Slices of the pixels that have a neighbour at an offset, and of those neighbours."""
    (h, w) = shape
    rows, columns = slice(max(0, -dy), min(h, h - dy)), slice(max(0, -dx), min(w, w - dx))
    near_rows, near_columns = slice(rows.start + dy, rows.stop + dy), slice(columns.start + dx, columns.stop + dx)
    return (rows, columns), (near_rows, near_columns)


def tone_mapped(radiance: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
    """Linear light to display values 0 to 1: straight to 0.7, then a soft shoulder that keeps bright colours."""
    knee = 0.7
    over = np.maximum(radiance - knee, 0)
    compressed = np.minimum(radiance, knee) + (1 - knee) * over / (over + (1 - knee))
    return linear_to_srgb(compressed)


def as_bytes(values: Float[np.ndarray, "*n"]) -> UInt8[np.ndarray, "*n"]:
    """Display values 0 to 1 as bytes."""
    return np.clip(np.rint(values * 255.0), 0, 255).astype(np.uint8)
