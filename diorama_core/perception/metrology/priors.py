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

_UNNAMED = {
    "chair": 0.0,
    "armchair": 1.0,
    "sofa": 1.0,
    "table": 1.0,
    "coffee table": 1.0,
    "dresser": 1.5,
    "night stand": 1.0,
    "bed": 1.5,
    "wardrobe": 4.5,
}
"""What unnamed furniture may be, with the cost of the rarer kinds."""
_UNNAMED_WIDENED = 1.3
_UNNAMED_ANYTHING_COST = 6.0
_USUAL_SPREAD = 3 * np.log(0.16)
"""Sum of the logarithms of the sigmas of an ordinary category: wider ones explain anything, and pay for it."""


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
        priors = [(category(kind).priors[0], cost) for kind, cost in _UNNAMED.items()]
        kinds = tuple(_mode(p, cost + _breadth_cost(p), _UNNAMED_WIDENED) for p, cost in priors)
        return (*kinds, _mode(UNKNOWN.priors[0], _UNNAMED_ANYTHING_COST))
    own = tuple(_mode(prior, 0.0) for prior in category(name).priors)
    also = tuple(_mode(category(kind).priors[0], cost) for kind, cost in _ALSO.get(name, ()))
    return own + also


@cache
def supported_modes(name: str) -> tuple[SizeMode, ...]:
    """The modes of a thing that lies on another; unnamed things are small there."""
    if name == UNKNOWN.name:
        return (SizeMode(np.log([0.2, 0.24, 0.24]), np.array([0.7, 0.7, 0.7]), 0.0),)
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


def _breadth_cost(prior: SizePrior) -> float:
    """Twice the difference of log densities at the mode between an ordinary category and this one."""
    return max(0.0, 2.0 * float(np.log(prior.log_sigma_xyz).sum() - _USUAL_SPREAD))


def _mode(prior: SizePrior, cost: float, widened: float = 1.0) -> SizeMode:
    return SizeMode(prior.log_median_xyz, prior.log_sigma_xyz * widened, cost)
