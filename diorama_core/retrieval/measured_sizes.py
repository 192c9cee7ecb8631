"""How large a thing was measured, as evidence for which of its word's kinds it is."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from diorama_core.library.kind_sizes import size_density
from diorama_core.retrieval.settings import SETTINGS, MeasuredSizeSettings


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
