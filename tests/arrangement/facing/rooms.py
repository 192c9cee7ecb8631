"""Rooms of boxes about which nothing was seen, for terms and their decision."""

from __future__ import annotations

import numpy as np

from diorama_core.arrangement.facing.evidence import HEADINGS, FacingObject, FacingRoom, WallSamples

NO_WALLS = WallSamples(np.zeros((0, 2)), np.zeros((0, 2)))


def thing(kind: str, x: float, y: float, size=(0.5, 0.5, 0.9), turn_deg: float = -90.0, **more) -> FacingObject:
    """On the floor unless told otherwise; its picture tells nothing."""
    name = f"{kind} at {x} {y}"
    known = {"picture": np.zeros(HEADINGS), **more}
    return FacingObject(name, kind, np.array([x, y, size[2] / 2]), np.array(size), np.deg2rad(turn_deg), **known)


def room(*objects: FacingObject, walls: WallSamples = NO_WALLS) -> FacingRoom:
    """Seen from the origin."""
    return FacingRoom(objects, np.zeros(2), walls)


def wall_along_y(at_x: float) -> WallSamples:
    """A wall that looks toward +X."""
    y = np.linspace(0.0, 5.0, 100)
    return WallSamples(np.column_stack([np.full_like(y, at_x), y]), np.tile([1.0, 0.0], (100, 1)))


def heading_deg(item: FacingObject, heading: int) -> int:
    """The direction of a heading, from +X on, -180 to 179."""
    return (round(np.rad2deg(item.yaw_rad) + 360 / HEADINGS * heading) + 180) % 360 - 180
