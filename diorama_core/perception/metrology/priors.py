"""How big a thing may be: the modes of its size, read from the taxonomy.

A general word covers more than its own row ("table" is also said of coffee tables), and a thing without a name is
most likely one of the usual kinds of furniture; each such reading is a further mode at a price.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import UNKNOWN, SizePrior, category

_ALSO = {
    "table": (("coffee table", 1.5), ("side table", 2.5)),
    "sofa": (("armchair", 2.5),),
    "chair": (("armchair", 3.0),),
    "cabinet": (("dresser", 0.5), ("wardrobe", 2.0)),
    "plant": (("vase", 2.0),),
    "lamp": (("floor lamp", 4.0),),
}
"""Category: further categories it is used for, with the cost of that reading."""

_UNNAMED = ("chair", "armchair", "sofa", "table", "coffee table", "dresser", "night stand", "bed", "wardrobe")
_UNNAMED_WIDENED = 1.3
_UNNAMED_ANYTHING_COST = 3.5


@dataclass(frozen=True, eq=False)
class SizeMode:
    """One reading of what a thing is, as far as size goes."""

    log_size: Float[np.ndarray, "3"]
    """Logarithms of depth, width, height in metres."""
    sigma: Float[np.ndarray, "3"]
    cost: float

    @property
    def square(self) -> bool:
        """Whether width and depth are so alike that turning by a quarter changes nothing."""
        return bool(abs(self.log_size[0] - self.log_size[1]) < 0.1)


@cache
def size_modes(name: str) -> tuple[SizeMode, ...]:
    """The modes of a canonical category, the most usual first."""
    if name == UNKNOWN.name:
        kinds = tuple(_mode(category(kind).priors[0], 0.0, _UNNAMED_WIDENED) for kind in _UNNAMED)
        return (*kinds, _mode(UNKNOWN.priors[0], _UNNAMED_ANYTHING_COST))
    own = tuple(_mode(prior, 0.0) for prior in category(name).priors)
    also = tuple(_mode(category(kind).priors[0], cost) for kind, cost in _ALSO.get(name, ()))
    return own + also


@cache
def supported_modes(name: str) -> tuple[SizeMode, ...]:
    """The modes of a thing that lies on another; unnamed things are small there."""
    if name == UNKNOWN.name:
        return (SizeMode(np.log([0.25, 0.3, 0.28]), np.array([0.5, 0.5, 0.5]), 0.0),)
    return size_modes(name)


@cache
def hung_modes(name: str) -> tuple[SizeMode, ...]:
    """The modes of a thing on a wall; unnamed things are flat there."""
    if name == UNKNOWN.name:
        return (SizeMode(np.log([0.05, 0.8, 0.7]), np.array([0.4, 0.5, 0.5]), 0.0),)
    return size_modes(name)


@cache
def hanging_modes(name: str) -> tuple[SizeMode, ...]:
    """The modes of a thing below the ceiling; unnamed things are lamps there."""
    if name == UNKNOWN.name:
        lamp = category("ceiling lamp").priors[0]
        return (_mode(lamp, 0.0, _UNNAMED_WIDENED),)
    return size_modes(name)


def _mode(prior: SizePrior, cost: float, widened: float = 1.0) -> SizeMode:
    return SizeMode(prior.log_median_xyz, prior.log_sigma_xyz * widened, cost)
