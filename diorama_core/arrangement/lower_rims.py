"""What a photo shows just below each object: the objects whose pixels adjoin its lower rim."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Bool

COLUMNS = 320
"""Masks are compared at about this width: a rim is a few pixels wide there, whatever the photo's size."""
RIM_SHARE = 0.01
"""How far below the rim to look, as a share of the picture's height: past the shadow and the error of a mask."""


def seen_below(masks: Mapping[str, Bool[np.ndarray, "h w"]]) -> dict[str, dict[str, float]]:
    """For each object the share of its lower rim below which each other object is seen.

    Args:
        masks: by object, all of one photo; where masks overlap, the smaller object lies in front.
    """
    if not masks:
        return {}
    names = sorted(masks, key=lambda name: (-int(masks[name].sum()), name))
    step = max(1, masks[names[0]].shape[1] // COLUMNS)
    owners = np.full(masks[names[0]][::step, ::step].shape, -1)
    for k, name in enumerate(names):
        owners[masks[name][::step, ::step]] = k
    return {name: {names[other]: share for other, share in _below(owners, k).items()} for k, name in enumerate(names)}


def _below(owners: np.ndarray, k: int) -> dict[int, float]:
    mine = owners == k
    rows, columns = np.flatnonzero(mine.any(axis=1)), np.flatnonzero(mine.any(axis=0))
    if not len(rows):
        return {}
    height = len(owners)
    lowest = height - 1 - mine[::-1, columns].argmax(axis=0)
    ends = lowest >= (rows[0] + rows[-1]) / 2  # the underside of a table top is no lower end
    under = lowest[ends] + max(2, round(RIM_SHARE * height))
    inside = under < height
    seen = owners[under[inside], columns[ends][inside]]
    below, counts = np.unique(seen[(seen >= 0) & (seen != k)], return_counts=True)
    return {int(other): float(count) / max(int(ends.sum()), 1) for other, count in zip(below, counts, strict=True)}
