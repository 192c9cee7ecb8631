"""What stands beside a thing, and on it, tells what it is: a chair at a desk, a small cabinet at a bed.

What the neighbours are is as uncertain, where their words are loose too. Beliefs of all things are updated together
from those of their neighbours, a few times (mean field); all things' own evidence stays.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import fsum, prod

import numpy as np

from diorama_core.artefacts import Cuboid, DetectedObject
from diorama_core.library.taxonomy import with_kin
from diorama_core.scene.types import Support

_BESIDE_M = 0.8
_ROUNDS = 3
"""After so many updates beliefs hardly change."""
_COMPUTERS = frozenset({"monitor", "computer", "laptop", "keyboard", "mouse", "printer"})
_DESKS = with_kin("desk")
_LOUNGE_SEATS = frozenset({"armchair", "recliner", "rocking chair"})
_KITCHEN = frozenset({"stove", "sink", "dishwasher", "refrigerator", "kitchen counter", "range hood", "microwave"})


@dataclass(frozen=True)
class Companion:
    """Kinds that another kind makes likelier."""

    kinds: frozenset[str]
    others: frozenset[str]
    carried: bool
    """Whether the others lie on it; else they stand beside it."""
    factor: float


COMPANIONS = (
    Companion(frozenset({"office chair"}), _DESKS | _COMPUTERS, False, 4.0),
    Companion(frozenset({"filing cabinet"}), _DESKS | _COMPUTERS, False, 2.0),
    Companion(_DESKS, _COMPUTERS, True, 5.0),
    Companion(frozenset({"tv stand"}), frozenset({"television", "game console"}), True, 5.0),
    Companion(frozenset({"night stand"}), with_kin("bed"), False, 4.0),
    Companion(frozenset({"coffee table", "side table"}), with_kin("sofa"), False, 2.0),
    Companion(frozenset({"kitchen counter"}), frozenset({"stove", "sink", "dishwasher"}), False, 3.0),
    Companion(frozenset({"chair"}), frozenset({"table"}), False, 1.5),
    Companion(_LOUNGE_SEATS, frozenset({"coffee table", "sofa", "side table", "fireplace", "floor lamp"}), False, 2.0),
    Companion(_DESKS, frozenset({"office chair"}), False, 3.0),
    Companion(frozenset({"bar stool"}), frozenset({"kitchen island", "kitchen counter"}), False, 3.0),
    Companion(frozenset({"sideboard", "display cabinet", "chandelier"}), frozenset({"table"}), False, 2.0),
    Companion(frozenset({"dresser"}), with_kin("bed"), False, 2.0),
    Companion(frozenset({"wall cabinet", "pantry cabinet"}), _KITCHEN, False, 3.0),
)


def with_neighbours(
    alone: Sequence[Mapping[str, float]],
    objects: Sequence[DetectedObject],
    cuboids: Sequence[Cuboid],
    supports: Sequence[Support],
) -> list[Mapping[str, float]]:
    """How likely every object is of each kind once its neighbours are taken into account, as probabilities.

    Args:
        alone: how likely each is of each kind by itself, up to a factor.
        objects: all of the photo.
        cuboids: theirs, in the same order.
        supports: who carries whom.
    """
    positions = {o.id: i for i, o in enumerate(objects)}
    carried: list[list[int]] = [[] for _ in objects]
    for edge in supports:
        if edge.parent in positions and edge.child in positions:
            carried[positions[edge.parent]].append(positions[edge.child])
    indices = range(len(objects))
    beside = [[j for j in indices if j != i and gap_m(cuboids[i], cuboids[j]) < _BESIDE_M] for i in indices]
    beliefs = [_normalised(kinds) for kinds in alone]
    for _ in range(_ROUNDS):
        beliefs = [
            _updated(alone[i], [beliefs[j] for j in carried[i]], [beliefs[j] for j in beside[i]]) for i in indices
        ]
    return beliefs


def _updated(
    alone: Mapping[str, float], carried: Sequence[Mapping[str, float]], beside: Sequence[Mapping[str, float]]
) -> Mapping[str, float]:
    """One object's belief, by itself and by what is on it and near it."""
    likely = dict(alone)
    for row in COMPANIONS:
        kinds = row.kinds & likely.keys()
        if kinds:
            factor = 1.0 + (row.factor - 1.0) * _any(row.others, carried if row.carried else beside)
            likely |= {kind: likely[kind] * factor for kind in kinds}
    return _normalised(likely)


def _any(kinds: frozenset[str], beliefs: Sequence[Mapping[str, float]]) -> float:
    """How likely at least one of some objects is of one of the kinds."""
    none = sorted(1.0 - fsum(share for kind, share in of_one.items() if kind in kinds) for of_one in beliefs)
    return 1.0 - prod(none)  # sorted: the order of the objects must not show in a bit


def _normalised(likely: Mapping[str, float]) -> Mapping[str, float]:
    whole = fsum(likely.values())
    return {kind: value / whole for kind, value in likely.items()}


def gap_m(a: Cuboid, b: Cuboid) -> float:
    """Horizontal distance between two cuboids' upright bounding boxes."""
    (low_a, high_a), (low_b, high_b) = ((c.corners_world[:, :2].min(0), c.corners_world[:, :2].max(0)) for c in (a, b))
    return float(np.linalg.norm(np.clip(np.maximum(low_a, low_b) - np.minimum(high_a, high_b), 0.0, None)))
