"""What was measured of a room elsewhere: walls, openings, floors, and boxes with things in them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from jaxtyping import Float

from diorama_core.importing.point_cloud import ScanPhoto

OpeningKind = Literal["door", "window", "opening"]
RESTS_M = 0.08
"""How far the bottom of a box may be off what it stands on."""


@dataclass(frozen=True, eq=False)
class MeasuredWall:
    """A flat wall: corners of its middle plane in the world, in order, either way round."""

    id: str
    polygon: Float[np.ndarray, "n 3"]
    thickness_m: float = 0.0
    """Thickness of a slab centred on the corners; 0 where the corners lie on the surface."""


@dataclass(frozen=True, eq=False)
class MeasuredOpening:
    """A door, a window, or a hole in a wall."""

    kind: OpeningKind
    centre: Float[np.ndarray, "3"]
    width_m: float
    height_m: float
    wall: str | None = None
    """Id of its wall, where the file names it; otherwise the nearest one is taken."""


@dataclass(frozen=True, eq=False)
class MeasuredBox:
    """A box with a thing in it."""

    label: str
    kinds: Mapping[str, float]
    """Categories that it may be of, with how often its word means each; sizes decide among them."""
    R_world_box: Float[np.ndarray, "3 3"]
    """Axes of the box in the world: x to the front, z up."""
    centre: Float[np.ndarray, "3"]
    size_m: Float[np.ndarray, "3"]
    """Along x (depth), y (width), z (height)."""
    confidence: float = 1.0
    points: Float[np.ndarray, "n 3"] | None = None
    """Scanned points of the object's surface, in the world (m)."""
    kinds_know_size: bool = False
    """Whether the shares of its kinds say already how usual its size is for each."""
    fits: Mapping[str, float] = field(default_factory=dict)
    """How well shapes agree with the points, by id, 0 to 1; those that were not compared agree as the worst of them."""

    def is_under(self, box: MeasuredBox) -> bool:
        """Whether another box stands on it."""
        top, bottom = self.centre[2] + self.size_m[2] / 2, box.centre[2] - box.size_m[2] / 2
        off = np.abs(self.R_world_box.T @ (box.centre - self.centre))[:2]
        return abs(float(top - bottom)) < RESTS_M and bool((off < self.size_m[:2] / 2).all())


@dataclass(frozen=True, eq=False)
class MeasuredFloor:
    """The floor of one room of a flat or a storey."""

    outline: Float[np.ndarray, "n 2"]
    height_m: float
    name: str = ""
    """What the file calls the room."""


@dataclass(frozen=True, eq=False)
class MeasuredRoom:
    """Everything that was measured. World frame: +Z up, metres."""

    walls: tuple[MeasuredWall, ...]
    boxes: tuple[MeasuredBox, ...]
    openings: tuple[MeasuredOpening, ...] = ()
    floors: tuple[MeasuredFloor, ...] = ()
    """Those that the file has; otherwise one within the walls, at their lowest corner."""
    notes: tuple[str, ...] = field(default=())
    photos: tuple[ScanPhoto, ...] = ()
    """Taken while the room was measured, their cameras in the world."""
