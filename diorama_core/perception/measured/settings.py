"""The numbers of objects measured in a depth map."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class MeasuredSettings:
    """How objects are measured in the points of a depth map."""

    voxel_m: float = 0.04
    max_cells: int = 128
    """Points farther than this many cells from the first, along an axis, are lumped together."""
    layer_gap_m: float = 0.12
    """Steps in depth larger than this (plus 4 % of the depth) separate an object from what is behind or before it."""
    assumed_height_m: float = 1.4
    """Assumed camera height when no floor is visible."""
    guess_confidence: float = 0.2
    ring_px: float = 0.02
    """Width of the ring of background around a mask, as a share of the picture."""
    full_points: int = 1500
    """From this many points on, a cloud is as good as it gets."""
    on_floor_m: float = 0.15
    """A bottom lower than this rests on the floor: lower parts are often hidden."""
    contact_m: float = 0.2
    """A bottom within this of a supporter's top rests on it."""
    rug_m: float = 0.05


SETTINGS = MeasuredSettings()
