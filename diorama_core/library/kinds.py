"""Statistics of a category's shapes: usual sizes, and the share of its cuboid that an object's outline fills.

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
