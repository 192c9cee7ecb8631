"""How far observed positions can be trusted: along the viewing ray, and across it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.scene.types import Camera


@dataclass(frozen=True)
class ObservationNoise:
    """Standard deviations of an observed position."""

    along: float
    """Along the viewing ray, as a share of the distance."""
    across_m: float
    """Across it, and the least along it."""
    measured: bool = False
    """Whether distances were measured; those reasoned from a photo alone follow from what holds an object."""

    def tolerance_m(
        self, camera: Camera | None, position: Float[np.ndarray, "3"], direction: Float[np.ndarray, "3"]
    ) -> float:
        """Two standard deviations of a position in one direction of the world; without a camera, those across.

        Args:
            camera: in the world.
            position: of the object, in the world (m).
            direction: unit, in the world.
        """
        if camera is None:
            return 2.0 * self.across_m
        sight = position - camera.position
        return 2.0 * float(np.hypot(self.along * float(sight @ direction), self.across_m))


MEASURED = ObservationNoise(along=0.01, across_m=0.02, measured=True)
"""With measured depth; most of it is what the object itself hides."""
REASONED = ObservationNoise(along=0.05, across_m=0.05)
"""From a photo alone, relative to what is beside or below: errors common to the room cancel."""
