"""The furniture of a room as a table (CSV): name, kind, size, place, room, materials, in metres."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from diorama_core.export.files import whole_file
from diorama_core.export.gathering import ExportObject, ExportScene
from diorama_core.progress import Progress

COLUMNS = (
    *("id", "name", "kind", "width_m", "depth_m", "height_m", "x_m", "y_m", "bottom_m", "turned_deg"),
    *("on", "room", "shape", "materials"),
)
FORMULA_STARTS = ("=", "+", "-", "@")
"""Spreadsheets take text that begins so for a formula."""


def write_schedule(gathered: ExportScene, path: Path, progress: Progress | None = None) -> None:
    """Write a row for each object by kind and id, whole or not at all; raises `ExportError`.

    Width runs along an object's front. The file is UTF-8 with the mark by which spreadsheets know that.
    """
    if progress is not None:
        progress.report(0.0, "writing the schedule")
    items = sorted(gathered.objects, key=lambda o: (o.item.category, o.id))
    with whole_file(path) as temporary, temporary.open("w", encoding="utf-8-sig", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(COLUMNS)
        rows.writerows(_row(gathered, item) for item in items)


def _row(gathered: ExportScene, node: ExportObject) -> list[str]:
    item, surfaces = node.item, gathered.meshes[node.mesh].surfaces
    depth, width, height = (float(v) for v in item.size_m)
    x, y, _ = (float(v) for v in item.pose.position)
    lengths = [width, depth, height, x, y, float(item.corners_world[:, 2].min())]
    supporter = "" if node.support is None else node.support.parent
    materials = ", ".join(sorted({s.material.name for s in surfaces}))
    texts = (supporter, gathered.name, item.shape_id, materials)
    turned = round(float(np.degrees(item.pose.yaw_rad))) % 360
    return [
        *map(_text, (node.id, node.name, item.category)),
        *(f"{v:.3f}" for v in lengths),
        str(turned),
        *map(_text, texts),
    ]


def _text(words: str) -> str:
    return f"'{words}" if words.startswith(FORMULA_STARTS) else words
