"""The numbers of the geometric graph."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class GeometricGraphSettings:
    """Costs of supporters by measured geometry, and what is seen around objects."""

    unnamed_prior: tuple[float, float, float, float] = (1.0, 0.5, 2.0, 5.0)
    carries_nothing_cost: float = 5.0
    larger_cost: float = 4.0
    """Cost of lying on something whose footprint is much smaller."""
    floor_gap_m: float = 0.10
    top_gap_m: float = 0.06
    inner_gap_m: float = 0.10
    """Usual errors of an underside's height above the floor, a top, a shelf."""
    max_gap_cost: float = 8.0
    below_weight: float = 3.0
    """Weight of what is seen just below the object."""
    belief_cost: float = 1.5
    """Cost of contradicting the geometry stage."""
    within_rug: float = 3.0
    """What standing within a rug speaks for being on it, against the floor."""
    rim_px: float = 0.012
    """How far below an object's lower rim to look, as a share of the picture's height."""
    nearer_m: float = 0.08
    """Something this much nearer below the rim hides the object's end."""
    level_m: float = 0.12
    """Two seen points whose heights differ by less are at one level."""
    contact_m: float = 0.12
    """Farther than this behind the rim, what is seen below is background, not the carrier."""


SETTINGS = GeometricGraphSettings()
