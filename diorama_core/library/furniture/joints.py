"""What of a piece moves: hinges, drawers and swivels, known by construction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from diorama_core.library.furniture.solids import axis_rotation

JointKind = Literal["hinge", "slide", "swivel"]
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Joint:
    """One degree of freedom, 0 where the piece is built. Parts of equal joints move together."""

    name: str
    """What moves: "door", "drawer", "lid", "seat"."""
    kind: JointKind
    """A hinge turns between limits, a slide moves along its axis, a swivel turns without end."""
    origin: Vector
    """A point on the axis, metres, in the frame of the parts."""
    axis: Vector
    """Unit direction: positive motion is along it, or right-handed about it."""
    lower: float = 0.0
    """Radians or metres; unused for swivels."""
    upper: float = 0.0

    def moved(self, x: float, y: float, z: float) -> Joint:
        """Shifted with its parts."""
        a, b, c = self.origin
        return replace(self, origin=(a + x, b + y, c + z))

    def turned(self, axis: str, angle_deg: float) -> Joint:
        """Turned with its parts about a coordinate axis through the origin."""
        R = axis_rotation(axis, angle_deg)
        return replace(self, origin=_vector(R @ self.origin), axis=_vector(R @ self.axis))


def door_hinge(front: float, y: float, side: int) -> Joint:
    """The hinge of a leaf whose front is the plane x = `front`, at its edge `y`; `side` +1 is its left (y high).

    The axis lies on the front's outer edge, so that the leaf's back never swings into the case.
    """
    return Joint("door", "hinge", (front, y, 0.0), (0.0, 0.0, float(side)), 0.0, float(np.pi / 2))


def drawer_slide(x: float, y: float, z: float, travel: float) -> Joint:
    """A drawer that comes out toward +X."""
    return Joint("drawer", "slide", (x, y, z), (1.0, 0.0, 0.0), 0.0, travel)


def _vector(values: np.ndarray) -> Vector:
    x, y, z = (round(float(v), 9) for v in values)
    return (x, y, z)
