"""The numbers of the camera stage that reads straight lines."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LineCameraSettings:
    """How focal length and attitude are read from straight lines."""

    min_segments: int = 6
    """Fewer segments do not determine the room's axes."""
    frame_margin: float = 0.025
    """Share of the longer side within which a segment along the picture's side may be a frame's."""
    frame_slant: float = 0.02
    hopeless_gap: float = 0.12
    """A reading whose score is so much below the best one's is not worth a second look."""
    clear_gap: float = 0.05
    """A second reading whose score is nearer than this to the best one's makes the best one doubtful."""
    sure_support: float = 0.6
    unsure_support: float = 0.2
    """Shares of agreeing lines at which confidence is full and none."""
    doubtful: float = 0.35
    """Confidence up to which users are asked to check what lines say."""
    min_wall_share: float = 0.02
    """Share of the measured points on walls from which on they decide about the room's directions."""
    prior_weight: float = 0.03
    focal_prior: tuple[float, float] = (0.78, 0.25)
    """Focal length over the longer side: median, and standard deviation of the logarithm."""
    focal_range: tuple[float, float] = (0.35, 2.5)
    few_segments: float = 8.0
    """So many segments are half of full evidence against the prior."""
    directions: int = 4000
    rescored: int = 400
    difference: float = 2e-3


SETTINGS = LineCameraSettings()
