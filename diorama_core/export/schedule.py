"""The furniture of a room as a table (CSV, XLSX): name, kind, size, place, room, materials, in metres."""

from __future__ import annotations

import csv
import io
import re
from datetime import datetime
from pathlib import Path

import numpy as np

from diorama_core.export.files import whole_file, write_whole
from diorama_core.export.gathering import ExportObject, ExportScene
from diorama_core.progress import SILENT, Progress

COLUMNS = (
    *("id", "name", "kind", "width_m", "depth_m", "height_m", "x_m", "y_m", "bottom_m", "turned_deg"),
    *("on", "room", "shape", "materials"),
)
FORMULA_STARTS = ("=", "+", "-", "@")
"""Spreadsheets take text of a CSV that begins so for a formula."""
NUMBERED = re.compile(r"( \d+)?( from the photo.*)?( \d+)?$")
"""What is in a material's name only to tell it from others."""
PICTURE_PX, WIDEST = 96, 40
"""Side of a picture in XLSX; the widest column, in characters."""


def write_csv(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write a row for each object by kind and id, whole or not at all; raises `ExportError`.

    Width runs along an object's front. The file is UTF-8 with the mark by which spreadsheets know that.
    """
    progress.report(0.0, "writing the furniture list")
    with whole_file(path) as temporary, temporary.open("w", encoding="utf-8-sig", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(COLUMNS)
        for node in _rows(gathered):
            rows.writerow(_as_text(cell) for cell in _row(gathered, node))


def write_xlsx(gathered: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write the same table as a workbook, with a picture of each object; raises `ExportError`, `Cancelled`."""
    import xlsxwriter

    from diorama_core.render.thumbnails import thumbnail

    nodes, content = _rows(gathered), io.BytesIO()
    book = xlsxwriter.Workbook(content, {"in_memory": True})
    book.set_properties({"created": datetime(1980, 1, 1)})  # the same scene gives the same bytes
    sheet, metres, bold = book.add_worksheet("Furniture"), book.add_format({"num_format": "0.000"}), book.add_format()
    bold.set_bold()
    table: list[list[str | float | int]] = [[*COLUMNS], *(_row(gathered, node) for node in nodes)]
    for number, cells in enumerate(table):
        for column, cell in enumerate(cells):
            if isinstance(cell, str):
                sheet.write_string(number, column, cell, None if number else bold)
            else:
                sheet.write_number(number, column, cell, metres if isinstance(cell, float) else None)
    sheet.write_string(0, len(COLUMNS), "appearance", bold)
    for number, node in enumerate(nodes, 1):
        progress.report(number / (len(nodes) + 1), f"pictures: {number} of {len(nodes)}")
        progress.check()
        paint = (node.item.colour, node.item.finish)
        drawn = io.BytesIO(thumbnail(gathered.library, node.item.shape_id, PICTURE_PX, paint=paint))
        sheet.set_row_pixels(number, PICTURE_PX)
        sheet.insert_image(number, len(COLUMNS), "picture.png", {"image_data": drawn, "description": node.name})
    for column in range(len(COLUMNS)):
        sheet.set_column(column, column, min(WIDEST, 2 + max(len(_as_text(cells[column])) for cells in table)))
    sheet.set_column_pixels(len(COLUMNS), len(COLUMNS), PICTURE_PX)
    sheet.freeze_panes(1, 2)
    sheet.set_landscape()
    sheet.fit_to_pages(1, 0)
    sheet.autofilter(0, 0, len(nodes), len(COLUMNS) - 1)
    book.close()
    write_whole(path, content.getvalue())


def _rows(gathered: ExportScene) -> list[ExportObject]:
    return sorted(gathered.objects, key=lambda o: (o.item.category, o.id))


def _row(gathered: ExportScene, node: ExportObject) -> list[str | float | int]:
    """The cells of an object: texts, metres as `float`, degrees as `int`."""
    item, surfaces = node.item, gathered.meshes[node.mesh].surfaces
    depth, width, height = (float(v) for v in item.size_m)
    x, y, _ = (float(v) for v in item.pose.position)
    supporter = "" if node.support is None else node.support.parent
    room = gathered.room_of.get(node.id)
    materials = ", ".join(sorted({NUMBERED.sub("", s.material.name) for s in surfaces}))
    return [
        *(node.id, node.name, item.category),
        *(width, depth, height, x, y, float(item.corners_world[:, 2].min())),
        round(float(np.degrees(item.pose.yaw_rad))) % 360,
        *(supporter, room.name if room is not None else gathered.name, item.shape_id, materials),
    ]


def _as_text(cell: str | float | int) -> str:
    """A cell of the CSV."""
    if isinstance(cell, str):
        return f"'{cell}" if cell.startswith(FORMULA_STARTS) else cell
    return f"{cell:.3f}" if isinstance(cell, float) else str(cell)
