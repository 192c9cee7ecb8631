"""Floor plans and elevations as PDF, in scale on its page, by ReportLab."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

from diorama_core.export.plan_sheet import PlanSheet, SheetLine, Text

POINTS_PER_MM = 72.0 / 25.4
LATIN, EAST_ASIAN = "Vera", "STSong-Light"
"""A font that comes with ReportLab and is embedded; and the one that PDF readers bring for other scripts."""


def pdf_bytes(sheets: Sequence[PlanSheet], title: str) -> bytes:
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
    text = "".join(c for c in mark.text if c.isprintable())
    canvas.saveState()
    canvas.setFillGray(0.0)
    canvas.setFont(LATIN if all(ord(c) in known for c in text) else EAST_ASIAN, 0.92 * mark.height_mm)
    canvas.translate(*mark.at)
    canvas.rotate(mark.turn_deg)
    draw = canvas.drawCentredString if mark.anchor == "middle" else canvas.drawString
    draw(0, -0.36 * mark.height_mm, text)
    canvas.restoreState()
