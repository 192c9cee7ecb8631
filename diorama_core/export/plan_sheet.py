"""A floor plan on paper: scale and page chosen, everything in millimetres with y upward."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.errors import ExportError
from diorama_core.export.plan import LETTER, Dimension, FloorPlan, Piece

A4, A3 = (297.0, 210.0), (420.0, 297.0)
CHOICES = ((20, A4), (25, A4), (50, A4), (50, A3), (100, A4), (100, A3), (200, A4), (200, A3), (500, A3), (1000, A3))
"""Denominators of scales with their pages, the first that fits is taken."""
MARGIN_MM, TITLE_MM, DIMENSION_ROOM_MM = 10.0, 16.0, 6.0
TEXT_MM, SMALL_MM, TICK_MM = 2.5, 2.0, 1.4
SCHEDULE_MM, ROW_MM = 78.0, 4.0
COLUMNS_MM = (0.0, 5.0, 46.0)
"""Where the columns of the schedule begin: number, name, size."""

Grey = float


@dataclass(frozen=True, eq=False)
class SheetLine:
    """A path on the page."""

    points: tuple[Float[np.ndarray, "_ 2"], ...]
    """One or more outlines, filled together (a hole runs the other way round)."""
    closed: bool = False
    fill: Grey | None = None
    """0 black to 1 white; None leaves it open."""
    stroke_mm: float = 0.18
    """0 draws no line."""
    dashed: bool = False
    group: str = "plan"


@dataclass(frozen=True, eq=False)
class Text:
    """One line of text, centred on a point."""

    text: str
    at: tuple[float, float]
    height_mm: float = TEXT_MM
    turn_deg: float = 0.0
    anchor: str = "middle"
    """`middle` or `start`."""
    group: str = "labels"

    @property
    def printable(self) -> str:
        """The text without what no font has."""
        return "".join(c for c in self.text if c.isprintable())


@dataclass(frozen=True, eq=False)
class PlanSheet:
    """A page with its marks in the order they are drawn."""

    title: str
    scale: int
    """1 : scale."""
    width_mm: float
    height_mm: float
    marks: tuple[SheetLine | Text, ...]
    kind: str = "Floor plan"


def plan_sheet(plan: FloorPlan) -> PlanSheet:
    """The plan on the smallest page and in the largest scale that fit.

    Raises:
        ExportError: when no scale fits.
    """
    low, high = plan.bounds
    rows = _schedule(plan)
    beside = SCHEDULE_MM if rows else 0.0
    scale, page = _choice(high - low, beside)
    width, height = page
    centre = np.array([(width - beside) / 2, (height + TITLE_MM) / 2])
    to_page = _ToPage((low + high) / 2, 1000.0 / scale, centre)
    marks: list[SheetLine | Text] = [SheetLine((to_page(f),), True, 0.96, 0.0, group="floor") for f in plan.floors]
    for piece in plan.pieces:
        marks += _piece_marks(piece, to_page)
    marks.append(SheetLine(tuple(to_page(w) for w in plan.walls), True, 0.25, 0.3, group="walls"))
    marks += [SheetLine((to_page(p),), stroke_mm=0.13, group="windows") for p in plan.window_panes]
    marks += [SheetLine((to_page(p),), stroke_mm=0.13, group="doors") for p in plan.door_leaves]
    for dimension in plan.dimensions:
        marks += _dimension_marks(dimension, to_page)
    for piece in plan.pieces:
        marks += _label_marks(piece, to_page)
    marks += [_text(a.text, to_page(a.at), TEXT_MM, 0.0) for a in plan.areas]
    marks += _schedule_marks(rows, width - MARGIN_MM - SCHEDULE_MM, height - MARGIN_MM)
    marks += _title_marks(plan.name, scale, width)
    return PlanSheet(
        plan.name, scale, width, height, tuple(m for m in marks if isinstance(m, Text) or m.points), plan.kind
    )


@dataclass(frozen=True, eq=False)
class _ToPage:
    """World metres to page millimetres."""

    centre_m: Float[np.ndarray, "2"]
    mm_per_m: float
    centre_mm: Float[np.ndarray, "2"]

    def __call__(self, points: Float[np.ndarray, "*n 2"]) -> Float[np.ndarray, "*n 2"]:
        return (points - self.centre_m) * self.mm_per_m + self.centre_mm


def _choice(extent_m: Float[np.ndarray, "2"], beside_mm: float) -> tuple[int, tuple[float, float]]:
    for scale, (width, height) in CHOICES:
        for page in ((width, height), (height, width)):
            free = np.array(page) - 2 * MARGIN_MM - 2 * DIMENSION_ROOM_MM - [beside_mm, TITLE_MM]
            if (extent_m * 1000.0 / scale <= free).all():
                return scale, page
    raise ExportError(f"a plan of {extent_m[0]:.0f} x {extent_m[1]:.0f} m fits no page; export the DXF instead")


def _piece_marks(piece: Piece, to_page: _ToPage) -> list[SheetLine | Text]:
    outlines = tuple(to_page(o) for o in piece.outlines)
    if piece.overhead:
        return [SheetLine(outlines, True, None, 0.13, dashed=True, group="overhead")]
    return [SheetLine(outlines, True, 1.0, 0.18 if piece.on_floor else 0.13, group="furniture")]


def _label_marks(piece: Piece, to_page: _ToPage) -> list[SheetLine | Text]:
    """Name and size in the middle of furniture that is large enough for them."""
    if not piece.outlines or not piece.label or not piece.on_floor or piece.overhead:
        return []
    points = to_page(np.concatenate(piece.outlines))
    low, high = points.min(axis=0), points.max(axis=0)
    width, height = high - low
    lengthwise = width >= height
    along, across = (width, height) if lengthwise else (height, width)
    if along < LETTER * SMALL_MM * len(piece.label) or across < 1.2 * SMALL_MM:
        return []
    middle, turn = (low + high) / 2, 0.0 if lengthwise else 90.0
    up = np.array([0.0, 1.0]) if lengthwise else np.array([-1.0, 0.0])
    size = "{:.2f} × {:.2f}".format(*piece.extent_m)
    if across < 2.8 * SMALL_MM or along < LETTER * SMALL_MM * len(size):
        return [_text(piece.label, middle, SMALL_MM, turn)]
    gap = 0.65 * SMALL_MM * up
    return [_text(piece.label, middle + gap, SMALL_MM, turn), _text(size, middle - gap, 0.8 * SMALL_MM, turn)]


def _text(text: str, at: Float[np.ndarray, "2"], height_mm: float, turn_deg: float, group: str = "labels") -> Text:
    return Text(text, (float(at[0]), float(at[1])), height_mm, turn_deg, group=group)


def _dimension_marks(dimension: Dimension, to_page: _ToPage) -> list[SheetLine | Text]:
    """Dimension line with slanted ticks, extension lines, and the length above it, readable from below or the right."""
    start, end = to_page(dimension.start + dimension.offset), to_page(dimension.end + dimension.offset)
    away = dimension.offset / max(float(np.linalg.norm(dimension.offset)), 1e-9)
    along = (end - start) / max(float(np.linalg.norm(end - start)), 1e-9)
    tick = 0.5 * TICK_MM * (along + away)
    lines = [np.stack([start, end]), *(np.stack([p - tick, p + tick]) for p in (start, end))]
    lines += [np.stack([p - 3.0 * away, p + 1.0 * away]) for p in (start, end)]
    marks: list[SheetLine | Text] = [SheetLine((line,), stroke_mm=0.13, group="dimensions") for line in lines]
    turn = dimension.text_angle_deg
    up = np.array([-np.sin(np.radians(turn)), np.cos(np.radians(turn))])
    short = float(np.linalg.norm(end - start)) < LETTER * SMALL_MM * len(dimension.text)
    height = 0.7 * SMALL_MM if short else SMALL_MM
    return [*marks, _text(dimension.text, (start + end) / 2 + 0.85 * SMALL_MM * up, height, turn, "dimensions")]


def _schedule(plan: FloorPlan) -> list[tuple[str, str, str]]:
    """Number, name and width × depth × height of the furniture, equal pieces once."""
    sizes = (f"{p.size_m[1]:.2f} × {p.size_m[0]:.2f} × {p.height_m:.2f}" for p in plan.pieces)
    counted = Counter((p.label, size) for p, size in zip(plan.pieces, sizes, strict=True) if p.label)
    return [(str(n), label, size) for (label, size), n in sorted(counted.items())]


def _schedule_marks(rows: Sequence[tuple[str, str, str]], left: float, top: float) -> list[SheetLine | Text]:
    """The schedule at the right border, as long as the page is."""
    room = int((top - MARGIN_MM - TITLE_MM) / ROW_MM) - 1
    shown = list(rows[:room])
    if len(rows) > room:
        more = sum(int(number) for number, *_ in rows[room - 1 :])
        shown = [*rows[: room - 1], (str(more), "more", "")]
    table = [("", "furniture", "width × depth × height"), *shown] if rows else []
    marks: list[SheetLine | Text] = []
    for line, cells in enumerate(table):
        y = top - (line + 0.5) * ROW_MM
        letters = int((COLUMNS_MM[2] - COLUMNS_MM[1]) / (LETTER * SMALL_MM))
        named = cells[1] if len(cells[1]) <= letters else f"{cells[1][: letters - 1]}…"
        for x, cell in zip(COLUMNS_MM, (cells[0], named, cells[2]), strict=True):
            marks += [Text(cell, (left + x, y), SMALL_MM, anchor="start", group="schedule")] if cell else []
        under = np.array([[left, y - ROW_MM / 2], [left + SCHEDULE_MM, y - ROW_MM / 2]])
        marks.append(SheetLine((under,), stroke_mm=0.25 if line == 0 else 0.08, group="schedule"))
    return marks


def _title_marks(name: str, scale: int, width_mm: float) -> list[SheetLine | Text]:
    """Name, scale and a scale bar along the lower border."""
    base = MARGIN_MM + 3.0
    bar_m = next(m for m in (1, 2, 5, 10, 20, 50) if m * 1000.0 / scale >= 20.0)
    step = bar_m * 1000.0 / scale
    right = width_mm - MARGIN_MM
    marks: list[SheetLine | Text] = [
        SheetLine((np.array([[MARGIN_MM, base + 8], [right, base + 8]]),), stroke_mm=0.25, group="title"),
        Text(name, (MARGIN_MM, base + 2.5), 3.5, anchor="start", group="title"),
        Text(f"1 : {scale}   lengths in metres", (MARGIN_MM, base - 2.0), TEXT_MM, anchor="start", group="title"),
    ]
    for part in range(2):
        left = right - (2 - part) * step
        box = np.array([[left, base], [left + step, base], [left + step, base + 1.5], [left, base + 1.5]])
        marks.append(SheetLine((box,), True, 0.0 if part == 0 else 1.0, 0.18, group="title"))
    for number in range(3):
        at = (right - (2 - number) * step, base + 3.5)
        marks.append(Text(f"{number * bar_m} m" if number == 2 else str(number * bar_m), at, SMALL_MM, group="title"))
    return marks
