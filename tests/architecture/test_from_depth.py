"""Planes from measured depth: ceilings, screens, chains of walls, real photos; kinds of rooms: `test_known_rooms`."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.progress import Progress
from tests import synthetic_rooms
from tests.architecture.known_rooms import L_SHAPE
from tests.synthetic_rooms import box_room, cuboid, floor, shoot, wall

look = partial(synthetic_rooms.look, size=(400, 300))


def reconstruct(shot, with_masks=False):
    objects = shot.objects if with_masks else ()
    return PlanarRoom().reconstruct(shot.inputs, objects, shot.geometry, Progress())


def matched(walls, normal, offset, angle_deg, distance_m):
    """The walls that are one true wall within tolerances."""
    normal = np.array(normal, dtype=float) / np.linalg.norm(normal)
    close = np.cos(np.deg2rad(angle_deg))
    return [w for w in walls if w.normal @ normal > close and abs(w.offset - offset) < distance_m]


def test_ceiling_is_found_and_retained():
    shot = shoot(look(0, -8, fov_deg=75), box_room(-2.0, 2.0, 4.0, 2.45))
    (ceiling,) = reconstruct(shot).architecture.by_role("ceiling")
    assert ceiling.polygon[:, 2] == pytest.approx(2.45, abs=0.03)


def test_a_tall_screen_is_not_a_wall():
    screen = cuboid("screen", (0.3, 2.0, 0), (0.1, 1.4, 1.7), yaw_deg=-90)
    shot = shoot(look(0, 8), box_room(-2.2, 2.2, 4.5, 2.6), (screen,))
    walls = reconstruct(shot).architecture.by_role("wall")
    assert not matched(walls, (0, -1, 0), -1.95, 5.0, 0.2)
    assert matched(walls, (0, -1, 0), -4.5, 2.0, 0.05)


def test_a_door_shows_the_wall_that_it_fills():
    """An alcove 1 m wide ends in a door that leaves nothing of its wall to see."""
    alcove = (
        floor((-2, -2), (2, -2), (2, 4), (-2, 4)),
        floor((-0.5, 4), (0.5, 4), (0.5, 5.5), (-0.5, 5.5)),
        wall("left", (-2, -2), (-2, 4), 2.4),
        wall("far left", (-2, 4), (-0.5, 4), 2.4),
        wall("side left", (-0.5, 4), (-0.5, 5.5), 2.4),
        wall("side right", (0.5, 5.5), (0.5, 4), 2.4),
        wall("far right", (0.5, 4), (2, 4), 2.4),
        wall("right", (2, 4), (2, -2), 2.4),
    )
    door = cuboid("door", (0.0, 5.48, 0.0), (0.05, 1.0, 2.4), yaw_deg=-90)
    shot = shoot(look(0, 8), alcove, (door,))
    shot = replace(shot, objects=tuple(replace(o, label="door", category="door") for o in shot.objects))
    walls = reconstruct(shot, with_masks=True).architecture.by_role("wall")
    assert [w for w in matched(walls, (0, -1, 0), -5.46, 2.0, 0.05) if w.confidence > 0.5]


def test_walls_chain_from_left_to_right_and_face_the_camera():
    shot = shoot(look(10, 12), L_SHAPE)
    architecture = reconstruct(shot).architecture
    walls = architecture.by_role("wall")
    for left, right in itertools.pairwise(walls):
        np.testing.assert_allclose(left.polygon[1], right.polygon[0], atol=1e-9)
    for plane in architecture.planes:
        assert abs(np.linalg.norm(plane.normal) - 1) < 1e-9
        if plane.confidence > 0.2:
            assert plane.normal @ shot.camera.position > plane.offset


def test_needs_depth():
    shot = shoot(look(), box_room(-2.0, 2.0, 3.5, 2.6))
    with pytest.raises(ValueError, match="measured depth"):
        PlanarRoom().reconstruct(replace(shot.inputs, depth_m=None), (), shot.geometry, Progress())


def test_real_depth_photos_have_floor_and_walls(photos):
    from diorama_core.perception.camera.estimate import EmbeddedCamera
    from diorama_core.perception.measured import MeasuredGeometry

    for entry in (p for p in photos if p.depth is not None):
        inputs = entry.inputs
        camera = EmbeddedCamera().estimate(inputs, Progress())
        geometry = MeasuredGeometry().measure(inputs, camera, (), Progress())
        estimate = PlanarRoom().reconstruct(inputs, (), geometry, Progress())
        measured = [w for w in estimate.architecture.by_role("wall") if w.confidence > 0.5]
        assert measured, entry.id
        assert estimate.architecture.floor.confidence > 0.9, entry.id
