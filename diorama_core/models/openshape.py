"""Shapes as coloured points in CLIP's space: OpenShape's PointBERT (Liu et al. 2023), trained into OpenCLIP bigG-14's.

The network sees patches of points: the 64 within a fifth of the shape's radius of each of 384 points far from one
another. Patches are made here, so that the graph holds nothing but the network (`scripts/convert_openshape.py`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32, Int

from diorama_core.models.clip import unit
from diorama_core.models.runtime import GraphNetwork

POINTS = 10_000
"""As many points of a shape as the network was trained with."""
PATCHES, NEIGHBOURS, RADIUS = 384, 64, 0.2


@dataclass(frozen=True)
class OpenShape(GraphNetwork):
    """Input: points of a surface, +Z up, with colours. Output: one unit vector in OpenCLIP bigG-14's space."""

    weights: str = "openshape"

    def shape(self, points: Float[np.ndarray, "n 3"], colours: Float[np.ndarray, "n 3"]) -> Float32[np.ndarray, " d"]:
        """The shape that the points lie on.

        Args:
            points: On its surface, in any unit; `POINTS` are best.
            colours: sRGB, 0 to 1.
        """
        centres, patches = patches_of(points, colours)
        return unit(self.session.answer({"centres": centres[None], "patches": patches[None]}, (1, None)))[0]


def patches_of(
    points: Float[np.ndarray, "n 3"], colours: Float[np.ndarray, "n 3"]
) -> tuple[Float32[np.ndarray, "p 3"], Float32[np.ndarray, "p k 9"]]:
    """Patches of points as the network was trained with them.

    Points are centred on their mean, scaled into the unit ball and mirrored (its data had y up, and y and z exchanged).

    Returns:
        Middles of the patches; and for each point of a patch where it lies from the middle, where it lies, its colour.
    """
    order = np.random.default_rng(0).permutation(len(points))  # patches take the first ones that are near
    xyz = points[order] - points.mean(axis=0)
    xyz = (xyz / max(float(np.linalg.norm(xyz, axis=1).max()), 1e-6) * [1.0, -1.0, 1.0]).astype(np.float32)
    centres = xyz[_far_apart(xyz, PATCHES)]
    near = np.stack([_first_near(xyz, centre) for centre in centres])
    seen = np.concatenate([xyz, colours[order]], axis=1).astype(np.float32)
    return centres, np.concatenate([xyz[near] - centres[:, None], seen[near]], axis=2)


def _far_apart(xyz: Float32[np.ndarray, "n 3"], count: int) -> Int[np.ndarray, " count"]:
    """Indices of points of which each is the farthest from those before it; points repeat where there are too few."""
    chosen = np.zeros(count, int)
    nearest = np.full(len(xyz), np.inf, np.float32)
    for k in range(1, count):
        nearest = np.minimum(nearest, ((xyz - xyz[chosen[k - 1]]) ** 2).sum(axis=1))
        chosen[k] = int(nearest.argmax())
    return chosen


def _first_near(xyz: Float32[np.ndarray, "n 3"], centre: Float32[np.ndarray, "3"]) -> Int[np.ndarray, " k"]:
    """The first points within the radius; the very first again where there are too few."""
    near = np.flatnonzero(((xyz - centre) ** 2).sum(axis=1) <= RADIUS**2)[:NEIGHBOURS]
    return np.concatenate([near, np.full(NEIGHBOURS - len(near), near[0])])
