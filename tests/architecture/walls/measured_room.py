"""A photographed room as a measured surface, for tests of what is read from it."""

from __future__ import annotations

from functools import cache

from diorama_core.architecture.texture.colours import object_pixels
from diorama_core.architecture.walls.surface import MeasuredSurface, measure_surface
from tests.synthetic_rooms import Shot, box_room, cuboid, look, shoot

TOP_M = 2.6


@cache
def plain_shot(noise: float = 0.0) -> Shot:
    """A box room with a wardrobe before the far wall."""
    wardrobe = cuboid("wardrobe", (-0.8, 3.6, 0), (0.6, 1.0, 2.0), -90)
    camera = look(0, 2, 1.5, 80, (320, 240))
    return shoot(camera, box_room(-2.0, 2.0, 4.0, TOP_M), (wardrobe,), ("wardrobe",), noise=noise)


def surface_of(shot: Shot) -> MeasuredSurface:
    depth = shot.inputs.depth_m
    return measure_surface(depth, shot.camera, object_pixels(depth.shape, shot.objects))
