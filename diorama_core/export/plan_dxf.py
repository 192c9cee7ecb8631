"""Floor plans and elevations as DXF (R2010, millimetres, full size), by ezdxf: layers, dimensions, blocks."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from diorama_core.export.plan import Dimension, FloorPlan, Piece
from diorama_core.export.sharing import unique_name

MM_PER_M = 1000.0
LAYERS = {
    "FLOOR": 9,
    "WALLS": 7,
    "DOORS": 30,
    "WINDOWS": 140,
    "FURNITURE": 8,
    "OVERHEAD": 252,
    "LABELS": 2,
    "DIMENSIONS": 3,
}
"""Layers with their colours (AutoCAD colour index)."""
TEXT_MM = 90.0
STYLE = "DIORAMA"
APART_M = 0.5
"""Between drawings beside each other."""


def dxf_text(plans: Sequence[FloorPlan]) -> str:
    """Plans as the text of a DXF file: the first in the model space where it is, the others beside it."""
    import ezdxf
    from ezdxf import units

    document = ezdxf.new("R2010", setup=True)
    document.units = units.MM
    document.header["$MEASUREMENT"] = 1
    for name, colour in LAYERS.items():
        document.layers.add(name, color=colour, linetype="DASHED" if name == "OVERHEAD" else "CONTINUOUS")
    space, taken = document.modelspace(), set[str]()
    _dimension_style(document)
    right = float(plans[0].bounds[0, 0])
    for plan in plans:
        low, high = plan.bounds
        _draw(document, space, plan.move(np.array([right - low[0], 0.0])), taken)
        if len(plans) > 1:
            name = space.add_text(plan.name, height=TEXT_MM, dxfattribs={"layer": "LABELS"})
            name.set_placement((right * MM_PER_M, low[1] * MM_PER_M - 2 * TEXT_MM))
        right += float(high[0] - low[0]) + APART_M * (len(plans) > 1)
    low, high = plans[0].bounds * MM_PER_M
    document.set_modelspace_vport(height=float(1.2 * max(high - low)), center=tuple((low + high) / 2))
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue()


def _draw(document: Any, space: Any, plan: FloorPlan, taken: set[str]) -> None:
    for floor in plan.floors:
        space.add_lwpolyline(floor * MM_PER_M, close=True, dxfattribs={"layer": "FLOOR"})
    _add_walls(space, plan)
    for layer, lines in (("WINDOWS", plan.window_panes), ("DOORS", plan.door_leaves)):
        for line in lines:
            space.add_lwpolyline(line * MM_PER_M, dxfattribs={"layer": layer})
    for piece in plan.pieces:
        _add_piece(document, space, piece, taken)
    for area in plan.areas:
        label = space.add_text(area.text, height=TEXT_MM, dxfattribs={"layer": "LABELS"})
        label.set_placement(area.at * MM_PER_M, align=_middle())
    for dimension in plan.dimensions:
        _add_dimension(space, dimension)


def _add_walls(space: Any, plan: FloorPlan) -> None:
    if not plan.walls:
        return
    hatch = space.add_hatch(color=LAYERS["FURNITURE"], dxfattribs={"layer": "WALLS", "hatch_style": 0})
    for wall in plan.walls:
        space.add_lwpolyline(wall * MM_PER_M, close=True, dxfattribs={"layer": "WALLS"})
        hatch.paths.add_polyline_path(wall * MM_PER_M, is_closed=True)


def _add_piece(document: Any, space: Any, piece: Piece, taken: set[str]) -> None:
    """A block with the outline, put where the object is, with its name and size as attributes one can list."""
    if not piece.outlines:
        return
    points = np.concatenate(piece.outlines)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    layer = "OVERHEAD" if piece.overhead else "FURNITURE"
    name = unique_name(re.sub(r"[^A-Za-z0-9_-]+", "_", piece.id) or "object", taken, "_")
    block = document.blocks.new(name)
    for outline in piece.outlines:
        block.add_lwpolyline((outline - middle) * MM_PER_M, close=True, dxfattribs={"layer": "0"})
    insert = space.add_blockref(name, middle * MM_PER_M, dxfattribs={"layer": layer})
    size = "{:.2f} x {:.2f} m".format(*piece.extent_m)
    for tag, text in (("ID", piece.id), ("NAME", piece.label), ("SIZE", size)):
        attribute = insert.add_attrib(
            tag, " ".join(text.split()), middle * MM_PER_M, {"layer": layer, "height": TEXT_MM}
        )
        attribute.is_invisible = True
    if piece.on_floor and piece.label and not piece.overhead:
        label = space.add_text(" ".join(piece.label.split()), height=TEXT_MM, dxfattribs={"layer": "LABELS"})
        label.set_placement(middle * MM_PER_M, align=_middle())


def _middle() -> Any:
    from ezdxf.enums import TextEntityAlignment

    return TextEntityAlignment.MIDDLE_CENTER


def _dimension_style(document: Any) -> None:
    style = document.dimstyles.duplicate_entry("EZDXF", STYLE)
    style.dxf.dimtxt = TEXT_MM
    style.dxf.dimtsz = 40.0
    style.dxf.dimlfac = 1.0 / MM_PER_M
    style.dxf.dimdec = 2
    style.dxf.dimzin = 0  # keeps the zeros of 0.80
    style.dxf.dimexe = 40.0
    style.dxf.dimexo = 60.0
    style.dxf.dimgap = 30.0
    style.dxf.dimscale = 1.0
    style.copy_to_header(document)  # LibreCAD sizes the text of dimensions by the header alone


def _add_dimension(space: Any, dimension: Dimension) -> None:
    space.add_linear_dim(
        base=tuple((dimension.start + dimension.offset) * MM_PER_M),
        p1=tuple(dimension.start * MM_PER_M),
        p2=tuple(dimension.end * MM_PER_M),
        angle=dimension.text_angle_deg,
        dimstyle=STYLE,
        dxfattribs={"layer": "DIMENSIONS"},
    ).render()
