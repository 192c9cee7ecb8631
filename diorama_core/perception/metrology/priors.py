"""How big a thing may be: the modes of its size, read from the taxonomy.

A general word covers more than its own row ("table" is also said of coffee tables), and a thing without a name is one
of the kinds that it may be; each such reading is a further mode at a price.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from jaxtyping import Float

from diorama_core.library.kinds import outline_of, sizes_of_kind
from diorama_core.library.taxonomy import PORTABLE, UNKNOWN, Mount, category, column
from diorama_core.perception.metrology.settings import SETTINGS, PlacementSettings

_ALSO: Mapping[str, Mapping[str, float]] = column("also_said_of")
"""Category: further categories it is used for, with the cost of that reading."""


@dataclass(frozen=True, eq=False)
class SizeMode:
    """One reading of what a thing is, as far as size goes."""

    log_size: Float[np.ndarray, "3"]
    """Logarithms of depth, width, height in metres."""
    sigma: Float[np.ndarray, "3"]
    """Deviation of each logarithm by itself."""
    cost: float
    outline: Float[np.ndarray, "40 3"]
    """What is filled of the cuboid (`library.kinds`)."""
    whitening: Float[np.ndarray, "3 3"]
    """Turns a difference of logarithms into independent sigmas: extents of a kind grow together."""

    @property
    def square(self) -> bool:
        """Whether width and depth are so alike that turning by a quarter changes nothing."""
        return bool(abs(self.log_size[0] - self.log_size[1]) < 0.1)


@cache
def size_modes(
    name: str, meanings: tuple[tuple[str, float], ...] = (), settings: PlacementSettings = SETTINGS.placement
) -> tuple[SizeMode, ...]:
    """The modes of a canonical category, the most usual first, then those of what else its word may mean.

    Args:
        name: of the category.
        meanings: kinds that the word may mean with their probabilities; what it is generally said of when empty.
    """
    if name == UNKNOWN.name:
        return (*modes_held(name, meanings, "floor", settings), *_anything(settings))
    if meanings:
        return _own_modes(name) + _modes_of_meanings(name, meanings, settings)
    return _own_modes(name) + tuple(_mode(kind, cost) for kind, cost in _ALSO.get(name, {}).items())


@cache
def modes_held(
    name: str,
    meanings: tuple[tuple[str, float], ...],
    mount: Mount,
    settings: PlacementSettings = SETTINGS.placement,
) -> tuple[SizeMode, ...]:
    """The modes of a thing that is so mounted; of one without a name those of the likeliest kinds that are.

    Args:
        name: of the category.
        meanings: kinds that the word may mean with their probabilities.
        mount: what holds the thing.
        settings: of placement.
    """
    if name != UNKNOWN.name:
        return size_modes(name, settings=settings)
    kinds = [(kind, share) for kind, share in meanings if category(kind).mount == mount]
    modes = tuple(_rarer(kind, share, *kinds[0]) for kind, share in kinds[: settings.max_meanings + 1])
    return modes or _anything(settings)


def _anything(settings: PlacementSettings) -> tuple[SizeMode]:
    return (_mode(UNKNOWN.name, settings.unnamed_anything_cost),)


def _modes_of_meanings(
    name: str, meanings: tuple[tuple[str, float], ...], settings: PlacementSettings
) -> tuple[SizeMode, ...]:
    """The likeliest mode of every other kind that a word may mean and that is held alike, dearer where it is rarer."""
    shares = dict(meanings)
    weight, kinds_held = max(shares.get(name, 0.0), settings.min_share), _holder(name)
    others = [
        (kind, share)
        for kind, share in meanings
        if kind != name and share >= settings.min_share and _holder(kind) == kinds_held
    ]
    return tuple(_rarer(kind, share, name, weight) for kind, share in others[: settings.max_meanings])


def _rarer(kind: str, share: float, than: str, its_share: float) -> SizeMode:
    """The likeliest mode of a kind, dearer as far as it is rarer than another."""
    mode, usual = _own_modes(kind)[0], _own_modes(than)[0]
    cost = 2.0 * (float(np.log(its_share / share)) + _log_breadth(mode) - _log_breadth(usual))
    return replace(mode, cost=max(0.0, cost))


def _log_breadth(mode: SizeMode) -> float:
    """Logarithm of the volume of one sigma: a wide mode explains more, each size less well."""
    return -float(np.linalg.slogdet(mode.whitening)[1])


def _holder(name: str) -> str:
    """What holds things of a kind: a wall, the ceiling, or what they stand on."""
    mount = category(name).mount
    return mount if mount in ("wall", "ceiling") else "stands"


def standing_costs(name: str, mode: SizeMode, settings: PlacementSettings = SETTINGS.placement) -> tuple[float, float]:
    """What speaks against a portable thing of this size standing on the floor, and on furniture; 0 for all others."""
    if name not in PORTABLE:
        return 0.0, 0.0
    raised = (settings.small_m - float(np.exp(mode.log_size[2]))) / settings.small_sigma_m
    return 2.0 * float(np.logaddexp(0.0, raised)), 2.0 * float(np.logaddexp(0.0, -raised))


def _own_modes(name: str) -> tuple[SizeMode, ...]:
    """A mixture of the library's usual sizes of a kind and the taxonomy's broader ones, by log density."""
    parts = sizes_of_kind(name)
    costs = [float(np.linalg.slogdet(p.covariance)[1]) - 2.0 * np.log(p.share) for p in parts]
    modes = [
        SizeMode(p.log_size, np.sqrt(np.diag(p.covariance)), cost - min(costs), p.outline, _whitening(p.covariance))
        for p, cost in zip(parts, costs, strict=True)
    ]
    return tuple(sorted(modes, key=lambda m: m.cost))


def _whitening(covariance: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3 3"]:
    return np.asarray(np.linalg.inv(np.linalg.cholesky(covariance)))


def plain_mode(log_size: Float[np.ndarray, "3"], sigma: Float[np.ndarray, "3"], cost: float, name: str) -> SizeMode:
    """A mode whose extents vary independently.

    Args:
        log_size: logarithms of depth, width and height in metres.
        sigma: their standard deviations.
        cost: of the mode, in nats.
        name: of the category, which tells the outline.
    """
    return SizeMode(log_size, sigma, cost, outline_of(name), np.diag(1.0 / sigma))


def _mode(name: str, cost: float) -> SizeMode:
    prior = category(name).priors[0]
    return plain_mode(prior.log_median_xyz, prior.log_sigma_xyz, cost, name)
