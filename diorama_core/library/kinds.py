"""How large things of a kind are: usual sizes of the library's shapes, the share of a cuboid that an outline fills, and
both mixed with the taxonomy's broad ranges.

An object does not reach into the corners of its cuboid: a round table's outline in a picture is smaller than its
cuboid's, so that taking one for the other puts everything too far away. The outline of a kind is the mean support
function of its shapes, sampled in some directions. Both are measured on the built-in library's training shapes
(`scripts/measure_kinds.py`).
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import UNKNOWN, category
from diorama_core.scene.values import ArrayValue

PATH = Path(__file__).with_name("kinds.json")
STEPS = 200
"""The file's outlines are in these parts of a unit box."""
_ELEVATIONS_DEG = (-75.0, -45.0, 0.0, 45.0, 75.0)
_AZIMUTHS_DEG = (0.0, 45.0, 90.0)


def _directions() -> Float[np.ndarray, "15 3"]:
    azimuth, elevation = (np.deg2rad(g.ravel()) for g in np.meshgrid(_AZIMUTHS_DEG, _ELEVATIONS_DEG))
    return np.column_stack(
        [np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)]
    )


OUTLINE_DIRECTIONS: Float[np.ndarray, "15 3"] = _directions()
"""Directions of a quarter of all around; the others are mirror images: the sign of a front is rarely known."""


@dataclass(frozen=True, eq=False)
class KindMode(ArrayValue):
    """Shapes of a kind that are alike in size and outline."""

    share: float
    """Share of the kind's shapes."""
    log_size: Float[np.ndarray, "3"]
    """Mean logarithms of depth, width and height in metres."""
    covariance: Float[np.ndarray, "3 3"]
    """Covariance of the logarithms."""
    outline: Float[np.ndarray, "40 3"]
    """Points in a unit box about the origin whose hull has the mode's mean support function."""


@cache
def modes_of_kind(name: str) -> tuple[KindMode, ...]:
    """The modes of a canonical category, most common first; none where the library has no shape of it."""
    return _table().get(name, ())


@cache
def outline_of(name: str) -> Float[np.ndarray, "40 3"]:
    """The mean outline of a category's objects; of an object of no known kind the mean over all kinds."""
    modes = modes_of_kind(name) or tuple(m for kind in _table().values() for m in kind)
    return np.asarray(np.average([m.outline for m in modes], axis=0, weights=[m.share for m in modes]))


@cache
def _table() -> dict[str, tuple[KindMode, ...]]:
    return {
        name: tuple(_mode(m) for m in modes) for name, modes in json.loads(PATH.read_text(encoding="utf-8")).items()
    }


def _mode(entry: dict[str, Any]) -> KindMode:
    covariance = np.zeros((3, 3))
    covariance[np.triu_indices(3)] = entry["covariance"]
    covariance = covariance + np.triu(covariance, 1).T
    quarter = np.array(entry["outline"], dtype=float) / STEPS
    return KindMode(entry["share"], np.log(entry["size_m"]), covariance, _all_around(quarter))


def _all_around(quarter: Float[np.ndarray, "15 3"]) -> Float[np.ndarray, "40 3"]:
    """A quarter's points with their mirror images, those on a mirror once."""
    ahead, aside, right = quarter[0::3], quarter[1::3], quarter[2::3]
    mirrors = [np.array([x, y, 1.0]) for x in (1.0, -1.0) for y in (1.0, -1.0)]
    return np.concatenate(
        [*(aside * m for m in mirrors), *(ahead * m for m in mirrors[::2]), *(right * m for m in mirrors[:2])]
    )


BROAD_SHARE = 0.3
"""Share of the mixture that is the taxonomy's: of things unlike all in the library."""
MAX_MODES = 3
MAX_SIGMAS, MIN_SIGMA, OFF_ANYWAY = 2.6, 0.08, 0.22
"""How far a side may be off a kind's usual one, in standard deviations of its logarithm, and the quarter that is
allowed beside them: 99 % of the built-in shapes are within."""
SAID_SIGMAS = 4.0
"""Sigmas for what has a name: makers call a side table what is as wide as a console table."""


@cache
def sizes_of_kind(name: str) -> tuple[KindMode, ...]:
    """The parts of the mixture for a canonical category: the taxonomy's, then the library's most common ones."""
    broad, outline = category(name).priors, outline_of(name)
    return (
        *(KindMode(BROAD_SHARE / len(broad), p.log_median_xyz, np.diag(p.log_sigma_xyz**2), outline) for p in broad),
        *(
            KindMode((1 - BROAD_SHARE) * m.share, m.log_size, m.covariance, m.outline)
            for m in modes_of_kind(name)[:MAX_MODES]
        ),
    )


def size_density(name: str, size_m: Float[np.ndarray, "3"], sigma: float) -> float:
    """How usual a size is for a kind, the better way round: a density of logarithms, but for a constant factor.

    Args:
        name: of the canonical category.
        size_m: depth, width and height, metres; width and depth may have changed places.
        sigma: of the logarithms: how exactly they were measured.
    """
    log_size, total = np.log(size_m), 0.0
    for mode in sizes_of_kind(name):
        covariance = mode.covariance + sigma**2 * np.eye(3)
        off = np.stack([log_size, log_size[[1, 0, 2]]]) - mode.log_size
        nearest = float((off * np.linalg.solve(covariance, off.T).T).sum(axis=1).min())
        total += mode.share * float(np.exp(-nearest / 2) / np.sqrt(np.linalg.det(covariance)))
    return total


def is_possible(name: str, size_m: Float[np.ndarray, "3"], *, is_given: bool = False) -> bool:
    """Whether a thing of this kind can be so large, along every side, the better way round.

    One gate for everything that is named by its shape or by a word: models of a library, meshes of a scene, boxes of a
    scan. Anything is possible for "object".

    Args:
        name: of the canonical category.
        size_m: depth, width and height, metres; width and depth may have changed places.
        is_given: whether somebody called it so, who is believed a little longer.
    """
    most = SAID_SIGMAS if is_given else MAX_SIGMAS
    if name == UNKNOWN.name:
        return True
    log_size = np.log(np.maximum(size_m, 1e-6))
    return any(
        bool((_beyond(mode, turned, category(name).flat) <= most).all())
        for mode in sizes_of_kind(name)
        for turned in (log_size, log_size[[1, 0, 2]])
    )


def _beyond(mode: KindMode, log_size: Float[np.ndarray, "3"], flat: bool) -> Float[np.ndarray, "3"]:
    """Standard deviations by which a size is off a mode, beyond what is off anyway."""
    sigma = np.maximum(np.sqrt(np.diag(mode.covariance)), MIN_SIGMA)
    off = log_size - mode.log_size
    thin = flat & (np.arange(3) == mode.log_size.argmin()) & (off < 0)
    return np.asarray(np.maximum(np.where(thin, 0.0, np.abs(off)) - OFF_ANYWAY, 0.0) / sigma)
