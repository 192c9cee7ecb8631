"""Edges behind which something goes on: only where something nearer lies beside them."""

from __future__ import annotations

import numpy as np

from diorama_core.artefacts import DetectedObject
from diorama_core.multiview.cut_short import edges_cut_short


def marked(name: str, box: tuple[int, int, int, int]) -> DetectedObject:
    mask = np.zeros((100, 200), dtype=bool)
    mask[box[1] : box[3], box[0] : box[2]] = True
    return DetectedObject(name, "table", "table", tuple(float(v) for v in box), mask, 1, 0.9)


TABLE, CHAIR = marked("table", (40, 30, 120, 60)), marked("chair", (110, 35, 150, 95))
BOXES = np.array([TABLE.box, CHAIR.box])


def test_an_edge_beside_something_nearer_is_cut_short() -> None:
    found = edges_cut_short([TABLE, CHAIR], BOXES, np.array([3.0, 2.0]))
    np.testing.assert_array_equal(found[0], [False, False, True, False])
    assert not found[1].any()


def test_what_is_farther_hides_nothing() -> None:
    found = edges_cut_short([TABLE, CHAIR], BOXES, np.array([2.0, 3.0]))
    assert not found[0].any()
    np.testing.assert_array_equal(found[1], [True, True, False, False])


def test_the_picture_s_border_hides_nothing() -> None:
    alone = marked("table", (0, 0, 200, 100))
    assert not edges_cut_short([alone], np.array([alone.box]), np.array([2.0])).any()
    assert edges_cut_short([], np.zeros((0, 4)), np.zeros(0)).shape == (0, 4)
