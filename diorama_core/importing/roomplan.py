"""Scans of Apple RoomPlan: `CapturedRoom` or `CapturedStructure` as JSON, a folder of captured rooms, and the
parametric `room.usdz`.

Rooms of a folder are placed by their `referenceOriginTransform`: it takes the home's frame to the room's.

RoomPlan is y-up and metric. The axes of a wall or an object are x along its width, y up, and z out of its front.
https://developer.apple.com/documentation/roomplan/capturedroom
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_args

import numpy as np
from jaxtyping import Float
from shapely.geometry import Polygon

from diorama_core.errors import InputError
from diorama_core.importing.measured_types import MeasuredBox, MeasuredOpening, MeasuredRoom, MeasuredWall, OpeningKind
from diorama_core.importing.roomplan_parts import (
    MAX_PARTS,
    box_of,
    join_floors,
    kinds_of,
    move,
    name_floors,
    read_usd,
    storey_notes,
    without_unusable,
    words,
)
from diorama_core.io.bounded import read_json, shorten
from diorama_core.library.ingest.usd_stage import Z_UP

MAX_JSON_BYTES = 64_000_000
REACH_M = 10_000.0
CONFIDENCE = {"high": 1.0, "medium": 0.7, "low": 0.4}
_SURFACES: Mapping[str, OpeningKind] = {f"{kind}s": kind for kind in get_args(OpeningKind)}


def read_room_plan(path: Path) -> MeasuredRoom | None:
    """The room or home that RoomPlan measured; None for a file, or a folder of files, that is not from it.

    Raises:
        InputError: it cannot be read, or makes no sense.
        UnavailableError: a USDZ, and usd-core is missing.
    """
    room = read_usd(path) if path.is_file() and path.suffix.lower() != ".json" else _from_json(path)
    if room is not None and not _is_in_range(room):
        raise InputError(f"{path.name}: something in it is not within {REACH_M / 1000:.0f} km; export the scan again")
    return room


def _is_in_range(room: MeasuredRoom) -> bool:
    """True if all measurements are finite, and near enough to be computed with."""
    numbers: list[np.ndarray | float] = [v for wall in room.walls for v in (wall.polygon, wall.thickness_m)]
    numbers += [v for box in room.boxes for v in (box.centre, box.size_m)]
    numbers += [v for opening in room.openings for v in (opening.centre, opening.width_m, opening.height_m)]
    numbers += [v for floor in room.floors for v in (floor.outline, floor.height_m)]
    return all(bool((np.abs(values) < REACH_M).all()) for values in numbers)


def _from_json(path: Path) -> MeasuredRoom | None:
    files = sorted(path.rglob("*.json")) if path.is_dir() else [path]
    read = {f: read_json(f, InputError, most=MAX_JSON_BYTES, advice="export the scan again") for f in files}
    rooms = {f: d for f, d in read.items() if isinstance(d, dict) and isinstance(d.get("walls"), list)}
    if not rooms:
        return None
    try:
        document = next(iter(rooms.values())) if len(rooms) == 1 else _combine(rooms)
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        raise InputError(
            f"{path.name}: a room has no place in the home ({shorten(str(error))}); export its rooms together"
        ) from error
    names = {key: document.get(key) or [] for key in ("walls", "objects", "floors", "sections", *_SURFACES)}
    if not all(isinstance(rows, list) for rows in names.values()) or sum(map(len, names.values())) > MAX_PARTS:
        raise InputError(f"{path.name}: more than {MAX_PARTS} parts, or lists that are none; export the scan again")
    try:
        walls = tuple(
            MeasuredWall(f"wall-{number}", _outline(row), float(_dimensions(row)[2]))
            for number, row in enumerate(names["walls"], 1)
        )
        ids = {str(row.get("identifier")): wall.id for row, wall in zip(names["walls"], walls, strict=True)}
        openings = tuple(_json_opening(row, kind, ids) for key, kind in _SURFACES.items() for row in names[key])
        boxes, left_out = without_unusable(_json_box(row) for row in names["objects"])
        floors = [_outline(row) for row in names["floors"]]
        sections = [(_section_name(row), Z_UP[:3, :3] @ _point(row["center"])) for row in names["sections"]]
    except (LookupError, TypeError, ValueError, AttributeError, ArithmeticError) as error:
        raise InputError(
            f"{path.name}: a wall or an object makes no sense ({shorten(str(error))}); export the scan again"
        ) from error
    joined = join_floors([Polygon(f[:, :2]) for f in floors], [float(f[:, 2].mean()) for f in floors])
    joined = name_floors(joined, [(name, at) for name, at in sections if name], walls)
    unsure = sum(box.confidence < CONFIDENCE["medium"] for box in boxes)
    curved = sum(row.get("curve") is not None for row in names["walls"])
    notes = [f"RoomPlan was unsure of {unsure} of {len(boxes)} objects"] if unsure else []
    notes += [f"{curved} curved walls are flat from end to end"] if curved else []
    return MeasuredRoom(walls, boxes, openings, joined, (*notes, *storey_notes(joined), *left_out))


def _combine(rooms: Mapping[Path, Mapping[str, Any]]) -> Mapping[str, Any]:
    """Captured rooms as one document, in the frame of the home; a room without a named section has its file's name."""
    whole: dict[str, list[Any]] = {key: [] for key in ("walls", "objects", "floors", "sections", *_SURFACES)}
    for path, room in rooms.items():
        T = np.linalg.inv(np.asarray(room["referenceOriginTransform"], np.float64).reshape(4, 4).T)
        for key, rows in whole.items():
            if key == "sections":
                continue
            for row in room.get(key) or []:
                M = T @ np.asarray(row["transform"], np.float64).reshape(4, 4).T
                rows.append({**row, "transform": M.T.ravel().tolist()})
        named = [s for s in room.get("sections") or [] if _section_name(s)]
        called = path.parent.name if path.stem == "room" else path.stem
        middles = [np.mean(_outline(f), axis=0) @ Z_UP[:3, :3] for f in room.get("floors") or []]
        named = named or [{"label": called, "center": middle.tolist()} for middle in middles]
        whole["sections"] += [{**s, "center": move(T, _point(s["center"])).tolist()} for s in named]
    return whole


def _section_name(row: Mapping[str, Any]) -> str:
    """The name that RoomPlan gives a part of the floor; empty where it knows none."""
    label = _word(row.get("label") or "")
    return "" if label == "unidentified" else shorten(words(label), 60)


def _point(values: Any) -> Float[np.ndarray, "3"]:
    point = np.asarray(values, np.float64)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ValueError("a place is no three numbers")
    return point


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


def _json_opening(row: Mapping[str, Any], kind: OpeningKind, walls: Mapping[str, str]) -> MeasuredOpening:
    size = _dimensions(row)
    wall = walls.get(str(row.get("parentIdentifier")))
    return MeasuredOpening(kind, _matrix(row)[:3, 3], float(size[0]), float(size[1]), wall)


def _json_box(row: Mapping[str, Any]) -> MeasuredBox | str:
    attributes = row.get("attributes") or {}
    values = attributes.values() if isinstance(attributes, dict) else attributes
    kinds = kinds_of(_word(row["category"]), tuple(_word(v) for v in values))
    confidence = CONFIDENCE.get(_word(row.get("confidence", "high")), 1.0)
    return box_of(_word(row["category"]), kinds, _matrix(row), _dimensions(row), confidence)


def _outline(row: Mapping[str, Any]) -> Float[np.ndarray, "n 3"]:
    """Corners of a wall or a floor in the world; its corners, or its dimensions along x and y, are in its own plane."""
    local = np.asarray(row.get("polygonCorners") or [], np.float64).reshape(-1, 3)
    if len(local) < 3:
        width, length, _ = _dimensions(row)
        local = np.array([[x * width / 2, y * length / 2, 0.0] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    if not np.isfinite(local).all():
        raise ValueError("its corners are no places")
    return move(_matrix(row), local)
