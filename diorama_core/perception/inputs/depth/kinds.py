"""What the numbers of a depth map are, by likelihood: depth, its root or logarithm, inverse depth, or along the rays.

Each reading has one score: how many pixels lie on planes under it, and whether what is nearer in the picture (the
floor's lower end, things before walls) is nearer in the map.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import LabelledBox
from diorama_core.library.taxonomy import UNKNOWN, category
from diorama_core.perception.inputs.depth.planes import (
    DEPTH,
    INVERSE,
    ROOT,
    TRIALS,
    DepthFunction,
    PlaneFit,
    SampledDepth,
    planes_of,
    sample_depth,
)

Kind = Literal["depth", "distance", "inverse", "root", "logarithm", "shifted"]
DepthKind = Literal["auto", "depth", "distance", "inverse", "root", "logarithm", "shifted"]
"""Along the optical axis; along the rays; inverse depth or disparity of any offset; the square root or logarithm of
depth; depth less a constant; or inferred from the picture."""
BENT = ("root", "logarithm", "shifted")
"""Kinds under which larger is farther, but planes of depth are none of the numbers."""

PLANE_WEIGHT = 40.0
"""Nats for all pixels on planes: wrong readings of measured maps explain 0.05 to 0.4 less."""
ORDER_WEIGHT = 3.0
PRIOR = {"depth": 1.5, "distance": 0.0, "inverse": 0.0, **dict.fromkeys(BENT, 0.0)}
"""Most maps that are called depth are depth along the axis, and a fitted focal length explains a little by itself."""
RAY_FOCALS = (0.45, 0.6, 0.8, 1.1)
"""Focal lengths over the longer side that are tried where none is known."""
LOG_RANGES = (0.4, 0.6, 0.85, 1.2, 1.8)
"""Logarithms of far over near depth in a room, which tell a logarithm's base: they are tried."""
OFFSETS = (0.1, 0.2, 0.4, 0.8, 1.6)
"""Nearest depth over the range of depth, which is what normalised depth lacks: they are tried."""
EXACT, NEARLY = 0.8, 0.04
"""Share of pixels on planes from which nothing else is asked, and by which a first look may be behind."""
SEARCH_POINTS, SEARCH_TRIALS = 800, 60
"""For the first look at a focal length: enough to tell whether a closer one is worth its time."""
MIN_ORDER = 0.15
"""Rank correlation, -1 to 1, below which the map does not order near and far as its reading claims."""
CONTRADICTION = 3.0
"""Nats by which another reading must be better for a map to contradict its given kind."""


@dataclass(frozen=True)
class Known:
    """What is known beside a map: boxes of named things in shares of the longer side, and the focal length over it."""

    boxes: tuple[LabelledBox, ...] = ()
    focal: float | None = None


@dataclass(frozen=True, eq=False)
class DepthReading:
    """One reading of a map's numbers."""

    kind: Kind
    score: float
    fit: PlaneFit
    function: DepthFunction
    """Function of depth that the numbers are, distances along rays apart."""
    focal: float | None
    """Over the longer side: the one under which distances along rays form planes."""
    order: float
    """-1 to 1: whether larger numbers are farther (1) or nearer in the picture."""


def depth_readings(
    values: Float[np.ndarray, "h w"], known: Known, asked: DepthKind = "auto"
) -> tuple[DepthReading, ...]:
    """All readings of a map's positive numbers that come into question, likeliest first; `asked` is among them."""
    sample, order = sample_depth(values), depth_order(values, known.boxes)
    scale = max(float(np.median(sample.values)), 1e-12)
    sample = SampledDepth(sample.x, sample.y, sample.values / scale)
    readings = [
        _reading("depth", DEPTH, planes_of(sample), order),
        _reading("inverse", INVERSE, planes_of(sample, INVERSE), -order),
    ]
    exact = readings[0].fit.explained > EXACT
    rays = () if exact and asked != "distance" else _ray_focals(sample, always=asked == "distance")
    for trial in rays if known.focal is None else (known.focal,):
        readings.append(_reading("distance", DEPTH, planes_of(to_axial_depth(sample, trial)), order, trial))
    for kind, function in () if exact and asked not in BENT else _find_bent_functions(sample, asked):
        readings.append(_reading(kind, function, planes_of(sample, function), order))
    restored = [_to_map_unit(r, scale) for r in readings]
    return tuple(sorted(restored, key=lambda r: -r.score))


def depth_order(values: Float[np.ndarray, "h w"], boxes: Sequence[LabelledBox]) -> float:
    """Order of depth, 1 if larger numbers are farther, else -1: by the picture's lower end and objects' backgrounds."""
    height = len(values)
    spread = float(np.ptp(np.percentile(values[values > 0], [10, 90]))) or 1.0
    lower, middle = (_median(values[int(a * height) : int(b * height)]) for a, b in ((0.85, 1.0), (0.4, 0.6)))
    medians = []
    if lower is not None and middle is not None:
        medians.append(float(np.clip(2.0 * (middle - lower) / spread, -1.0, 1.0)))
    votes = [v for box in boxes if (v := _background_order(values, box, spread)) is not None]
    if votes:
        medians.append(float(np.mean(votes)))
    return float(np.mean(medians)) if medians else 0.0


def to_axial_depth(sample: SampledDepth, focal: float) -> SampledDepth:
    """Distances along rays as depth along the optical axis."""
    rays = np.sqrt(1.0 + (sample.x**2 + sample.y**2) / focal**2)
    return SampledDepth(sample.x, sample.y, sample.values / rays)


def rays_of(height: int, width: int, focal: float) -> Float[np.ndarray, "h w"]:
    """The length of each pixel's ray at depth 1; `focal` over the longer side."""
    side = max(height, width)
    x = (np.arange(width) + 0.5 - width / 2) / side / focal
    y = (np.arange(height) + 0.5 - height / 2) / side / focal
    return np.sqrt(1.0 + x[None, :] ** 2 + y[:, None] ** 2)


def _ray_focals(sample: SampledDepth, *, always: bool) -> tuple[float, ...]:
    """The focal length under which distances form planes best; none where depth forms clearly more."""
    few = sample.subsample(SEARCH_POINTS)
    scores = {f: _share(to_axial_depth(few, f), trials=SEARCH_TRIALS) for f in RAY_FOCALS}
    best, as_depth = max(scores, key=lambda f: scores[f]), _share(few, trials=SEARCH_TRIALS)
    if scores[best] < as_depth - NEARLY and not always:
        return ()
    if scores[best] > as_depth or always:
        scores = {best: _share(to_axial_depth(sample, best))}
        for step in (1.15, 1.07, 1.035):
            for near in (best / step, best * step):
                scores[near] = _share(to_axial_depth(sample, near))
            best = max(scores, key=lambda f: scores[f])
    return (best,)


def _find_bent_functions(sample: SampledDepth, asked: DepthKind) -> tuple[tuple[Kind, DepthFunction], ...]:
    """The root, logarithm and offset of depth, where the numbers form about as many planes so as they do as depth."""
    few = sample.subsample(SEARCH_POINTS)
    enough = _share(few, trials=SEARCH_TRIALS) - NEARLY

    def planar(function: DepthFunction) -> float:
        return _share(few, function, SEARCH_TRIALS)

    def best(make: Callable[[float], DepthFunction], tried: Sequence[float]) -> DepthFunction:
        chosen = max(tried, key=lambda v: planar(make(v)))
        for step in (1.2, 1.1, 1.05):
            chosen = max((chosen, chosen / step, chosen * step), key=lambda v: planar(make(v)))
        return make(chosen)

    kinds: dict[Kind, DepthFunction] = {
        "root": ROOT,
        "logarithm": best(lambda v: DepthFunction(rate=v / few.spread), LOG_RANGES),
        "shifted": best(lambda v: DepthFunction(offset=v * few.spread), OFFSETS),
    }
    return tuple((k, f) for k, f in kinds.items() if k == asked or planar(f) > enough)


def _share(sample: SampledDepth, function: DepthFunction = DEPTH, trials: int = TRIALS) -> float:
    return planes_of(sample, function, trials).explained


def _reading(
    kind: Kind, function: DepthFunction, fit: PlaneFit, order: float, focal: float | None = None
) -> DepthReading:
    score = PLANE_WEIGHT * fit.explained + ORDER_WEIGHT * order + PRIOR[kind]
    return DepthReading(kind, score, fit, function, focal, order)


def _to_map_unit(reading: DepthReading, scale: float) -> DepthReading:
    """The reading in the map's own unit."""
    function, one = reading.function.scale(scale), np.ones(1)
    factor = float(function.inverse_depth(scale * one)[0] / reading.function.inverse_depth(one)[0])
    fit = PlaneFit(reading.fit.explained, reading.fit.planes * factor, reading.fit.shares)
    return replace(reading, fit=fit, function=function)


def _background_order(values: np.ndarray, box: LabelledBox, spread: float) -> float | None:
    """Order of depth by the background above and beside an object on the floor: 1 if its numbers are larger, or -1."""
    if box.category == UNKNOWN.name or category(box.category).mount != "floor" or box.category == "rug":
        return None
    side = max(values.shape)
    x1, y1, x2, y2 = (round(v * side) for v in box.box)
    width, tall = x2 - x1, y2 - y1
    here = _median(values[y1 + tall // 3 : y2 - tall // 4, x1 + width // 4 : x2 - width // 4])
    above = _median(values[max(0, y1 - max(tall // 3, 3)) : y1, x1:x2])
    return None if here is None or above is None else float(np.clip(4.0 * (above - here) / spread, -1.0, 1.0))


def _median(values: np.ndarray) -> float | None:
    known = values[values > 0]
    return float(np.median(known)) if known.size >= 9 else None
