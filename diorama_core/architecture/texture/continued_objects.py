"""What of an object goes on where it was not marked: it is no more wall or floor than the rest of the object.

A box that is drawn too small, or around a part, leaves a plant's upper half in the wall's picture. What is not of the
wall's own colour, has about a colour of the object, and is joined to where the object hides the wall, is the object's.
A poster behind it stays, unless it has the object's colours. Within a box, an even patch that a doubtful mask cuts in
two where the picture has no edge (a white duvet) is the object's too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.artefacts import Box, DetectedObject
from diorama_core.geometry.vectors import alike, cells_of
from diorama_core.scene.values import ArrayValue

_CELL_LAB = np.array([14.0, 8.0, 8.0])
_SHADE = np.array([0.5, 1.0, 1.0])
"""Weights of CIELAB's axes: light and shade vary on one thing."""


_EVEN_LAB = np.array([8.0, 5.0, 5.0])


@dataclass(frozen=True)
class ContinuedObjectSettings:
    """How far an object is followed beyond its mask."""

    min_cell_share: float = 0.03
    """Share of an object's pixels: rarer colours are of what shines through it or stands beside it."""
    min_pixels: int = 100
    alike_lab: float = 16.0
    """So near a colour of the object is alike."""
    black_l: float = 16.0
    shade_ab: float = 9.0
    darkest_shade: float = 0.4
    """Darkening moves colours toward L = -16, a = b = 0 by CIELAB's definition; how near that line, and how far along
    it, the wall's own colour is found in light and shade."""
    larger: float = 1.5
    as_broad: float = 0.3
    large: float = 0.1
    """Bounds of a piece, in sides of the object's box, and of the joint, in sides of the piece."""
    reach: float = 0.03
    """How far beyond an object's box the wall is hidden for its sake at most, as a share of the photo's longer side."""
    gap_m: float = 0.06
    rim_m: float = 0.06
    """Gaps between leaves that do not part a piece, and shadows and rims around it."""
    main_share: float = 0.25
    """Share of an object's pixels that have a colour whose patches are looked at."""
    cut_share: float = 0.3
    """Share of a patch of even colour that a mask holds when it has cut it in two."""


SETTINGS = ContinuedObjectSettings()


@dataclass(frozen=True, eq=False)
class ObjectColours(ArrayValue):
    """One object's box and the colours that cover most of it."""

    box: Box
    lab: Float32[np.ndarray, "k 3"]


def cut_patches(rgb: UInt8[np.ndarray, "h w 3"], objects: Sequence[DetectedObject]) -> Bool[np.ndarray, "h w"]:
    """Pixels in the boxes of objects that belong to even patches of which the masks hold a part."""
    patches = np.zeros(rgb.shape[:2], dtype=bool)
    for item in objects:
        x1, y1, x2, y2 = (max(round(v), 0) for v in item.box)
        mask = item.mask[y1:y2, x1:x2]
        if np.count_nonzero(mask) < SETTINGS.min_pixels:
            continue
        lab = cv2.cvtColor(rgb[y1:y2, x1:x2].astype(np.float32) / np.float32(255.0), cv2.COLOR_RGB2LAB)
        for colour in _common_colours(lab[mask], SETTINGS.main_share):
            even = alike(lab, colour, _EVEN_LAB).astype(np.uint8)
            count, label = cv2.connectedComponents(even)
            mask_share = np.bincount(label[mask], minlength=count) / np.maximum(
                np.bincount(label.ravel(), minlength=count), 1
            )
            mask_share[0] = 0.0
            patches[y1:y2, x1:x2] |= (mask_share > SETTINGS.cut_share)[label] & ~mask
    return cv2.morphologyEx(patches.astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8)).astype(bool)


def object_colours(rgb: UInt8[np.ndarray, "h w 3"], objects: Sequence[DetectedObject]) -> tuple[ObjectColours, ...]:
    """Common colours of all objects that enough is seen of."""
    colours = []
    for item in objects:
        pixels = rgb[item.mask]
        if len(pixels) >= SETTINGS.min_pixels:
            colours.append(ObjectColours(item.box, _common_colours(_lab(pixels), SETTINGS.min_cell_share)))
    return tuple(colours)


def find_continued_objects(
    colours: Float32[np.ndarray, "h w 3"],
    is_plane: Bool[np.ndarray, "h w"],
    foreign: Bool[np.ndarray, "h w"],
    pixels: Float[np.ndarray, "n 2"],
    objects: Sequence[ObjectColours],
    pixel_m: float,
    longest_px: int,
) -> Bool[np.ndarray, "h w"]:
    """Texels of a wall that show more of objects than their boxes hold.

    Args:
        colours: of the wall's texels, 0 to 255.
        is_plane: those seen that are of the wall's own colour.
        foreign: those seen that are not.
        pixels: where the photo shows the foreign ones, in the order of `np.nonzero`.
        objects: what hides the wall.
        pixel_m: size of a texel.
        longest_px: the photo's longer side.
    """
    rows, columns = np.nonzero(foreign)
    continued = np.zeros(foreign.shape, np.uint8)
    if not len(rows) or not is_plane.any():
        return continued.astype(bool)
    lab = _lab(colours[rows, columns])
    lit = _is_shade(lab, _lab(np.median(colours[is_plane], axis=0)[None])[0])
    reach = SETTINGS.reach * longest_px
    for item in objects:
        x1, y1, x2, y2 = item.box
        low, high = np.array([x1, y1]) - reach, np.array([x2, y2]) + reach
        beside = np.asarray(((pixels >= low) & (pixels <= high)).all(axis=1))
        if not beside.any() or not len(item.lab):
            continue
        alike = np.flatnonzero((_distance(lab, item.lab) < SETTINGS.alike_lab) & ~lit)
        pieces = np.zeros(foreign.shape, np.uint8)
        pieces[rows[alike], columns[alike]] = 1
        joined = cv2.morphologyEx(pieces, cv2.MORPH_CLOSE, _square(SETTINGS.gap_m, pixel_m))
        label = cv2.connectedComponents(joined, connectivity=8)[1][rows[alike], columns[alike]]
        for piece in np.unique(label[beside[alike]]):
            of_piece = alike[label == piece]
            if _continues(pixels[of_piece], beside[of_piece], item.box):
                continued[rows[of_piece], columns[of_piece]] = 1
    return cv2.dilate(continued, _square(SETTINGS.rim_m, pixel_m)).astype(bool)


def _continues(pixels: Float[np.ndarray, "n 2"], beside: Bool[np.ndarray, "n"], box: Box) -> bool:
    """Whether a piece is not much larger than an object's box, and as broad there as elsewhere."""
    extent, joint = np.ptp(pixels, axis=0), np.ptp(pixels[beside], axis=0)
    size = np.array([box[2] - box[0], box[3] - box[1]])
    return bool(
        (extent <= SETTINGS.larger * size).all()
        and (joint >= SETTINGS.as_broad * extent).any()
        and extent.max() >= SETTINGS.large * size.max()
    )


def _is_shade(lab: Float32[np.ndarray, "n 3"], of: Float32[np.ndarray, "3"]) -> Bool[np.ndarray, "n"]:
    """Which colours are of the wall's own in other light, which moves them toward and away from black."""
    scale = (lab[:, :1] + SETTINGS.black_l) / (of[0] + SETTINGS.black_l)
    off = np.abs(lab[:, 1:] - scale * of[1:])
    return np.asarray((off < SETTINGS.shade_ab).all(axis=1) & (lab[:, 0] > SETTINGS.darkest_shade * of[0]))


def _common_colours(lab: Float32[np.ndarray, "n 3"], share: float) -> Float32[np.ndarray, "k 3"]:
    """Medians of the cells of colour that hold at least a share of some pixels."""
    label, count = cells_of(np.round(lab / _CELL_LAB))
    common = np.flatnonzero(count >= share * len(lab))
    medians = [np.median(lab[label == k], axis=0) for k in common]
    return np.array(medians, dtype=np.float32).reshape(-1, 3)


def _lab(rgb: np.ndarray) -> Float32[np.ndarray, "n 3"]:
    """CIELAB of colours, 0 to 255."""
    return cv2.cvtColor(rgb[:, None].astype(np.float32) / np.float32(255.0), cv2.COLOR_RGB2LAB)[:, 0]


def _distance(lab: Float32[np.ndarray, "n 3"], of: Float32[np.ndarray, "k 3"]) -> Float[np.ndarray, "n"]:
    """To the nearest of some colours; lightness counts half."""
    nearest = np.full(len(lab), np.inf)
    for colour in of:
        nearest = np.minimum(nearest, np.square((lab - colour) * _SHADE).sum(axis=1))
    return np.asarray(np.sqrt(nearest))


def _square(half_m: float, pixel_m: float) -> UInt8[np.ndarray, "k k"]:
    return np.ones((2 * max(1, round(half_m / pixel_m)) + 1,) * 2, np.uint8)
