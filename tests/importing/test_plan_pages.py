from __future__ import annotations

import io
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import InputError, UnavailableError
from diorama_core.importing.plan_pages import LARGEST_PX, plan_page


def write_pdf(path: Path) -> Path:
    """A4 across: a room of 8 x 5 m at 1:50, with a door's gap in its lower wall."""
    pytest.importorskip("reportlab", reason="needs reportlab (pip install 'diorama[plan]')")
    from reportlab.pdfgen.canvas import Canvas

    canvas = Canvas(str(path), pagesize=(842, 595))
    unit = 72 / 2.54 * 2  # 1 m on paper
    canvas.setLineWidth(6)
    left, low = 190, 150
    canvas.lines(
        [
            (left, low, left + 3 * unit, low),
            (left + 4 * unit, low, left + 8 * unit, low),
            (left + 8 * unit, low, left + 8 * unit, low + 5 * unit),
            (left + 8 * unit, low + 5 * unit, left, low + 5 * unit),
            (left, low + 5 * unit, left, low),
        ]
    )
    canvas.drawString(left, low - 40, "Ground floor 1:50")
    canvas.save()
    return path


def test_the_first_page_of_a_pdf_is_a_picture(tmp_path: Path) -> None:
    pytest.importorskip("pypdfium2", reason="needs pypdfium2 (pip install 'diorama[plan]')")
    rgb = plan_page(write_pdf(tmp_path / "plan.pdf").read_bytes(), "plan.pdf")
    assert max(rgb.shape[:2]) == pytest.approx(LARGEST_PX, abs=2)
    assert rgb.shape[1] / rgb.shape[0] == pytest.approx(842 / 595, rel=0.01)
    assert 0.002 < (rgb.mean(axis=2) < 100).mean() < 0.1  # dark lines on white


def test_a_large_scan_is_made_smaller() -> None:
    buffer = io.BytesIO()
    Image.new("RGB", (5000, 1000), (200, 210, 220)).save(buffer, "PNG")
    assert plan_page(buffer.getvalue(), "scan.png").shape == (480, LARGEST_PX, 3)


def test_what_is_no_plan_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pypdfium2", reason="needs pypdfium2 (pip install 'diorama[plan]')")
    with pytest.raises(InputError, match="notes"):
        plan_page(b"hello", "notes.txt")
    with pytest.raises(InputError, match="the page cannot be read"):
        plan_page(b"%PDF-1.4 nothing", "broken.pdf")
    monkeypatch.setitem(sys.modules, "pypdfium2", None)
    with pytest.raises(UnavailableError, match=r"diorama\[plan\]"):
        plan_page(b"%PDF-1.4", "plan.pdf")


def test_a_grey_picture_has_three_channels() -> None:
    buffer = io.BytesIO()
    Image.fromarray(np.full((20, 30), 90, np.uint8)).save(buffer, "PNG")
    assert plan_page(buffer.getvalue(), "grey.png").shape == (20, 30, 3)
