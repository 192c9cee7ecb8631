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
from diorama_core.geometry.silhouette import Hits
from diorama_core.pose.inner_edges import WHOLE_CELL, InnerEdges

OF_EDGES, OF_PARTS = 5.0, 3.0
"""What a correlation of edges, and a share of the colours explained, say as a logarithm."""
MIN_CELLS = 30
"""Cells that a shape covers, below which their colours tell no parts."""
_DARK = 8.0
"""Grey levels added before logarithms: noise of dark pixels is no colour."""
_SAME_COLOUR = 8
"""Parts whose sRGB values are this near count as one."""
_NOISE = 1e-3
"""Sum of squared logarithms below which a picture has one colour."""


@dataclass(frozen=True, eq=False)
class Details:
    """One object's edges and colours in the cells of its window."""

    edges: InnerEdges
    own: Float[np.ndarray, "n"]
    """How much of each cell is known to show the object."""
    log_rgb: Float[np.ndarray, "n 3"]
    """Logarithms of the photo's mean colours."""

    @classmethod
    def of(cls, rgb: UInt8[np.ndarray, "h w 3"], seen: Observed) -> Details:
        """What the photo shows of an object."""
        return cls(InnerEdges.of(rgb, seen), seen.covered * seen.weight, np.log(seen.window.means(rgb) + _DARK))

    def log_likelihood(self, appearance: ShapeAppearance, hits: Hits) -> float:
        """How well one posed shape agrees, up to a constant of the object: higher is better.

        Args:
            appearance: The shape.
            hits: What the rays of the object's window meet of it, in one pose.
        """
        edges = float(self.edges.agreement(hits)[0])
        return OF_EDGES * edges + OF_PARTS * self.explained_by_parts(appearance, hits)

    def explained_by_parts(self, appearance: ShapeAppearance, hits: Hits) -> float:
        """Share of the picture's variation of colour that lies between the parts of a shape, 0 to 1."""
        shown = hits.covered[0] & (self.own > WHOLE_CELL)
        rgba = appearance.face_rgba[np.where(shown, hits.triangles[0], 0)]
        shown &= rgba[:, 3] > 0
        if shown.sum() < MIN_CELLS:
            return 0.0
        values = self.log_rgb[shown] - self.log_rgb[shown].mean(axis=0)
        parts = np.unique(rgba[shown, :3] // _SAME_COLOUR, axis=0, return_inverse=True)[1].ravel()
        count = np.bincount(parts)
        sums = np.stack([np.bincount(parts, values[:, k]) for k in range(3)], axis=1)
        between = float((sums**2 / count[:, None]).sum())
        return between / (float((values**2).sum()) + _NOISE)
