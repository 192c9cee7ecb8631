from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.architecture.rac.arrangement import arrangement, inverse_depths
from diorama_core.architecture.rac.search import best_layout, borders_of, cell_costs, label_cells
from tests.architecture.rac.test_proposals import CAMERA, proposed
from tests.synthetic_rooms import box_room, cuboid, look

ROOM = box_room(-2.0, 2.0, 4.0, 2.5)


def test_the_best_layout_s_depth_is_that_of_the_empty_room():
    surface, found = proposed(ROOM, (cuboid("cabinet", (-0.6, 2.6, 0), (0.6, 1.0, 0.8)),))
    layout = best_layout(surface, found, CAMERA)
    empty, _ = proposed(ROOM)
    pixels = CAMERA.project(empty.points)
    off = np.abs(layout.depth_at(pixels) - empty.depth_m)
    assert np.quantile(off, 0.97) < 0.05
    assert set(layout.planes_at(pixels)) <= set(range(len(found.normals)))


def test_what_hides_the_room_costs_nothing_behind_it_and_something_before_it():
    surface, found = proposed(ROOM)
    cells = arrangement(inverse_depths(found.normals, found.offsets, CAMERA), (640, 480))
    everything = np.ones(len(surface.points), bool)
    nothing = replace(found, segment=np.full(len(surface.points), -1))
    nearer = replace(surface, is_object=everything, depth_m=0.5 * surface.depth_m)
    assert cell_costs(cells, nearer, nothing, CAMERA).min(axis=1).max() == 0.0
    farther = replace(surface, is_object=everything, depth_m=2.0 * surface.depth_m)
    assert cell_costs(cells, farther, nothing, CAMERA).min(axis=1).sum() > 0.2


def test_without_planes_there_is_no_layout():
    surface, found = proposed(ROOM)
    none = replace(found, normals=np.zeros((0, 3)), offsets=np.zeros(0), segment=np.full(len(surface.points), -1))
    assert best_layout(surface, none, CAMERA) is None


CELLS = arrangement(
    inverse_depths(np.stack([p.normal for p in ROOM]), np.array([p.offset for p in ROOM]), look(15, 5)), (640, 480)
)


def true_costs():
    """A convex room shows the nearest plane before the camera."""
    costs = np.ones((len(CELLS.cells), len(ROOM)))
    truth = []
    for k, cell in enumerate(CELLS.cells):
        middle = cell.corners.mean(axis=0, keepdims=True)
        q = [float(CELLS.inverse_at(p, middle)[0]) for p in range(len(ROOM))]
        truth.append(int(np.argmax(q)))
        costs[k, truth[-1]] = 0.0
    return costs, tuple(truth)


def test_a_room_that_is_seen_is_found():
    costs, truth = true_costs()
    assert label_cells(costs, borders_of(CELLS)) == truth


def test_planes_that_do_not_meet_there_may_not_be_neighbours():
    costs, truth = true_costs()
    k = max(range(len(truth)), key=lambda c: len(borders_of(CELLS)[c]))
    wrong = costs.copy()
    wrong[k] = 0.1
    wrong[k, (truth[k] + 1) % len(ROOM)] = 0.0  # a little cheaper, and impossible among these neighbours
    assert label_cells(wrong, borders_of(CELLS)) == truth


def test_no_layout_where_a_cell_can_show_nothing():
    costs, _ = true_costs()
    costs[0] = np.inf
    assert label_cells(costs, borders_of(CELLS)) is None
    assert label_cells(np.zeros((0, 0)), ()) is None
