"""Lines of sight: how far along its own an object from a photo alone must be to be where its supporter is."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

MAX_NEARER = 1.4
"""An object is brought to its supporter along its line of sight by at most this factor, either way."""
MIN_FACING = 0.3
"""Cosine between a supporter's front and the line of sight from which on its middle plane tells distances."""


def nearness(
    eye: Float[np.ndarray, "3"],
    front: Float[np.ndarray, "3"],
    supporter: Float[np.ndarray, "3"],
    load: Float[np.ndarray, "3"],
) -> float:
    """How many times as far as it was observed a load is in the upright middle plane of its supporter.

    Where that plane is seen edge-on, what is as far away as the supporter's middle.

    Args:
        eye: the camera's position.
        front: unit, where the supporter's front looks.
        supporter: its centre.
        load: the load's observed centre.
    """
    sight, away = load - eye, supporter - eye
    if abs(float(front @ away)) < MIN_FACING * float(np.linalg.norm(away)) or float(front @ sight) == 0.0:
        front = sight
    factor = float(front @ away) / float(front @ sight)
    return float(np.clip(factor, 1.0 / MAX_NEARER, MAX_NEARER)) if factor > 0.0 else 1.0
