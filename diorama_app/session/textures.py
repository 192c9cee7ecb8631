"""Pictures on the room's planes when planes change."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import UInt8

from diorama_core.scene.types import Scene

Textures = Mapping[str, UInt8[np.ndarray, "_ _ 3"]]
"""Pictures by their file names."""


def refitted(before: Scene, after: Scene, textures: Textures) -> tuple[Scene, Textures]:
    """The edited scene with the pictures of resized planes cut and continued, not stretched, and the new pictures."""
    if not textures or after.architecture is before.architecture:
        return after, {}
    from diorama_core.architecture.texture.refit import refitted_textures  # OpenCV; opening a project does without it

    return refitted_textures(before, after, textures)
