"""The colour each object has in the photo, so that the scene looks like the room it was made from."""

from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.artefacts import DetectedObject
from diorama_core.library.taxonomy import with_kin

KEEP_THEIR_OWN = frozenset(
    {
        *("picture", "mirror", "window", "plant", "books", "television"),
        *("monitor", "laptop", "clock", "toy", "keyboard", "rug"),
    }
)
"""Categories whose look is not one colour of one main material."""
SETS = with_kin("chair", "office chair", "stool")
"""Categories whose equal shapes in one room are a set."""
_BIN = 20.0
_FEWEST_PIXELS = 60
_MIN_SHARE = 0.25
"""An object without a colour that covers this much of it is not painted."""

Colour = tuple[float, float, float]


def photo_colours(rgb: UInt8[np.ndarray, "h w 3"], objects: tuple[DetectedObject, ...]) -> dict[str, Colour]:
    """Main colour (sRGB 0 to 1) of every object that has a clear one; others are left out.

    Pixels near the mask's border and those of smaller objects in front are no evidence.
    """
    kernel = np.ones((5, 5), np.uint8)
    by_area = sorted(objects, key=lambda o: int(o.mask.sum()))
    colours: dict[str, Colour] = {}
    nearer = np.zeros(rgb.shape[:2], dtype=bool)
    for item in by_area:
        inner = cv2.erode(item.mask.astype(np.uint8), kernel).astype(bool) & ~nearer
        nearer |= item.mask
        colour = None if item.category in KEEP_THEIR_OWN else _main_colour(rgb, inner)
        if colour is not None:
            colours[item.id] = colour
    return colours


def shared_by_sets(
    colours: dict[str, Colour], objects: tuple[DetectedObject, ...], shape_of: Mapping[str, str]
) -> dict[str, Colour]:
    """Seats of one shape get one colour: that of the one whose mask is surest, among those that have one."""
    sure = {o.id: (o.mask_confidence * float(np.sqrt(o.mask.sum())), o.id) for o in objects}
    sets: dict[tuple[str, str], list[str]] = {}
    for item in objects:
        if item.category in SETS and item.id in shape_of:
            sets.setdefault((item.category, shape_of[item.id]), []).append(item.id)
    shared = dict(colours)
    for members in sets.values():
        coloured = [m for m in members if m in colours]
        if coloured:
            colour = colours[max(coloured, key=sure.__getitem__)]
            shared.update(dict.fromkeys(members, colour))
    return shared


def _main_colour(rgb: UInt8[np.ndarray, "h w 3"], mask: Bool[np.ndarray, "h w"]) -> Colour | None:
    """Median of the fullest bin of a coarse Lab grid, and its neighbours'."""
    pixels = rgb[mask]
    if len(pixels) < _FEWEST_PIXELS:
        return None
    lab = cv2.cvtColor(pixels[None].astype(np.float32) / 255.0, cv2.COLOR_RGB2Lab)[0]
    # Shade varies over one surface, hue hardly: lightness gets wider bins.
    _, label, counts = np.unique(
        np.floor(lab / (2 * _BIN, _BIN, _BIN)), axis=0, return_inverse=True, return_counts=True
    )
    seed = np.median(lab[label.ravel() == int(np.argmax(counts))], axis=0)
    near = np.linalg.norm((lab - seed) / (2.0, 1.0, 1.0), axis=1) < _BIN
    if near.mean() < _MIN_SHARE:
        return None
    red, green, blue = (float(c) / 255.0 for c in np.median(pixels[near], axis=0))
    return (red, green, blue)
