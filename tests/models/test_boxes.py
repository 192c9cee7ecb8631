from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.models.boxes import Detections, overlaps, without_doubles


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
