"""How large a thing was measured, as evidence for which of its word's kinds it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.library.kind_sizes import size_density


@dataclass(frozen=True)
class MeasuredSizeSettings:
    """Noise of measured sizes."""

    sigma: float = 0.3
    """Of the logarithms of a size measured in a photo."""
    trust: float = 0.6
    """Power of the size's likelihood: the box, which it was measured from, has said some of it."""
    floor: float = 0.02
    """Added to the likelihoods, relative to the largest: sizes of what is hidden are guessed."""
    min_m: float = 0.01


SETTINGS = MeasuredSizeSettings()


def as_measured(
    shares: Mapping[str, float], size_m: Float[np.ndarray, "3"], settings: MeasuredSizeSettings = SETTINGS
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
