from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.architecture.rac.arrangement import arrangement, inverse_depths
from diorama_core.architecture.rac.comparison import best_layout, cell_costs
from diorama_core.architecture.rac.proposals import proposals
from diorama_core.architecture.walls.surface import measured_surface
from tests.synthetic_rooms import box_room, cuboid, look, shoot

CAMERA = look(15, 8, fov_deg=80)
ROOM = box_room(-2.0, 2.0, 4.0, 2.5)


def looked_at(cuboids=()):
    shot = shoot(CAMERA, ROOM, cuboids)
    surface = measured_surface(shot.inputs.depth_m, CAMERA, shot.inputs.instances > 0)
    return surface, proposals(surface)


def test_the_best_layout_s_depth_is_that_of_the_empty_room():
    surface, found = looked_at((cuboid("cabinet", (-0.6, 2.6, 0), (0.6, 1.0, 0.8)),))
    layout = best_layout(surface, found, CAMERA)
    empty, _ = looked_at()
    pixels = CAMERA.project(empty.points)
    off = np.abs(layout.depth_at(pixels) - empty.depth_m)
    assert np.quantile(off, 0.97) < 0.05
    assert set(layout.planes_at(pixels)) <= set(range(len(found.normals)))


def test_what_hides_the_room_costs_nothing_behind_it_and_something_before_it():
    surface, found = looked_at()
    cells = arrangement(inverse_depths(found.normals, found.offsets, CAMERA), (640, 480))
    everything = np.ones(len(surface.points), bool)
    nothing = replace(found, segment=np.full(len(surface.points), -1))
    nearer = replace(surface, is_object=everything, depth_m=0.5 * surface.depth_m)
    assert cell_costs(cells, nearer, nothing, CAMERA).min(axis=1).max() == 0.0
    farther = replace(surface, is_object=everything, depth_m=2.0 * surface.depth_m)
    assert cell_costs(cells, farther, nothing, CAMERA).min(axis=1).sum() > 0.2


def test_without_planes_there_is_no_layout():
    surface, found = looked_at()
    none = replace(found, normals=np.zeros((0, 3)), offsets=np.zeros(0), segment=np.full(len(surface.points), -1))
    assert best_layout(surface, none, CAMERA) is None
