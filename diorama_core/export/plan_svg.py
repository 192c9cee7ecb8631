"""Floor plans and elevations as SVG, in millimetres on its page."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.export.plan_sheet import PlanSheet, SheetLine, Text

NAMESPACE = "http://www.w3.org/2000/svg"


def svg_text(sheets: Sequence[PlanSheet]) -> bytes:
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
