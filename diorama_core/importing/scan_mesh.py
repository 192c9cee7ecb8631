"""Scans that come as a mesh in a scene file: one surface of a room's size, made of many small triangles."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import trimesh

from diorama_core.importing.part import Part
from diorama_core.importing.point_cloud import PointCloud, points_of_mesh

MIN_SPAN_M, MIN_HEIGHT_M = 2.0, 1.5
"""Smallest room: the shorter side of its plan, and its height."""
MIN_TRIANGLES = 2000
LONG_EDGE_M = 0.6
"""Scanners make few larger triangles than this, unless the mesh was reduced."""
MIN_SMALL = 0.85
"""Share of the area in smaller triangles."""
EXACT_COS, EXACT_M, MIN_PLANE_M2 = 1e-3, 2e-3, 0.3
"""Steps of normals and offsets within which modelled faces lie in one plane, and the least such plane that counts."""
MAX_EXACT = 0.35
"""Share of the area in exact planes: a reduced scan has large triangles, but none of them are level or upright."""
MIN_SHARE = 0.7
"""Smallest share of the file's area in one scan; chairs modelled beside it leave less."""
SAID_NOTHING = re.compile(
    r"^(mesh|node|object|obj|geometry|geom|default|scan|chunk|group|root|scene|world|model|textured|output|material|mat|"
    r"polygon|part|piece|sub|tile|raw|export|[0-9a-f]{6,}|[\d_.\s-])*$",
    re.IGNORECASE,
)
"""Names that programs give: no word in them is anybody's."""


def scan_in(parts: Sequence[Part]) -> PointCloud | None:
    """The points of a scan, where the parts of a file are one; None where they are modelled.

    Args:
        parts: in the world, +Z up, metres.
    """
    meshes = [p.whole for p in parts]
    if not meshes:
        return None
    largest = max(range(len(parts)), key=lambda k: meshes[k].area)
    nameless = all(SAID_NOTHING.match(p.name) for p in parts)
    whole = trimesh.util.concatenate(meshes) if nameless and len(meshes) > 1 else meshes[largest]
    if whole.area < MIN_SHARE * sum(m.area for m in meshes) or not is_scanned(whole):
        return None
    return PointCloud(points_of_mesh(whole), np.array([0.0, 0.0, 1.0]), ("the mesh was read as a scan of a room",))


def is_scanned(mesh: trimesh.Trimesh) -> bool:
    """Whether a mesh is as large as a room and made of small triangles all over."""
    x, y, height = mesh.extents
    if min(x, y) < MIN_SPAN_M or height < MIN_HEIGHT_M or len(mesh.faces) < MIN_TRIANGLES:
        return False
    corners = mesh.triangles
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    small = float(mesh.area_faces[longest < LONG_EDGE_M].sum() / max(mesh.area, 1e-12))
    return small > MIN_SMALL or _exact_share(mesh) < MAX_EXACT


def _exact_share(mesh: trimesh.Trimesh) -> float:
    """Share of the area that lies in exact planes of some size."""
    offsets = (mesh.face_normals * mesh.triangles_center).sum(axis=1)
    keys = np.column_stack([np.round(mesh.face_normals / EXACT_COS), np.round(offsets / EXACT_M)])
    _, which = np.unique(keys, axis=0, return_inverse=True)
    areas = np.bincount(which.reshape(-1), mesh.area_faces)
    return float(areas[areas > MIN_PLANE_M2].sum() / max(mesh.area, 1e-12))
