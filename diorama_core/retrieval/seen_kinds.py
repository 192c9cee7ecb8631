"""What the picture of a thing looks like, as evidence for its kind beside its word, its size and its place."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from diorama_core.artefacts import DetectedObject, SeenKinds

_TRUST = 0.5
"""Power of the probabilities: the namer learnt from rendered rooms and is too sure of itself on photos."""
_FLOOR = 0.003
"""Added to every probability: of a kind that the namer rules out not everything is known."""


def with_seen_kinds(
    objects: tuple[DetectedObject, ...], seen: Sequence[SeenKinds] | None
) -> tuple[DetectedObject, ...]:
    """The objects with what they look like; unchanged where nobody looked."""
    of = {one.object_id: one for one in seen or ()}
    return tuple(
        replace(item, looks_like=tuple(zip(of[item.id].kinds, map(float, of[item.id].probabilities), strict=True)))
        if item.id in of
        else item
        for item in objects
    )


def as_it_looks(shares: Mapping[str, float], looks_like: Sequence[tuple[str, float]]) -> dict[str, float]:
    """How likely each kind is after a look at the thing.

    Args:
        shares: how likely each kind is before it, adding up to 1.
        looks_like: kinds with probabilities where all are equally frequent; without any, nothing changes.
    """
    if not looks_like:
        return dict(shares)
    seen = dict(looks_like)
    likely = {kind: share * (seen.get(kind, 0.0) + _FLOOR) ** _TRUST for kind, share in shares.items()}
    whole = sum(likely.values())
    return {kind: value / whole for kind, value in likely.items()}
