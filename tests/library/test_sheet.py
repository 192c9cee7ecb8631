from __future__ import annotations

from pathlib import Path

from PIL import Image

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.sheet import contact_sheet


def test_every_shape_gets_its_place(tmp_path: Path) -> None:
    shapes = built_in_library(tmp_path).in_category("sofa")[:5]
    asked: list[str] = []

    def red(shape) -> Image.Image:
        asked.append(shape.id)
        return Image.new("RGB", (10, 10), (200, 0, 0))

    page = contact_sheet(shapes, red, 40, 3)
    assert asked == [s.id for s in shapes]
    assert page.size == (120, 2 * 58)
    assert page.getpixel((20, 20)) == (200, 0, 0)
    assert page.getpixel((60, 58 + 20)) == (200, 0, 0)
    assert page.getpixel((100, 58 + 20)) != (200, 0, 0)
