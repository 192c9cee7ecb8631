"""The table of forms of masks."""

from __future__ import annotations

from dataclasses import dataclass

from diorama_core.perception.inputs.masks.files import read_arrays, read_folder_of_masks
from diorama_core.perception.inputs.masks.pictures import MaskMap, read_picture
from diorama_core.perception.inputs.masks.segments import (
    is_markup,
    is_polygon_list,
    read_cvat_masks,
    read_polygon_list,
    read_segments,
)
from diorama_core.perception.inputs.source import Folder, Form, Source


@dataclass(frozen=True)
class MaskContent:
    """A file or a folder, and the photo that it is of."""

    given: Folder | Source
    photo_name: str
    photo_size: tuple[int, int]

    @property
    def source(self) -> Source:
        """The file, of what is no folder."""
        assert isinstance(self.given, Source)
        return self.given


def _is_folder(content: MaskContent) -> bool:
    return isinstance(content.given, Folder)


def _is_array(content: MaskContent) -> bool:
    return content.source.data.startswith((b"\x93NUMPY", b"PK\x03\x04"))


def _is_json(content: MaskContent) -> bool:
    return content.source.data.lstrip()[:1] in (b"[", b"{")


def _folder(content: MaskContent) -> MaskMap:
    assert isinstance(content.given, Folder)
    return read_folder_of_masks(content.given)


MASK_FORMS: tuple[Form[MaskContent, MaskMap], ...] = (
    Form(
        "folder or zip of masks",
        "SAM (amg.py), SAM 3D Objects, Grounded-SAM",
        "one file an object, white on black (JPEG too) or cut out of the photo; smaller ones in front of larger",
        _is_folder,
        _folder,
    ),
    Form(
        "numpy array (.npy, .npz)",
        "Mask R-CNN, SAM, scripts",
        "ids (h, w), or true and false (n, h, w)",
        _is_array,
        lambda content: read_arrays(content.source),
    ),
    Form(
        "segments in JSON",
        "COCO, SAM, LabelMe, Label Studio's brush, VIA, Supervisely, Roboflow",
        "run lengths, plain or packed, bitmaps and polygons, of the photo's file name",
        _is_json,
        lambda content: read_segments(content.source, content.photo_name, content.photo_size),
    ),
    Form(
        "CVAT",
        "CVAT for images",
        "polygons and masks of the photo",
        lambda content: is_markup(content.source),
        lambda content: read_cvat_masks(content.source, content.photo_name, content.photo_size),
    ),
    Form(
        "YOLO polygons",
        "Ultralytics",
        "a class number and the corners of a polygon a line, in shares of the picture",
        lambda content: is_polygon_list(content.source),
        lambda content: read_polygon_list(content.source, content.photo_size),
    ),
    Form(
        "picture (PNG, TIFF, GIF, WebP)",
        "Pascal VOC, LabelMe, CVAT, painting programs",
        "a colour or an id an object; black, 0 and void (255) are none; palettes by their colours",
        lambda _: True,
        lambda content: read_picture(content.source),
    ),
)
