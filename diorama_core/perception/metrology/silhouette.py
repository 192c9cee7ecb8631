"""What masks add to boxes: how far an outline reaches into its box's four corners.

A cuboid that is seen at an angle leaves other corners of its box empty than one seen from the front, so the mask tells
headings apart that have the same box. A thing never reaches beyond its cuboid but need not fill it.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import DetectedObject
from diorama_core.library.taxonomy import having
from diorama_core.perception.metrology.problem import Cuboids, Problems, View, corners_camera
from diorama_core.perception.metrology.settings import SETTINGS, BoxObservationSettings

DIAGONALS: Float[np.ndarray, "4 2"] = np.array([[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]])
"""Toward the corners: top left, top right, bottom left, bottom right."""
CORNER_EDGES = ((0, 1), (2, 1), (0, 3), (2, 3))
"""The box edges (x1, y1, x2, y2) that meet in each corner."""
_SOLID = having("solid")
"""Categories whose things fill their cuboids."""


def mask_reach(item: DetectedObject, box: Float[np.ndarray, "4"]) -> Float[np.ndarray, "4"]:
    """How far the mask reaches along the diagonals, in half box sizes from the box's centre; NaN without a mask."""
    rows, columns = np.nonzero(_outline_rows(item.mask))
    if len(rows) < 8:
        return np.full(4, np.nan)
    ends = np.concatenate([np.column_stack([columns, rows]) + shift for shift in ([0, 0], [1, 0], [0, 1], [1, 1])])
    return _reach(_normalise(ends[None].astype(np.float64), box[None]))[0]


def corner_costs(
    problems: Problems,
    boxes: Cuboids,
    view: View,
    reach: Float[np.ndarray, "objects 4"],
    weight: Float[np.ndarray, "objects 4"],
    exact: Bool[np.ndarray, "objects"],
    names: tuple[str, ...],
    settings: BoxObservationSettings = SETTINGS.observed,
) -> Float[np.ndarray, "n"]:
    """What the masks say against every row's cuboid, in squared sigmas, bounded.

    Args:
        problems: The rows.
        boxes: Their cuboids.
        view: The camera.
        reach: `mask_reach` of every object.
        weight: Trust in every corner of every object, 0 where it is hidden or cut.
        exact: Whether the mask is the user's own.
        names: Category of every object.
    """
    camera = corners_camera(boxes, problems.camera_height_m, view)
    k = view.intrinsics
    depth = np.maximum(camera[..., 2:], 1e-3)
    pixels = camera[..., :2] / depth * [k.fx, k.fy] + [k.cx, k.cy]
    usable = (camera[..., 2] > 0.1).all(axis=1)
    item = problems.item.astype(int)
    excess = _reach(_normalise(pixels, problems.box_px)) - reach[item]
    solid = np.array([name in _SOLID for name in names])[item]
    empty_sigma = np.where(solid, settings.empty_sigma_solid, settings.empty_sigma)[:, None]
    beyond_sigma = np.where(exact[item], settings.beyond_sigma, settings.beyond_sigma_guessed)[:, None]
    sigmas = np.where(excess < 0, -excess / beyond_sigma, excess / empty_sigma)
    costs = np.minimum(np.nan_to_num(sigmas) ** 2, settings.max_outline_cost) * weight[item]
    return np.where(usable, np.minimum(costs.sum(axis=1), settings.max_outline_cost), weight[item].sum(axis=1))


def _normalise(pixels: Float[np.ndarray, "n p 2"], box: Float[np.ndarray, "n 4"]) -> Float[np.ndarray, "n p 2"]:
    centre, half = (box[:, :2] + box[:, 2:]) / 2, (box[:, 2:] - box[:, :2]) / 2
    return (pixels - centre[:, None]) / half[:, None]


def _reach(points: Float[np.ndarray, "n p 2"]) -> Float[np.ndarray, "n 4"]:
    return (points @ DIAGONALS.T).max(axis=1)


def _outline_rows(mask: Bool[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """Only the first and last pixel of every row: enough for any extreme."""
    outline = np.zeros_like(mask)
    filled = np.flatnonzero(mask.any(axis=1))
    outline[filled, mask[filled].argmax(axis=1)] = True
    outline[filled, mask.shape[1] - 1 - mask[filled, ::-1].argmax(axis=1)] = True
    return outline
