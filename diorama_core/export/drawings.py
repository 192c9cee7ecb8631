"""Floor plans and wall elevations as SVG, PDF or DXF files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from diorama_core.export.elevations import elevations
from diorama_core.export.files import write_whole
from diorama_core.export.gathering import ExportScene
from diorama_core.export.plan import FloorPlan, floor_plans
from diorama_core.export.plan_dxf import dxf_text
from diorama_core.export.plan_pdf import pdf_bytes
from diorama_core.export.plan_sheet import plan_sheet
from diorama_core.export.plan_svg import svg_text
from diorama_core.progress import SILENT, Progress


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
        content = pdf_bytes(sheets, name) if path.suffix.lower() == ".pdf" else svg_text(sheets)
    progress.check()
    write_whole(path, content)
