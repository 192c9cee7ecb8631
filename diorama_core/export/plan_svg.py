"""The floor plan as SVG, in millimetres on its page."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
from jaxtyping import Float

from diorama_core.export.files import write_whole
from diorama_core.export.gathering import ExportScene
from diorama_core.export.plan import floor_plan
from diorama_core.export.plan_sheet import PlanSheet, SheetLine, Text, plan_sheet
from diorama_core.progress import Progress

NAMESPACE = "http://www.w3.org/2000/svg"


def write_svg(scene: ExportScene, path: Path, progress: Progress | None = None) -> None:
    """Write the plan; raises `ExportError` when it cannot be written."""
    progress = progress or Progress()
    progress.report(0.1, "drawing the plan")
    content = svg_text(plan_sheet(floor_plan(scene)))
    progress.check()
    write_whole(Path(path), content)


def svg_text(sheet: PlanSheet) -> bytes:
    """A sheet as an SVG document, one group per kind of mark."""
    ET.register_namespace("", NAMESPACE)
    root = ET.Element(
        _tag("svg"),
        {
            "width": f"{sheet.width_mm:g}mm",
            "height": f"{sheet.height_mm:g}mm",
            "viewBox": f"0 0 {sheet.width_mm:g} {sheet.height_mm:g}",
        },
    )
    ET.SubElement(root, _tag("title")).text = sheet.title
    ET.SubElement(root, _tag("desc")).text = f"Floor plan, 1 : {sheet.scale}, one user unit is a millimetre on paper"
    ET.SubElement(root, _tag("rect"), {"width": "100%", "height": "100%", "fill": "#ffffff"})
    group, name = root, ""
    for mark in sheet.marks:
        if mark.group != name:
            name = mark.group
            group = ET.SubElement(root, _tag("g"), {"class": name})
        _add(group, mark, sheet.height_mm)
    ET.indent(root)
    return ET.tostring(root, encoding="utf-8", xml_declaration=True)


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
    ET.SubElement(group, _tag("text"), attributes).text = "".join(c for c in mark.text if c.isprintable())


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
