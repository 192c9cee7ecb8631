"""Small surfaces made by hand."""

from __future__ import annotations

import numpy as np
import trimesh

from diorama_core.render.appearance import Material, Surface


def quad(material: Material | None = None, *, uv: bool = True, turn: np.ndarray | None = None) -> Surface:
    """A square of two metres in the plane z = 0, looking up; u along x, v along y."""
    R = np.eye(3) if turn is None else turn
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=float)
    return Surface(
        vertices=(corners @ R.T).astype(np.float32),
        normals=np.tile(R[:, 2], (4, 1)).astype(np.float32),
        faces=np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        material=material or Material("oak", (0.5, 0.25, 0.1)),
        uv=np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32) if uv else None,
    )


def ball(material: Material | None = None, radius: float = 0.1) -> Surface:
    """A closed ball."""
    mesh = trimesh.creation.icosphere(3, radius)
    return Surface(
        mesh.vertices.astype(np.float32),
        mesh.vertex_normals.astype(np.float32),
        mesh.faces.astype(np.int32),
        material or Material("steel", (0.5, 0.5, 0.5)),
    )
