from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from diorama_app.cli import main


def test_one_category_on_a_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "plates.png"
    assert main(["library", "sheet", "--category", "dinner plates", "-o", str(out), "--size", "32"]) == 0
    assert "shapes on" in capsys.readouterr().out
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
