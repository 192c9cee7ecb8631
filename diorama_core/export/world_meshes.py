"""Surfaces of an export placed in the world: what formats without a scene graph write."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.export.gathering import ExportScene
from diorama_core.geometry.vectors import unit
from diorama_core.progress import SILENT, Progress
from diorama_core.render.appearance import Surface

Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Turns the world (+Z up) to +Y up."""


@dataclass(frozen=True, eq=False)
class WorldMesh:
    """One object or plane with its surfaces in the world."""

    id: str
    name: str
    surfaces: tuple[Surface, ...]


def world_meshes(
    scene: ExportScene, progress: Progress = SILENT, *, R: Float[np.ndarray, "3 3"] | None = None
) -> Iterator[WorldMesh]:
    """Planes, then objects, one at a time, so that only one is in memory.

    Args:
        scene: What is written.
        progress: Where objects are counted and cancelling is noticed.
        R: Turns the world into the file's frame; None keeps +Z up.
    """
    total = max(1, len(scene.planes) + len(scene.objects))
    for number, plane in enumerate(scene.planes):
        progress.report(number / total, f"writing {plane.name}")
        yield WorldMesh(plane.id, plane.name, _place(scene.meshes[plane.mesh].surfaces, np.eye(4), R))
    for number, item in enumerate(scene.objects, start=len(scene.planes)):
        progress.report(number / total, f"writing {item.name}")
        matrix = item.T_world.copy()
        matrix[:3, :3] = matrix[:3, :3] * item.scale
        yield WorldMesh(item.id, item.name, _place(scene.meshes[item.mesh].surfaces, matrix, R))
    progress.report(1.0, "finishing the file")


def _place(
    surfaces: tuple[Surface, ...], matrix: Float[np.ndarray, "4 4"], R: Float[np.ndarray, "3 3"] | None
) -> tuple[Surface, ...]:
    turn = np.eye(3) if R is None else R
    linear, offset = turn @ matrix[:3, :3], turn @ matrix[:3, 3]
    back = np.linalg.inv(linear)
    return tuple(
        replace(
            s,
            vertices=(s.vertices @ linear.T + offset).astype(np.float32),
            normals=unit(s.normals @ back).astype(np.float32),
        )
        for s in surfaces
    )
