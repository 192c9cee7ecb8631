"""How far a shape may be stretched to fill an observed cuboid, so that no chair becomes a pancake."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.geometry.openings import OPENING_CATEGORIES, STANDS_OUT_M
from diorama_core.library.record import SymmetryFold
from diorama_core.library.taxonomy import UNKNOWN, SizePrior, category, having
from diorama_core.pose.settings import SETTINGS, PoseSearchSettings

_STRETCH_SHAPED = float(np.log(1.28))
_STRETCH_BOXY = float(np.log(1.75))
_SIDES_SQUARE = 0.5 * float(np.log(1.3))
_STRETCH_FLAT = float(np.log(3.0))

BOXY = having("any_proportions")
"""Categories that come in all proportions; the others keep theirs more strictly."""

FLAT = having("flat_piece")
"""Categories of one flat piece that is made in any proportions: a tall narrow picture is no row of small ones."""


@dataclass(frozen=True, eq=False)
class SizeLimits:
    """What sizes a shape may be given."""

    shape_size_m: Float[np.ndarray, "3"]
    """At scale 1, never degenerate."""
    min_m: Float[np.ndarray, "3"]
    max_m: Float[np.ndarray, "3"]
    stretch_log: float
    """How far the logarithm of one axis' scale may be from the mean of the three."""
    sides_log: float = np.inf
    """How far the logarithms of the horizontal scales may be from their mean: 0 for what is round and stays round."""
    any_proportions: bool = False
    """Whether things of its category come in all proportions, so that stretching says nothing against a shape."""
    settings: PoseSearchSettings = SETTINGS.search

    @classmethod
    def of(
        cls,
        shape_size_m: tuple[float, float, float],
        category_name: str,
        observed_m: Float[np.ndarray, "3"],
        *,
        measured: bool = False,
        sides_log: float = np.inf,
        settings: PoseSearchSettings = SETTINGS.search,
    ) -> SizeLimits:
        """Limits for a shape standing for an object of a category, by the size prior nearest to what was observed.

        A measured height is plausible, however tall for its kind: what hides a thing leaves its top to be seen.

        Args:
            shape_size_m: of the shape, unscaled.
            category_name: of the object.
            observed_m: depth, width and height of the object's cuboid.
            measured: whether depth was measured.
            sides_log: largest deviation of the logarithm of a side's scale from the mean of both sides'.
            settings: of the search.
        """
        size_m = np.asarray(shape_size_m, dtype=np.float64)
        least, most = _category_range(category_name, observed_m, size_m, settings)
        if measured:
            most[2] = max(most[2], observed_m[2])
        elif category_name in OPENING_CATEGORIES:  # its frame is in the wall: only what stands out is seen
            least[0] = most[0] = STANDS_OUT_M
        flat = category_name in FLAT and not measured  # measured proportions tell which frame it is
        stretch = _STRETCH_FLAT if flat else _STRETCH_BOXY if category_name in BOXY else _STRETCH_SHAPED
        return cls(size_m, least, most, stretch, sides_log, flat, settings)

    @cached_property
    def thin(self) -> Bool[np.ndarray, "3"]:
        """Axes along which objects of this shape come in any thickness."""
        return _thin(self.shape_size_m, self.settings)

    def scale_for(self, wanted_m: Float[np.ndarray, "*p 3"]) -> Float[np.ndarray, "*p 3"]:
        """Per-axis scales nearest to giving the shape the wanted size, within the limits."""
        free = self.shape_size_m > self.settings.degenerate_m
        wanted = np.clip(np.where(np.isnan(wanted_m), 1.0, wanted_m), self.min_m, self.max_m)
        log_scale = np.log(wanted / np.maximum(self.shape_size_m, self.settings.degenerate_m))
        sides = log_scale[..., :2]
        middle = sides.mean(axis=-1, keepdims=True)
        log_scale[..., :2] = middle + np.clip(sides - middle, -self.sides_log, self.sides_log)
        shaped = free & ~self.thin
        if not shaped.any():
            shaped = free if free.any() else np.ones(3, dtype=bool)
        centre = log_scale[..., shaped].mean(axis=-1, keepdims=True)
        limited = centre + np.clip(log_scale - centre, -self.stretch_log, self.stretch_log)
        thin = free & ~shaped
        return np.exp(np.where(thin, log_scale, np.where(shaped, limited, centre)))

    def stretch(self, scale: Float[np.ndarray, "*p 3"]) -> Float[np.ndarray, "*p"]:
        """How unevenly the scales stretch the shape: root mean square of log deviations, thin axes left out."""
        shaped = ~self.thin
        if not shaped.any():
            return np.zeros(np.shape(scale)[:-1])
        return np.log(scale[..., shaped]).std(axis=-1)


def _thin(size_m: Float[np.ndarray, "3"], settings: PoseSearchSettings) -> Bool[np.ndarray, "3"]:
    return np.asarray(size_m <= max(settings.flat_m, settings.thin_share * float(size_m.max())))


def sides_log_of(
    symmetry: SymmetryFold, category_name: str, *, round: bool, settings: PoseSearchSettings = SETTINGS.search
) -> float:
    """How far the horizontal scales of a shape may differ: what looks the same after a quarter turn is no long one.

    Args:
        symmetry: Turns about up that leave the shape the same.
        category_name: Unnamed things come in all proportions.
        round: Whether its outline from above is a circle.
    """
    if category_name == UNKNOWN.name:
        return np.inf
    if round:
        return 0.0
    return _SIDES_SQUARE if symmetry % settings.quarters == 0 else np.inf


def _category_range(
    category_name: str, observed_m: np.ndarray, own_m: np.ndarray, settings: PoseSearchSettings
) -> tuple[np.ndarray, np.ndarray]:
    if category_name == UNKNOWN.name:
        return np.full(3, 0.02), np.where(
            _thin(own_m, settings), np.maximum(settings.thicker * own_m, settings.flat_m), 4.0
        )
    row = category(category_name)
    prior = _nearest_prior(row.priors, np.log(np.clip(observed_m, 1e-3, 10.0)))
    least = np.exp(prior.log_median_xyz - settings.sigmas * prior.log_sigma_xyz)
    most = np.exp(prior.log_median_xyz + settings.sigmas * prior.log_sigma_xyz)
    least = np.maximum(np.minimum(least, own_m / settings.own_size_factor), settings.degenerate_m)
    most = np.maximum(most, own_m * settings.own_size_factor)
    for axis, plausible in ((1, row.plausible_width_m), (2, row.plausible_height_m)):
        if plausible is not None:
            least[axis], most[axis] = max(least[axis], plausible[0]), min(most[axis], plausible[1])
    return least, most


def _nearest_prior(priors: tuple[SizePrior, ...], log_size: np.ndarray) -> SizePrior:
    return min(priors, key=lambda p: float((((log_size - p.log_median_xyz) / p.log_sigma_xyz) ** 2).sum()))
