"""What stands on other things tells the camera's height, too: a room twice as large would have cups twice as large.

A scene made larger about the camera's foot looks the same in the picture, its supporters included. So the things that
were placed on others are solved again at some heights, on their supporters made as much larger, and vote with the
things on the floor.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.floor import (
    HEIGHTS_M,
    HeightScan,
    costs_at_heights,
    parabola_minimum,
    share_of_vote,
    stands_on_floor,
)
from diorama_core.perception.metrology.placement import Placement
from diorama_core.perception.metrology.problem import Cuboids, Problems, View, stacked
from diorama_core.perception.metrology.supported_objects import place_on

_CAP = 9.0
"""No object counts more than this beyond its best: it may be mislabelled, or on something else."""
_RULED_OUT = 9.0
"""Heights that cost so much more than the best are not tried again: three sigma."""


def with_votes_of_supported(
    scan: HeightScan, placements: Sequence[Placement], observations: BoxObservations, view: View
) -> HeightScan:
    """The scan with the votes of what was placed on other objects at its height; the same where nothing was.

    Args:
        scan: By what stands on the floor.
        placements: Of all objects, at the scan's height.
        observations: Of all objects.
        view: The camera.
    """
    floor_voters = {p.index for p in placements if stands_on_floor(observations.categories[p.index])}
    voters = [p for p in placements if p.supporter >= 0 and p.index not in floor_voters]
    if not voters:
        return scan
    tried = _plausible(scan.costs)
    heights_m = HEIGHTS_M[tried]
    rows = [
        one
        for p in voters
        for one in _runs(observations, p, placements[p.supporter].cuboid, heights_m / scan.height_m, heights_m)
    ]
    found = costs_at_heights(stacked(rows), heights_m, observations, view)
    total = scan.costs.copy()
    for index, costs in found.items():
        vote = np.minimum(costs - costs.min(), _CAP) * share_of_vote(index, found, observations)
        total[tried] += vote
    log_height, log_sigma, lowest = parabola_minimum(np.log(heights_m), total[tried])
    return HeightScan(float(np.exp(log_height)), log_sigma, lowest, total)


def _plausible(costs: Float[np.ndarray, "h"]) -> slice:
    """The heights around the best one that are not ruled out; at least the best one's neighbours."""
    best = int(np.clip(np.argmin(costs), 1, len(costs) - 2))
    near = np.flatnonzero(costs < costs[best] + _RULED_OUT)
    return slice(min(int(near.min()), best - 1), max(int(near.max()), best + 1) + 1)


def _runs(
    observations: BoxObservations,
    placement: Placement,
    supporter: Cuboids,
    larger: Float[np.ndarray, "h"],
    heights_m: Float[np.ndarray, "h"],
) -> list[Problems]:
    """Rows of one object on its supporter, in runs of one assumption at every height."""
    at_heights = [
        place_on(
            observations,
            placement.index,
            placement.supporter,
            Cuboids(supporter.centre * factor, supporter.yaw_rad, supporter.size_m * factor),
            float(height),
            0.0,
        )
        for factor, height in zip(larger, heights_m, strict=True)
    ]
    return [row for run in zip(*at_heights, strict=True) for row in run]
