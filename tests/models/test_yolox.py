"""The one real network that is at hand, on real photos."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from diorama_core.models.boxes import overlaps
from diorama_core.models.runtime import SessionPool
from diorama_core.models.yolox import Yolox, letterbox
from diorama_core.perception.foundation.detection import EverydayDetection
from diorama_core.progress import Progress
from tests.conftest import PhotoEntry


@pytest.fixture(scope="module")
def detection(shared: Path) -> EverydayDetection:
    path = shared / "models" / "yolox_nano.onnx"
    if not path.exists():
        pytest.skip("needs the real network models/yolox_nano.onnx in the shared folder")
    return EverydayDetection(Yolox(path, pool=SessionPool()))


@pytest.mark.parametrize(
    ("photo_id", "expected"),
    [
        ("im3d_5", {"chair": 3, "table": 1}),
        ("im3d_7", {"chair": 3, "table": 1}),
        ("nyu_00000", {"refrigerator": 1, "chair": 2}),
        ("acdc_kitchen", {"refrigerator": 1, "microwave": 1}),
        ("im3d_1", {"sofa": 2}),
        ("midi_bedroom", {"bed": 1, "plant": 1}),
    ],
)
def test_furniture_is_found_in_real_photos(
    detection: EverydayDetection, photos: list[PhotoEntry], photo_id: str, expected: dict[str, int]
) -> None:
    photo = next(p for p in photos if p.id == photo_id).inputs.photo
    boxes = detection.detect(photo, (), Progress())
    counts = Counter(b.category for b in boxes)
    assert all(counts[name] >= n for name, n in expected.items()), counts
    for b in boxes:
        assert 0 <= b.box[0] < b.box[2] <= photo.width
        assert 0 <= b.box[1] < b.box[3] <= photo.height
        assert b.score >= detection.threshold


def test_boxes_agree_with_those_of_another_detector(detection: EverydayDetection, photos: list[PhotoEntry]) -> None:
    """Chairs and tables of a photo that came with somebody else's boxes."""
    inputs = next(p for p in photos if p.id == "im3d_7").inputs
    mine = [b for b in detection.detect(inputs.photo, (), Progress()) if b.category in ("chair", "table")]
    theirs = np.array([b.box for b in inputs.boxes if b.category in ("chair", "table")])
    assert np.median(overlaps(np.array([b.box for b in mine]), theirs).max(axis=1)) > 0.8


def test_the_letterbox_keeps_proportions_and_is_grey_beyond() -> None:
    pixels, scale = letterbox(np.full((100, 200, 3), (10, 20, 30), np.uint8), 416)
    assert scale == pytest.approx(2.08)
    assert tuple(pixels[0, :, 0, 0]) == (30.0, 20.0, 10.0)
    assert tuple(pixels[0, :, -1, -1]) == (114.0, 114.0, 114.0)
