"""The box that a click means."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.models.boxes import Detections
from diorama_core.perception.foundation.proposals import find_clicked_box


def detections(*rows: tuple[float, float, float, float, float]) -> Detections:
    """Boxes with their scores."""
    table = np.array(rows, dtype=float).reshape(-1, 5)
    return Detections(table[:, :4], table[:, 4], np.zeros(len(table), dtype=int))


SOFA, PILLOW = (100.0, 200.0, 400.0, 350.0), (120.0, 230.0, 180.0, 280.0)


@pytest.mark.parametrize(
    ("x", "y", "meant"), [(250.0, 275.0, SOFA), (150.0, 255.0, PILLOW), (380.0, 340.0, SOFA), (10.0, 10.0, None)]
)
def test_it_is_the_one_whose_middle_is_near(x: float, y: float, meant: tuple[float, ...] | None) -> None:
    assert find_clicked_box(detections((*SOFA, 0.8), (*PILLOW, 0.5)), x, y) == meant


def test_a_likelier_box_wins_where_both_lie_alike() -> None:
    wider = (98.0, 198.0, 402.0, 352.0)
    assert find_clicked_box(detections((*SOFA, 0.3), (*wider, 0.9)), 250.0, 275.0) == wider
    assert find_clicked_box(detections((*SOFA, 0.9), (*wider, 0.3)), 250.0, 275.0) == SOFA


def test_of_no_boxes_none_is_meant() -> None:
    assert find_clicked_box(detections(), 5.0, 5.0) is None


corner = st.floats(0, 500)
box = st.tuples(corner, corner, st.floats(5, 200), st.floats(5, 200), st.floats(0.05, 1.0))


@given(st.lists(box, max_size=12), st.floats(0, 700), st.floats(0, 700))
def test_it_always_holds_the_pixel(boxes: list[tuple[float, float, float, float, float]], x: float, y: float) -> None:
    rows = [(left, top, left + w, top + h, score) for left, top, w, h, score in boxes]
    meant = find_clicked_box(detections(*rows), x, y)
    edge = 1e-3  # boxes are of single precision
    holding = [r for r in rows if r[0] + edge <= x <= r[2] - edge and r[1] + edge <= y <= r[3] - edge]
    if meant is None:
        assert not holding
    else:
        assert meant in [r[:4] for r in rows]
        assert meant[0] - 1e-6 <= x <= meant[2] + 1e-6
        assert meant[1] - 1e-6 <= y <= meant[3] + 1e-6
