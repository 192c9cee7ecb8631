"""Convex bodies of the room's planes."""

from __future__ import annotations

from collections.abc import Iterable

import manifold3d
import numpy as np
from jaxtyping import Float

from diorama_core.export.bodies import Points, StaticSlab
from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.unseen_walls import heights, open_edges, rectangle
from diorama_core.scene.types import Architecture, Plane

MIN_SLAB_M = 0.05
GROUND_BEYOND_M, GROUND_DEPTH_M = 10.0, 0.5
"""How far the floor reaches beyond the room, and down: what falls for two seconds is not stopped by less."""
THIN_M = 1e-3
"""Pieces of slabs that are thinner than this are left out."""
CLEAR_M = 0.02
"""Between what stands over the floor's edge and the barrier beyond it."""


def ground_piece(plane: Plane) -> tuple[Points, ...]:
    """The floor as one thick box that reaches beyond the room, so that nothing falls beside or through it."""
    axes = np.stack(plane_axes(plane.normal), axis=1)
    flat = plane.polygon @ axes
    low, high = flat.min(axis=0) - GROUND_BEYOND_M, flat.max(axis=0) + GROUND_BEYOND_M
    top = np.array([[u, v] for u in (low[0], high[0]) for v in (low[1], high[1])]) @ axes.T
    top = top + plane.normal * float(plane.polygon.mean(axis=0) @ plane.normal)
    return (np.vstack([top, top - plane.normal * GROUND_DEPTH_M]),)


def slab_pieces(plane: Plane) -> tuple[Points, ...]:
    """A plane with its thickness as convex prisms: one where its outline is convex, one a triangle otherwise."""
    depth = -plane.normal * max(plane.thickness, MIN_SLAB_M)
    flat = plane.polygon @ np.stack(plane_axes(plane.normal), axis=1)
    if _is_convex(flat):
        return (np.vstack([plane.polygon, plane.polygon + depth]),)
    triangles = np.asarray(manifold3d.triangulate([flat]), dtype=int)
    return tuple(
        np.vstack([plane.polygon[t], plane.polygon[t] + depth]) for t in triangles if _height(flat[t]) > THIN_M
    )


def barriers(architecture: Architecture, objects: Iterable[Points]) -> tuple[StaticSlab, ...]:
    """Walls that nobody sees where a room has none, beyond what stands over the floor's edge there: robots stay inside.

    Args:
        architecture: With the floor.
        objects: Corners of each object in the world.
    """
    found: list[StaticSlab] = []
    corners = list(objects)
    for a, b in open_edges(architecture):
        length = float(np.linalg.norm(b - a))
        along = (b - a) / length
        outward = np.array([along[1], -along[0]])
        away = CLEAR_M
        spans = [((c[:, :2] - a) @ along, (c[:, :2] - a) @ outward) for c in corners]
        for beside, beyond in sorted(spans, key=lambda span: float(span[1].min())):
            meets = beside.max() > -away - MIN_SLAB_M and beside.min() < length + away + MIN_SLAB_M
            if meets and beyond.max() > away - CLEAR_M and beyond.min() < away + MIN_SLAB_M + CLEAR_M:
                away = float(beyond.max()) + CLEAR_M
        start, end = (a + away * outward - away * along, b + away * outward + away * along)
        plane = Plane(f"barrier_{len(found) + 1}", "wall", rectangle(start, end, (0, 1), heights(architecture)))
        found.append(StaticSlab(plane.id, plane, slab_pieces(plane)))
    return tuple(found)


def _height(triangle: Float[np.ndarray, "3 2"]) -> float:
    """Least height of a triangle: slivers are no bodies for a simulator."""
    sides = np.roll(triangle, -1, axis=0) - triangle
    doubled_area = abs(float(sides[0, 0] * sides[1, 1] - sides[0, 1] * sides[1, 0]))
    return doubled_area / max(float(np.linalg.norm(sides, axis=1).max()), 1e-12)


def _is_convex(outline: Float[np.ndarray, "n 2"]) -> bool:
    edges = np.roll(outline, -1, axis=0) - outline
    after = np.roll(edges, -1, axis=0)
    turns = edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]
    return bool((turns >= -1e-9).all() or (turns <= 1e-9).all())
