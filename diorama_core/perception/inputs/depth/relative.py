"""Inverse depth of any offset and unit, and roots, logarithms and offsets of depth made metric.

Walls meet floors at right angles, things have their sizes, and a camera is held at a person's height.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.errors import InputError
from diorama_core.perception.inputs.depth.kinds import DepthReading, Known
from diorama_core.perception.inputs.depth.planes import DepthFunction, PlaneFit
from diorama_core.perception.inputs.depth.scale import (
    CONTRADICTED_BY,
    ScaleEvidence,
    focal_of_planes,
    focal_score,
    scale_evidence,
    size_scatter,
)

OFFSETS = np.concatenate([[0.0], np.geomspace(0.003, 2.0, 60), -np.geomspace(0.003, 0.95, 40)])
"""Added to the numbers, in shares of their smallest: what a network or a program subtracted before."""
SCATTER_WEIGHT = 12.0
"""Nats for a scatter of one e-fold among the sizes of named things."""
BASES = (1.0, float(np.log(2.0)), float(np.log(10.0)))
"""Rates of the logarithms that are in use."""
NEAR_BASE = 0.15
"""Tolerance of the logarithm of a fitted rate to one of those; planes tell it to a tenth."""


def metric_depth(
    name: str, values: Float[np.ndarray, "h w"], fit: PlaneFit, known: Known
) -> tuple[Float[np.ndarray, "h w"], tuple[str, ...]]:
    """Depth along the optical axis in metres, with a note how it came about.

    Args:
        name: of the file.
        values: inverse depth times anything plus anything; 0 where there is none.
        fit: planes of the values.
        known: beside them.

    Raises:
        InputError: neither named things nor a floor give it a size.
    """
    smallest = float(np.percentile(values[values > 0], 0.5))
    best: tuple[float, Float[np.ndarray, "h w"], PlaneFit, float] | None = None
    for offset in OFFSETS * smallest:
        depth = np.where(values > 0, 1.0 / np.maximum(values + offset, 0.02 * smallest), 0.0)
        moved = PlaneFit(fit.explained, fit.planes + np.array([0.0, 0.0, offset]), fit.shares)
        score, angle_focal = focal_score(moved)
        focal = known.focal if known.focal is not None else angle_focal
        total = score - SCATTER_WEIGHT * size_scatter(depth, focal, known.boxes)
        if best is None or total > best[0]:
            best = total, depth, moved, focal
    assert best is not None
    _, depth, moved, focal = best
    factor = _factor(name, scale_evidence(depth, moved, focal, known.boxes))
    note = f"{name} is inverse depth; its size and offset were fitted to walls, floor and the usual sizes of objects"
    return depth * factor, (note,)


def metric_of_bent(
    name: str, values: Float[np.ndarray, "h w"], reading: DepthReading, known: Known, per_metre: float | None
) -> tuple[Float[np.ndarray, "h w"], tuple[str, ...]]:
    """Depth in metres of its root or logarithm, with a note how it came about.

    Args:
        name: of the file.
        values: the root, the logarithm, or depth less a constant; 0 where there is none.
        reading: of the numbers.
        known: beside them.
        per_metre: numbers for one of metres: their root times this, or their natural logarithm; None to fit it.

    Raises:
        InputError: neither named things nor a floor give it a size.
    """
    rate, function = reading.function.rate, reading.function
    if per_metre is not None:
        natural = function if rate is None else DepthFunction(rate=1.0)
        return np.where(values > 0, 1.0 / natural.inverse_depth(values / per_metre), 0.0), ()
    base = None if rate is None else min(BASES, key=lambda b: abs(np.log(rate / b)))
    usual = reading.kind == "root" or (base is not None and rate is not None and abs(np.log(rate / base)) < NEAR_BASE)
    if usual and base is not None:
        function = DepthFunction(rate=base)
    depth = np.where(values > 0, 1.0 / function.inverse_depth(values), 0.0)
    evidence = scale_evidence(depth, reading.fit, known.focal or focal_of_planes(reading.fit), known.boxes)
    if usual and (evidence is None or abs(evidence.log_scale) < CONTRADICTED_BY):
        return depth, (f"{name} was read as the {reading.kind} of metres",)
    note = f"{name} was read as {reading.kind}; its size was fitted to the floor and the usual sizes of objects"
    return depth * _factor(name, evidence), (note,)


def _factor(name: str, evidence: ScaleEvidence | None) -> float:
    if evidence is None:
        raise InputError(
            f"{name}: this depth has no unit, and no named object or floor gives it one; add --boxes, or metric depth"
        )
    return float(np.exp(evidence.log_scale))
