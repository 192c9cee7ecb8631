"""How long the unit of a depth map is: named things have usual sizes, rooms usual heights, and so have cameras."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import LabelledBox
from diorama_core.library.kinds import sizes_of_kind
from diorama_core.library.taxonomy import UNKNOWN
from diorama_core.perception.inputs.depth.planes import PlaneFit

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


def size_scatter(
    depth: Float[np.ndarray, "h w"], valid: Bool[np.ndarray, "h w"], focal: float, boxes: Sequence[LabelledBox]
) -> float:
    """The median deviation of the logarithms of things' sizes from their median; 0 for fewer than three things.

    Args:
        depth: z in camera, in the map's unit.
        valid: where it was measured.
        focal: focal length in shares of the picture's longer side.
        boxes: of named things, in shares of the longer side.
    """
    logs = np.array([v for box in boxes for v in _log_scales(depth, valid, focal, box)])
    return float(np.median(np.abs(logs - np.median(logs)))) if len(logs) >= 6 else 0.0


def scale_evidence(
    depth: Float[np.ndarray, "h w"],
    valid: Bool[np.ndarray, "h w"],
    fit: PlaneFit,
    focal: float,
    boxes: Sequence[LabelledBox],
) -> ScaleEvidence | None:
    """How long a map's unit is in metres; None where neither named things nor a floor say so.

    Args:
        depth: along the optical axis, in an unknown unit, of the photo's proportions.
        valid: where it was measured.
        fit: its planes.
        focal: over the longer side.
        boxes: in shares of the longer side of the map, x and y from its upper left.
    """
    logs = [v for box in boxes for v in _log_scales(depth, valid, focal, box)]
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


def _log_scales(depth: np.ndarray, valid: np.ndarray, focal: float, box: LabelledBox) -> list[float]:
    """Logarithms of a thing's usual height and width over what the map says of them."""
    if box.category == UNKNOWN.name:
        return []
    side, (height, width) = max(depth.shape), depth.shape
    x1, y1, x2, y2 = (v * side for v in box.box)
    inner_x, inner_y = 0.2 * (x2 - x1), 0.2 * (y2 - y1)
    part = np.s_[int(y1 + inner_y) : int(y2 - inner_y) + 1, int(x1 + inner_x) : int(x2 - inner_x) + 1]
    values = depth[part][valid[part]]
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
