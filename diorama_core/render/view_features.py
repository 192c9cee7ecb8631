"""What one picture of an object looks like, as a few hundred numbers: outline, inner edges and colours, and where on
the object the colours are.

The same numbers are made of a crop of a photo and of the views of a shape, so that their dot product says how alike
the two are; no networks are needed. Outline: share of a coarse grid's cells that the object covers, in a square around
it. Inner edges: histograms of gradient directions (Dalal and Triggs, 2005) in coarse cells, without the outline itself;
they tell a chest of drawers from a wardrobe. Colours: main colours, softly assigned to reference colours.

Main colours alone cannot tell a dark screen in a white frame from a white screen in a dark one. The light of a photo is
not known, so how bright the whole is says nothing, and how bright its parts are says half as much as their hue.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Int, Int32, UInt8

from diorama_core.geometry.palettes import Palette
from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.render.templates import Templates

_CELLS = 12
_EDGE_CELLS = 5
_DIRECTIONS = 6
_SIDE = 60
"""Pixels of the square in which edges are measured: a multiple of `_CELLS` and `_EDGE_CELLS`."""
_MARGIN = 0.04
_BLUR, _BLUR_REACH = 0.4, 5
"""Pixels of the square by which a larger picture is smoothed first, and times so much that this takes in around one."""
_COLOUR_SPREAD = 22.0
_GRADIENT_FLOOR = 3.0
"""Gray levels a pixel below which a gradient is noise."""


@dataclass(frozen=True)
class FeatureWeights:
    """How much each part counts; they add up to 1, so that an object agrees with itself by 1."""

    outline: float = 0.55
    edges: float = 0.25
    colour: float = 0.2


WEIGHTS = FeatureWeights()
OUTLINE_WIDTH, EDGES_WIDTH = _CELLS**2, _EDGE_CELLS**2 * _DIRECTIONS
WIDTH = OUTLINE_WIDTH + EDGES_WIDTH + 27
"""Numbers in a feature."""


def view_feature(
    gray: UInt8[np.ndarray, "h w"], mask: Bool[np.ndarray, "h w"], colour: Float[np.ndarray, "c"]
) -> Float32[np.ndarray, "width"] | None:
    """The feature of one picture of an object.

    Args:
        gray: Its brightness.
        mask: Where it is.
        colour: `colour_feature` of its main colours.

    Returns:
        `WIDTH` numbers of unit length (shorter where colours are not known); None for an empty mask.
    """
    feature = outline_and_edges(gray, mask)
    if feature is None:
        return None
    parts = (
        np.sqrt(WEIGHTS.outline) * feature[0],
        np.sqrt(WEIGHTS.edges) * feature[1],
        np.sqrt(WEIGHTS.colour) * colour,
    )
    return np.concatenate(parts).astype(np.float32)


def outline_and_edges(
    gray: UInt8[np.ndarray, "h w"], mask: Bool[np.ndarray, "h w"]
) -> tuple[Float[np.ndarray, "outline"], Float[np.ndarray, "edges"]] | None:
    """The outline and the inner edges of one picture of an object, each of unit length; None for an empty mask."""
    box = _box(mask)
    if box is None:
        return None
    covered = _square(mask.astype(np.float32), box, cv2.BORDER_CONSTANT)
    brightness = _square(np.where(mask, gray, gray[mask].mean()).astype(np.float32), box, cv2.BORDER_REPLICATE)
    return _unit(_outline(covered)), _unit(_edges(brightness, covered))


def square_around(
    mask: Bool[np.ndarray, "h w"], picture: Float32[np.ndarray, "h w *c"]
) -> Float32[np.ndarray, "s s *c"] | None:
    """A picture in the small square around what a mask covers, 0 outside the picture; None for an empty mask."""
    box = _box(mask)
    return None if box is None else _square(picture, box, cv2.BORDER_CONSTANT)


def window_around(mask: Bool[np.ndarray, "h w"]) -> tuple[slice, slice] | None:
    """Rows and columns of all that the square around what a mask covers depends on; None for an empty mask."""
    box = _box(mask)
    return None if box is None else _window(box)


def _window(box: tuple[int, int, int, int]) -> tuple[slice, slice]:
    x1, y1, x2, y2 = box
    half = (0.5 + _MARGIN) * max(x2 - x1, y2 - y1)
    reach = half * (1 + _BLUR_REACH * 2 * _BLUR / _SIDE) + 2
    columns, rows = (slice(max(0, int(c - reach)), int(c + reach) + 1) for c in ((x1 + x2) / 2, (y1 + y2) / 2))
    return rows, columns


def _box(mask: Bool[np.ndarray, "h w"]) -> tuple[int, int, int, int] | None:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return (int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1) if len(rows) else None


def colour_feature(palette: Palette) -> Float[np.ndarray, "c"]:
    """Square roots of the shares of a palette near each reference colour: unit length, or zeros when none is known."""
    if not len(palette.share):
        return np.zeros(len(_reference_colours()))
    scale = np.array([0.5, 1.0, 1.0])  # the light is not known, so lightness counts half, as in `palette_agreement`
    apart = ((palette.lab[:, None] - _reference_colours()) * scale) ** 2
    near = np.exp(-apart.sum(axis=-1) / (2 * _COLOUR_SPREAD**2)) + 1e-9
    shares = (palette.share[:, None] * near / near.sum(axis=1, keepdims=True)).sum(axis=0)
    return np.sqrt(shares / shares.sum())


def _square(
    picture: Float32[np.ndarray, "h w *c"], box: tuple[int, int, int, int], border: int
) -> Float32[np.ndarray, "s s *c"]:
    """The square around a box, with a margin, resized; `border` tells what lies outside the picture."""
    x1, y1, x2, y2 = box
    half = (0.5 + _MARGIN) * max(x2 - x1, y2 - y1)
    scale = _SIDE / (2 * half)
    to_square = np.array([[scale, 0, _SIDE / 2 - scale * (x1 + x2) / 2], [0, scale, _SIDE / 2 - scale * (y1 + y2) / 2]])
    if scale < 1:  # smooth first, so that thin parts do not fall between the samples
        window, whole = _window(box), picture
        picture = np.zeros(whole.shape, np.float32)
        picture[window] = cv2.GaussianBlur(whole[window], (0, 0), _BLUR / scale)
    return cv2.warpAffine(picture, to_square, (_SIDE, _SIDE), flags=cv2.INTER_LINEAR, borderMode=border)


def _outline(covered: Float32[np.ndarray, "s s"]) -> Float[np.ndarray, "n"]:
    cells = cv2.resize(covered, (_CELLS, _CELLS), interpolation=cv2.INTER_AREA).ravel()
    return cells - 0.35  # empty cells speak too


def _edges(brightness: Float32[np.ndarray, "s s"], covered: Float32[np.ndarray, "s s"]) -> Float[np.ndarray, "n"]:
    """Gradient directions (a line's both sides alike) by cell, square roots of their magnitudes."""
    smooth = cv2.GaussianBlur(brightness, (0, 0), 0.8)
    dx, dy = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=0.25), cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=0.25)
    inside = cv2.erode(covered, np.ones((3, 3), np.uint8)) > 0.9
    size = np.maximum(np.hypot(dx, dy) - _GRADIENT_FLOOR, 0) * inside
    used = np.flatnonzero(size)
    angle = np.arctan2(dy.ravel()[used], dx.ravel()[used]) % np.pi * (_DIRECTIONS / np.pi)
    low = np.floor(angle).astype(int)
    share, weight, cell = angle - low, size.ravel()[used], _edge_cell()[used] * _DIRECTIONS
    histogram = np.bincount(cell + low % _DIRECTIONS, weight * (1 - share), _EDGE_CELLS**2 * _DIRECTIONS)
    histogram += np.bincount(cell + (low + 1) % _DIRECTIONS, weight * share, _EDGE_CELLS**2 * _DIRECTIONS)
    return np.sqrt(histogram)


@cache
def _edge_cell() -> Int[np.ndarray, "p"]:
    """The cell of every pixel of the square."""
    part = np.arange(_SIDE) * _EDGE_CELLS // _SIDE
    return (part[:, None] * _EDGE_CELLS + part).ravel()


def _unit(values: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
    length = np.linalg.norm(values)
    return values / length if length > 1e-9 else values


@cache
def _reference_colours() -> Float[np.ndarray, "27 3"]:
    """CIE Lab of a coarse grid of sRGB colours."""
    levels = np.array([0.12, 0.45, 0.85], np.float32)
    rgb = np.stack(np.meshgrid(levels, levels, levels), axis=-1).reshape(1, 27, 3)
    return cv2.cvtColor(rgb, cv2.COLOR_RGB2Lab)[0].astype(np.float64)


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
    square = square_around(mask, picture)
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


def paint_views(
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
