"""Floor plans and wall elevations as files: SVG in millimetres on its page, PDF in scale by ReportLab, or DXF."""

from __future__ import annotations

import io
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.export.elevations import elevations
from diorama_core.export.files import write_whole
from diorama_core.export.gathering import ExportScene
from diorama_core.export.plan import FloorPlan, floor_plans
from diorama_core.export.plan_dxf import dxf_text
from diorama_core.export.plan_sheet import PlanSheet, SheetLine, Text, plan_sheet
from diorama_core.progress import SILENT, Progress

NAMESPACE = "http://www.w3.org/2000/svg"
POINTS_PER_MM = 72.0 / 25.4
LATIN, EAST_ASIAN = "Vera", "STSong-Light"
"""A font that comes with ReportLab and is embedded; and the one that PDF readers bring for other scripts."""


def write_plan(scene: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write the floor plan of each storey; raises `ExportError` when it cannot be written."""
    _write(scene.name, floor_plans(scene), Path(path), progress)


def write_elevations(scene: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write a drawing of each wall, by room; raises `ExportError` when it cannot be written."""
    _write(scene.name, elevations(scene), Path(path), progress)


def _write(name: str, drawings: Sequence[FloorPlan], path: Path, progress: Progress) -> None:
    progress.report(0.1, f"drawing {path.name}")
    if path.suffix.lower() == ".dxf":
        content = dxf_text(drawings).encode()
    else:
        sheets = [plan_sheet(d) for d in drawings]
        content = _pdf_bytes(sheets, name) if path.suffix.lower() == ".pdf" else _svg_text(sheets)
    progress.check()
    write_whole(path, content)


def _svg_text(sheets: Sequence[PlanSheet]) -> bytes:
    """Sheets as an SVG document, below each other, each with one group per kind of mark."""
    ET.register_namespace("", NAMESPACE)
    if len(sheets) > 1:
        width, height = max(s.width_mm for s in sheets), sum(s.height_mm for s in sheets)
        root, top = ET.Element(_tag("svg"), _size(width, height)), 0.0
        for sheet in sheets:
            page = _page(sheet)
            page.set("y", f"{top:g}")
            page.set("width", f"{sheet.width_mm:g}")
            page.set("height", f"{sheet.height_mm:g}")
            root.append(page)
            top += sheet.height_mm
    else:
        root = _page(sheets[0])
    ET.indent(root)
    return ET.tostring(root, encoding="utf-8", xml_declaration=True)


def _size(width_mm: float, height_mm: float) -> dict[str, str]:
    size = {"width": f"{width_mm:g}mm", "height": f"{height_mm:g}mm"}
    return {**size, "viewBox": f"0 0 {width_mm:g} {height_mm:g}"}


def _page(sheet: PlanSheet) -> ET.Element:
    root = ET.Element(_tag("svg"), _size(sheet.width_mm, sheet.height_mm))
    ET.SubElement(root, _tag("title")).text = sheet.title
    ET.SubElement(root, _tag("desc")).text = f"{sheet.kind}, 1 : {sheet.scale}, one user unit is a millimetre on paper"
    ET.SubElement(root, _tag("rect"), {"width": "100%", "height": "100%", "fill": "#ffffff"})
    group, name = root, ""
    for mark in sheet.marks:
        if mark.group != name:
            name = mark.group
            group = ET.SubElement(root, _tag("g"), {"class": name})
        _add(group, mark, sheet.height_mm)
    return root


def _add(group: ET.Element, mark: SheetLine | Text, height_mm: float) -> None:
    if isinstance(mark, SheetLine):
        ET.SubElement(group, _tag("path"), _line_attributes(mark, height_mm))
        return
    x, y = mark.at[0], height_mm - mark.at[1]
    attributes = {
        "x": f"{x:.3f}",
        "y": f"{y + 0.36 * mark.height_mm:.3f}",
        "font-size": f"{mark.height_mm:g}",
        "font-family": "Helvetica, Arial, sans-serif",
        "text-anchor": mark.anchor,
    }
    if mark.turn_deg:
        attributes["transform"] = f"rotate({-mark.turn_deg:.3f} {x:.3f} {y:.3f})"
    ET.SubElement(group, _tag("text"), attributes).text = mark.printable


def _line_attributes(mark: SheetLine, height_mm: float) -> dict[str, str]:
    attributes = {
        "d": " ".join(_path(p, mark.closed, height_mm) for p in mark.points),
        "fill": "none" if mark.fill is None else _grey(mark.fill),
        "stroke": "#000000" if mark.stroke_mm else "none",
    }
    if mark.stroke_mm:
        attributes["stroke-width"] = f"{mark.stroke_mm:g}"
    if mark.dashed:
        attributes["stroke-dasharray"] = "1.5 1"
    return attributes


def _path(points: Float[np.ndarray, "n 2"], closed: bool, height_mm: float) -> str:
    steps = " L".join(f"{x:.3f} {height_mm - y:.3f}" for x, y in points)
    return f"M{steps}{' Z' if closed else ''}"


def _grey(value: float) -> str:
    return "#" + 3 * f"{round(255 * value):02x}"


def _tag(name: str) -> str:
    return f"{{{NAMESPACE}}}{name}"


def _pdf_bytes(sheets: Sequence[PlanSheet], title: str) -> bytes:
    """Sheets as a PDF document, a page each."""
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.cidfonts import UnicodeCIDFont
    from reportlab.pdfbase.ttfonts import TTFont
    from reportlab.pdfgen.canvas import Canvas

    pdfmetrics.registerFont(TTFont(LATIN, "Vera.ttf"))
    pdfmetrics.registerFont(UnicodeCIDFont(EAST_ASIAN))
    known = frozenset(pdfmetrics.getFont(LATIN).face.charToGlyph)
    buffer = io.BytesIO()
    canvas = Canvas(buffer, invariant=True)
    canvas.setTitle(title)
    canvas.setCreator("Diorama")
    for sheet in sheets:
        canvas.setPageSize((sheet.width_mm * POINTS_PER_MM, sheet.height_mm * POINTS_PER_MM))
        canvas.scale(POINTS_PER_MM, POINTS_PER_MM)
        canvas.setLineJoin(1)
        for mark in sheet.marks:
            if isinstance(mark, SheetLine):
                _draw_line(canvas, mark)
            else:
                _draw_text(canvas, mark, known)
        canvas.showPage()
    canvas.save()
    return buffer.getvalue()


def _draw_line(canvas: Any, mark: SheetLine) -> None:
    path = canvas.beginPath()
    for outline in mark.points:
        path.moveTo(*outline[0])
        for point in outline[1:]:
            path.lineTo(*point)
        if mark.closed:
            path.close()
    if mark.fill is not None:
        canvas.setFillGray(mark.fill)
    if mark.stroke_mm:
        canvas.setLineWidth(mark.stroke_mm)
        canvas.setDash([1.5, 1.0] if mark.dashed else [])
    canvas.drawPath(path, stroke=int(mark.stroke_mm > 0), fill=int(mark.fill is not None))


def _draw_text(canvas: Any, mark: Text, known: frozenset[int]) -> None:
    text = mark.printable
    canvas.saveState()
    canvas.setFillGray(0.0)
    canvas.setFont(LATIN if all(ord(c) in known for c in text) else EAST_ASIAN, 0.92 * mark.height_mm)
    canvas.translate(*mark.at)
    canvas.rotate(mark.turn_deg)
    draw = canvas.drawCentredString if mark.anchor == "middle" else canvas.drawString
    draw(0, -0.36 * mark.height_mm, text)
    canvas.restoreState()
