"""The bundled example's inputs: small, consistent and understood by the taxonomy."""

from __future__ import annotations

import json
from pathlib import Path

from PIL import Image

from diorama_core.library.taxonomy import resolve
from diorama_core.scene.types import Intrinsics

EXAMPLE = Path(__file__).resolve().parents[2] / "assets" / "example"


def test_photo_boxes_and_intrinsics_agree() -> None:
    photo = EXAMPLE / "photo.jpg"
    assert photo.stat().st_size < 400_000
    with Image.open(photo) as image:
        width, height = image.size
    k = Intrinsics(**json.loads((EXAMPLE / "intrinsics.json").read_text()))
    assert (k.width, k.height) == (width, height)
    boxes = json.loads((EXAMPLE / "boxes.json").read_text())["boxes"]
    assert len(boxes) >= 20
    for box in boxes:
        x1, y1, x2, y2 = box["bbox"]
        assert 0 <= x1 < x2 <= width
        assert 0 <= y1 < y2 <= height
        assert resolve(box["class"]).exact, box["class"]
