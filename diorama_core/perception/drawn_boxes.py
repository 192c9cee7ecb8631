"""Where objects end whose boxes were drawn roughly, by a person or a detector.

The outliner sees a margin around every box, so it tells where an object ends beyond a box that was drawn too small.
How steeply its probability falls there says how exactly it knows. How carefully the boxes of a photo were drawn is the
deviation that makes all their edges likeliest; edges then lie between drawing and outline, weighted by precision. Boxes
that were drawn exactly stay.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32

from diorama_core.artefacts import Box, LabelledBox
from diorama_core.geometry.projection import box_iou
from diorama_core.models.outliner import MARGIN, SIDE
from diorama_core.perception.metrology.settings import SETTINGS as METROLOGY

LEVELS = (0.3, 0.5, 0.7)
"""Probabilities where a fall begins, where the object ends, and where it is over: the error of an edge is about as
large as the fall is wide (1,940 edges of 37 photos, drawn with errors of 0 to 8 % of the box)."""


@dataclass(frozen=True)
class DrawnBoxSettings:
    """How outlines and drawing are weighed."""

    least_error: float = 0.012
    """Standard deviation of the surest edge, as a share of the box's side; from .01 to .015 all is the same within .006
    of the boxes' overlap."""
    freedom: float = 4.0
    """Degrees of freedom of the errors (Student's t): some outlines are of something else."""
    drawing_errors: tuple[float, ...] = (0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08, 0.1)
    """Standard deviations that are compared of how a photo's boxes were drawn, as shares of their sides."""
    least_edges: int = 12
    """Fewer do not tell how carefully they were drawn: a box that is drawn alone is taken as it is."""
    border_share: float = METROLOGY.observed.border_share
    """An edge so near to the border of the photo, as a share of its longer side, is that border."""
    deviations: float = 2.0
    """What the outline shows to be cut by the border, and was drawn to end at most so many before it, is cut there."""


SETTINGS = DrawnBoxSettings()


def ends_of_objects(
    boxes: Sequence[Box],
    windows: Sequence[Float32[np.ndarray, "s s"]],
    photo_shape: tuple[int, int],
    settings: DrawnBoxSettings = SETTINGS,
) -> list[Box]:
    """The boxes of a photo with their edges where drawing and outlines together put them.

    Args:
        boxes: as drawn, in photo pixels.
        windows: for each box how likely each cell of its window is the object's (`BoxOutliner.windows`).
        photo_shape: rows and columns.
        settings: how they are weighed.
    """
    drawn, border = np.array(boxes, dtype=float).reshape(-1, 4), np.array([0, 0, *photo_shape[::-1]], dtype=float)
    sides, near = np.tile(np.maximum(drawn[:, 2:] - drawn[:, :2], 1.0), 2), settings.border_share * max(photo_shape)
    edges = np.array([_edges(window) for window in windows]).reshape(-1, 2, 4)
    off, error = edges[:, 0], np.hypot(settings.least_error, edges[:, 1])
    free = np.isfinite(off + error) & (np.abs(drawn - border) > near)
    if free.sum() < settings.least_edges:
        return list(boxes)
    drawing_variances, freedom = np.array(settings.drawing_errors) ** 2, settings.freedom
    variance = drawing_variances[:, None] + error[free] ** 2
    likelihood = -np.log(variance) / 2 - (freedom + 1) / 2 * np.log1p(off[free] ** 2 / variance / freedom)
    drawing = drawing_variances[np.argmax(likelihood.sum(axis=1))]
    off, error = np.where(free, off, 0.0), np.where(free, error, 1.0)
    moved = drawn + drawing / (drawing + error**2) * off * sides
    rough_px = settings.deviations * np.sqrt(drawing) * sides
    cut = free & (np.abs(drawn + off * sides - border) <= near) & (np.abs(drawn - border) <= near + rough_px)
    ends = np.clip(np.where(cut, border, moved), 0.0, np.tile(border[2:], 2))
    return [(float(a), float(b), float(c), float(d)) for a, b, c, d in ends]


def _edges(window: Float32[np.ndarray, "s s"]) -> Float[np.ndarray, "2 4"]:
    """How far to the right of or below its edges (x1, y1, x2, y2) the object ends, and how wide the fall is there.

    In shares of the box's sides; NaN where nothing is likely the object's, or it goes on beyond the window.
    """
    begun, middle, over = (np.array([_crossings(window.max(axis=axis), v) for axis in (0, 1)]).T for v in LEVELS)
    return np.array([(middle - [[0.0], [1.0]]).ravel(), np.abs(over - begun).ravel()])


def _crossings(profile: Float32[np.ndarray, " s"], level: float) -> tuple[float, float]:
    """Where a profile first rises above a level and last falls below it, in shares of the box's side; NaN where not."""
    above = np.flatnonzero(profile > level)
    if not len(above):
        return np.nan, np.nan
    cells, (first, last) = np.pad(profile, 1, constant_values=np.nan), above[[0, -1]] + 1
    rise = first - (cells[first] - level) / (cells[first] - cells[first - 1])
    fall = last + (cells[last] - level) / (cells[last] - cells[last + 1])
    left, right = ((np.array([rise, fall]) - 0.5) / SIDE * (1 + 2 * MARGIN) - MARGIN).tolist()
    return left, right


def find_drawn_box(boxes: Sequence[LabelledBox], box: Box) -> LabelledBox | None:
    """The drawn box of an object that ends at `box`: the one that overlaps it most; None where none does."""
    if not boxes:
        return None
    shared = box_iou(np.array([b.box for b in boxes]), np.array(box))
    best = int(np.argmax(shared))
    return boxes[best] if shared[best] > 0.0 else None
