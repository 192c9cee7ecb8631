"""What a photo shows within one object's outline: the lines that drawers, doors, boards and cushions draw, and details
that tell shapes apart whose outlines agree about equally well.

The edges of the photo within the object's mask are compared with those of a posed shape: where its surface turns or
steps back. Both are taken as strengths of horizontal and vertical gradients, slightly blurred, and correlated.

Beside the inner edges it is read how well the parts of a shape divide the picture into areas of one colour each: both
are deaf to how bright the light is and to which colours a shape happens to have. Their weights were learned together
with rank and outline by ranking the candidates of rendered rooms, one room held out at a time.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.geometry.observed import Observed
from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.geometry.silhouette import ShapeHits
from diorama_core.pose.settings import SETTINGS, PoseEvidenceSettings


@dataclass(frozen=True, eq=False)
class InnerEdges:
    """The photo's edges within one object, in the cells of its window."""

    cells: int
    inside: Bool[np.ndarray, "c c"]
    """Cells that show the object and nothing else, without its rim."""
    photo: Float[np.ndarray, "m"]
    """Edges of zero mean and unit length; zeros where nothing is to be seen."""
    settings: PoseEvidenceSettings

    @classmethod
    def of(
        cls, rgb: UInt8[np.ndarray, "h w 3"], seen: Observed, settings: PoseEvidenceSettings = SETTINGS.evidence
    ) -> InnerEdges:
        """The edges of an object in the photo.

        Args:
            rgb: the photo, sRGB, eight bits.
            seen: the object's cells, and its mask's share in each.
            settings: of the evidence.
        """
        cells = seen.window.cells
        grey = seen.window.means(rgb) @ np.array([0.299, 0.587, 0.114])
        whole = (seen.covered * seen.weight > settings.whole_cell).reshape(cells, cells).astype(np.uint8)
        inside = cv2.erode(whole, np.ones((3, 3), np.uint8), borderValue=0).astype(bool)
        return cls(
            cells,
            inside,
            _normalise_edges(_gradients(grey.reshape(cells, cells), settings), inside, settings),
            settings,
        )

    def agreement(self, hits: ShapeHits) -> Float[np.ndarray, "p"]:
        """Correlation, -1 to 1, with the edges of a shape under every pose; 0 where either has none."""
        return np.array([self._pose_score(hits, k) for k in range(len(hits.poses))])

    def _pose_score(self, hits: ShapeHits, pose: int) -> float:
        covered = hits.is_hit[pose]
        if not self.inside.any() or not covered.any():
            return 0.0
        depth = np.where(covered, hits.depth_m[pose], 1.0)
        depth = np.where(covered, depth, np.median(depth[covered])).reshape(self.cells, self.cells)
        edges = self.settings.step * _bends(1.0 / np.maximum(depth, self.settings.near_m))
        for axis in range(3):
            edges = edges + _gradients(
                self.settings.turn * hits.normals_world[pose][:, axis].reshape(self.cells, self.cells), self.settings
            )
        return float(
            _normalise_edges(np.minimum(edges, self.settings.strongest), self.inside, self.settings) @ self.photo
        )


def _gradients(picture: Float[np.ndarray, "c c"], settings: PoseEvidenceSettings) -> Float32[np.ndarray, "c c 2"]:
    """How much a picture changes along its rows and its columns."""
    smooth = cv2.GaussianBlur(picture.astype(np.float32), (0, 0), settings.smooth)
    along = [cv2.Sobel(smooth, cv2.CV_32F, dx, dy, scale=0.25) for dx, dy in ((1, 0), (0, 1))]
    return np.abs(np.stack(along, axis=-1))


def _bends(inverse_depth: Float[np.ndarray, "c c"]) -> Float32[np.ndarray, "c c 2"]:
    """How much inverse depth steps along rows and columns, as a share of itself; along planes it does not."""
    padded = np.pad(inverse_depth, 1, mode="edge")
    middle = padded[1:-1, 1:-1]
    across = np.abs(padded[1:-1, 2:] - 2 * middle + padded[1:-1, :-2])
    down = np.abs(padded[2:, 1:-1] - 2 * middle + padded[:-2, 1:-1])
    return np.stack([across / middle, down / middle], axis=-1).astype(np.float32)


def _normalise_edges(
    edges: Float32[np.ndarray, "c c 2"], inside: Bool[np.ndarray, "c c"], settings: PoseEvidenceSettings
) -> Float[np.ndarray, "m"]:
    """The edges inside, both directions one after the other, of zero mean and unit length."""
    blurred = cv2.GaussianBlur(np.sqrt(edges), (0, 0), settings.blur)
    residuals = blurred[inside].astype(np.float64)
    if not len(residuals):
        return np.zeros(0)
    residuals = (residuals - residuals.mean(axis=0)).T.reshape(-1)
    length = float(np.linalg.norm(residuals))
    return residuals / length if length > settings.nothing else np.zeros_like(residuals)


@dataclass(frozen=True, eq=False)
class Details:
    """One object's edges and colours in the cells of its window."""

    edges: InnerEdges
    own: Float[np.ndarray, "n"]
    """How much of each cell is known to show the object."""
    log_rgb: Float[np.ndarray, "n 3"]
    """Logarithms of the photo's mean colours."""
    settings: PoseEvidenceSettings

    @classmethod
    def of(
        cls, rgb: UInt8[np.ndarray, "h w 3"], seen: Observed, settings: PoseEvidenceSettings = SETTINGS.evidence
    ) -> Details:
        """What the photo shows of an object.

        Args:
            rgb: the photo, sRGB, eight bits.
            seen: the object's cells, and its mask's share in each.
            settings: of the evidence.
        """
        return cls(
            InnerEdges.of(rgb, seen, settings),
            seen.covered * seen.weight,
            np.log(seen.window.means(rgb) + settings.dark),
            settings,
        )

    def log_likelihood(self, appearance: ShapeAppearance, hits: ShapeHits) -> float:
        """How well one posed shape agrees, up to a constant of the object: higher is better.

        Args:
            appearance: The shape.
            hits: What the rays of the object's window meet of it, in one pose.
        """
        edges = float(self.edges.agreement(hits)[0])
        return self.settings.of_edges * edges + self.settings.of_parts * self.share_between_parts(appearance, hits)

    def share_between_parts(self, appearance: ShapeAppearance, hits: ShapeHits) -> float:
        """Share of the picture's variation of colour that lies between the parts of a shape, 0 to 1."""
        shown = hits.is_hit[0] & (self.own > self.settings.whole_cell)
        rgba = appearance.face_rgba[np.where(shown, hits.triangles[0], 0)]
        shown &= rgba[:, 3] > 0
        if shown.sum() < self.settings.min_part_cells:
            return 0.0
        values = self.log_rgb[shown] - self.log_rgb[shown].mean(axis=0)
        parts = np.unique(rgba[shown, :3] // self.settings.same_colour, axis=0, return_inverse=True)[1].ravel()
        count = np.bincount(parts)
        sums = np.stack([np.bincount(parts, values[:, k]) for k in range(3)], axis=1)
        between = float((sums**2 / count[:, None]).sum())
        return between / (float((values**2).sum()) + self.settings.colour_noise)
