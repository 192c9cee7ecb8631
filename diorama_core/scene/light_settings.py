"""How a person lights the room: the sun by time of day and direction, the lamps, and the exposure."""

from __future__ import annotations

import math
from dataclasses import dataclass

MAX_EXPOSURE_EV = 4.0
"""A picture is made at most so many stops brighter or darker."""


@dataclass(frozen=True)
class LightSettings:
    """The light that a person chose; the default is the light of the photo."""

    hour: float | None = None
    """Local solar time, 0 to 24; None keeps the light of the photo."""
    north_rad: float = math.pi / 2
    """Direction of north in the world, counter-clockwise from +X."""
    exposure_ev: float = 0.0
    """Stops by which pictures and the view are brighter (positive) or darker."""
    lamps_on: tuple[str, ...] | None = None
    """Ids of the lamps that shine. None where nobody chose: the photo's light holds theirs already, so the view and
    pictures add none, and files give every lamp its usual light."""

    def __post_init__(self) -> None:
        numbers = [self.north_rad, self.exposure_ev, *([] if self.hour is None else [self.hour])]
        if not all(math.isfinite(n) for n in numbers):
            raise ValueError("every number of the light must be finite")
        if self.hour is not None and not 0.0 <= self.hour <= 24.0:
            raise ValueError("the time of day must be from 0 to 24 hours")
        if abs(self.exposure_ev) > MAX_EXPOSURE_EV:
            raise ValueError(f"the exposure must be from -{MAX_EXPOSURE_EV:g} to {MAX_EXPOSURE_EV:g} stops")

    @property
    def exposure(self) -> float:
        """Factor by which light is multiplied."""
        return 2.0**self.exposure_ev


PHOTO_LIGHT = LightSettings()
"""Nothing chosen: the light of the photo."""
