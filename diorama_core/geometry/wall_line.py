"""A wall as a line on the floor: what stands before it, and how far along."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.scene.values import ArrayValue


@dataclass(frozen=True, eq=False)
class WallLine(ArrayValue):
    """One wall from its left to its right end, as seen from inside the room; metres."""

    id: str
    start: Float[np.ndarray, "2"]
    end: Float[np.ndarray, "2"]

    @property
    def length_m(self) -> float:
        """From end to end."""
        return float(np.linalg.norm(self.end - self.start))

    @property
    def along(self) -> Float[np.ndarray, "2"]:
        """Unit, from left to right."""
        return (self.end - self.start) / self.length_m

    @property
    def inward(self) -> Float[np.ndarray, "2"]:
        """Unit, into the room."""
        return np.array([self.along[1], -self.along[0]])

    @property
    def yaw_rad(self) -> float:
        """Heading of what stands with its back to it."""
        return float(np.arctan2(self.inward[1], self.inward[0]))

    def point(self, t_m: float, off_m: float = 0.0) -> Float[np.ndarray, "2"]:
        """The place `t_m` from the left end and `off_m` into the room."""
        return self.start + self.along * t_m + self.inward * off_m

    def t_of(self, xy: Float[np.ndarray, "*n 2"]) -> Float[np.ndarray, "*n"]:
        """How far along the wall points are."""
        return np.asarray((np.asarray(xy) - self.start) @ self.along)

    def off_of(self, xy: Float[np.ndarray, "*n 2"]) -> Float[np.ndarray, "*n"]:
        """How far before the wall points are."""
        return np.asarray((np.asarray(xy) - self.start) @ self.inward)
