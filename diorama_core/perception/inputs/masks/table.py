"""The table of forms of masks."""

from __future__ import annotations

from diorama_core.perception.inputs.form import Form
from diorama_core.perception.inputs.masks.files import read_arrays, read_folder_of_masks, read_segments
from diorama_core.perception.inputs.masks.pictures import read_picture
from diorama_core.perception.inputs.masks.stack import MaskMap
from diorama_core.perception.inputs.source import Folder, Source


def _is_folder(given: Folder | Source) -> bool:
    return isinstance(given, Folder)


def _is_array(given: Folder | Source) -> bool:
    return isinstance(given, Source) and given.data.startswith((b"\x93NUMPY", b"PK\x03\x04"))


def _is_json(given: Folder | Source) -> bool:
    return isinstance(given, Source) and given.data.lstrip()[:1] in (b"[", b"{")


def _folder(given: Folder | Source) -> MaskMap:
    assert isinstance(given, Folder)
    return read_folder_of_masks(given)


def _array(given: Folder | Source) -> MaskMap:
    assert isinstance(given, Source)
    return read_arrays(given)


def _json(given: Folder | Source) -> MaskMap:
    assert isinstance(given, Source)
    return read_segments(given)


def _picture(given: Folder | Source) -> MaskMap:
    assert isinstance(given, Source)
    return read_picture(given)


MASK_FORMS: tuple[Form[Folder | Source, MaskMap], ...] = (
    Form(
        "folder or zip of masks",
        "SAM (amg.py), SAM 3D Objects, Grounded-SAM",
        "one file an object, white on black or cut out of the photo; of overlapping masks the smaller is in front",
        _is_folder,
        _folder,
    ),
    Form(
        "numpy array (.npy, .npz)",
        "Mask R-CNN, SAM, scripts",
        "ids (h, w), or true and false (n, h, w)",
        _is_array,
        _array,
    ),
    Form(
        "segments in JSON",
        "COCO, SAM's automatic masks, LabelMe",
        "run lengths, plain or packed, and polygons with the picture's size",
        _is_json,
        _json,
    ),
    Form(
        "picture (PNG, TIFF, GIF, WebP)",
        "Pascal VOC, LabelMe, CVAT, painting programs",
        "a colour or an id an object; black, 0 and void (255) are none; palettes by their colours",
        lambda given: isinstance(given, Source),
        _picture,
    ),
)
