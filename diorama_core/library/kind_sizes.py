"""How large things of a kind are: the library's usual sizes of it, mixed with the taxonomy's broader ones."""

from __future__ import annotations

from functools import cache

import numpy as np
from jaxtyping import Float

from diorama_core.library.kinds import KindMode, modes_of_kind, outline_of
from diorama_core.library.taxonomy import UNKNOWN, category

BROAD_SHARE = 0.3
"""Share of the mixture that is the taxonomy's: of things unlike all in the library."""
MAX_MODES = 3
MAX_SIGMAS, MIN_SIGMA, OFF_ANYWAY = 2.6, 0.08, 0.22
"""How far a side may be off a kind's usual one, in standard deviations of its logarithm, and the quarter that is
allowed beside them: 99 % of the built-in shapes are within."""
SAID_SIGMAS = 4.0
"""Sigmas for what has a name: makers call a side table what is as wide as a console table."""


@cache
def sizes_of_kind(name: str) -> tuple[KindMode, ...]:
    """The parts of the mixture for a canonical category: the taxonomy's, then the library's most common ones."""
    broad, outline = category(name).priors, outline_of(name)
    return (
        *(KindMode(BROAD_SHARE / len(broad), p.log_median_xyz, np.diag(p.log_sigma_xyz**2), outline) for p in broad),
        *(
            KindMode((1 - BROAD_SHARE) * m.share, m.log_size, m.covariance, m.outline)
            for m in modes_of_kind(name)[:MAX_MODES]
        ),
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


def is_possible(name: str, size_m: Float[np.ndarray, "3"], *, is_given: bool = False) -> bool:
    """Whether a thing of this kind can be so large, along every side, the better way round.

    One gate for everything that is named by its shape or by a word: models of a library, meshes of a scene, boxes of a
    scan. Anything is possible for "object".

    Args:
        name: of the canonical category.
        size_m: depth, width and height, metres; width and depth may have changed places.
        is_given: whether somebody called it so, who is believed a little longer.
    """
    most = SAID_SIGMAS if is_given else MAX_SIGMAS
    if name == UNKNOWN.name:
        return True
    log_size = np.log(np.maximum(size_m, 1e-6))
    return any(
        bool((_beyond(mode, turned, category(name).flat) <= most).all())
        for mode in sizes_of_kind(name)
        for turned in (log_size, log_size[[1, 0, 2]])
    )


def _beyond(mode: KindMode, log_size: Float[np.ndarray, "3"], flat: bool) -> Float[np.ndarray, "3"]:
    """Standard deviations by which a size is off a mode, beyond what is off anyway."""
    sigma = np.maximum(np.sqrt(np.diag(mode.covariance)), MIN_SIGMA)
    off = log_size - mode.log_size
    thin = flat & (np.arange(3) == mode.log_size.argmin()) & (off < 0)
    return np.asarray(np.maximum(np.where(thin, 0.0, np.abs(off)) - OFF_ANYWAY, 0.0) / sigma)
