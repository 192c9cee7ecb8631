"""The colour each object has, as the photo shows it without the colour of the room's light."""

from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.architecture.texture.colours import GRID_PX, object_pixels, visible_planes
from diorama_core.artefacts import DetectedObject, Inputs
from diorama_core.library.taxonomy import with_kin
from diorama_core.perception.illuminant import Illuminant, estimate_illuminant
from diorama_core.scene.types import Architecture, Camera

KEEP_THEIR_OWN = frozenset({"picture", "mirror", "window", "plant", "books", "clock"})
"""Categories whose look is not one colour of one main material."""
SETS = with_kin("chair", "office chair", "stool")
"""Categories whose equal shapes in one room are a set."""
_BIN = 20.0
_BINS = 16
"""More than there are along either axis of hue, which reach from -127 to 127."""
_FEWEST_PIXELS = 60
_MIN_SHARE = 0.25
"""An object without a colour that covers this much of it is not painted."""

_AGREE = 18.0
"""Colours of a set this near each other (CIELAB, lightness at half weight) are one colour in other light."""
_OWN_VOICE = 0.4
"""A member sees well enough to differ from its set when it is seen this well beside the one that is seen best."""

Colour = tuple[float, float, float]


def room_illuminant(
    inputs: Inputs, objects: tuple[DetectedObject, ...], room: Architecture, camera: Camera
) -> Illuminant:
    """The light of a photo, by all its pixels and those of walls and ceiling that nothing hides."""
    shape = (inputs.photo.height, inputs.photo.width)
    step = max(1, max(shape) // GRID_PX)
    upper = np.array([plane.role != "floor" for plane in room.planes] + [False])  # the last one: no plane
    seen = upper[visible_planes(room.planes, camera, step)]
    walls = cv2.resize(seen.astype(np.uint8), shape[::-1], interpolation=cv2.INTER_NEAREST).astype(bool)
    return estimate_illuminant(inputs.photo.rgb, walls & ~object_pixels(shape, objects))


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
    """Seats of one shape share the colours that agree.

    The member whose mask is surest speaks for all that are of about its colour, that are hardly seen, or that have no
    colour; of those that clearly differ, the surest speaks for the next ones.
    """
    sure = {o.id: (o.mask_confidence * float(np.sqrt(o.mask.sum())), o.id) for o in objects}
    sets: dict[tuple[str, str], list[str]] = {}
    for item in objects:
        if item.category in SETS and item.id in shape_of:
            sets.setdefault((item.category, shape_of[item.id]), []).append(item.id)
    shared = dict(colours)
    for members in sets.values():
        order = sorted((m for m in members if m in colours), key=sure.__getitem__, reverse=True)
        leaders = order[:1]
        for member in order[1:]:
            alike = [leader for leader in leaders if _agree(colours[member], colours[leader])]
            if not alike and sure[member][0] >= _OWN_VOICE * sure[leaders[0]][0]:
                leaders.append(member)
                continue
            shared[member] = colours[(alike or leaders)[0]]
        if leaders:
            shared.update({m: colours[leaders[0]] for m in members if m not in colours})
    return shared


def _agree(one: Colour, other: Colour) -> bool:
    lab = cv2.cvtColor(np.array([[one, other]], np.float32), cv2.COLOR_RGB2Lab)[0]
    return float(np.linalg.norm((lab[0] - lab[1]) / (2.0, 1.0, 1.0))) < _AGREE


def _main_colour(rgb: UInt8[np.ndarray, "h w 3"], mask: Bool[np.ndarray, "h w"]) -> Colour | None:
    """Median of the fullest bin of a coarse Lab grid, and its neighbours'."""
    pixels = rgb[mask]
    if len(pixels) < _FEWEST_PIXELS:
        return None
    lab = cv2.cvtColor(pixels[None].astype(np.float32) / 255.0, cv2.COLOR_RGB2Lab)[0]
    # Shade varies over one surface, hue hardly: lightness gets wider bins.
    light, green_red, blue_yellow = np.floor(lab / (2 * _BIN, _BIN, _BIN)).astype(int).T
    bins = (light * _BINS + green_red + _BINS // 2) * _BINS + blue_yellow + _BINS // 2
    seed = np.median(lab[bins == int(np.argmax(np.bincount(bins)))], axis=0)
    near = np.linalg.norm((lab - seed) / (2.0, 1.0, 1.0), axis=1) < _BIN
    if near.mean() < _MIN_SHARE:
        return None
    red, green, blue = (float(c) / 255.0 for c in np.median(pixels[near], axis=0))
    return (red, green, blue)
