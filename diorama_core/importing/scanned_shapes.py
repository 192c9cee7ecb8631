"""How well shapes agree with the points of a scanned thing, whatever their proportions: both in one box."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Float
from scipy.spatial import cKDTree

from diorama_core.geometry.shape_appearance import SHARED_APPEARANCES
from diorama_core.importing.measured_types import MeasuredBox
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.retrieval.pools import size_cost

POINTS = 500
SHAPES_OF_KIND = 4
"""Those nearest in size are compared."""
SHAPES_COMPARED = 24
"""Shapes of the object's own kind that are compared at most."""
FIT_SIGMA_M = 0.02
TURN_COST_M = 0.006
"""Metres that another front must be nearer."""
FAR_M = 0.15
"""What is farther apart counts no more."""
UNSEEN_WEIGHT = 0.5
"""Weight of a shape's surface without points nearby: part of it faced a wall or was never scanned."""


@dataclass(frozen=True, eq=False)
class ScannedSurface:
    """Points of a thing in its own box."""

    points: Float[np.ndarray, "n 3"]
    """Along the box's axes, from its middle."""
    size_m: Float[np.ndarray, "3"]
    tree: cKDTree

    @classmethod
    def of(cls, box: MeasuredBox) -> ScannedSurface:
        """Return the surface of a scanned box."""
        if box.points is None:
            raise ValueError("the box has no points")
        local = (box.points - box.centre) @ box.R_world_box
        chosen = local[np.linspace(0, len(local) - 1, min(len(local), POINTS)).astype(int)]
        return cls(chosen, box.size_m, cKDTree(chosen))

    def misfit_of_kind(self, kind: str, library: ShapeLibrary) -> float | None:
        """How far the points are from the best shape of a kind, in metres; None where the library has none."""
        shapes = sorted(library.in_category(kind), key=lambda s: (_unlike(s, self.size_m), s.id))[:SHAPES_OF_KIND]
        return min((min(self.misfits(s, library)) for s in shapes), default=None)

    def fits(self, kind: str, library: ShapeLibrary) -> tuple[dict[str, float], int]:
        """How well a kind's shapes agree with the points, by id, and how many quarters the best one is turned by.

        A front that was guessed stays where another one is hardly better.
        """
        shapes = sorted(library.in_category(kind), key=lambda s: (_unlike(s, self.size_m), s.id))[:SHAPES_COMPARED]
        costs_m = {s.id: np.asarray(self.misfits(s, library)) + TURN_COST_M * (np.arange(4) > 0) for s in shapes}
        if not costs_m:
            return {}, 0
        best = min(costs_m, key=lambda name: (float(costs_m[name].min()), name))
        fits = {name: float(np.exp(-misfits.min() / FIT_SIGMA_M)) for name, misfits in costs_m.items()}
        return fits, int(np.argmin(costs_m[best])) % 4

    def misfits(self, shape: Shape, library: ShapeLibrary) -> Sequence[float]:
        """For each quarter turn of a shape that is stretched into the box, the mean distance of the two surfaces.

        A turn that stretches the shape more than the other way round counts as farther off: thin things fit either way.
        """
        unit = unit_surface(shape, library)
        if not len(unit):
            return [FAR_M]
        cost = [size_cost(shape.size_m, self.size_m), size_cost(shape.size_m, self.size_m[[1, 0, 2]])]
        farther = [FIT_SIGMA_M * (c - min(cost)) for c in cost]
        return [self._misfit(_turned(unit, q) * self.size_m) + farther[q % 2] for q in range(4)]

    def _misfit(self, surface: Float[np.ndarray, "m 3"]) -> float:
        distance_m = np.minimum(cKDTree(surface).query(self.points)[0], FAR_M).mean()
        back = np.minimum(self.tree.query(surface)[0], FAR_M).mean()
        return float(distance_m + UNSEEN_WEIGHT * back)


def unit_surface(shape: Shape, library: ShapeLibrary) -> Float[np.ndarray, "m 3"]:
    """Points spread over a shape's surface, in a box of sides 1 around the origin."""
    parts = partial(library.parts, shape.id)
    appearance = SHARED_APPEARANCES.get(shape.content_hash, default_cache_dir() / "appearances", parts)
    points = appearance.spread_points(2 * POINTS)
    if not len(points):
        return points
    low, high = appearance.vertices.min(axis=0), appearance.vertices.max(axis=0)
    return np.asarray((points - (low + high) / 2) / np.maximum(high - low, 1e-6))


def _turned(points: Float[np.ndarray, "m 3"], quarters: int) -> Float[np.ndarray, "m 3"]:
    """Turned about up by quarters, counter-clockwise seen from above."""
    x, y, z = points.T
    for _ in range(quarters):
        x, y = -y, x
    return np.column_stack([x, y, z])


def _unlike(shape: Shape, size_m: Float[np.ndarray, "3"]) -> float:
    """In size, either way round."""
    return min(size_cost(shape.size_m, size_m), size_cost(shape.size_m, size_m[[1, 0, 2]]))
