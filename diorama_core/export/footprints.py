"""What objects cover on the floor, or of a wall: outlines of their meshes seen from above, or from before it."""

from __future__ import annotations

import manifold3d
import numpy as np
from jaxtyping import Float, Int

from diorama_core.export.gathering import ExportMesh, ExportObject, ExportScene
from diorama_core.geometry.planes import signed_area

Outline = Float[np.ndarray, "_ 2"]
GRID_M = 0.0005
"""Vertices are taken together on a grid of this size before the union: outlines are drawn at 1:20 at most."""
GAP_M = 0.002
"""Gaps between parts that are narrower than this are closed."""
SIMPLER_M = 0.002
"""Deviation allowed when points are left out of an outline."""
UPRIGHT = 0.999
"""Cosine from which on an object stands upright, so that its shape's outline only has to be turned."""
AT_ONCE = 500
"""Triangles united at once."""


def silhouette(scene: ExportScene, item: ExportObject, axes: Float[np.ndarray, "2 3"]) -> tuple[Outline, ...]:
    """Outlines of an object along two axes of the world; holes are left out."""
    matrix = item.T_world.copy()
    matrix[:3, :3] = matrix[:3, :3] * item.scale
    return outline(_flat(scene.meshes[item.mesh], axes @ matrix[:3]))


def footprints(scene: ExportScene) -> dict[str, tuple[Outline, ...]]:
    """Outlines of every object in the world's x and y, by object id; holes are left out."""
    shapes: dict[str, tuple[Outline, ...]] = {}
    outlines = {}
    for item in scene.objects:
        if item.T_world[2, 2] > UPRIGHT:
            if item.mesh not in shapes:
                shapes[item.mesh] = outline(_flat(scene.meshes[item.mesh], np.eye(2, 4)))
            outlines[item.id] = tuple(_place(o, item) for o in shapes[item.mesh])
        else:
            outlines[item.id] = silhouette(scene, item, np.eye(2, 3))
    return outlines


def outline(triangles: Float[np.ndarray, "n 3 2"]) -> tuple[Outline, ...]:
    """The outer boundaries of the union of triangles, counter-clockwise."""
    cells = np.round(triangles / GRID_M).astype(np.int64)
    a, b, c = cells[:, 0], cells[:, 1], cells[:, 2]
    turn = np.sign((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    if not turn.any():
        return ()
    if _is_closed(cells):
        cells = cells[turn > 0]  # what is seen from below covers the same
    else:
        cells = np.where((turn < 0)[:, None, None], cells[:, ::-1], cells)[turn != 0]
    snapped = np.unique(cells.astype(np.int32), axis=0) * GRID_M
    order = np.argsort(snapped[:, 0, 0] + 0.37 * snapped[:, 0, 1])
    blocks = [
        manifold3d.CrossSection(list(snapped[order[i : i + AT_ONCE]]), manifold3d.FillRule.Positive)
        for i in range(0, len(order), AT_ONCE)
    ]
    whole = manifold3d.CrossSection.batch_boolean(blocks, manifold3d.OpType.Add) if len(blocks) > 1 else blocks[0]
    # A little wider and back again: parts that only touch become one.
    whole = whole.offset(GAP_M / 2, manifold3d.JoinType.Miter).offset(-GAP_M / 2, manifold3d.JoinType.Miter)
    polygons = [np.asarray(p) for p in whole.simplify(SIMPLER_M).to_polygons()]
    return tuple(p for p in polygons if signed_area(p) > 1e-5)


def _is_closed(cells: Int[np.ndarray, "n 3 2"]) -> bool:
    """Whether every edge is run through as often in one direction as in the other, seen from above.

    Then the triangles seen from above and those seen from below cover every place equally often, as those of a closed
    body do: chains of triangles in a plane that have no boundary cancel.
    """
    corners = cells - cells.min(axis=(0, 1))
    across = int(corners.max()) + 1
    if across**4 >= 2**63:
        return False  # an edge is no longer one number
    start = corners[..., 0] * across + corners[..., 1]
    end = np.roll(start, -1, axis=1)
    return np.array_equal(np.sort(start * across**2 + end, axis=None), np.sort(end * across**2 + start, axis=None))


def _flat(mesh: ExportMesh, matrix: Float[np.ndarray, "2 4"]) -> Float[np.ndarray, "n 3 2"]:
    linear, offset = matrix[:, :3], matrix[:, 3]
    return np.concatenate([(s.vertices @ linear.T + offset)[s.faces] for s in mesh.surfaces])


def _place(shape: Outline, item: ExportObject) -> Outline:
    return (shape * item.scale[:2]) @ item.T_world[:2, :2].T + item.T_world[:2, 3]
