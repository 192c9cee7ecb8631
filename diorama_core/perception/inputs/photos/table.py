"""The table of forms of photos: what is in the file before a picture of it is decoded."""

from __future__ import annotations

from dataclasses import dataclass

from diorama_core.perception.inputs.photos.decoding import is_heif
from diorama_core.perception.inputs.photos.raw import largest_picture, raw_kind
from diorama_core.perception.inputs.source import Form, Source


@dataclass(frozen=True)
class PhotoFile:
    """The picture of a file, as a file of its own."""

    source: Source
    orientation: int | None = None
    """EXIF orientation of the file around it; None where the picture's own counts."""
    notes: tuple[str, ...] = ()


def _is_raw(source: Source) -> bool:
    return raw_kind(source.data) is not None


def _is_heif(source: Source) -> bool:
    return is_heif(source.data)


def _is_anything(source: Source) -> bool:
    return True


def _raw(source: Source) -> PhotoFile:
    return PhotoFile(*largest_picture(source, raw_kind(source.data) or "camera raw"))


PHOTO_FORMS: tuple[Form[Source, PhotoFile], ...] = (
    Form(
        "camera raw (DNG, CR2, CR3, NEF, ARW, RAF, RW2, ORF)",
        "cameras, phones",
        "the largest picture within; developed where that is a thumbnail and `rawpy` is installed (`diorama[raw]`)",
        _is_raw,
        _raw,
    ),
    Form("HEIC, HEIF", "iPhones, Samsung", "the main picture, upright", _is_heif, PhotoFile),
    Form(
        "JPEG, PNG, WebP, AVIF, TIFF, BMP, GIF, PPM, JPEG 2000",
        "everything else",
        "turned by its EXIF; 10, 12 and 14 bits stretched; plain borders cut off; of several pages the largest; "
        "a 360 degree photo alone is [a whole room](many-photos.md#one-360-degree-photo); sweep panoramas are refused",
        _is_anything,
        PhotoFile,
    ),
)
