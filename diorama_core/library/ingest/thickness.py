"""Flat models get a thickness: packs have pictures, mirrors and rugs as single rectangles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import trimesh
from jaxtyping import Float
from trimesh.visual.texture import TextureVisuals

FLAT = 1e-3
"""Share of the longest side below which a model is flat."""
THICKNESS = 0.005
"""Thickness given to a flat model, as a share of its longest side: 4 mm for a picture, 1 cm for a rug."""


def with_thickness(meshes: Sequence[trimesh.Trimesh]) -> tuple[tuple[trimesh.Trimesh, ...], bool]:
    """The meshes, and whether they are together flat along an axis: then each is a front, a back and a rim.

    The middle plane stays where it was.
    """
    bounds = np.array([m.bounds for m in meshes])
    extents = bounds[:, 1].max(axis=0) - bounds[:, 0].min(axis=0)
    axis, longest = int(extents.argmin()), float(extents.max())
    if extents[axis] >= FLAT * longest:
        return tuple(meshes), False
    offset = np.zeros(3)
    offset[axis] = THICKNESS * longest / 2
    return tuple(_thick(mesh, offset) for mesh in meshes), True


def _thick(mesh: trimesh.Trimesh, offset: Float[np.ndarray, "3"]) -> trimesh.Trimesh:
    """A mesh as a front, a back behind it, and a rim along its border, all in its own material."""
    normals = mesh.face_normals @ offset
    faces = np.where((normals < 0)[:, None], mesh.faces[:, ::-1], mesh.faces)
    count = len(mesh.vertices)
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, index, counts = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    a, b = edges[index[counts == 1]].T
    rim = np.concatenate([np.stack([a, a + count, b], axis=1), np.stack([b, a + count, b + count], axis=1)])
    vertices = np.concatenate([mesh.vertices + offset, mesh.vertices - offset])
    visual = mesh.visual
    if isinstance(visual, TextureVisuals):
        visual = TextureVisuals(uv=np.concatenate([visual.uv, visual.uv]), material=visual.material)
    elif visual.kind == "vertex":
        visual = trimesh.visual.ColorVisuals(vertex_colors=np.concatenate([visual.vertex_colors] * 2))
    everything = np.concatenate([faces, faces[:, ::-1] + count, rim])
    return trimesh.Trimesh(vertices, everything, visual=visual, process=False, metadata=dict(mesh.metadata))
