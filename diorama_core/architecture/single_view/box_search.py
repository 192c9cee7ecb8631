"""Search for the room box with the highest score: coordinate ascent from a few starts."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.architecture.single_view.room_cues import MAX_CEILING_M, PRIOR_MEDIAN_M, RoomCues
from diorama_core.architecture.single_view.settings import SETTINGS, RoomSearchSettings

_SCALES = np.geomspace(0.6, 1.7, 15)
_DISTANCES_M = np.geomspace(0.5, 9.0, 24)
_CEILINGS_M = np.geomspace(2.1, MAX_CEILING_M, 24)


def find_box(cues: RoomCues, settings: RoomSearchSettings = SETTINGS.search) -> tuple[Float[np.ndarray, "4"], float]:
    """The best box (x0, x1, y1, ceiling) and its score; deterministic."""
    candidates = [_swept(cues, start, float(cues.score(start[None])[0]), settings) for start in _starts(cues, settings)]
    candidates.sort(key=lambda pair: -pair[1])
    return max(
        (_ascend(cues, *pair, settings=settings) for pair in candidates[: settings.finalists]), key=lambda pair: pair[1]
    )


def _starts(cues: RoomCues, settings: RoomSearchSettings) -> list[Float[np.ndarray, "4"]]:
    """Rooms of usual size, small, deep and wide, each grown around the objects; and one tight around them."""
    x, y, z = cues.camera.position
    half, deep, high = (0.5 * PRIOR_MEDIAN_M[0], PRIOR_MEDIAN_M[1], max(PRIOR_MEDIAN_M[2], z + 0.4))
    shapes = [(half, half, deep), (1.3, 1.3, 2.4), (half, half, 6.0), (3.5, 1.5, 4.0), (1.5, 3.5, 4.0)]
    boxes = [np.array([x - left, x + right, y + far, high]) for left, right, far in shapes]
    tight = np.array([x - 0.5, x + 0.5, y + 1.0, high])
    return [around_objects(cues, box, settings) for box in [*boxes, tight]]


def around_objects(
    cues: RoomCues, box: Float[np.ndarray, "4"], settings: RoomSearchSettings = SETTINGS.search
) -> Float[np.ndarray, "4"]:
    """The box with its walls and ceiling pushed out until every standing object is inside."""
    if len(cues.object_low) == 0:
        return box
    low, high = cues.object_low.min(axis=0) - settings.margin_m, cues.object_high.max(axis=0) + settings.margin_m
    return np.array([min(box[0], low[0]), max(box[1], high[0]), max(box[2], high[1]), max(box[3], high[2])])


def _ascend(
    cues: RoomCues, box: Float[np.ndarray, "4"], score: float, settings: RoomSearchSettings
) -> tuple[Float[np.ndarray, "4"], float]:
    best = box
    for _ in range(settings.sweeps):
        before = score
        best, score = _swept(cues, best, score, settings)
        if score <= before + 1e-9:
            break
    for step in settings.refinements:
        for _ in range(2):
            for coordinate in (2, 0, 1, 3):
                near = best[coordinate] * (1.0 + step * np.array([-1.0, -0.5, 0.5, 1.0]))
                best, score = _improved(cues, best, score, coordinate, near)
    return best, score


def _swept(
    cues: RoomCues, box: Float[np.ndarray, "4"], score: float, settings: RoomSearchSettings
) -> tuple[Float[np.ndarray, "4"], float]:
    """One round: each number in turn, then the whole plan scaled about the camera, which keeps corners in place."""
    for coordinate in (2, 0, 1, 3):
        box, score = _improved(cues, box, score, coordinate, _candidates(cues, box, coordinate, settings))
    eye = np.array([*cues.camera.position[[0, 0, 1]], 0.0])
    scaled = eye + (box - eye) * _SCALES[:, None]
    trial = np.concatenate([scaled, scaled])
    trial[: len(scaled), 3] = box[3]
    trial[len(scaled) :, 3] = cues.camera.position[2] + (box[3] - cues.camera.position[2]) * _SCALES
    return _best_of(cues, trial, box, score)


def _improved(
    cues: RoomCues, box: Float[np.ndarray, "4"], score: float, coordinate: int, values: Float[np.ndarray, "m"]
) -> tuple[Float[np.ndarray, "4"], float]:
    trial = np.repeat(box[None], len(values), axis=0)
    trial[:, coordinate] = values
    return _best_of(cues, trial, box, score)


def _best_of(
    cues: RoomCues, trial: Float[np.ndarray, "m 4"], box: Float[np.ndarray, "4"], score: float
) -> tuple[Float[np.ndarray, "4"], float]:
    scores = cues.score(trial)
    best = int(scores.argmax())
    return (trial[best], float(scores[best])) if scores[best] > score else (box, score)


def _candidates(
    cues: RoomCues, box: Float[np.ndarray, "4"], coordinate: int, settings: RoomSearchSettings
) -> Float[np.ndarray, "m"]:
    """Values to try: evenly spread ones, and those at which a line of the picture becomes a boundary of the box."""
    x, y, z = cues.camera.position
    if coordinate == 3:
        spread = np.maximum(_CEILINGS_M, z + 0.15)
    else:
        spread = (x - _DISTANCES_M, x + _DISTANCES_M, y + _DISTANCES_M)[coordinate]
    lines = _line_values(cues, box, coordinate, settings)
    low, high = (1.9, MAX_CEILING_M) if coordinate == 3 else (0.4, 14.0)
    reach = lines if coordinate == 3 else np.abs(lines - (y if coordinate == 2 else x))
    return np.concatenate([spread, lines[(reach > low) & (reach < high)]])


def _line_values(
    cues: RoomCues, box: Float[np.ndarray, "4"], coordinate: int, settings: RoomSearchSettings
) -> Float[np.ndarray, "m"]:
    """Where boundaries would have to be to pass through the picture's lines, given the other three numbers."""
    origin = cues.camera.position
    d, axes = cues.segment_rays[: settings.max_lines], cues.segment_axes[: settings.max_lines]
    x0, x1, y1, top = box

    def crossing(rays: np.ndarray, known: int, value: float, wanted: int) -> np.ndarray:
        """Coordinates at which rays from the camera pass, where another coordinate has a known value.

        Args:
            rays: (n, 3) in the world.
            known: axis of the known coordinate.
            value: of that coordinate (m).
            wanted: axis of the coordinate that is returned.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (value - origin[known]) / rays[:, known]
        points = origin[wanted] + t * rays[:, wanted]
        return points[np.isfinite(points) & (t > 0)]

    sides = d[axes == 1]
    fronts, uprights = d[axes == 0], d[axes == 2]
    if coordinate == 2:
        parts = [crossing(fronts, 2, 0.0, 1), crossing(fronts, 2, top, 1)]
        parts += [crossing(uprights, 0, x0, 1), crossing(uprights, 0, x1, 1)]
    elif coordinate == 3:
        parts = [crossing(fronts, 1, y1, 2), crossing(sides, 0, x0, 2), crossing(sides, 0, x1, 2)]
    else:
        values = np.concatenate([crossing(sides, 2, 0.0, 0), crossing(sides, 2, top, 0), crossing(uprights, 1, y1, 0)])
        parts = [values[values < origin[0]] if coordinate == 0 else values[values > origin[0]]]
    return np.concatenate(parts)
