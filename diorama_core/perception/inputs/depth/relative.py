"""Inverse depth of unknown offset and unit made metric: walls meet floors at right angles, things have their sizes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import InputError
from diorama_core.perception.inputs.depth.planes import PlaneFit
from diorama_core.perception.inputs.depth.scale import focal_score, scale_evidence, size_scatter

OFFSETS = np.concatenate([[0.0], np.geomspace(0.003, 2.0, 60), -np.geomspace(0.003, 0.95, 40)])
"""Added to the numbers, in shares of their smallest: what a network or a program subtracted before."""
SCATTER_WEIGHT = 12.0
"""Nats for a scatter of one e-fold among the sizes of named things."""


def metric_depth(
    name: str,
    values: Float[np.ndarray, "h w"],
    valid: Bool[np.ndarray, "h w"],
    fit: PlaneFit,
    boxes: Sequence[LabelledBox],
    focal: float | None,
) -> tuple[Float[np.ndarray, "h w"], tuple[str, ...]]:
    """Depth along the optical axis in metres, with a note how it came about.

    Args:
        name: of the file.
        values: inverse depth times anything plus anything.
        valid: where there is some.
        fit: planes of the values.
        boxes: named things in shares of the longer side.
        focal: over the longer side, where it is known.

    Raises:
        InputError: neither named things nor a floor give it a size.
    """
    smallest = float(np.percentile(values[valid], 0.5))
    best: tuple[float, float, float] | None = None
    for offset in OFFSETS * smallest:
        moved = PlaneFit(fit.explained, fit.planes + np.array([0.0, 0.0, offset]), fit.shares)
        score, angle_focal = focal_score(moved)
        used = focal if focal is not None else angle_focal
        scatter = size_scatter(_inverted(values, valid, offset, smallest), valid, used, boxes)
        total = score - SCATTER_WEIGHT * scatter
        if best is None or total > best[0]:
            best = total, float(offset), used
    assert best is not None
    _, offset, used = best
    depth = _inverted(values, valid, offset, smallest)
    moved = PlaneFit(fit.explained, fit.planes + np.array([0.0, 0.0, offset]), fit.shares)
    evidence = scale_evidence(depth, valid, moved, used, boxes)
    if evidence is None:
        raise InputError(
            f"{name}: inverse depth has no unit, and no named thing or floor gives it one; add --boxes, or metric depth"
        )
    note = f"{name} is inverse depth; its size and offset were fitted to walls, floor and the usual sizes of things"
    return depth * float(np.exp(evidence.log_scale)), (note,)


def _inverted(values: np.ndarray, valid: np.ndarray, offset: float, smallest: float) -> np.ndarray:
    least = 0.02 * smallest
    return np.where(valid, 1.0 / np.maximum(values + offset, least), 0.0)
