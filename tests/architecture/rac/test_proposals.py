from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.rac.proposals import MAX_PLANES, proposals
from diorama_core.architecture.walls.surface import measure_surface
from tests.synthetic_rooms import box_room, cuboid, look, shoot

CAMERA = look(15, 8, fov_deg=80)


def proposed(planes, cuboids=()):
    shot = shoot(CAMERA, planes, cuboids)
    surface = measure_surface(shot.inputs.depth_m, CAMERA, shot.inputs.instances > 0)
    return surface, proposals(surface)


def test_every_plane_of_a_box_room_is_proposed_once_though_furniture_parts_it():
    tall = cuboid("shelf", (-0.6, 3.2, 0), (0.4, 0.8, 2.4))  # before the middle of the back wall
    surface, found = proposed(box_room(-2.0, 2.0, 4.0, 2.5), (tall,))
    roles = [found.role(k) for k in range(len(found.normals))]
    assert sorted(roles) == ["ceiling", "floor", "wall", "wall"]
    assert (found.segment[surface.is_object] == -1).all(), "furniture proposes nothing"
    for k, (normal, offset) in enumerate(zip(found.normals, found.offsets, strict=True)):
        assert normal @ CAMERA.position > offset, "toward the camera"
        assert np.abs(surface.points[found.segment == k] @ normal - offset).max() < 0.15
    assert (found.segment >= 0).mean() > 0.7


def test_the_largest_planes_are_taken_and_nothing_gives_none():
    posts = tuple(cuboid(f"post{k}", (-1.6 + 0.8 * k, 2.0 + 0.3 * (k % 2), 0), (0.3, 0.3, 2.5)) for k in range(5))
    shot = shoot(CAMERA, box_room(-2.0, 2.0, 4.0, 2.5), posts)
    free = np.zeros_like(shot.inputs.instances, dtype=bool)
    found = proposals(measure_surface(shot.inputs.depth_m, CAMERA, free))
    assert len(found.normals) <= MAX_PLANES
    nothing = proposals(measure_surface(shot.inputs.depth_m, CAMERA, ~free))
    assert len(nothing.normals) == 0
    assert (nothing.segment == -1).all()
    assert found.offsets[[found.role(k) for k in range(len(found.normals))].index("floor")] == pytest.approx(
        0, abs=0.02
    )
