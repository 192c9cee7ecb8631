"""How long the unit of a depth map is: which of the usual ones, by usual sizes of named things and heights of rooms.

What has no unit is made metric: inverse depth of any offset and unit, and roots, logarithms and offsets of depth. Walls
meet floors at right angles, things have their sizes, and a camera is held at a person's height.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import InputError
from diorama_core.library.kinds import sizes_of_kind
from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.perception.inputs.depth.kinds import DepthKind, DepthReading, Known
from diorama_core.perception.inputs.depth.planes import DepthFunction, PlaneFit

USUAL_UNITS = {
    1.0: "metres", 1000.0: "millimetres", 5000.0: "1/5000 m, as in TUM RGB-D", 4000.0: "1/4000 m",
    256.0: "1/256 m", 100.0: "centimetres", 10000.0: "1/10000 m", 8000.0: "1/8000 m", 500.0: "1/500 m",
    2000.0: "1/2000 m", 10.0: "decimetres", 39.37: "inches", 3.2808: "feet", 6553.5: "1/6553.5 m",
    16777.215: "CARLA's 24 bits", 25.5: "1/25.5 m", 1000000.0: "micrometres",
    512.0: "1/512 m", 128.0: "1/128 m", 200.0: "1/200 m",
    50.0: "1/50 m",
}  # fmt: skip
"""Units per metre of sensors and data sets."""
CONTRADICTED_BY = float(np.log(1.8))
"""Factor beyond which the picture contradicts a unit: rooms of unusual things measure up to 1.5."""
CERTAIN_NATS = 1.2
"""By which one unit must be likelier than all others to be used; otherwise it is asked for."""
TOLERANCE = 0.11
"""Deviation of the evidence's logarithm from the true one, beside its own sigma's half: measured on known rooms."""
MIN_THINGS = 3
USUAL_HEIGHTS_M = (0.9, 2.5)
"""Usual heights of cameras over floors (m): of 26 photos with predicted depth one was higher, none lower."""


@dataclass(frozen=True)
class DepthAnswer:
    """What a person may say of a depth map: its unit, or what its numbers are."""

    words: str
    per_metre: float | None = None
    """Units per metre; None where the file and the picture say."""
    kind: DepthKind = "auto"


class AmbiguousDepthError(InputError):
    """What a depth map holds cannot be told; `choices` are the likely answers."""

    def __init__(self, message: str, choices: tuple[DepthAnswer, ...] = ()) -> None:
        super().__init__(message)
        self.choices = choices


@dataclass(frozen=True)
class DepthUnit:
    """Units per metre, and what to tell."""

    per_metre: float
    note: str = ""
    question: str = ""
    """Why the unit cannot be told, and what to give; empty where it can."""
    choices: tuple[tuple[float, str], ...] = ()
    """Likely units per metre and their words, where it cannot be told."""


def unit_of(evidence: ScaleEvidence | None, stated: float) -> DepthUnit:
    """The unit of a map whose container states so many units per metre; `evidence` is None where nothing is seen.

    Args:
        evidence: how many metres a unit is, by the picture; None where it says nothing.
        stated: units per metre that the container has.
    """
    if evidence is None or (evidence.things < MIN_THINGS and not evidence.heights_agree):
        return DepthUnit(stated, _doubtful_height(evidence, stated))
    seen = -evidence.log_scale
    off = abs(seen - np.log(stated))
    if off < CONTRADICTED_BY or off < 3.0 * evidence.sigma:
        return DepthUnit(stated)
    sigma = float(np.hypot(TOLERANCE, evidence.sigma / 2))
    nats = {u: -0.5 * ((seen - np.log(u)) / sigma) ** 2 for u in USUAL_UNITS}
    likely = sorted(nats, key=lambda u: -nats[u])[:2]
    wrong = _words(stated, float(np.exp(seen)) / stated, evidence)
    if nats[likely[0]] < -4.5 and evidence.things < MIN_THINGS:  # a hall, or depth that a network guessed
        return DepthUnit(stated, f"{wrong}; if that is wrong, give its unit by --depth-scale")
    if nats[likely[0]] < -4.5:
        return DepthUnit(stated, question=f"{wrong}; its unit is unknown: give --depth-scale {np.exp(seen):.3g} or so")
    if nats[likely[0]] - nats[likely[1]] < CERTAIN_NATS:
        best, other = likely
        return DepthUnit(
            stated,
            question=f"{wrong}; give --depth-scale {best:g} ({USUAL_UNITS[best]}) or --depth-scale {other:g}",
            choices=tuple((u, USUAL_UNITS[u]) for u in (best, other, stated) if u in USUAL_UNITS),
        )
    best = likely[0]
    return DepthUnit(best, f"{wrong}; it was read as {USUAL_UNITS[best]} (--depth-scale {best:g})")


def _words(stated: float, factor: float, evidence: ScaleEvidence) -> str:
    unit = USUAL_UNITS.get(stated, f"1/{stated:g} m")
    height, room = evidence.floor_height, evidence.room_height
    camera = "" if height is None else f" and the camera {height / stated:.1f} m above the floor"
    times = f"{factor:.1f} times" if factor > 1 else f"1/{1 / factor:.1f} of"
    if evidence.things < MIN_THINGS and room is not None:
        return f"read in {unit}, the room is {room / stated:.1f} m high{camera}"
    return f"read in {unit}, objects have {times} their usual size{camera}"


def _doubtful_height(evidence: ScaleEvidence | None, stated: float) -> str:
    """A note where only the floor says something, and hardly anybody holds a camera so high or low."""
    if evidence is None or evidence.floor_height is None:
        return ""
    height = evidence.floor_height / stated
    if USUAL_HEIGHTS_M[0] <= height <= USUAL_HEIGHTS_M[1]:
        return ""
    return (
        f"by this depth the camera is {height:.1f} m above the floor; if that is wrong, give its unit by --depth-scale"
    )


FOCAL_PRIOR = (0.72, 0.3)
"""Focal length over the longer side: median, and standard deviation of the logarithm, of phones to renderings."""
FOCAL_GRID = np.geomspace(0.4, 1.6, 25)
RIGHT_ANGLE = 0.06
"""Cosine by which walls, floor and ceiling of real rooms, as measured, are off a right angle."""
PAIR_WEIGHT = 40.0
"""Nats for two planes of all pixels that meet at a right angle."""
HEIGHT_PRIOR = (1.5, 0.22)
"""Camera height over the floor in metres: median, and standard deviation of the logarithm."""
ROOM_HEIGHT_PRIOR = (2.6, 0.15)
"""Height of a room in metres, likewise: homes and offices, not halls."""
HEIGHTS_AGREE = float(np.log(1.35))
"""Log ratio of the scales by the camera's and the room's height, within which the two agree."""
MIN_LEVEL_SHARE = 0.03
"""Share of the points on a floor or ceiling."""
SIZE_SIGMA = 0.55
"""Standard deviation of log(seen size / size of the kind): occlusion, pose and variation within the kind."""
MIN_SIZE_SIGMA = 0.15
"""Smallest standard deviation for many objects together, because the sizes of kinds err alike."""
DISAGREEMENT = float(np.log(1.8))
"""Log ratio of the scales by camera height and by object sizes above which one of them is wrong."""
FLOOR_COSINE = 0.77
"""Between a floor's normal and the picture's downward direction: a camera is tilted by 40 degrees at most."""
NEAR_PERCENTILE = 30
"""Percentile of the depths within a box that belongs to the object, not to what is seen beside and through it."""
MARGIN = 0.01
"""Share of the photo within which a box touches its side, and its thing is cut off."""


@dataclass(frozen=True)
class ScaleEvidence:
    """What the picture says about the unit of a map: metres a unit, as the logarithm."""

    log_scale: float
    sigma: float
    things: int
    """Named things that say so."""
    floor_height: float | None
    """Height of the camera over the floor, in the map's unit; None where no floor is seen."""
    room_height: float | None = None
    """Height of the ceiling over the floor, in the map's unit; None where no ceiling is seen."""

    @property
    def heights_agree(self) -> bool:
        """Whether the camera's height and the room's tell the same unit."""
        if self.floor_height is None or self.room_height is None:
            return False
        expected = ROOM_HEIGHT_PRIOR[0] / HEIGHT_PRIOR[0]
        return abs(float(np.log(self.room_height / self.floor_height / expected))) < HEIGHTS_AGREE


def focal_of_planes(fit: PlaneFit) -> float:
    """The focal length over the longer side under which planes of a room meet at right angles or are parallel."""
    return focal_score(fit)[1]


def focal_score(fit: PlaneFit) -> tuple[float, float]:
    """How well the planes of a room agree, in nats, and the focal length over the longer side at which they do."""
    score = -0.5 * (np.log(FOCAL_GRID / FOCAL_PRIOR[0]) / FOCAL_PRIOR[1]) ** 2
    for i in range(len(fit.planes)):
        for j in range(i):
            cosines = np.abs(_cosine(fit.planes[i], fit.planes[j]))
            off = np.minimum(cosines, 1.0 - cosines)
            weight = PAIR_WEIGHT * float(fit.shares[i] * fit.shares[j])
            score = score + weight * np.exp(-0.5 * (off / RIGHT_ANGLE) ** 2)
    best = int(np.argmax(score))
    return float(score[best]), float(FOCAL_GRID[best])


def size_scatter(depth: Float[np.ndarray, "h w"], focal: float, boxes: Sequence[LabelledBox]) -> float:
    """The median deviation of the logarithms of things' sizes from their median; 0 for fewer than three things.

    Lengths are as `scale_evidence` has them.

    Args:
        depth: z in camera, in the map's unit.
        focal: focal length in shares of the picture's longer side.
        boxes: of named things, in shares of the longer side.
    """
    logs = np.array([v for box in boxes for v in _log_scales(depth, focal, box)])
    return float(np.median(np.abs(logs - np.median(logs)))) if len(logs) >= 6 else 0.0


def scale_evidence(
    depth: Float[np.ndarray, "h w"], fit: PlaneFit, focal: float, boxes: Sequence[LabelledBox]
) -> ScaleEvidence | None:
    """How long a map's unit is in metres; None where neither named things nor a floor say so.

    Args:
        depth: along the optical axis, in an unknown unit, of the photo's proportions; 0 where it was not measured.
        fit: its planes.
        focal: over the longer side.
        boxes: in shares of the longer side of the map, x and y from its upper left.
    """
    logs = [v for box in boxes for v in _log_scales(depth, focal, box)]
    height, room = _heights(fit, focal)
    terms = []
    if logs:
        spread = max(MIN_SIZE_SIGMA, SIZE_SIGMA / np.sqrt(len(logs) / 2))
        terms.append((float(np.median(logs)), float(spread)))
    if height is not None:
        terms.append((float(np.log(HEIGHT_PRIOR[0] / height)), HEIGHT_PRIOR[1]))
    if not terms:
        return None
    if len(terms) == 2 and abs(terms[0][0] - terms[1][0]) > DISAGREEMENT:
        # The lowest plane is a table's top, or things are of unusual sizes: several things decide, one does not.
        if len(logs) < 6:
            return ScaleEvidence(terms[0][0], terms[0][1], 0, height, room)
        terms = terms[:1]
    if room is not None and not logs:
        terms.append((float(np.log(ROOM_HEIGHT_PRIOR[0] / room)), ROOM_HEIGHT_PRIOR[1]))
    weights = np.array([1.0 / s**2 for _, s in terms])
    mean = float(weights @ [m for m, _ in terms] / weights.sum())
    return ScaleEvidence(mean, float(weights.sum() ** -0.5), len(logs) // 2, height, room)


def _cosine(one: np.ndarray, other: np.ndarray) -> Float[np.ndarray, "f"]:
    """Between two planes' normals, for every focal length of the grid."""
    stretch = np.stack([FOCAL_GRID, FOCAL_GRID, np.ones_like(FOCAL_GRID)], axis=1)
    a, b = stretch * one, stretch * other
    return (a * b).sum(axis=1) / np.maximum(np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1), 1e-12)


def _heights(fit: PlaneFit, focal: float) -> tuple[float | None, float | None]:
    """Heights of the camera over the lowest large upward plane, and of the highest downward plane over that."""
    normals = fit.planes * [focal, focal, 1.0]
    lengths = np.maximum(np.linalg.norm(normals, axis=1), 1e-12)
    away, downward = 1.0 / lengths, normals[:, 1] / lengths
    large = fit.shares > MIN_LEVEL_SHARE
    floors, ceilings = away[large & (downward > FLOOR_COSINE)], away[large & (downward < -FLOOR_COSINE)]
    floor = float(floors.max()) if len(floors) else None
    return floor, None if floor is None or not len(ceilings) else floor + float(ceilings.max())


def _log_scales(depth: np.ndarray, focal: float, box: LabelledBox) -> list[float]:
    """Logarithms of a thing's usual height and width over what the map says of them."""
    if box.category == UNKNOWN.name:
        return []
    side, (height, width) = max(depth.shape), depth.shape
    x1, y1, x2, y2 = (v * side for v in box.box)
    inner_x, inner_y = 0.2 * (x2 - x1), 0.2 * (y2 - y1)
    values = depth[int(y1 + inner_y) : int(y2 - inner_y) + 1, int(x1 + inner_x) : int(x2 - inner_x) + 1]
    values = values[values > 0]
    if len(values) < 9:
        return []
    distance = float(np.percentile(values, NEAR_PERCENTILE))
    # The mean kind: seen a little from above and turned by any angle.
    deep, wide, tall = np.exp(sum(m.share * m.log_size for m in sizes_of_kind(box.category)))
    usual = {"h": tall + 0.25 * deep, "w": 2.0 / np.pi * (wide + deep)}
    seen = {"h": (y2 - y1) / side * distance / focal, "w": (x2 - x1) / side * distance / focal}
    low, far = MARGIN * side, np.array([width, height]) - MARGIN * side
    whole = {"h": y1 > low and y2 < far[1], "w": x1 > low and x2 < far[0]}
    return [float(np.log(usual[k] / seen[k])) for k in ("h", "w") if whole[k] and seen[k] > 0]


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
