"""Where on an object its colours are: a coarse grid over one picture of it, compared whatever the light.

Main colours alone cannot tell a dark screen in a white frame from a white screen in a dark one. The light of a photo is
not known, so how bright the whole is says nothing, and how bright its parts are says half as much as their hue.
"""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Int32, UInt8

from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.render.templates import Templates
from diorama_core.render.view_features import squared_around, window_around

CELLS = 6
LAYOUT_WIDTH = CELLS**2 * 4
"""Numbers in a layout: CIE Lab of every cell, and how much of it the object covers."""
_LIGHTNESS_WEIGHT = 0.5
_TOLERANCE = 18.0
_MIN_SHARED = 0.5
"""Cells that both pictures must cover; with less nothing is known."""
_NOTHING_KNOWN = 0.5
_MIDDLE_LIGHT = 0.7
"""The shade of templates at which a surface shows its own colour."""
_COLOURLESS = 140


def colour_layout(rgb: UInt8[np.ndarray, "h w 3"], mask: Bool[np.ndarray, "h w"]) -> Float32[np.ndarray, "width"]:
    """The mean colour of what the mask covers, cell by cell, in a square around it; zeros for an empty mask."""
    window = window_around(mask)
    if window is None:
        return np.zeros(LAYOUT_WIDTH, np.float32)
    lab = cv2.cvtColor(rgb[window].astype(np.float32) / 255.0, cv2.COLOR_RGB2Lab)
    picture = np.zeros((*mask.shape, 4), np.float32)
    picture[window] = np.where(mask[window][..., None], np.dstack([lab, np.ones_like(lab[..., 0])]), 0)
    square = squared_around(mask, picture)
    assert square is not None
    cells = cv2.resize(square, (CELLS, CELLS), interpolation=cv2.INTER_AREA).reshape(-1, 4)
    cells[:, :3] /= np.maximum(cells[:, 3:], 1e-3)
    return cells.ravel()


def layout_agreement(seen: Float[np.ndarray, "width"], views: Float[np.ndarray, "*v width"]) -> Float[np.ndarray, "*v"]:
    """0 to 1: how near the colours of cells are that both cover; brightness is compared within each picture only."""
    a, b = seen.reshape(-1, 4).astype(np.float64), views.reshape(*views.shape[:-1], -1, 4).astype(np.float64)
    shared = np.minimum(a[:, 3], b[..., 3])
    total = np.maximum(shared.sum(axis=-1), 1e-9)
    difference = a[:, :3] - b[..., :3]
    brighter = (difference[..., 0] * shared).sum(axis=-1) / total
    difference[..., 0] = _LIGHTNESS_WEIGHT * (difference[..., 0] - brighter[..., None])
    apart = (np.linalg.norm(difference, axis=-1) * shared).sum(axis=-1) / total
    return np.where(total >= _MIN_SHARED, np.exp(-apart / _TOLERANCE), _NOTHING_KNOWN)


def painted_views(
    templates: Templates, face_ids: Int32[np.ndarray, "v h w"], appearance: ShapeAppearance
) -> UInt8[np.ndarray, "v h w 3"]:
    """Templates in the shape's own colours, in the light of the templates; gray where it has none, black around it."""
    known = appearance.face_rgba[:, 3:] > 0
    linear = (np.where(known, appearance.face_rgba[:, :3], _COLOURLESS).astype(np.float32) / 255.0) ** 2.2
    seen = face_ids >= 0
    lit = linear[face_ids[seen]] * (templates.gray[seen].astype(np.float32) / (255.0 * _MIDDLE_LIGHT))[:, None]
    rgb = np.zeros((*seen.shape, 3), np.uint8)
    rgb[seen] = np.rint(255.0 * np.minimum(lit, 1.0) ** (1 / 2.2))
    return rgb
