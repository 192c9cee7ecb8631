from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.models.boxes import Detections, overlaps, without_doubles, without_parts_of_same


def detections(*rows: tuple[float, float, float, float, float, int]) -> Detections:
    boxes = np.array([row[:4] for row in rows], dtype=float).reshape(-1, 4)
    return Detections(boxes, np.array([row[4] for row in rows], dtype=float), np.array([row[5] for row in rows], int))


numbers = st.floats(0, 100)
box_rows = st.tuples(numbers, numbers, st.floats(1, 50), st.floats(1, 50), st.floats(0.01, 1), st.integers(0, 3)).map(
    lambda r: (r[0], r[1], r[0] + r[2], r[1] + r[3], r[4], r[5])
)


@given(st.lists(box_rows, max_size=12))
def test_of_boxes_that_overlap_the_best_stays(rows: list) -> None:
    found = detections(*rows)
    stayed = without_doubles(found, 0.5, across_classes=True)
    assert (np.diff(stayed.scores) <= 0).all(), "best first"
    doubles = overlaps(stayed.boxes, stayed.boxes) - np.eye(len(stayed))
    assert (doubles <= 0.5 + 1e-9).all()
    for box, score in zip(found.boxes, found.scores, strict=True):
        same = overlaps(box[None], stayed.boxes)[0] > 0.5 - 1e-9
        assert (stayed.scores[same] >= score).any(), "what went has a better one in its place"


def test_doubles_go_and_the_best_stays() -> None:
    found = detections((0, 0, 10, 10, 0.6, 0), (0, 0, 10, 9.5, 0.9, 1), (20, 0, 30, 10, 0.5, 0))
    assert list(without_doubles(found, 0.8, across_classes=True).scores) == [0.9, 0.5]
    assert len(without_doubles(found, 0.8, across_classes=False)) == 3


def test_parts_of_an_object_of_the_same_class_go() -> None:
    chair_with_part = detections((0, 0, 10, 10, 0.9, 0), (2, 2, 6, 6, 0.5, 0), (2, 2, 6, 6, 0.4, 1))
    assert list(without_parts_of_same(chair_with_part, 0.8).scores) == [0.9, 0.4]
    lumped = detections((0, 0, 20, 10, 0.3, 0), (0, 0, 10, 10, 0.9, 0), (10, 0, 20, 10, 0.8, 0))
    assert sorted(without_parts_of_same(lumped, 0.8).scores) == [0.8, 0.9]
