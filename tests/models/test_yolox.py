"""The one real network that is at hand, on real photos."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from diorama_core.models.boxes import Detections, without_doubles, without_parts_of_same
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
    best = [max(_iou(np.array(b.box), t) for t in theirs) for b in mine]
    assert np.median(best) > 0.8


def _iou(a: np.ndarray, b: np.ndarray) -> float:
    shared = np.prod(np.maximum(np.minimum(a[2:], b[2:]) - np.maximum(a[:2], b[:2]), 0))
    return float(shared / (np.prod(a[2:] - a[:2]) + np.prod(b[2:] - b[:2]) - shared))


def test_the_letterbox_keeps_proportions_and_is_grey_beyond() -> None:
    pixels, scale = letterbox(np.full((100, 200, 3), (10, 20, 30), np.uint8), 416)
    assert scale == pytest.approx(2.08)
    assert tuple(pixels[0, :, 0, 0]) == (30.0, 20.0, 10.0)
    assert tuple(pixels[0, :, -1, -1]) == (114.0, 114.0, 114.0)


def _found(*rows: tuple[float, float, float, float, float, int]) -> Detections:
    table = np.array(rows, dtype=float)
    return Detections(table[:, :4], table[:, 4], table[:, 5].astype(int))


def test_doubles_go_and_the_best_stays() -> None:
    found = _found((0, 0, 10, 10, 0.6, 0), (0, 0, 10, 9.5, 0.9, 1), (20, 0, 30, 10, 0.5, 0))
    assert list(without_doubles(found, 0.8, across_classes=True).scores) == [0.9, 0.5]
    assert len(without_doubles(found, 0.8, across_classes=False)) == 3


def test_parts_of_an_object_of_the_same_class_go() -> None:
    chair_with_part = _found((0, 0, 10, 10, 0.9, 0), (2, 2, 6, 6, 0.5, 0), (2, 2, 6, 6, 0.4, 1))
    assert list(without_parts_of_same(chair_with_part, 0.8).scores) == [0.9, 0.4]
    lumped = _found((0, 0, 20, 10, 0.3, 0), (0, 0, 10, 10, 0.9, 0), (10, 0, 20, 10, 0.8, 0))
    assert sorted(without_parts_of_same(lumped, 0.8).scores) == [0.8, 0.9]
