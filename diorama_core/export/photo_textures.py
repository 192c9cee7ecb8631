"""The size of a file's pictures: those that objects have from the photo are bounded together."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import UInt8

from diorama_core.scene.types import Scene

MAX_PHOTO_TEXTURES_PX = 4096

Pictures = Mapping[str, UInt8[np.ndarray, "_ _ _"]]


def bounded_pictures(scene: Scene, pictures: Pictures, side_px: int) -> Pictures:
    """The pictures, those of the objects' materials reduced by one factor so that they fit a square of that side.

    Args:
        scene: Whose objects name them.
        pictures: By name; those of planes stay as they are.
        side_px: Side of the square that would hold the same number of texels.
    """
    names = {m.texture for o in scene.objects for m in o.shown_photo_materials if m.texture in pictures}
    texels = sum(pictures[n].shape[0] * pictures[n].shape[1] for n in names if n is not None)
    if texels <= side_px**2:
        return pictures
    factor = side_px / float(np.sqrt(texels))
    return {name: _scaled(p, factor) if name in names else p for name, p in pictures.items()}


def _scaled(picture: UInt8[np.ndarray, "h w c"], factor: float) -> UInt8[np.ndarray, "h2 w2 c"]:
    import cv2  # the editor opens without it

    width, height = (max(1, int(n * factor)) for n in (picture.shape[1], picture.shape[0]))
    return np.asarray(cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA))
