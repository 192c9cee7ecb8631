"""What stands beside a thing, and on it, tells what it is: a chair at a desk, a small cabinet at a bed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diorama_core.artefacts import Cuboid, DetectedObject
from diorama_core.library.taxonomy import with_kin
from diorama_core.scene.types import Support

_BESIDE_M = 0.8
_COMPUTERS = frozenset({"monitor", "computer", "laptop", "keyboard", "mouse", "printer"})
_DESKS = with_kin("desk")


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
)


def neighbour_factors(
    index: int,
    kinds: Sequence[str],
    objects: Sequence[DetectedObject],
    cuboids: Sequence[Cuboid],
    supports: Sequence[Support],
) -> Mapping[str, float]:
    """How many times likelier each kind is for one object because of what is near it and on it.

    Args:
        index: of the object.
        kinds: that it may be of.
        objects: all of the photo.
        cuboids: theirs, in the same order.
        supports: who carries whom.
    """
    name = objects[index].id
    on_it = {s.child for s in supports if s.parent == name}
    carried = {o.category for o in objects if o.id in on_it}
    beside = {
        other.category
        for other, cuboid in zip(objects, cuboids, strict=True)
        if other.id != name and gap_m(cuboids[index], cuboid) < _BESIDE_M
    }
    return {
        kind: float(
            np.prod([c.factor for c in COMPANIONS if kind in c.kinds and c.others & (carried if c.carried else beside)])
        )
        for kind in kinds
    }


def gap_m(a: Cuboid, b: Cuboid) -> float:
    """Horizontal distance between two cuboids' upright bounding boxes."""
    (low_a, high_a), (low_b, high_b) = ((c.corners_world[:, :2].min(0), c.corners_world[:, :2].max(0)) for c in (a, b))
    return float(np.linalg.norm(np.clip(np.maximum(low_a, low_b) - np.minimum(high_a, high_b), 0.0, None)))
