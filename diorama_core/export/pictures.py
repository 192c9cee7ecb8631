"""Pictures as files: encoded, reduced, and multiplied by a colour for formats that know one or the other."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Mapping
from typing import Concatenate, Generic, ParamSpec, TypeVar

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear
from diorama_core.scene.types import Scene

Picture = UInt8[np.ndarray, "_ _ _"]
JPEG_FROM_PX = 512 * 512
"""Larger opaque pictures are JPEG, the others PNG."""
JPEG_QUALITY = 92
MAX_PHOTO_TEXTURES_PX = 4096
PNG_LEVEL = 3
"""Level of compression: the usual 6 takes more than twice as long for files 7 % smaller."""
Made = TypeVar("Made")
Told = ParamSpec("Told")


def picture_suffix(picture: Picture) -> str:
    """How the file of a picture ends."""
    return ".jpg" if picture.shape[2] == 3 and picture.shape[0] * picture.shape[1] > JPEG_FROM_PX else ".png"


def encode_picture(picture: Picture) -> bytes:
    """A picture's file: JPEG for large opaque ones, PNG for the others."""
    return (
        png_bytes(picture)
        if picture_suffix(picture) == ".png"
        else _file_content(picture, "JPEG", quality=JPEG_QUALITY)
    )


def png_bytes(picture: Picture) -> bytes:
    """A picture as PNG."""
    return _file_content(picture, "PNG", compress_level=PNG_LEVEL)


def _file_content(picture: Picture, form: str, **options: int) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(picture)).save(buffer, form, **options)
    return buffer.getvalue()


class OncePerPicture(Generic[Told, Made]):
    """What is made of pictures, each once whatever number of models show it; pictures are told apart by identity.

    Args:
        make: Makes it of a picture and whatever else it is told, which must be hashable.
    """

    def __init__(self, make: Callable[Concatenate[Picture, Told], Made]) -> None:
        self._make = make
        self._made: dict[tuple[object, ...], tuple[Picture, Made]] = {}

    def __call__(self, picture: Picture, *told: Told.args, **named: Told.kwargs) -> Made:
        """What is made of this picture."""
        key = (id(picture), *told, *named.items())
        if key not in self._made:
            # Holding the picture keeps its id from being reused.
            self._made[key] = (picture, self._make(picture, *told, **named))
        return self._made[key][1]


class TexturePictures:
    """Pictures of materials, tinted and as files, each made once for all models of an export."""

    def __init__(self) -> None:
        self.tinted = OncePerPicture(tint)
        self.encoded = OncePerPicture(encode_picture)


def texture_file(picture: Picture) -> tuple[str, bytes]:
    """A picture with sides that are powers of two, as a file: how its name ends, and its content."""
    scaled = power_of_two(picture)
    return picture_suffix(scaled), encode_picture(scaled)


def photo_text(photo: Picture) -> str:
    """A photo as JPEG in base 64, for files that hold text only."""
    return base64.b64encode(_file_content(photo, "JPEG", quality=JPEG_QUALITY)).decode("ascii")


def shrink(picture: Picture, max_px: int | None) -> Picture:
    """The picture, reduced so that its longer side has at most `max_px` pixels."""
    longest = max(picture.shape[:2])
    if max_px is None or longest <= max_px:
        return picture
    return _reduce(picture, *(round(n * max_px / longest) for n in picture.shape[:2]))


def fit_pictures(scene: Scene, pictures: Mapping[str, Picture], side_px: int) -> Mapping[str, Picture]:
    """The pictures, those that the scene shows reduced so that one square of that side would hold all of them.

    No side of one is longer than the square's, and all are reduced by one factor where they have more texels together.
    They stay pictures of their own rather than parts of one atlas: floors, walls and most materials repeat theirs,
    which a part of an atlas cannot, and the few that do not (paintings, screens, rugs) are a small share of the texels.

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


def _scale(picture: Picture, factor: float) -> Picture:
    """The picture made smaller; as it is where the factor would make it larger."""
    return picture if factor >= 1.0 else _reduce(picture, *(int(n * factor) for n in picture.shape[:2]))


def _reduce(picture: Picture, height: int, width: int) -> Picture:
    import cv2  # the editor opens without it

    return np.asarray(cv2.resize(picture, (max(width, 1), max(height, 1)), interpolation=cv2.INTER_AREA))


def power_of_two(picture: Picture) -> Picture:
    """The picture with sides that are powers of two, so that every device can repeat and minify it.

    A side goes up to the next power unless it lies less than a tenth above the one below.
    """
    height, width = (2 ** max(int(np.ceil(np.log2(n / 1.1))), 0) for n in picture.shape[:2])
    if (height, width) == picture.shape[:2]:
        return picture
    import cv2  # the editor opens without it

    return np.asarray(cv2.resize(picture, (width, height), interpolation=cv2.INTER_LINEAR)).reshape(height, width, -1)


def tint(picture: Picture, colour: tuple[float, float, float]) -> Picture:
    """An sRGB picture multiplied by a linear colour, as a renderer multiplies them; alpha stays."""
    if colour == (1.0, 1.0, 1.0):
        return picture
    light = srgb_to_linear(np.arange(256) / 255.0)
    shades = np.rint(255 * linear_to_srgb(np.clip(light[:, None] * np.asarray(colour), 0.0, 1.0))).astype(np.uint8)
    out = picture.copy()
    for channel in range(3):
        out[..., channel] = shades[picture[..., channel], channel]
    return out
