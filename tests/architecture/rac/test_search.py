from __future__ import annotations

import numpy as np

from diorama_core.architecture.rac.arrangement import arrangement, inverse_depths
from diorama_core.architecture.rac.search import borders_of, labelled
from tests.synthetic_rooms import box_room, look

PLANES = box_room(-2.0, 2.0, 4.0, 2.5)
CELLS = arrangement(
    inverse_depths(np.stack([p.normal for p in PLANES]), np.array([p.offset for p in PLANES]), look(15, 5)), (640, 480)
)


def true_costs():
    """A convex room shows the nearest plane before the camera."""
    costs = np.ones((len(CELLS.cells), len(PLANES)))
    truth = []
    for k, cell in enumerate(CELLS.cells):
        middle = cell.corners.mean(axis=0, keepdims=True)
        q = [float(CELLS.inverse_at(p, middle)[0]) for p in range(len(PLANES))]
        truth.append(int(np.argmax(q)))
        costs[k, truth[-1]] = 0.0
    return costs, tuple(truth)


def test_a_room_that_is_seen_is_found():
    costs, truth = true_costs()
    assert labelled(costs, borders_of(CELLS)) == truth


def test_planes_that_do_not_meet_there_may_not_be_neighbours():
    costs, truth = true_costs()
    k = max(range(len(truth)), key=lambda c: len(borders_of(CELLS)[c]))
    wrong = costs.copy()
    wrong[k] = 0.1
    wrong[k, (truth[k] + 1) % len(PLANES)] = 0.0  # a little cheaper, and impossible among these neighbours
    assert labelled(wrong, borders_of(CELLS)) == truth


def test_no_layout_where_a_cell_can_show_nothing():
    costs, _ = true_costs()
    costs[0] = np.inf
    assert labelled(costs, borders_of(CELLS)) is None
    assert labelled(np.zeros((0, 0)), ()) is None
