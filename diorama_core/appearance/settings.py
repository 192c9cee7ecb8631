"""The numbers by which photo, scene and room are compared, but for those of single surfaces."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class AppearanceSettings:
    """What is read of the photo for the materials and the light of a whole scene."""

    step_px: int = 4
    """Every fourth pixel of the walls each way is looked at."""
    rim: float = 0.01
    """Share of the photo's longer side that is left out around every object, where its shadow lies."""
    min_cells: int = 60
    """Pixels looked at from which a wall has a colour."""
    same_paint: float = 0.03
    """Chromaticities of walls that differ by less are of one paint."""
    by_day: float = 0.4
    """Brightness of a window over that of what is seen in the middle, below which it is night."""
    mask_margin: float = 0.004
    """Widening of what stands before an object, as a share of the photo's longer side."""
    edges_px: tuple[int, ...] = (5, 3)
    """Sides of the squares by which masks are narrowed: their edges show something of what is beside."""
    min_inner: float = 0.3
    """Share of a mask that must be left of it."""
    brightness_rounds: int = 2
    """Times that the scene is shown and set against the photo."""
    longest_px: int = 200
    """Size of the picture of the scene for that."""
    min_pixels: int = 12
    """Pixels of it below which nothing is said of an object."""
    max_gain: float = 1.5
    """What is more than so much brighter or darker is another surface than the one that is seen."""


SETTINGS = AppearanceSettings()
