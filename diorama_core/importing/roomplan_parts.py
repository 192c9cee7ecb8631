"""Parts of a RoomPlan scan: boxes with their kinds, floors joined to storeys, and the parametric `room.usdz`.

Its named meshes are walls, openings, floors and boxes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast, get_args

import numpy as np
from jaxtyping import Float
from shapely.geometry import LineString, MultiPolygon, Point, Polygon
from shapely.ops import polygonize, unary_union

from diorama_core.errors import InputError
from diorama_core.geometry.rooms import floor_under
from diorama_core.importing.measured_types import (
    MeasuredBox,
    MeasuredFloor,
    MeasuredOpening,
    MeasuredRoom,
    MeasuredWall,
    OpeningKind,
)
from diorama_core.importing.storeys import largest_polygon
from diorama_core.io.bounded import shorten
from diorama_core.library.ingest.usd_stage import Z_UP
from diorama_core.library.labels import meanings
from diorama_core.library.taxonomy import UNKNOWN, column, resolve

SAME_LEVEL_M = 0.3
"""Floors whose heights differ by less are of one storey."""
CORNER_M = 0.25
"""Ends of walls that are so near to another wall meet it."""
THINNEST_ROOM_M = 0.5
"""What is narrower is between the faces of a wall."""
MIN_SIDE_M = 0.01
"""Share of the second longest side of a thing."""
MAX_PARTS = 5_000
"""Walls, openings and objects of one scan."""
KINDS: Mapping[str, Mapping[str, float]] = {
    word: {kind: shares[word] for kind, shares in column("roomplan").items() if word in shares}
    for word in dict.fromkeys(word for shares in column("roomplan").values() for word in shares)
}
"""What RoomPlan's categories may be here; within a category sizes decide."""
ATTRIBUTES: Mapping[str, str] = {
    "dining": "",
    "coffee": "coffee table",
    "swivel": "office chair",
    "stool": "stool",
    "shelf": "bookshelf",
    "cabinet": "cabinet",
    "lShaped": "sectional sofa",
    "singleSeat": "armchair",
}
"""Kinds that attributes name (iOS 17 and later)."""


def without_unusable(rows: Iterable[MeasuredBox | str]) -> tuple[tuple[MeasuredBox, ...], tuple[str, ...]]:
    """The boxes, and a line for each that is none."""
    made = list(rows)
    lines = tuple(
        f"a {word} lies on its side or has no size, and was left out" for word in made if isinstance(word, str)
    )
    return tuple(box for box in made if isinstance(box, MeasuredBox)), lines


def kinds_of_label(label: str) -> frozenset[str]:
    """What a thing may be that a scan calls so; nothing where RoomPlan has no such word."""
    return frozenset(next((kinds for word, kinds in KINDS.items() if words(word) == label), ()))


def words(word: str) -> str:
    """A category as words, as in "dining table"."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", word).lower()


def kinds_of(word: str, attributes: tuple[str, ...] = ()) -> Mapping[str, float]:
    """What a thing of RoomPlan's category, with its attributes, may be, and how often it is."""
    resolution = resolve(words(word))
    kinds = KINDS.get(word) or (
        meanings(words(word), resolution.category.name) if resolution.exact else {UNKNOWN.name: 1.0}
    )
    named = [kind for a in attributes for end, kind in ATTRIBUTES.items() if kind and a.lower().endswith(end.lower())]
    return {named[0]: 1.0} if named else kinds


def box_of(
    word: str, kinds: Mapping[str, float], M: Float[np.ndarray, "4 4"], size: Float[np.ndarray, "3"], confidence: float
) -> MeasuredBox | str:
    """A box in our axes, upright: x is RoomPlan's z, and z its y; its word where it lies on its side or is empty.

    Args:
        word: RoomPlan's category.
        kinds: what it may be.
        M: its transform to the world, +Z up; rigid.
        size: along RoomPlan's axes, metres.
        confidence: 0 to 1.
    """
    front = M[:3, 2].copy()
    front[2] = 0.0
    length = float(np.linalg.norm(front))
    if length < 0.5 or np.sort(size)[1] < MIN_SIDE_M:
        return shorten(words(word) or "thing")
    front /= length
    up = np.array([0.0, 0.0, 1.0])
    R = np.stack([front, np.cross(up, front), up], axis=1)
    return MeasuredBox(words(word), kinds, R, M[:3, 3].copy(), np.maximum(size[[2, 0, 1]], 0.01), confidence)


def move(M: Float[np.ndarray, "4 4"], points: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
    """Points under a rigid motion."""
    return points @ M[:3, :3].T + M[:3, 3]


def join_floors(floors: Sequence[Polygon], heights_m: Sequence[float]) -> tuple[MeasuredFloor, ...]:
    """Floors that touch at about one height are one; others are rooms and storeys of their own, the lowest first."""
    joined: list[MeasuredFloor] = []
    left = sorted(zip(heights_m, floors, strict=True), key=lambda row: row[0])
    if not np.isfinite(heights_m).all():
        raise InputError("a floor's height is no number; export the scan again")
    while left:
        level = [row for row in left if row[0] - left[0][0] < SAME_LEVEL_M]
        left = left[len(level) :]
        whole = unary_union([f.buffer(0) for _, f in level])
        pieces = whole.geoms if isinstance(whole, MultiPolygon) else [whole]
        height = float(np.median([h for h, _ in level]))
        for piece in sorted(pieces, key=lambda p: -p.area):
            if isinstance(piece, Polygon) and not piece.is_empty:
                joined.append(MeasuredFloor(np.asarray(piece.exterior.coords)[:-1, :2], height))
    return tuple(joined)


def name_floors(
    floors: Sequence[MeasuredFloor],
    sections: Sequence[tuple[str, Float[np.ndarray, "3"]]],
    walls: Sequence[MeasuredWall],
) -> tuple[MeasuredFloor, ...]:
    """Floors by the names of the sections on them; one of several sections is parted by the walls between them.

    Args:
        floors: as measured.
        sections: names with their middles in the world.
        walls: of the home.
    """
    if not floors or not sections:
        return tuple(floors)
    outlines, heights = [f.outline for f in floors], [f.height_m for f in floors]
    under = floor_under(np.array([at for _, at in sections]), outlines, heights)
    named: list[MeasuredFloor] = []
    for number, floor in enumerate(floors):
        on_it = [(name, Point(at[:2])) for (name, at), k in zip(sections, under, strict=True) if k == number]
        cells = _cells(floor, walls) if len(on_it) > 1 else []
        if sum(any(cell.contains(at) for _, at in on_it) for cell in cells) < 2:
            named.append(replace(floor, name=" and ".join(dict.fromkeys(name for name, _ in on_it))))
            continue
        for cell in cells:
            name = " and ".join(dict.fromkeys(name for name, at in on_it if cell.contains(at)))
            named.append(MeasuredFloor(np.asarray(cell.exterior.coords)[:-1, :2], floor.height_m, name))
    return tuple(named)


def _cells(floor: MeasuredFloor, walls: Sequence[MeasuredWall]) -> list[Polygon]:
    """The rooms that walls make of a floor, without what is between the faces of a wall."""
    outline = Polygon(floor.outline)
    lines = [outline.exterior]
    for wall in walls:
        if abs(float(wall.polygon[:, 2].min()) - floor.height_m) < SAME_LEVEL_M:
            ends = wall.polygon[[0, int(np.linalg.norm((wall.polygon - wall.polygon[0])[:, :2], axis=1).argmax())], :2]
            reach = (ends[1] - ends[0]) / max(float(np.linalg.norm(ends[1] - ends[0])), 1e-9) * CORNER_M
            lines.append(LineString([ends[0] - reach, ends[1] + reach]))
    cells = [c for c in polygonize(unary_union(lines)) if outline.contains(c.representative_point())]
    return [c for c in cells if not c.buffer(-THINNEST_ROOM_M / 2).is_empty]


def storey_notes(floors: Sequence[MeasuredFloor]) -> tuple[str, ...]:
    """What is said of several floors."""
    heights = sorted({round(f.height_m, 2) for f in floors})
    if len(heights) > 1:
        listed = ", ".join(f"{h:g}" for h in heights)
        return (f"{len(heights)} storeys, whose floors are at {listed} m: each has its floor and what stands on it",)
    return (f"a home of {len(floors)} rooms, each with its own floor",) if len(floors) > 1 else ()


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
    return largest_polygon(unary_union(faces)) or Polygon()
