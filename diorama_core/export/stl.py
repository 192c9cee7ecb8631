"""A scene as binary STL: bare triangles in millimetres, +Z up, as slicers and CAD programs take them."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from diorama_core.export.files import whole_file
from diorama_core.export.gathering import ExportScene
from diorama_core.export.world_meshes import world_meshes
from diorama_core.geometry.vectors import unit
from diorama_core.progress import SILENT, Progress

MM_PER_M = 1000.0
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(scene: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write all triangles, as `Writer` says."""
    with whole_file(Path(path)) as temporary, temporary.open("wb") as stream:
        stream.write(b"Diorama: millimetres, +Z up".ljust(80, b" ") + struct.pack("<I", 0))
        count = 0
        for mesh in world_meshes(scene, progress):
            for surface in mesh.surfaces:
                rows = np.zeros(len(surface.faces), TRIANGLE)
                corners = surface.vertices[surface.faces].astype(np.float64) * MM_PER_M
                rows["normal"] = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
                rows["corners"] = corners
                stream.write(rows.tobytes())
                count += len(rows)
        stream.seek(80)
        stream.write(struct.pack("<I", count))
