"""What stands beside a thing, and on it, tells what it is: a chair at a desk, a small cabinet at a bed.

What the neighbours are is as uncertain, where their words are loose too. Beliefs of all things are updated together
from those of their neighbours, a few times (mean field); all things' own evidence stays.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import fsum, prod
from typing import Literal

import numpy as np

from diorama_core.artefacts import Cuboid, DetectedObject
from diorama_core.library.taxonomy import category, with_kin
from diorama_core.retrieval.settings import SETTINGS, RankingSettings
from diorama_core.scene.types import Support

Relation = Literal["on it", "near", "behind it", "beside it"]
"""Where a companion is: a sofa is behind a coffee table that stands before it, and beside a side table."""


def with_neighbours(
    alone: Sequence[Mapping[str, float]],
    objects: Sequence[DetectedObject],
    cuboids: Sequence[Cuboid],
    supports: Sequence[Support],
    settings: RankingSettings = SETTINGS.ranking,
) -> list[Mapping[str, float]]:
    """How likely every object is of each kind once its neighbours are taken into account, as probabilities.

    Args:
        alone: how likely each is of each kind by itself, up to a factor.
        objects: all of the photo.
        cuboids: theirs, in the same order.
        supports: who carries whom.
        settings: numbers to work with.
    """
    positions = {o.id: i for i, o in enumerate(objects)}
    carried: list[list[int]] = [[] for _ in objects]
    for edge in supports:
        if edge.parent in positions and edge.child in positions:
            carried[positions[edge.parent]].append(positions[edge.child])
    indices = range(len(objects))
    near = [[j for j in indices if j != i and gap_m(cuboids[i], cuboids[j]) < settings.near_m] for i in indices]
    across = [[j for j in near[i] if is_before(cuboids[i], cuboids[j])] for i in indices]
    neighbours_of: list[Mapping[Relation, list[int]]] = [
        {
            "on it": carried[i],
            "near": near[i],
            "behind it": across[i],
            "beside it": [j for j in near[i] if j not in across[i]],
        }
        for i in indices
    ]
    beliefs = [_normalise(kinds) for kinds in alone]
    for _ in range(settings.neighbour_rounds):
        beliefs = [
            _update_belief(
                alone[i], {where: [beliefs[j] for j in of_one] for where, of_one in neighbours_of[i].items()}
            )
            for i in indices
        ]
    return beliefs


def _update_belief(
    alone: Mapping[str, float], neighbours: Mapping[Relation, Sequence[Mapping[str, float]]]
) -> Mapping[str, float]:
    """One object's belief, by itself and by what is on it and near it."""
    likely = dict(alone)
    for kind in likely:
        for row in category(kind).seldom_without or ():
            present = _any(with_kin(*row.others), neighbours[row.where])
            factor = present * row.often / row.usual + (1.0 - present) * (1.0 - row.often) / (1.0 - row.usual)
            likely[kind] *= factor
    return _normalise(likely)


def _any(kinds: frozenset[str], beliefs: Sequence[Mapping[str, float]]) -> float:
    """How likely at least one of some objects is of one of the kinds."""
    none = sorted(1.0 - fsum(share for kind, share in of_one.items() if kind in kinds) for of_one in beliefs)
    return 1.0 - prod(none)  # sorted: the order of the objects must not show in a bit


def _normalise(likely: Mapping[str, float]) -> Mapping[str, float]:
    whole = fsum(likely.values())
    return {kind: value / whole for kind, value in likely.items()}


def gap_m(a: Cuboid, b: Cuboid) -> float:
    """Horizontal distance between two cuboids' upright bounding boxes."""
    (low_a, high_a), (low_b, high_b) = ((c.corners_world[:, :2].min(0), c.corners_world[:, :2].max(0)) for c in (a, b))
    return float(np.linalg.norm(np.clip(np.maximum(low_a, low_b) - np.minimum(high_a, high_b), 0.0, None)))


def is_before(thing: Cuboid, seat: Cuboid) -> bool:
    """Whether a thing is across the longer side of a seat, within its width, and not at one of its ends."""
    x, y = seat.R_world_object[:2, :2].T @ (thing.centre - seat.centre)[:2]
    return bool(abs(y) < seat.size_m[1] / 2 and abs(x) > seat.size_m[0] / 2)
