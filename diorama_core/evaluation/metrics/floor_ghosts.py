"""Ghosts: what is smeared over the floor's picture that nobody marked.

Ghosts are the share of the floor's picture that differs from the floor's colour by more than `GHOST_DIFFERENCE`
(CIEDE2000): smears are dark, so lightness counts in full. They are measured twice: of the floor as it is built, and of
floors made while every second object that stands on the floor is kept back, one half after the other, against the
colour that the floor has when nothing is.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.architecture.texture.colours import coloured
from diorama_core.architecture.texture.plane_textures import plane_textures
from diorama_core.artefacts import DetectedObject
from diorama_core.evaluation.metrics.colour import delta_e_2000, lab_of
from diorama_core.pipeline.run import Built

GHOST_DIFFERENCE = 10.0
_TEXELS = 40_000
"""Texels of the floor's picture that are looked at, evenly spread."""


def floor_ghosts(built: Built) -> float | None:
    """Share of the floor's picture that is not of its colour; None where it has no picture."""
    floor = built.scene.architecture.floor
    picture = None if floor is None else built.textures.get(floor.id)
    return None if picture is None else ghost_share(picture, usual_colour(picture))


def ghosts_unmarked(built: Built) -> float | None:
    """Share of the floor's picture that is not of its colour when half of what stands on it was not marked.

    Mean over both halves; None where nothing stands on the floor. A floor without a picture is of its plain colour.
    """
    room = built.architecture
    floor = room.architecture.floor
    if floor is None:
        return None
    standing = [edge.child for edge in room.supports if edge.parent == floor.id]
    known = built.textures.get(floor.id)
    colour = np.array(floor.colour) if known is None else usual_colour(known)
    marked = [tuple(o for o in built.objects if o.id not in standing[k::2]) for k in (0, 1)]
    pictures = [_floor_picture(built, objects, frozenset(standing)) for objects in marked if len(standing) > 1]
    return float(np.mean([ghost_share(picture, colour) for picture in pictures])) if pictures else None


def _floor_picture(
    built: Built, objects: tuple[DetectedObject, ...], standing: frozenset[str]
) -> UInt8[np.ndarray, "_ _ 3"]:
    room, camera = built.architecture.architecture, built.geometry.camera
    photo = replace(built.inputs.photo, rgb=built.illuminant.balanced(built.inputs.photo.rgb))
    inputs = replace(built.inputs, photo=photo)
    room = replace(room, planes=coloured(room.planes, inputs.photo.rgb, camera, objects))
    assert room.floor is not None
    plain = np.rint(255 * np.array(room.floor.colour)).astype(np.uint8)[None, None]
    alone = {room.floor.id}
    return plane_textures(inputs, objects, camera, room, standing=standing, only=alone).get(room.floor.id, plain)


def usual_colour(picture: UInt8[np.ndarray, "h w 3"]) -> Float[np.ndarray, "3"]:
    """Median colour, sRGB 0 to 1."""
    return np.asarray(np.median(_spread(picture), axis=0))


def ghost_share(picture: UInt8[np.ndarray, "h w 3"], colour: Float[np.ndarray, "3"]) -> float:
    """Share of a picture that differs from a colour (sRGB 0 to 1) by more than `GHOST_DIFFERENCE`."""
    pixels = lab_of(_spread(picture))
    wanted = np.broadcast_to(lab_of(colour[None]), pixels.shape)
    return float((delta_e_2000(pixels, wanted) > GHOST_DIFFERENCE).mean())


def _spread(picture: UInt8[np.ndarray, "h w 3"]) -> Float[np.ndarray, "n 3"]:
    """At most about `_TEXELS` pixels, evenly spread, 0 to 1."""
    return np.asarray(picture.reshape(-1, 3)[:: max(picture.shape[0] * picture.shape[1] // _TEXELS, 1)] / 255.0)
