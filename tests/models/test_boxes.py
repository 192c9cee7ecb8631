from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.models.boxes import Detections, fused, overlaps


def detections(*rows: tuple[float, float, float, float, float, int]) -> Detections:
    boxes = np.array([row[:4] for row in rows], dtype=float).reshape(-1, 4)
    return Detections(boxes, np.array([row[4] for row in rows], dtype=float), np.array([row[5] for row in rows], int))


def test_looks_that_agree_give_one_box_between_theirs() -> None:
    found = fused([detections((0, 0, 10, 10, 0.9, 1)), detections((0, 0, 12, 10, 0.6, 2))], iou=0.5)
    np.testing.assert_allclose(found.boxes, [[0, 0, 10.8, 10]], err_msg="the surer look counts more")
    np.testing.assert_allclose(found.scores, [0.75])
    assert found.labels.tolist() == [1], "the best box's label"


def test_what_one_look_alone_sees_counts_less() -> None:
    both = (0.0, 0.0, 10.0, 10.0, 0.6, 0)
    alone = (50.0, 50.0, 60.0, 60.0, 0.8, 0)
    found = fused([detections(both, alone), detections(both)], iou=0.5)
    np.testing.assert_allclose(found.boxes, [both[:4], alone[:4]])
    np.testing.assert_allclose(found.scores, [0.6, 0.4])


def test_nothing_seen_gives_nothing() -> None:
    assert len(fused([detections(), detections((3, 3, 3, 3, 0.5, 0))], iou=0.5)) == 0


numbers = st.floats(0, 100)
box_rows = st.tuples(numbers, numbers, st.floats(1, 50), st.floats(1, 50), st.floats(0.01, 1), st.integers(0, 3)).map(
    lambda r: (r[0], r[1], r[0] + r[2], r[1] + r[3], r[4], r[5])
)


@given(st.lists(st.lists(box_rows, max_size=6), min_size=1, max_size=3))
def test_fused_boxes_lie_within_what_was_seen_and_none_is_there_twice(views: list) -> None:
    looks = [detections(*rows) for rows in views]
    found = fused(looks, iou=0.5)
    assert (np.diff(found.scores) <= 0).all(), "best first"
    doubles = overlaps(found.boxes, found.boxes) - np.eye(len(found))
    assert (doubles <= 0.5 + 1e-9).all()
    if len(found):
        every = np.concatenate([look.boxes for look in looks])
        assert (found.boxes >= every.min(axis=0) - 1e-9).all()
        assert (found.boxes <= every.max(axis=0) + 1e-9).all()
        assert found.scores.max() <= max(look.scores.max(initial=0.0) for look in looks) + 1e-9


@given(st.lists(box_rows, max_size=6))
def test_one_look_twice_is_as_good_as_once(rows: list) -> None:
    look = detections(*rows)
    once, twice = fused([look], 0.5), fused([look, look], 0.5)
    np.testing.assert_allclose(once.boxes, twice.boxes)
    np.testing.assert_allclose(once.scores, twice.scores)
