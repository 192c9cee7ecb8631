"""Blender's object matrices, the scene's poses and sizes, and what changed as typed edits. Needs no Blender.

Frames are those of the scene: metres, +Z up, an object's front along its own +X, its origin the centre of its bounding
box. A matrix maps points of the object's unscaled shape to the world: rotation times scale, and the centre.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Matrix = tuple[tuple[float, ...], ...]
"""Four rows of four."""
Vector = tuple[float, float, float]

SAME = 1e-4
"""Difference of two matrices' numbers up to which they are the same: a tenth of a millimetre, a hundred times Blender's
own rounding."""
UPRIGHT = 1e-2
"""Difference of two rotations' numbers, half a degree, up to which an object has only turned about the vertical."""
FLAT_M = 0.05
"""Objects of at most this height (rugs, mats, trays) leave what stood on them to what is below."""
MAX_EDITS = 60
"""Of one request; the interface takes no more."""


class UnsendableError(ValueError):
    """What was done in Blender has no meaning in the scene: one line that says what to do."""


@dataclass(frozen=True)
class OpenedObject:
    """One object as it was when the room was opened."""

    id: str
    label: str
    matrix: Matrix
    size_m: Vector
    """Depth, width and height."""
    parent: str | None
    """Id of the object or plane that holds it up."""


@dataclass(frozen=True)
class Changes:
    """Typed edits, and what of Blender's changes they leave out."""

    edits: tuple[dict[str, Any], ...]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class _Placed:
    """Where the scene will have an object."""

    rigid: Matrix
    size_m: Vector
    resized: bool
    heading_deg: float
    notes: tuple[str, ...]


def matrix_of_entry(entry: Mapping[str, Any]) -> Matrix:
    """The matrix of an object's entry in the scene file."""
    rows, scale = entry["T_world_object"], (*entry["scale"], 1.0)
    return tuple(tuple(float(v) * float(s) for v, s in zip(row, scale, strict=True)) for row in rows)


def opened_object(entry: Mapping[str, Any]) -> OpenedObject:
    """An object by its entry in the scene file."""
    x, y, z = (float(v) for v in entry["size_m"])
    support = entry["support"] or {}
    return OpenedObject(entry["id"], entry["label"], matrix_of_entry(entry), (x, y, z), support.get("parent"))


def moved_ids(opened: Sequence[OpenedObject], now: Mapping[str, Matrix]) -> tuple[str, ...]:
    """Ids of objects that are still there and elsewhere, turned or scaled."""
    return tuple(o.id for o in opened if o.id in now and not _same(o.matrix, now[o.id]))


def changes(opened: Sequence[OpenedObject], now: Mapping[str, Matrix]) -> Changes:
    """What was done since a room was opened, as edits that are done one after the other.

    Args:
        opened: its objects.
        now: world matrices of the objects that are still there.

    Raises:
        UnsendableError: an object is mirrored or has no size, or too much has changed.
    """
    edits = _removals(opened, now)
    notes: list[str] = []
    known = {o.id: o for o in opened}
    placed: dict[str, _Placed] = {}
    for item in sorted((o for o in opened if o.id in now), key=lambda o: _depth(o, known)):
        placed[item.id] = made = _placed(item, now[item.id])
        notes += made.notes
        parent, below = placed.get(item.parent or ""), known.get(item.parent or "")
        expected = item.matrix
        if parent is not None and below is not None:  # what stands on a placed object goes along
            expected = _product(_product(parent.rigid, _inverse(_rigid(below.matrix))), item.matrix)
        if not _same(expected, now[item.id]) or (parent is not None and parent.resized):
            edits.append(_place(item, made))
    if len(edits) > MAX_EDITS:
        raise UnsendableError(f"{len(edits)} edits are more than the {MAX_EDITS} of one step; undo some and send twice")
    return Changes(tuple(edits), tuple(notes))


def _removals(opened: Sequence[OpenedObject], now: Mapping[str, Matrix]) -> list[dict[str, Any]]:
    """Edits that remove what is gone, and leave what stood on it where it is in Blender."""
    gone = {o.id: o for o in opened if o.id not in now}
    edits: list[dict[str, Any]] = []
    for item in opened:
        if item.id in now and item.parent in gone:
            below: str | None = item.parent
            while below in gone and gone[below].size_m[2] <= FLAT_M:
                below = gone[below].parent
            edits.append({"do": "support", "objects": [item.id], "parent": "" if below in gone else below or ""})
    return [*edits, {"do": "remove", "objects": list(gone)}] if gone else []


def _place(item: OpenedObject, made: _Placed) -> dict[str, Any]:
    up, centre = [row[2] for row in made.rigid[:3]], [row[3] for row in made.rigid[:3]]
    base = [c - u * made.size_m[2] / 2 for c, u in zip(centre, up, strict=True)]
    edit: dict[str, Any] = {"do": "place", "objects": [item.id], "base_m": base, "heading_deg": made.heading_deg}
    return {**edit, "size_m": list(made.size_m)} if made.resized else edit


def _placed(item: OpenedObject, matrix: Matrix) -> _Placed:
    """An object's place and size by its matrix; of its rotation, the turn about the vertical."""
    before, after = _scale(item.matrix), _scale(matrix)
    if min(after) < SAME or _determinant(matrix) < 0:
        raise UnsendableError(f"{item.label} ({item.id}) is mirrored or has no size; undo that and send again")
    ratios = [a / b for a, b in zip(after, before, strict=True)]
    resized = max(abs(r - 1) for r in ratios) > SAME
    x, y, z = (s * r for s, r in zip(item.size_m, ratios, strict=True)) if resized else item.size_m
    old, new = _rigid(item.matrix), _rigid(matrix)
    turn = _heading(new) - _heading(old)
    c, s = math.cos(turn), math.sin(turn)
    turned = _product(((c, -s, 0.0, 0.0), (s, c, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0)), old)
    rigid = tuple((*t[:3], n[3]) for t, n in zip(turned, new, strict=True))
    tilted = max(abs(rigid[i][j] - new[i][j]) for i in range(3) for j in range(3)) > UPRIGHT
    notes = (
        (f"{item.label} ({item.id}) is not tilted or sheared: only turns about the vertical are sent",)
        if tilted
        else ()
    )
    return _Placed(rigid, (x, y, z), resized, math.degrees(_heading(rigid)), notes)


def _depth(item: OpenedObject, known: Mapping[str, OpenedObject]) -> int:
    """How many objects are below; supports in a circle are counted once."""
    seen = {item.id}
    while (below := known.get(item.parent or "")) is not None and below.id not in seen:
        item = below
        seen.add(item.id)
    return len(seen)


def _heading(matrix: Matrix) -> float:
    return math.atan2(matrix[1][0], matrix[0][0])


def _scale(matrix: Matrix) -> Vector:
    x, y, z = (math.hypot(*(row[j] for row in matrix[:3])) for j in range(3))
    return x, y, z


def _rigid(matrix: Matrix) -> Matrix:
    """Without its scale."""
    scale = (*_scale(matrix), 1.0)
    return tuple(tuple(v / s for v, s in zip(row, scale, strict=True)) for row in matrix)


def _inverse(rigid: Matrix) -> Matrix:
    """Inverse of a matrix without scale."""
    columns = [[rigid[i][j] for i in range(3)] for j in range(3)]
    rows = [(*c, -sum(a * rigid[i][3] for i, a in enumerate(c))) for c in columns]
    return (*rows, (0.0, 0.0, 0.0, 1.0))


def _product(a: Matrix, b: Matrix) -> Matrix:
    return tuple(tuple(sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)) for i in range(4))


def _determinant(m: Matrix) -> float:
    return sum(
        m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]) for i in range(3)
    )


def _same(a: Matrix, b: Matrix) -> bool:
    return all(abs(x - y) <= SAME for r, q in zip(a, b, strict=True) for x, y in zip(r, q, strict=True))
