"""What the picture of a thing looks like and how large it was measured, as evidence for its kind beside its word."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import DetectedObject, SeenKinds
from diorama_core.library.kinds import size_density
from diorama_core.retrieval.settings import SETTINGS, MeasuredSizeSettings

TRUST, _TRUST_BESIDE_WORD = 0.8, 0.5
"""Powers of the probabilities of a thing without a name, and of one whose word leaves a choice: what its picture looks
like is too sure of itself on photos, and a word has said some of it."""
_FLOOR = 0.001
"""Added to every probability: of a kind that the namer rules out not everything is known."""


def with_seen_kinds(
    objects: tuple[DetectedObject, ...], seen: Sequence[SeenKinds] | None
) -> tuple[DetectedObject, ...]:
    """The objects with what they look like; unchanged where nobody looked."""
    of = {one.object_id: one for one in seen or ()}
    return tuple(
        replace(
            item,
            looks_like=tuple(zip(of[item.id].kinds, map(float, of[item.id].probabilities), strict=True)),
            seen_form=of[item.id].form,
        )
        if item.id in of
        else item
        for item in objects
    )


def as_it_looks(shares: Mapping[str, float], looks_like: Sequence[tuple[str, float]], named: bool) -> dict[str, float]:
    """How likely each kind is after a look at the thing.

    Without any looks nothing changes.
    """
    if not looks_like:
        return dict(shares)
    seen, trust = dict(looks_like), _TRUST_BESIDE_WORD if named else TRUST
    likely = {kind: share * (seen.get(kind, 0.0) + _FLOOR) ** trust for kind, share in shares.items()}
    whole = sum(likely.values())
    return {kind: value / whole for kind, value in likely.items()}


def as_measured(
    shares: Mapping[str, float], size_m: Float[np.ndarray, "3"], settings: MeasuredSizeSettings = SETTINGS.sizes
) -> dict[str, float]:
    """How likely each kind is once the thing was measured, but for a common factor.

    Args:
        shares: how likely each kind is before.
        size_m: depth, width and height of its cuboid, metres.
        settings: numbers to work with.
    """
    size_m = np.maximum(size_m, settings.min_m)
    usual = {kind: size_density(kind, size_m, settings.sigma) for kind in shares}
    best = max(usual.values())
    return {
        kind: share * float(usual[kind] / best + settings.floor) ** settings.trust for kind, share in shares.items()
    }
