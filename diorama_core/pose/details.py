"""What a photo shows within one object's outline, to compare shapes whose outlines agree about equally well.

Two things are read, both deaf to how bright the light is and to which colours a shape happens to have: the inner edges,
where drawers, cushions and legs meet, and how well the parts of a shape divide the picture into areas of one colour
each. Their weights were learned together with rank and outline by ranking the candidates of rendered rooms, one room
held out at a time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.geometry.observed import Observed
from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.geometry.silhouette import ShapeHits
from diorama_core.pose.inner_edges import InnerEdges
from diorama_core.pose.settings import SETTINGS, PoseEvidenceSettings


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
        return self.settings.of_edges * edges + self.settings.of_parts * self.explained_by_parts(appearance, hits)

    def explained_by_parts(self, appearance: ShapeAppearance, hits: ShapeHits) -> float:
        """Share of the picture's variation of colour that lies between the parts of a shape, 0 to 1."""
        shown = hits.covered[0] & (self.own > self.settings.whole_cell)
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
