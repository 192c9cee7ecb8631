"""How much each cost of a layout recipe counts, as a person may set it."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from diorama_core.errors import InputError

LARGEST = 10.0


@dataclass(frozen=True)
class Weights:
    """Factors on the costs of a recipe: 1 everywhere is the recipe as it is, 0 leaves a cost out.

    Support and the absence of overlap are no costs of the default recipe: it keeps to them exactly.

    Raises:
        InputError: a factor is negative, larger than `LARGEST` or no number.
    """

    align: float = 1.0
    """Contact faces parallel to what they rest on (published recipes)."""
    heading: float = 1.0
    """Fronts keep the direction seen in the photo (published recipes)."""
    place: float = 1.0
    """Contact faces touch what they rest on (published recipes)."""
    neighbours: float = 1.0
    """Objects near each other keep their arrangement (published recipes)."""
    volume: float = 1.0
    """Objects stay over and below what bounds their support (published recipes)."""
    collision: float = 1.0
    """Boxes apart (published recipes)."""
    outline: float = 1.0
    """Objects stay where they are seen in the photo (default recipe)."""
    distance: float = 1.0
    """Objects stay as far from the camera as observed (default recipe)."""

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not np.isfinite(value) or not 0.0 <= value <= LARGEST:
                raise InputError(f"the weight of {field.name} is {value:g}; give a factor from 0 to {LARGEST:g}")


AS_IT_IS = Weights()
PUBLISHED_COSTS = ("align", "heading", "place", "neighbours", "volume", "collision")
DEFAULT_COSTS = ("outline", "distance")


def weighted_costs(recipe: str) -> tuple[str, ...]:
    """The fields of `Weights` that make a difference to a recipe."""
    return DEFAULT_COSTS if recipe == "feasible" else PUBLISHED_COSTS
