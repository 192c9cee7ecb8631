"""The light from all sides of a room as an environment map: a file of its own, and what USD stages are lit by."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

from diorama_core.errors import ExportError
from diorama_core.export.files import write_whole
from diorama_core.export.gathering import ExportScene
from diorama_core.export.lights import MAIN_LUX
from diorama_core.io.srgb import linear_to_srgb
from diorama_core.progress import Progress
from diorama_core.render.lighting import MEAN_IRRADIANCE
from diorama_core.render.panorama import panorama

NITS = MAIN_LUX / (2.0 * MEAN_IRRADIANCE) / np.pi
"""Luminance of a map's radiance 1, in the units of the main light."""
BRIGHTEST = 0.999
"""Share of a map's texels that a picture of 8 bits holds unclipped: lamps and windows are lights of their own."""


def environment_of(gathered: ExportScene, progress: Progress | None = None) -> Float32[np.ndarray, "h w 3"]:
    """Linear radiance that comes to the middle of the room (`render.panorama`), in the colour of its light.

    Raises:
        Cancelled: when asked to stop.
    """
    return panorama(gathered.scene, gathered.library, textures=gathered.textures, progress=progress)


def write_hdr(gathered: ExportScene, path: Path, progress: Progress | None = None) -> None:
    """Write a Radiance picture, whole or not at all.

    Raises:
        ExportError: when it cannot be written.
        Cancelled: when asked to stop; what was there stays.
    """
    radiance = environment_of(gathered, progress)
    good, content = cv2.imencode(".hdr", np.ascontiguousarray(radiance[..., ::-1]))
    if not good:
        raise ExportError(f"cannot write {path}: the picture could not be encoded")
    write_whole(Path(path), content.tobytes())


def as_picture(radiance: Float32[np.ndarray, "h w 3"]) -> tuple[UInt8[np.ndarray, "h w 3"], float]:
    """A map as a picture of 8 bits (sRGB), and the radiance that its brightest value stands for."""
    brightest = max(float(np.quantile(radiance.max(axis=-1), BRIGHTEST)), 1e-6)
    shown = linear_to_srgb(np.clip(radiance.astype(np.float64) / brightest, 0.0, 1.0))
    return np.rint(255.0 * shown).astype(np.uint8), brightest
