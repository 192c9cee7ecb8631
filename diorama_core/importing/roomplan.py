"""Scans of Apple RoomPlan: `CapturedRoom` (or `CapturedStructure`) as JSON, and the parametric `room.usdz`.

RoomPlan is y-up and metric. The axes of a wall or an object are x along its width, y up, and z out of its front.
https://developer.apple.com/documentation/roomplan/capturedroom
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, cast

import numpy as np
from jaxtyping import Float
from shapely.geometry import MultiPolygon, Polygon
from shapely.ops import unary_union

from diorama_core.errors import InputError
from diorama_core.importing.measured_types import (
    MeasuredBox,
    MeasuredFloor,
    MeasuredOpening,
    MeasuredRoom,
    MeasuredWall,
)
from diorama_core.io.bounded import read_json, shortened
from diorama_core.library.hyponyms import meanings
from diorama_core.library.ingest.usd_stage import Z_UP
from diorama_core.library.taxonomy import UNKNOWN, column, resolve

MAX_JSON_BYTES = 64_000_000
REACH_M = 10_000.0
SAME_LEVEL_M = 0.3
"""Floors whose heights differ by less are of one storey."""
MIN_SIDE_M = 0.01
"""Of the second longest side of a thing."""
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
CONFIDENCE = {"high": 1.0, "medium": 0.7, "low": 0.4}
_SURFACES: Mapping[str, Literal["door", "window", "opening"]] = {
    "doors": "door",
    "windows": "window",
    "openings": "opening",
}
_NAMED = re.compile(r"^([A-Za-z]+?)_?\d*$")


def read_room_plan(path: Path) -> MeasuredRoom | None:
    """What RoomPlan measured; None for a file that is not from it.

    Raises:
        InputError: it cannot be read, or makes no sense.
        UnavailableError: a USDZ, and usd-core is missing.
    """
    room = _from_json(path) if path.suffix.lower() == ".json" else _from_usd(path)
    if room is not None and not _within_reach(room):
        raise InputError(f"{path.name}: something in it is not within {REACH_M / 1000:.0f} km; export the scan again")
    return room


def _within_reach(room: MeasuredRoom) -> bool:
    """Whether all that was measured is finite, and near enough to be computed with."""
    numbers: list[np.ndarray] = [wall.polygon for wall in room.walls]
    numbers += [values for box in room.boxes for values in (box.centre, box.size_m)]
    numbers += [opening.centre for opening in room.openings]
    numbers += [np.array([opening.width_m, opening.height_m]) for opening in room.openings]
    numbers += [np.array([wall.thickness_m for wall in room.walls])]
    numbers += [values for floor in room.floors for values in (floor.outline, np.array(floor.height_m))]
    return all(bool((np.abs(values) < REACH_M).all()) for values in numbers)


def _from_json(path: Path) -> MeasuredRoom | None:
    document = read_json(path, InputError, most=MAX_JSON_BYTES, advice="export the scan again")
    if not isinstance(document, dict) or not isinstance(document.get("walls"), list):
        return None
    names = {key: document.get(key) or [] for key in ("walls", "objects", "floors", *_SURFACES)}
    if not all(isinstance(rows, list) for rows in names.values()) or sum(map(len, names.values())) > MAX_PARTS:
        raise InputError(f"{path.name}: more than {MAX_PARTS} parts, or lists that are none; export the scan again")
    try:
        walls = tuple(_json_wall(row, number) for number, row in enumerate(names["walls"], 1))
        ids = {str(row.get("identifier")): wall.id for row, wall in zip(names["walls"], walls, strict=True)}
        openings = tuple(_json_opening(row, kind, ids) for key, kind in _SURFACES.items() for row in names[key])
        boxes, left_out = _upright(_json_box(row) for row in names["objects"])
        floors = [_outline(row) for row in names["floors"]]
    except (LookupError, TypeError, ValueError, AttributeError, ArithmeticError) as error:
        raise InputError(
            f"{path.name}: a wall or an object makes no sense ({shortened(str(error))}); export the scan again"
        ) from error
    joined = _joined([Polygon(f[:, :2]) for f in floors], [float(f[:, 2].mean()) for f in floors])
    unsure = sum(box.confidence < CONFIDENCE["medium"] for box in boxes)
    curved = sum(row.get("curve") is not None for row in names["walls"])
    notes = [f"RoomPlan was unsure of {unsure} of {len(boxes)} objects"] if unsure else []
    notes += [f"{curved} curved walls are flat from end to end"] if curved else []
    return MeasuredRoom(walls, boxes, openings, joined, (*notes, *_storey_notes(joined), *left_out))


def _matrix(row: Mapping[str, Any]) -> Float[np.ndarray, "4 4"]:
    """The transform to the world, +Z up; the file has columns, flat or nested."""
    M = np.asarray(row["transform"], np.float64).reshape(4, 4).T
    if not np.isfinite(M).all() or abs(abs(np.linalg.det(M[:3, :3])) - 1.0) > 1e-2:
        raise ValueError("its transform is no rotation")
    return Z_UP @ M


def _dimensions(row: Mapping[str, Any]) -> Float[np.ndarray, "3"]:
    size = np.asarray(row["dimensions"], np.float64)
    if size.shape != (3,) or not np.isfinite(size).all() or (size < 0).any() or size.max() > 1000:
        raise ValueError("its dimensions are no lengths")
    return size


def _word(value: object) -> str:
    """The name of a Swift enumeration's case: a string, or an object with one key."""
    return next(iter(value), "") if isinstance(value, dict) else str(value)


def _json_wall(row: Mapping[str, Any], number: int) -> MeasuredWall:
    return MeasuredWall(f"wall-{number}", _outline(row), float(_dimensions(row)[2]))


def _json_opening(
    row: Mapping[str, Any], kind: Literal["door", "window", "opening"], walls: Mapping[str, str]
) -> MeasuredOpening:
    size = _dimensions(row)
    wall = walls.get(str(row.get("parentIdentifier")))
    return MeasuredOpening(kind, _matrix(row)[:3, 3], float(size[0]), float(size[1]), wall)


def _upright(rows: Iterable[MeasuredBox | str]) -> tuple[tuple[MeasuredBox, ...], tuple[str, ...]]:
    """The boxes, and a line for each that is none."""
    made = list(rows)
    lines = tuple(
        f"a {word} lies on its side or has no size, and was left out" for word in made if isinstance(word, str)
    )
    return tuple(box for box in made if isinstance(box, MeasuredBox)), lines


def _json_box(row: Mapping[str, Any]) -> MeasuredBox | str:
    attributes = row.get("attributes") or {}
    values = attributes.values() if isinstance(attributes, dict) else attributes
    kinds = _kinds(_word(row["category"]), tuple(_word(v) for v in values))
    confidence = CONFIDENCE.get(_word(row.get("confidence", "high")), 1.0)
    return _box(_word(row["category"]), kinds, _matrix(row), _dimensions(row), confidence)


def _outline(row: Mapping[str, Any]) -> Float[np.ndarray, "n 3"]:
    """Corners of a wall or a floor in the world; its corners, or its dimensions along x and y, are in its own plane."""
    local = np.asarray(row.get("polygonCorners") or [], np.float64).reshape(-1, 3)
    if len(local) < 3:
        width, length, _ = _dimensions(row)
        local = np.array([[x * width / 2, y * length / 2, 0.0] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    if not np.isfinite(local).all():
        raise ValueError("its corners are no places")
    return _moved(_matrix(row), local)


def kinds_of_label(label: str) -> frozenset[str]:
    """What a thing may be that a scan calls so; nothing where RoomPlan has no such word."""
    return frozenset(next((kinds for word, kinds in KINDS.items() if _spoken(word) == label), ()))


def _spoken(word: str) -> str:
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", word).lower()


def _kinds(word: str, attributes: tuple[str, ...] = ()) -> Mapping[str, float]:
    found = resolve(_spoken(word))
    kinds = KINDS.get(word) or (meanings(_spoken(word), found.category.name) if found.exact else {UNKNOWN.name: 1.0})
    named = [kind for a in attributes for end, kind in ATTRIBUTES.items() if kind and a.lower().endswith(end.lower())]
    return {named[0]: 1.0} if named else kinds


def _box(
    word: str, kinds: Mapping[str, float], M: Float[np.ndarray, "4 4"], size: Float[np.ndarray, "3"], confidence: float
) -> MeasuredBox | str:
    """A box in our axes, upright: x is RoomPlan's z, and z its y; its word where it lies on its side or is empty."""
    front = M[:3, 2].copy()
    front[2] = 0.0
    length = float(np.linalg.norm(front))
    if length < 0.5 or np.sort(size)[1] < MIN_SIDE_M:
        return shortened(_spoken(word) or "thing")
    front /= length
    up = np.array([0.0, 0.0, 1.0])
    R = np.stack([front, np.cross(up, front), up], axis=1)
    return MeasuredBox(_spoken(word), kinds, R, M[:3, 3].copy(), np.maximum(size[[2, 0, 1]], 0.01), confidence)


def _moved(M: Float[np.ndarray, "4 4"], points: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
    return points @ M[:3, :3].T + M[:3, 3]


def _joined(floors: Sequence[Polygon], heights_m: Sequence[float]) -> tuple[MeasuredFloor, ...]:
    """Floors that touch at about one height are one; others are rooms and storeys of their own, the lowest first."""
    found: list[MeasuredFloor] = []
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
                found.append(MeasuredFloor(np.asarray(piece.exterior.coords)[:-1, :2], height))
    return tuple(found)


def _storey_notes(floors: Sequence[MeasuredFloor]) -> tuple[str, ...]:
    heights = sorted({round(f.height_m, 2) for f in floors})
    if len(heights) > 1:
        listed = ", ".join(f"{h:g}" for h in heights)
        return (f"{len(heights)} storeys, whose floors are at {listed} m: each has its floor and what stands on it",)
    return (f"a home of {len(floors)} rooms, each with its own floor",) if len(floors) > 1 else ()


def _from_usd(path: Path) -> MeasuredRoom | None:
    from diorama_core.library.ingest.usd_stage import opened_stage, usd_errors

    stage = opened_stage(path)
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
        at[:3, 3] = _moved(mesh.M_world, (mesh.low + mesh.high) / 2)
        if word == "wall":
            walls.append(_usd_wall(at, size, len(walls) + 1))
        elif word in ("door", "window", "opening"):
            kind = cast(Literal["door", "window", "opening"], word)
            openings.append(MeasuredOpening(kind, at[:3, 3], float(size[[0, 2]].max()), float(size[1])))
        elif word in known:
            boxes.append(_box(known[word], KINDS[known[word]], at, size, 1.0))
    joined = _joined([f.outline for f in floors], [f.top_m for f in floors])
    upright, left_out = _upright(boxes)
    return MeasuredRoom(tuple(walls), upright, tuple(openings), joined, (*_storey_notes(joined), *left_out))


def _usd_wall(at: Float[np.ndarray, "4 4"], size: Float[np.ndarray, "3"], number: int) -> MeasuredWall:
    """A wall's slab: its middle plane and how thick it is."""
    along, thin = (0, 2) if size[0] >= size[2] else (2, 0)
    corners = np.zeros((4, 3))
    corners[:, along] = np.array([-1, 1, 1, -1]) * size[along] / 2
    corners[:, 1] = np.array([-1, -1, 1, 1]) * size[1] / 2
    return MeasuredWall(f"wall-{number}", _moved(at, corners), float(size[thin]))


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
        own = _NAMED.match(self.path.rpartition("/")[2])
        return own[1] if own else ""


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
            M, points = _unbaked(M, points)
        M = Z_UP @ M
        placed = _moved(M, points)
        outline = _outline_of(placed, mesh.GetFaceVertexCountsAttr().Get(), mesh.GetFaceVertexIndicesAttr().Get())
        yield _Mesh(str(prim.GetPath()), M, points.min(axis=0), points.max(axis=0), outline, float(placed[:, 2].max()))


def _unbaked(
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
