"""The parametric `room.usdz` of RoomPlan: named meshes as walls, openings, floors and boxes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast, get_args

import numpy as np
from jaxtyping import Float
from shapely.geometry import MultiPolygon, Polygon
from shapely.ops import unary_union

from diorama_core.errors import InputError
from diorama_core.importing.measured_types import (
    MeasuredBox,
    MeasuredOpening,
    MeasuredRoom,
    MeasuredWall,
    OpeningKind,
)
from diorama_core.importing.roomplan_parts import (
    KINDS,
    MAX_PARTS,
    box_of,
    join_floors,
    move,
    storey_notes,
    without_unusable,
)
from diorama_core.library.ingest.usd_stage import Z_UP

_NAMED = re.compile(r"^([A-Za-z]+?)_?\d*$")


def read_usd(path: Path) -> MeasuredRoom | None:
    """What RoomPlan measured, from its USDZ; None where the file is not from it."""
    from diorama_core.library.ingest.usd_stage import open_stage, usd_errors

    stage = open_stage(path)
    with usd_errors(path):
        return _from_stage(stage, path)


def _from_stage(stage: Any, path: Path) -> MeasuredRoom | None:
    meshes = list(_meshes(stage))
    if not any(re.search(r"/(Parametric|Arch)_grp(/|$)", mesh.path) for mesh in meshes):
        return None
    if len(meshes) > MAX_PARTS:
        raise InputError(f"{path.name} has more than {MAX_PARTS} parts; export the scan again")
    known = {name.lower(): name for name in KINDS}
    walls: list[MeasuredWall] = []
    openings: list[MeasuredOpening] = []
    boxes: list[MeasuredBox | str] = []
    floors = [mesh for mesh in meshes if mesh.word == "Floor"]
    for mesh in meshes:
        word = mesh.word.lower()
        size, at = mesh.high - mesh.low, mesh.M_world.copy()
        at[:3, 3] = move(mesh.M_world, (mesh.low + mesh.high) / 2)
        if word == "wall":
            walls.append(_usd_wall(at, size, len(walls) + 1))
        elif word in get_args(OpeningKind):
            kind = cast(OpeningKind, word)
            openings.append(MeasuredOpening(kind, at[:3, 3], float(size[[0, 2]].max()), float(size[1])))
        elif word in known:
            boxes.append(box_of(known[word], KINDS[known[word]], at, size, 1.0))
    joined = join_floors([f.outline for f in floors], [f.top_m for f in floors])
    upright, left_out = without_unusable(boxes)
    return MeasuredRoom(tuple(walls), upright, tuple(openings), joined, (*storey_notes(joined), *left_out))


def _usd_wall(at: Float[np.ndarray, "4 4"], size: Float[np.ndarray, "3"], number: int) -> MeasuredWall:
    """A wall's slab: its middle plane and how thick it is."""
    along, thin = (0, 2) if size[0] >= size[2] else (2, 0)
    corners = np.zeros((4, 3))
    corners[:, along] = np.array([-1, 1, 1, -1]) * size[along] / 2
    corners[:, 1] = np.array([-1, -1, 1, 1]) * size[1] / 2
    return MeasuredWall(f"wall-{number}", move(at, corners), float(size[thin]))


@dataclass(frozen=True, eq=False)
class _Mesh:
    """A mesh of a USD stage."""

    path: str
    M_world: Float[np.ndarray, "4 4"]
    """Its axes in the world, rigid."""
    low: Float[np.ndarray, "3"]
    high: Float[np.ndarray, "3"]
    """Bounds along its own axes, metres."""
    outline: Polygon
    """Seen from above."""
    top_m: float

    @property
    def word(self) -> str:
        """Its name without the number."""
        match = _NAMED.match(self.path.rpartition("/")[2])
        return match[1] if match else ""


def _meshes(stage: Any) -> Iterator[_Mesh]:
    from pxr import Usd, UsdGeom

    from diorama_core.library.ingest.usd_stage import matrix_of

    places = UsdGeom.XformCache()
    metres = float(UsdGeom.GetStageMetersPerUnit(stage))
    for prim in Usd.PrimRange(stage.GetPseudoRoot()):
        if not prim.IsA(UsdGeom.Mesh):
            continue
        mesh = UsdGeom.Mesh(prim)
        points = np.asarray(mesh.GetPointsAttr().Get() or [], np.float64).reshape(-1, 3)
        if len(points) < 3 or not np.isfinite(points).all():
            continue
        M = matrix_of(places.GetLocalToWorldTransform(prim))
        lengths = np.linalg.norm(M[:3, :3], axis=0)
        points = points * lengths * metres
        M = M.copy()
        M[:3, :3] /= np.maximum(lengths, 1e-12)
        M[:3, 3] *= metres
        if np.allclose(M[:3, :3], np.eye(3), atol=1e-6):
            M, points = _unbake(M, points)
        M = Z_UP @ M
        placed = move(M, points)
        outline = _outline_of(placed, mesh.GetFaceVertexCountsAttr().Get(), mesh.GetFaceVertexIndicesAttr().Get())
        yield _Mesh(str(prim.GetPath()), M, points.min(axis=0), points.max(axis=0), outline, float(placed[:, 2].max()))


def _unbake(
    M: Float[np.ndarray, "4 4"], points: Float[np.ndarray, "n 3"]
) -> tuple[Float[np.ndarray, "4 4"], Float[np.ndarray, "n 3"]]:
    """The axes of a mesh whose points are in the room's: those of the smallest rectangle around it, from above."""
    import cv2

    _, (a, b), angle = cv2.minAreaRect(points[:, [0, 2]].astype(np.float32))
    turn = np.radians(angle if a >= b else angle + 90.0)
    along = np.array([np.cos(turn), 0.0, np.sin(turn)])
    R = np.stack([along, [0.0, 1.0, 0.0], np.cross(along, [0.0, 1.0, 0.0])], axis=1)
    turned = np.eye(4)
    turned[:3, :3] = R
    turned[:3, 3] = M[:3, 3]
    return turned, points @ R


def _outline_of(points: Float[np.ndarray, "n 3"], counts: Any, indices: Any) -> Polygon:
    """What a mesh covers, seen from above; the largest piece."""
    numbers, ends = np.asarray(indices if indices is not None else [], int), np.cumsum(counts if counts else [0])
    if len(numbers) != ends[-1] or (len(numbers) and not 0 <= numbers.min() <= numbers.max() < len(points)):
        raise InputError("the file has a mesh whose faces make no sense; export the scan again")
    faces = [Polygon(points[face, :2]).buffer(0) for face in np.split(numbers, ends[:-1]) if len(face) >= 3]
    whole = unary_union(faces)
    largest = max(whole.geoms, key=lambda p: p.area) if isinstance(whole, MultiPolygon) else whole
    return largest if isinstance(largest, Polygon) else Polygon()
