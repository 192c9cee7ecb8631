"""What the numbers of a depth map are, by likelihood: depth, distance along the rays, or inverse depth.

Each reading has one score: how many pixels lie on planes under it, and whether what is nearer in the picture (the
floor's lower end, things before walls) is nearer in the map.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import LabelledBox
from diorama_core.library.taxonomy import UNKNOWN, category
from diorama_core.perception.inputs.depth.planes import TRIALS, PlaneFit, SampledDepth, planes_of, sampled

Kind = Literal["depth", "distance", "inverse"]
DepthKind = Literal["auto", "depth", "distance", "inverse"]
"""Along the optical axis; along the rays; inverse depth or disparity of any offset; or inferred from the picture."""

PLANE_WEIGHT = 40.0
"""Nats for all pixels on planes: wrong readings of measured maps explain 0.05 to 0.4 less."""
ORDER_WEIGHT = 3.0
PRIOR = {"depth": 1.5, "distance": 0.0, "inverse": 0.0}
"""Most maps that are called depth are depth along the axis, and a fitted focal length explains a little by itself."""
RAY_FOCALS = (0.45, 0.6, 0.8, 1.1)
"""Focal lengths over the longer side that are tried where none is known."""
EXACT, NEARLY = 0.8, 0.04
"""Share of pixels on planes from which nothing else is asked, and by which a first look may be behind."""
SEARCH_POINTS, SEARCH_TRIALS = 800, 60
"""For the first look at a focal length: enough to tell whether a closer one is worth its time."""
MIN_ORDER = 0.15
"""Of -1 to 1: below, the map says nothing of near and far, or the contrary of its reading."""
CONTRADICTION = 3.0
"""Nats by which another reading must be better for a map to contradict its given kind."""


@dataclass(frozen=True, eq=False)
class DepthReading:
    """One reading of a map's numbers."""

    kind: Kind
    score: float
    fit: PlaneFit
    focal: float | None
    """Over the longer side: the one under which distances along rays form planes."""
    order: float
    """-1 to 1: whether larger numbers are farther (1) or nearer in the picture."""


def depth_readings(
    values: Float[np.ndarray, "h w"],
    valid: Bool[np.ndarray, "h w"],
    boxes: Sequence[LabelledBox],
    focal: float | None,
) -> tuple[DepthReading, ...]:
    """All readings, likeliest first.

    Args:
        values: the map's positive numbers.
        valid: where there are some.
        boxes: named things in shares of the longer side.
        focal: over the longer side, where it is known.
    """
    sample, order = sampled(values, valid), near_and_far(values, valid, boxes)
    scale = max(float(np.median(sample.values)), 1e-12)
    sample = SampledDepth(sample.x, sample.y, sample.values / scale)
    readings = [
        _reading("depth", planes_of(sample, inverse=False), order, None),
        _reading("inverse", planes_of(sample, inverse=True), -order, None),
    ]
    for trial in (focal,) if focal is not None else _ray_focals(sample, readings[0].fit.explained):
        readings.append(_reading("distance", planes_of(on_axis(sample, trial), inverse=False), order, trial))
    restored = [_in_unit(r, scale) for r in readings]
    return tuple(sorted(restored, key=lambda r: -r.score))


def near_and_far(
    values: Float[np.ndarray, "h w"], valid: Bool[np.ndarray, "h w"], boxes: Sequence[LabelledBox]
) -> float:
    """Whether larger numbers are farther (1) or nearer (-1): by the picture's lower end, and things' backgrounds."""
    height = len(values)
    known = values[valid]
    spread = float(np.ptp(np.percentile(known, [10, 90]))) or 1.0
    lower, middle = (
        _median(values, valid, np.s_[int(a * height) : int(b * height)]) for a, b in ((0.85, 1.0), (0.4, 0.6))
    )
    found = []
    if lower is not None and middle is not None:
        found.append(float(np.clip(2.0 * (middle - lower) / spread, -1.0, 1.0)))
    votes = [v for box in boxes if (v := _before_background(values, valid, box, spread)) is not None]
    if votes:
        found.append(float(np.mean(votes)))
    return float(np.mean(found)) if found else 0.0


def on_axis(sample: SampledDepth, focal: float) -> SampledDepth:
    """Distances along rays as depth along the optical axis."""
    rays = np.sqrt(1.0 + (sample.x**2 + sample.y**2) / focal**2)
    return SampledDepth(sample.x, sample.y, sample.values / rays)


def rays_of(height: int, width: int, focal: float) -> Float[np.ndarray, "h w"]:
    """The length of each pixel's ray at depth 1; `focal` over the longer side."""
    side = max(height, width)
    x = (np.arange(width) + 0.5 - width / 2) / side / focal
    y = (np.arange(height) + 0.5 - height / 2) / side / focal
    return np.sqrt(1.0 + x[None, :] ** 2 + y[:, None] ** 2)


def _ray_focals(sample: SampledDepth, explained: float) -> tuple[float, ...]:
    """The focal length under which distances form planes best, where they do so nearly as well as depth does.

    Args:
        sample: the numbers.
        explained: share of them on planes where they are depth along the axis.
    """
    if explained > EXACT:
        return ()
    few = sample.thinned(SEARCH_POINTS)
    scores = {f: _share(on_axis(few, f), SEARCH_TRIALS) for f in RAY_FOCALS}
    best, as_depth = max(scores, key=lambda f: scores[f]), _share(few, SEARCH_TRIALS)
    if scores[best] < as_depth - NEARLY:
        return ()
    if scores[best] > as_depth:
        scores = {best: _share(on_axis(sample, best))}
        for step in (1.15, 1.07, 1.035):
            for near in (best / step, best * step):
                scores[near] = _share(on_axis(sample, near))
            best = max(scores, key=lambda f: scores[f])
    return (best,)


def _share(sample: SampledDepth, trials: int = TRIALS) -> float:
    return planes_of(sample, inverse=False, trials=trials).explained


def _reading(kind: Kind, fit: PlaneFit, order: float, focal: float | None) -> DepthReading:
    score = PLANE_WEIGHT * fit.explained + ORDER_WEIGHT * order + PRIOR[kind]
    return DepthReading(kind, score, fit, focal, order)


def _in_unit(reading: DepthReading, scale: float) -> DepthReading:
    """The reading's planes in the map's own unit."""
    factor = scale if reading.kind == "inverse" else 1.0 / scale
    fit = PlaneFit(reading.fit.explained, reading.fit.planes * factor, reading.fit.shares)
    return DepthReading(reading.kind, reading.score, fit, reading.focal, reading.order)


def _before_background(values: np.ndarray, valid: np.ndarray, box: LabelledBox, spread: float) -> float | None:
    """Whether what is above and beside a thing that stands on the floor has larger numbers (1) or smaller (-1)."""
    if box.category == UNKNOWN.name or category(box.category).mount != "floor" or box.category == "rug":
        return None
    side = max(values.shape)
    x1, y1, x2, y2 = (round(v * side) for v in box.box)
    width, tall = x2 - x1, y2 - y1
    inner = np.s_[y1 + tall // 3 : y2 - tall // 4, x1 + width // 4 : x2 - width // 4]
    above = np.s_[max(0, y1 - max(tall // 3, 3)) : y1, x1:x2]
    here, there = _median(values, valid, inner), _median(values, valid, above)
    return None if here is None or there is None else float(np.clip(4.0 * (there - here) / spread, -1.0, 1.0))


def _median(values: np.ndarray, valid: np.ndarray, part: tuple[slice, ...] | slice) -> float | None:
    found = values[part][valid[part]]
    return float(np.median(found)) if found.size >= 9 else None
