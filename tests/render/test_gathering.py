"""Fallen light: the same for every pixel of a surface, known to every pixel, dark where something is in the way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.render.gathering import gather_light
from diorama_core.render.lighting import Effort, Lighting, Spots, irradiance
from diorama_core.render.picture import scene_view
from diorama_core.render.shading import shoot
from diorama_core.render.world import World, scene_world
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()
SIZE = (161, 121)
"""Odd, so that the last row and column belong to gathered pixels and the ones before them do not."""
LIGHT = Lighting(
    window_centre=np.array([0.0, 2.0, 2.3]),
    window_edges=np.array([[0.5, 0.0, 0.0], [0.0, 0.5, 0.0]]),
    window_irradiance=np.array([1.0, 1.0, 1.0]),
    reference_m=2.0,
    sky=np.array([0.5, 0.5, 0.5]),
    ground=np.array([0.5, 0.5, 0.5]),
    reach_m=1.0,
)


def world_and_grid():
    scene = furnished_room(LIBRARY)
    world = scene_world(scene, LIBRARY)
    count = len(scene.objects)
    blockers = world.shadow_caster(without=range(count, count + len(scene.architecture.planes)))
    shot = shoot(world, blockers, scene_view(scene, "photo", SIZE), LIGHT, Effort(1, 1))
    return world, blockers, shot.grid


def test_an_even_sky_alone_lights_every_pixel_the_same() -> None:
    """Without a window and with nothing near, all that falls is the sky: also on rims and thin things."""
    world, _, grid = world_and_grid()
    sky_alone = replace(LIGHT, window_irradiance=np.zeros(3))
    empty = World([])
    fallen = gather_light(empty, empty.shadow_caster(), grid, sky_alone, Effort(1, 1))
    assert np.allclose(fallen[grid.found], 0.5, atol=1e-5)
    assert (fallen[~grid.found] == 0).all()
    assert len(world.vertices)


def test_light_agrees_with_many_rays() -> None:
    """A quarter of the pixels with few rays each tells the light of all, as hundreds of rays a pixel do."""
    world, blockers, grid = world_and_grid()
    fallen = gather_light(world, blockers, grid, LIGHT, Effort(3, 3))
    at = np.nonzero(grid.found)
    chosen = tuple(a[::37] for a in at)
    spots = Spots(grid.points[chosen], grid.normals[chosen], grid.flat_normals[chosen])
    true = np.add(*irradiance(world, blockers, spots, None, LIGHT, Effort(128, 128)))
    error = np.abs(fallen[chosen] - true).mean(axis=1)
    assert np.median(error) < 0.03
    assert np.percentile(error, 95) < 0.2


def test_a_window_sends_no_light_along_its_wall() -> None:
    up = np.array([[0.0, 0.0, 1.0]], np.float32)
    spots = Spots(np.array([[0.0, 2.0, 0.0], [0.0, -3.0, 2.3]], np.float32), np.repeat(up, 2, 0), np.repeat(up, 2, 0))
    below = replace(LIGHT, inward=np.array([0.0, 0.0, -1.0]))
    empty = World([])
    window, _ = irradiance(empty, empty.shadow_caster(), spots, None, below, Effort(4, 1))
    assert window[0, 0] > 0.3
    assert window[1, 0] < 0.01
