"""How likely a box is for what lies on another thing: that thing's size tells how far away both are.

By its box alone a dresser may be a pillow that is near; not where it would have to lie on the bed behind it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import Category, SizePrior, category, column
from diorama_core.retrieval.box_views import (
    DISTANCES_M,
    HEIGHTS_M,
    SETTINGS,
    BoxView,
    foot_sigma_m,
    normal,
    place_density,
    size_density,
)

_BOARDS = frozenset(kind for kind, like in column("carries_as").items() if like == "bookshelf")
"""Things lie at any height of them."""
_RAISED_M, _RAISED_SIGMA_M = {"surface": 0.75, "wall": 1.45, "ceiling": 2.3}, 0.35
"""Heights of carriers that do not stand on the floor."""


def lying_likelihoods(
    view: BoxView,
    kinds: Sequence[str],
    carrier: BoxView,
    carrier_kinds: Sequence[str],
    height: Float[np.ndarray, "h"],
) -> Float[np.ndarray, "k c"]:
    """How likely a box is for every kind lying on every kind of carrier.

    Args:
        view: the box of what lies there.
        kinds: that it may be of.
        carrier: the box of what it lies on.
        carrier_kinds: that this may be of.
        height: how likely every camera height of `box_views.HEIGHTS_M` is, adding up to 1.
    """
    distances = np.stack([_distances(view, carrier, category(kind), height) for kind in carrier_kinds], axis=1)
    return _sizes(view, kinds) @ distances + SETTINGS.certain


def _sizes(view: BoxView, kinds: Sequence[str]) -> Float[np.ndarray, "k d"]:
    entries = [category(kind) for kind in kinds]
    return np.stack([np.mean([size_density(view, p, e.mount) for p in e.priors], axis=0) for e in entries])


def _distances(
    view: BoxView, carrier: BoxView, entry: Category, height: Float[np.ndarray, "h"]
) -> Float[np.ndarray, "d"]:
    """How likely what lies on a carrier of one kind is at every distance, times how well its foot is level with it."""
    priors = [_on_prior(view, carrier, entry, prior) for prior in entry.priors]
    return np.asarray(height @ np.mean(priors, axis=0))


def _on_prior(view: BoxView, carrier: BoxView, entry: Category, prior: SizePrior) -> Float[np.ndarray, "h d"]:
    likely = place_density(carrier, prior, entry.mount) * size_density(carrier, prior, entry.mount)
    likely = likely / np.maximum(likely.sum(axis=1, keepdims=True), 1e-12)
    likely = (1.0 - SETTINGS.anywhere) * likely + SETTINGS.anywhere / len(DISTANCES_M)
    reach = SETTINGS.reach_m + SETTINGS.reach_share * DISTANCES_M[:, None]
    beyond = DISTANCES_M - DISTANCES_M[:, None]
    on_it = (beyond > -reach) & (beyond < prior.depth_m + reach)
    level, spread = _level_m(entry, prior)
    foot = DISTANCES_M * view.tan_bottom - level + HEIGHTS_M[:, None]
    if view.cut_bottom:
        foot = np.minimum(foot, 0.0)
    return likely @ (on_it / on_it.sum(axis=1, keepdims=True)) * normal(foot, np.hypot(spread, foot_sigma_m()))


def _level_m(entry: Category, prior: SizePrior) -> tuple[float, float]:
    """Height of what things lie on, and its standard deviation, metres."""
    if entry.name in _BOARDS and entry.mount == "floor":
        return prior.height_m / 2, prior.height_m / 2
    if entry.mount != "floor":
        return _RAISED_M[entry.mount] + (prior.height_m if entry.mount == "surface" else 0.0), _RAISED_SIGMA_M
    level = entry.seat_height_m or prior.height_m
    return level, SETTINGS.level_sigma * level
