"""Pictures on the room's planes when planes change."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import UInt8

from diorama_core.scene.types import Scene

Textures = Mapping[str, UInt8[np.ndarray, "_ _ 3"]]
"""Pictures by their file names."""


def refit(before: Scene, after: Scene, textures: Textures) -> tuple[Scene, Textures]:
    """The edited scene and its new pictures.

    Those of resized planes are cut and continued, not stretched; those of finishes are made."""
    if after.architecture is before.architecture:
        return after, {}
    # OpenCV; opening a project does without it
    from diorama_core.appearance.surface_finish import with_finish_pictures
    from diorama_core.architecture.texture.refit import refit_textures

    after, made = refit_textures(before, after, textures)
    after, finishes = with_finish_pictures(after, {**textures, **made})
    return after, {**made, **finishes}
