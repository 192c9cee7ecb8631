"""Pictures that no lens projects: 360 degree photos and sweep panoramas, known by their headers or their shape."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from PIL import Image

from diorama_core.errors import InputError, SphericalPhotoError

SWEEP_ASPECT = 2.2
"""Longer than any single shot of a camera: phones crop to 16:9 (1.78), films to 2.4 with borders cut."""
CERTAIN_ASPECT = 3.0
"""From here on a picture is a panorama whoever made it."""
_SPHERE_ASPECT = (1.97, 2.03)
_CUSTOM_RENDERED, _PANORAMA = 0xA401, 6
_PROJECTION = re.compile(rb"ProjectionType[\s\"'=>]+([A-Za-z]+)")
SEAM_SHARE = 0.35
"""Largest difference of the first and last column of a panorama, as a share of that of unrelated columns."""
SEAM_STEPS = 3.0
"""Largest difference of the first and last column of a panorama, as a multiple of that of neighbouring columns."""
POLE_SHARE = 0.4
"""Largest variation of the first and last row, which show the poles, as a share of the middle rows'."""


def check_perspective(name: str, picture: Image.Image, exif: Mapping[int, Any], *, has_focal: bool) -> tuple[str, ...]:
    """A note where the picture may be a panorama.

    Args:
        name: of the file.
        picture: upright, decoded.
        exif: the header's tags.
        has_focal: whether the header states the focal length of a single shot.

    Raises:
        SphericalPhotoError: it shows all directions.
        InputError: it is another panorama.
    """
    projection = _stated_projection(picture)
    aspect = max(picture.size) / min(picture.size)
    crop = "crop it to one direction, without its bent lines"
    if projection == "equirectangular" or (projection is None and _is_sphere(picture)):
        raise SphericalPhotoError(
            f"{name}: this is a 360 degree photo (equirectangular), not a perspective one; upload it "
            f"alone in the editor, give it to 'diorama build', or {crop}"
        )
    if projection not in (None, "perspective", "rectilinear") or exif.get(_CUSTOM_RENDERED) == _PANORAMA:
        raise InputError(
            f"{name}: this is a panorama ({projection or 'by its header'}), not a perspective photo; {crop}"
        )
    if aspect > CERTAIN_ASPECT or (aspect > SWEEP_ASPECT and has_focal):
        raise InputError(f"{name}: {aspect:.1f} : 1 is a sweep panorama, not a perspective photo; {crop}")
    if aspect > SWEEP_ASPECT:
        return (f"{aspect:.1f} : 1 is the shape of a panorama; if it is one, {crop}",)
    return ()


def check_sphere(name: str, picture: Image.Image) -> None:
    """Raise `InputError` where a picture is not all of a sphere.

    Args:
        name: of the file.
        picture: upright, decoded.
    """
    if not _SPHERE_ASPECT[0] <= picture.width / picture.height <= _SPHERE_ASPECT[1]:
        size = f"{picture.width} x {picture.height}"
        raise InputError(f"{name}: {size} is not 2 : 1, so it is no whole 360 degree photo; stitch all directions")
    if _stated_projection(picture) != "equirectangular" and not _is_sphere(picture):
        raise InputError(f"{name}: its left and right sides do not meet, so it is no 360 degree photo")


def _stated_projection(picture: Image.Image) -> str | None:
    """The projection that the header names (GPano), in lower case."""
    xmp = picture.info.get("xmp", b"")
    match = _PROJECTION.search(xmp.encode() if isinstance(xmp, str) else bytes(xmp))
    return match.group(1).decode().lower() if match else None


def _is_sphere(picture: Image.Image) -> bool:
    """Whether a picture of 2:1 closes around the viewer, with poles above and below."""
    if not _SPHERE_ASPECT[0] <= picture.width / picture.height <= _SPHERE_ASPECT[1]:
        return False
    small = np.asarray(picture.convert("L").resize((256, 128), Image.Resampling.BOX), np.float64)
    apart = np.abs(small - np.roll(small, 64, axis=1)).mean()
    seam, beside = (float(np.abs(small[:, 0] - small[:, n]).mean()) for n in (-1, 1))
    varied = small[32:96].std(axis=1).mean()
    poles = max(small[0].std(), small[-1].std())
    closed = seam < SEAM_SHARE * apart and seam < SEAM_STEPS * beside + 1.0
    return bool(apart > 2.0 and closed and poles < POLE_SHARE * varied)
