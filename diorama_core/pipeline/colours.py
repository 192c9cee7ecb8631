"""The colour each object has, as the photo shows it without the colour of the room's light."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from diorama_core.appearance.light import SHINING
from diorama_core.appearance.sets import Colour, leaders
from diorama_core.architecture.texture.colours import GRID_PX, object_pixels, visible_planes
from diorama_core.artefacts import DetectedObject, Inputs
from diorama_core.library.taxonomy import LAMPS, SETS, having
from diorama_core.perception.illuminant import Illuminant, estimate_illuminant
from diorama_core.scene.types import Architecture, Camera

KEEP_THEIR_OWN = having("own_colours")
"""Categories whose look is not one colour of one main material."""


@dataclass(frozen=True)
class MainColourSettings:
    """When an object has a colour of its own, and how far the photo's is freed of the light's."""

    bin_lab: float = 20.0
    """Width of a bin of hue (CIELAB); of lightness, which shade changes, it is twice that."""
    min_pixels: int = 60
    adapted: float = 0.5
    """Share of a light's cast that is taken off: eyes that look at a photo adapt to it in part (CIECAM02's degree of
    adaptation), and a room that looks warm in the photo is to look warm."""
    min_share: float = 0.25
    """An object without a colour that covers this much of it is not painted."""


SETTINGS = MainColourSettings()


def room_illuminant(
    inputs: Inputs, objects: tuple[DetectedObject, ...], room: Architecture, camera: Camera
) -> Illuminant:
    """The light of a photo that its colours are freed of, by all its pixels and those of unhidden walls and ceiling.

    Args:
        inputs: as given.
        objects: what was found in the photo, with masks.
        room: planes.
        camera: the photo's.
    """
    shape = (inputs.photo.height, inputs.photo.width)
    step = max(1, max(shape) // GRID_PX)
    upper = np.array([plane.role != "floor" for plane in room.planes] + [False])  # the last one: no plane
    seen = upper[visible_planes(room.planes, camera, step)]
    walls = cv2.resize(seen.astype(np.uint8), shape[::-1], interpolation=cv2.INTER_NEAREST).astype(bool)
    return estimate_illuminant(inputs.photo.rgb, walls & ~object_pixels(shape, objects)).partly(SETTINGS.adapted)


def photo_colours(rgb: UInt8[np.ndarray, "h w 3"], objects: tuple[DetectedObject, ...]) -> dict[str, Colour]:
    """Main colour (sRGB 0 to 1) of every object that has a clear one; others are left out.

    Pixels near the mask's border and those of smaller objects in front are no evidence, and a lamp's light is no
    colour of its material.
    """
    kernel = np.ones((5, 5), np.uint8)
    by_area = sorted(objects, key=lambda o: o.pixels)
    colours: dict[str, Colour] = {}
    nearer = np.zeros(rgb.shape[:2], dtype=bool)
    for item in by_area:
        inner = cv2.erode(item.mask.astype(np.uint8), kernel).astype(bool) & ~nearer
        nearer |= item.mask
        if item.category in LAMPS:
            inner &= rgb.max(axis=2) < SHINING
        colour = None if item.category in KEEP_THEIR_OWN else _main_colour(rgb, inner)
        if colour is not None:
            colours[item.id] = colour
    return colours


def share_set_colours(
    colours: dict[str, Colour], objects: tuple[DetectedObject, ...], shape_of: Mapping[str, str]
) -> dict[str, Colour]:
    """Seats of one shape share the colours that agree.

    The member whose mask is surest speaks for all that are of about its colour, that are hardly seen, or that have no
    colour; of those that clearly differ, the surest speaks for the next ones.
    """
    sure = {o.id: (o.mask_confidence * float(np.sqrt(o.pixels)), o.id) for o in objects}
    sets: dict[tuple[str, str], list[str]] = {}
    for item in objects:
        if item.category in SETS and item.id in shape_of:
            sets.setdefault((item.category, shape_of[item.id]), []).append(item.id)
    shared = dict(colours)
    for members in sets.values():
        shared.update({m: colours[leader] for m, leader in leaders(members, colours, sure).items()})
    return shared


def _main_colour(rgb: UInt8[np.ndarray, "h w 3"], mask: Bool[np.ndarray, "h w"]) -> Colour | None:
    """Median of the fullest bin of a coarse Lab grid, and its neighbours'."""
    pixels = rgb[mask]
    if len(pixels) < SETTINGS.min_pixels:
        return None
    lab = cv2.cvtColor(pixels[None].astype(np.float32) / 255.0, cv2.COLOR_RGB2Lab)[0]
    # Shade varies over one surface, hue hardly: lightness gets wider bins. Grey lies in the middle of one.
    bins = 16  # more than there are along either axis of hue, which reach from -127 to 127
    widths = SETTINGS.bin_lab * np.array([2.0, 1.0, 1.0])
    light, green_red, blue_yellow = np.floor(lab / widths + (0.0, 0.5, 0.5)).astype(int).T
    cell = (light * bins + green_red + bins // 2) * bins + blue_yellow + bins // 2
    seed = np.median(lab[cell == int(np.argmax(np.bincount(cell)))], axis=0)
    near = np.linalg.norm((lab - seed) / (2.0, 1.0, 1.0), axis=1) < SETTINGS.bin_lab
    if near.mean() < SETTINGS.min_share:
        return None
    red, green, blue = (float(c) / 255.0 for c in np.median(pixels[near], axis=0))
    return (red, green, blue)
