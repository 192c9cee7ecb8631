"""Edits as plans make them: corners of the room are dragged, walls get a length that was typed. Pure functions.

Both move whole walls along their normals, so that the room stays closed and what is fastened to them follows
(`scene.room_edits.move_plane`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.errors import EditRefused
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.room_edits import move_plane
from diorama_core.scene.types import Plane, Scene

MEET_M = 0.05
"""Ends of walls nearer than this are one corner."""
LONGEST_M = 50.0
SQUARE = 0.2
"""Least sine between a wall and the one that is moved to change its length."""

Point = Float[np.ndarray, "2"]


@dataclass(frozen=True)
class WallFoot:
    """A wall's face on the floor, from left to right seen from inside the room (metres, world x and y)."""

    id: str
    start: Point
    end: Point
    outward: Point
    """Unit, out of the room."""

    @property
    def length_m(self) -> float:
        """Between its ends."""
        return float(np.linalg.norm(self.end - self.start))

    @property
    def along(self) -> Point:
        """Unit, from start to end."""
        return (self.end - self.start) / max(self.length_m, 1e-9)


@dataclass(frozen=True)
class Corner:
    """Where two walls meet."""

    first: str
    """The wall that ends here, seen from inside the room from left to right."""
    second: str
    """The wall that starts here."""
    at: Point


def wall_feet(scene: Scene) -> tuple[WallFoot, ...]:
    """Every wall's foot."""
    return tuple(_foot(p) for p in scene.architecture.by_role("wall"))


def corners(scene: Scene) -> tuple[Corner, ...]:
    """Every corner of two walls."""
    feet = wall_feet(scene)
    return tuple(
        Corner(a.id, b.id, (a.end + b.start) / 2)
        for a in feet
        for b in feet
        if a.id != b.id and float(np.linalg.norm(a.end - b.start)) < MEET_M
    )


def move_corner(scene: Scene, first: str, second: str, shift: Point) -> Scene:
    """Move a corner by moving both of its walls: each stays parallel to what it was.

    Args:
        scene: as it is.
        first: id of a wall.
        second: id of the wall beside it.
        shift: of the corner, world x and y, metres.

    Raises:
        EditRefused: when the walls do not meet in a corner, or one would vanish.
    """
    if not any({c.first, c.second} == {first, second} for c in corners(scene)):
        raise EditRefused("these walls do not meet in a corner")
    shift = np.asarray(shift, dtype=np.float64)
    for wall in (first, second):
        outward = -scene.plane(wall).normal[:2]
        scene = move_plane(scene, wall, float(outward @ shift))
    return scene


def set_wall_length(scene: Scene, wall_id: str, length_m: float) -> Scene:
    """Give a wall a length by moving the wall at its right end, or else the one at its left.

    Raises:
        EditRefused: when the length is none, or no wall stands at its ends.
    """
    feet = {f.id: f for f in wall_feet(scene)}
    if wall_id not in feet:
        raise EditRefused("only walls have a length to set")
    if not 0.1 <= length_m <= LONGEST_M:
        raise EditRefused(f"a wall cannot be {length_m:g} m long; give 0.1 to {LONGEST_M:g} m")
    wall = feet[wall_id]
    after = [c.second for c in corners(scene) if c.first == wall_id]
    before = [c.first for c in corners(scene) if c.second == wall_id]
    for end, sign in [*((feet[i], 1.0) for i in after), *((feet[i], -1.0) for i in before)]:
        lever = sign * float(end.outward @ wall.along)
        if abs(lever) > SQUARE:
            return move_plane(scene, end.id, (length_m - wall.length_m) * lever)
    raise EditRefused("no other wall stands at its ends; drag a wall instead")


def _foot(wall: Plane) -> WallFoot:
    origin, axes, extents = plane_rectangle(wall)
    start = origin[:2]
    flat = -wall.normal[:2]
    return WallFoot(wall.id, start, start + axes[:2, 0] * extents[0], flat / max(float(np.linalg.norm(flat)), 1e-9))
