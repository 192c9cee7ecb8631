from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_app.cli import main
from diorama_app.cli.library import changes
from tests.cli.running import told


def test_one_category_on_a_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "plates.png"
    assert "shapes on" in told(
        capsys, ["library", "sheet", "--category", "dinner plates", "-o", str(out), "--size", "32"]
    )
    assert Image.open(out).width == 6 * 32


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "sheet.jpg"], "end the name with .png"),
        (["-o", "nowhere/at/all.png"], "there is no folder"),
        (["--size", "4"], "a side of 16 to 1024"),
        (["--columns", "0"], "1 to 40 columns"),
    ],
    ids=["not a PNG", "no folder", "too small", "no columns"],
)
def test_what_cannot_be_drawn_is_said_at_once(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["library", "sheet", *words]) != 0
    assert message in capsys.readouterr().err


def test_one_shape_from_four_sides(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert "night-stand-cane (" in told(capsys, ["library", "show", "night-stand-cane"])
    page = np.asarray(Image.open("night-stand-cane.png"))
    side = len(page) // 2
    views = [page[:side, :side], page[:side, side:], page[side:, :side], page[side:, side:]]
    assert all(view.std() > 5 for view in views)
    assert len({view.tobytes() for view in views}) == 4, "the last one is open"
    assert main(["library", "show", "no-such-shape"]) == 1


def test_a_change_of_a_watched_file_is_noticed(tmp_path: Path) -> None:
    design = tmp_path / "lamps" / "arc.py"
    design.parent.mkdir()
    design.write_text("a = 1")
    seen = changes([tmp_path], pause_s=0.0)
    next(seen)
    os.utime(design, ns=(0, 0))
    next(seen)
    (tmp_path / "new.py").write_text("")
    next(seen)
    design.unlink()
    next(seen)
