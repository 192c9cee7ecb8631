"""Pictures of single objects that people bring to a search: what of the picture is the object."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Bool, UInt8
from PIL import Image, ImageOps

from diorama_core.errors import InputError
from diorama_core.scene.values import ArrayValue

_MAX_PIXELS = 16_000_000
CROP_FORMATS = ("JPEG", "PNG", "WEBP", "GIF", "BMP", "TIFF", "AVIF")
_WORKING_SIDE = 320
_RIM = 0.02
_PLAUSIBLE_SHARE = (0.08, 0.97)
"""Shares of the picture that an object fills, when the background was told from it."""
_WHOLE = "{name}: the object could not be separated from its background; a cut-out on a transparent one finds better"


@dataclass(frozen=True, eq=False)
class ShapeCrop(ArrayValue):
    """A picture of one thing."""

    rgb: UInt8[np.ndarray, "h w 3"]
    mask: Bool[np.ndarray, "h w"]
    """Where the object is."""
    note: str = ""
    """For the user, when the object could not be told from its background."""

    @property
    def gray(self) -> UInt8[np.ndarray, "h w"]:
        """Brightness."""
        return cv2.cvtColor(self.rgb, cv2.COLOR_RGB2GRAY)


def read_crop(path: Path) -> ShapeCrop:
    """A picture file of one thing, at a working size.

    A transparent background is taken as it is; else what looks like the rim of the picture is taken for background
    (GrabCut: Rother et al., 2004), and the whole picture for the object where that finds nothing plausible.

    Raises:
        InputError: when the file is no picture, is too large, or shows nothing.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            with Image.open(path, formats=CROP_FORMATS) as opened:
                if opened.width * opened.height > _MAX_PIXELS:
                    raise InputError(f"{path} has {opened.width} x {opened.height} pixels; give a crop of one object")
                rgba = ImageOps.exif_transpose(opened).convert("RGBA")
    except InputError:
        raise
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise InputError(f"{path} cannot be read as a picture ({error}); give a PNG or JPEG of one object") from error
    rgba.thumbnail((_WORKING_SIDE, _WORKING_SIDE))
    pixels = np.asarray(rgba)
    rgb, alpha = np.ascontiguousarray(pixels[..., :3]), pixels[..., 3]
    if (alpha < 255).any():
        mask, note = alpha > 127, ""
    else:
        mask = foreground(rgb)
        note = _WHOLE.format(name=path.name) if mask.all() else ""
    if not mask.any():
        raise InputError(f"{path} is wholly transparent; give a picture of one object")
    return ShapeCrop(rgb, mask, note)


def foreground(rgb: UInt8[np.ndarray, "h w 3"]) -> Bool[np.ndarray, "h w"]:
    """Where the object is in a picture that frames it; everywhere when that cannot be told."""
    height, width = rgb.shape[:2]
    everywhere = np.ones((height, width), bool)
    rim = max(1, round(_RIM * max(height, width)))
    if min(height, width) < 4 * rim or rgb.std() < 2:
        return everywhere
    labels = np.zeros((height, width), np.uint8)
    cv2.setRNGSeed(0)
    frame = (rim, rim, width - 2 * rim, height - 2 * rim)
    try:
        cv2.grabCut(
            rgb[..., ::-1].copy(), labels, frame, np.zeros((1, 65)), np.zeros((1, 65)), 4, cv2.GC_INIT_WITH_RECT
        )
    except cv2.error:  # too few colours to model
        return everywhere
    mask = (labels & 1).astype(np.uint8)
    mask = cv2.morphologyEx(mask, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8)) > 0
    least, most = _PLAUSIBLE_SHARE
    return mask if least <= mask.mean() <= most else everywhere
