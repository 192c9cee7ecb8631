from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.rac.arrangement import arrangement, inverse_depths
from tests.synthetic_rooms import box_room, look


def planes_of(room):
    return np.stack([p.normal for p in room]), np.array([p.offset for p in room])


def test_inverse_depth_of_a_plane_is_that_of_its_points():
    camera = look(20, 10)
    floor = box_room(-2, 2, 4, 2.5)[0]
    a = inverse_depths(*planes_of([floor]), camera)
    point = np.array([[0.3, 2.0, 0.0]])
    pixel = camera.project(point)
    assert float(pixel[0] @ a[0, :2] + a[0, 2]) == pytest.approx(1.0 / camera.to_camera(point)[0, 2])


def test_cells_fill_the_picture_and_know_their_pixels():
    camera = look(25, 8)
    cells = arrangement(inverse_depths(*planes_of(box_room(-2, 2, 4, 2.5)), camera), (640, 480))
    areas = []
    for cell in cells.cells:
        x, y = cell.corners.T
        areas.append(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2)
    assert sum(areas) == pytest.approx(640 * 480, rel=1e-3)
    middles = np.array([c.corners.mean(axis=0) for c in cells.cells])
    assert cells.holds(middles).tolist() == list(range(len(cells.cells)))


def test_neighbours_differ_by_the_line_between_them():
    cells = arrangement(inverse_depths(*planes_of(box_room(-2, 2, 4, 2.5)), look()), (640, 480))
    pairs = cells.neighbours()
    assert pairs
    for a, b, line in pairs:
        differ = [k for k, (s, t) in enumerate(zip(cells.cells[a].sides, cells.cells[b].sides, strict=True)) if s != t]
        assert differ == [line]


def test_one_plane_that_fills_the_picture_is_one_cell():
    back = box_room(-2, 2, 4, 2.5)[1]
    cells = arrangement(inverse_depths(*planes_of([back]), look(0, 0)), (640, 480))
    assert len(cells.cells) == 1
    assert cells.lines == ()
