"""The size of a file's pictures: those that the scene has from the photo are bounded together.

They stay pictures of their own rather than parts of one atlas: floors, walls and most materials repeat their picture,
which a part of an atlas cannot, and the few that do not (paintings, screens, rugs) are a small share of the texels.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import UInt8

from diorama_core.scene.types import Scene

MAX_PHOTO_TEXTURES_PX = 4096

Pictures = Mapping[str, UInt8[np.ndarray, "_ _ _"]]


def fit_pictures(scene: Scene, pictures: Pictures, side_px: int) -> Pictures:
    """The pictures, those that the scene shows reduced so that one square of that side would hold all of them.

    No side of one is longer than the square's, and all are reduced by one factor where they have more texels together.

    Args:
        scene: Whose planes and objects name them.
        pictures: By name.
        side_px: Of the square.
    """
    names = {p.texture for p in scene.architecture.planes}
    names |= {m.texture for o in scene.objects for m in o.visible_materials}
    shown = {name: _scale(p, side_px / max(p.shape[:2])) for name, p in pictures.items() if name in names}
    texels = sum(p.shape[0] * p.shape[1] for p in shown.values())
    factor = side_px / max(float(np.sqrt(texels)), 1.0)
    return {**pictures, **{name: _scale(p, factor) for name, p in shown.items()}}


def _scale(picture: UInt8[np.ndarray, "h w c"], factor: float) -> UInt8[np.ndarray, "h2 w2 c"]:
    """The picture made smaller; as it is where the factor would make it larger."""
    if factor >= 1.0:
        return picture
    import cv2  # the editor opens without it

    width, height = (max(1, int(n * factor)) for n in (picture.shape[1], picture.shape[0]))
    return np.asarray(cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA))
