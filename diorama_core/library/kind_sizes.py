"""How large things of a kind are: the library's usual sizes of it, mixed with the taxonomy's broader ones."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
from jaxtyping import Float

from diorama_core.library.kinds import KindMode, modes_of_kind, outline_of
from diorama_core.library.taxonomy import category

BROAD_COUNT = 3
"""How many shapes of a kind the taxonomy's sizes are worth: of the kinds with few shapes in the library, most new ones
are unlike them. Chosen, like the modes (`scripts/measure_kinds.py`), by the likelihood of shapes left out."""


@cache
def sizes_of_kind(name: str) -> tuple[KindMode, ...]:
    """The parts of the mixture for a canonical category: the taxonomy's, then the library's, most common first."""
    broad, known, outline = category(name).priors, modes_of_kind(name), outline_of(name)
    count = sum(m.count for m in known)
    share = BROAD_COUNT / (BROAD_COUNT + count)
    return (
        *(KindMode(share / len(broad), 0, p.log_median_xyz, np.diag(p.log_sigma_xyz**2), outline) for p in broad),
        *(replace(m, share=(1 - share) * m.share) for m in known),
    )


def size_density(name: str, size_m: Float[np.ndarray, "3"], sigma: float) -> float:
    """How usual a size is for a kind, the better way round: a density of logarithms, but for a constant factor.

    Args:
        name: of the canonical category.
        size_m: depth, width and height, metres; width and depth may have changed places.
        sigma: of the logarithms: how exactly they were measured.
    """
    log_size, total = np.log(size_m), 0.0
    for mode in sizes_of_kind(name):
        covariance = mode.covariance + sigma**2 * np.eye(3)
        off = np.stack([log_size, log_size[[1, 0, 2]]]) - mode.log_size
        nearest = float((off * np.linalg.solve(covariance, off.T).T).sum(axis=1).min())
        total += mode.share * float(np.exp(-nearest / 2) / np.sqrt(np.linalg.det(covariance)))
    return total
