"""Objects of one set are equally large: four dining chairs of one shape share its scale where the picture allows it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.pose.agree import SETS
from diorama_core.pose.settings import SETTINGS, PoseSearchSettings


def shared_scales(
    categories: Sequence[str],
    shape_ids: Sequence[str],
    scales: Float[np.ndarray, "n 3"],
    trust: Sequence[float],
    settings: PoseSearchSettings = SETTINGS.search,
) -> Float[np.ndarray, "n 3"]:
    """The scale that each object would have were its set of one size; its own where it stands alone.

    Args:
        categories: of every object; only those that come in sets share.
        shape_ids: the shape chosen for every object.
        scales: its scale along the shape's axes.
        trust: how well every object is seen.
    """
    logs, shared = np.log(scales), scales.copy()
    for name in sorted({s for s, c in zip(shape_ids, categories, strict=True) if c in SETS}):
        alike = np.array([i for i, s in enumerate(shape_ids) if s == name and categories[i] in SETS])
        if len(alike) < 2:
            continue
        common = _weighted_median(logs[alike], np.array([trust[i] + 1e-3 for i in alike]))
        near = alike[np.abs(logs[alike] - common).max(axis=1) <= settings.max_log_difference]
        shared[near] = np.exp(common)
    return shared


def _weighted_median(values: Float[np.ndarray, "m k"], weight: Float[np.ndarray, "m"]) -> Float[np.ndarray, "k"]:
    """Per column the value up to which half of the weight lies."""
    order = np.argsort(values, axis=0, kind="stable")
    below = np.cumsum(weight[order], axis=0)
    at = (below >= 0.5 * weight.sum()).argmax(axis=0)
    return np.take_along_axis(values, order, axis=0)[at, np.arange(values.shape[1])]
