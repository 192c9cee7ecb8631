"""The table of forms of masks."""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool

from diorama_core.errors import InputError
from diorama_core.perception.inputs.arrays import array_header
from diorama_core.perception.inputs.masks.pictures import (
    MAX_STACKED,
    MaskMap,
    one_object,
    paint_masks,
    read_picture,
    without_void,
)
from diorama_core.perception.inputs.masks.segments import (
    MAX_TOTAL_MEGAPIXELS,
    is_markup,
    is_polygon_list,
    read_cvat_masks,
    read_polygon_list,
    read_segments,
)
from diorama_core.perception.inputs.source import Folder, Form, Source

AROUND_SHARE = 0.6
"""Share of the picture's border that each mask covers, where they are black on white."""
_PICTURES = (".npy", ".png", ".tif", ".tiff", ".bmp", ".gif", ".webp", ".pgm", ".ppm", ".pbm", ".jpg", ".jpeg")


@dataclass(frozen=True)
class MaskContent:
    """A file or a folder, and the photo that it is of."""

    given: Folder | Source
    photo_name: str
    photo_size: tuple[int, int]

    @property
    def folder(self) -> Folder:
        """The folder, of what is one."""
        assert isinstance(self.given, Folder)
        return self.given

    @property
    def source(self) -> Source:
        """The file, of what is no folder."""
        assert isinstance(self.given, Source)
        return self.given


MASK_FORMS: tuple[Form[MaskContent, MaskMap], ...] = (
    Form(
        "folder or zip of masks",
        "SAM (amg.py), SAM 3D Objects, Grounded-SAM",
        "one file an object, white on black (JPEG too) or cut out of the photo; smaller ones in front of larger",
        lambda content: isinstance(content.given, Folder),
        lambda content: read_folder_of_masks(content.folder),
    ),
    Form(
        "numpy array (.npy, .npz)",
        "Mask R-CNN, SAM, scripts",
        "ids (h, w), or true and false (n, h, w)",
        lambda content: content.source.data.startswith((b"\x93NUMPY", b"PK\x03\x04")),
        lambda content: read_arrays(content.source),
    ),
    Form(
        "segments in JSON",
        "COCO, SAM, LabelMe, Label Studio's brush, VIA, Supervisely, Roboflow",
        "run lengths, plain or packed, bitmaps and polygons, of the photo's file name",
        lambda content: content.source.data.lstrip()[:1] in (b"[", b"{"),
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


def read_folder_of_masks(folder: Folder) -> MaskMap:
    """One file per object: white on black (SAM's amg.py), or cut out of the photo (SAM 3D Objects)."""
    pictures = [f for f in folder.files if f.suffix in _PICTURES]
    if not pictures:
        raise InputError(f"{folder.name}: holds no mask; give one PNG for each object, white on black")
    masks: list[Bool[np.ndarray, "h w"]] = []
    left_out = []
    for file in pictures[: MAX_STACKED + 1]:
        mask = one_object(file) if file.suffix != ".npy" else _read_mask(file)
        if mask is None:
            left_out.append(file.name)
            continue
        if mask.size * (len(masks) + 1) > MAX_TOTAL_MEGAPIXELS * 1_000_000:
            raise InputError(f"{folder.name}: its masks have too many pixels together; reduce them first")
        if mask.any() and not mask.all():
            masks.append(mask)
    shown = ", ".join(left_out[:3]) + (f" and {len(left_out) - 3} more" if len(left_out) > 3 else "")
    notes = (f"{folder.name}: {shown} is not white on black and was left out",) if left_out else ()
    if left_out and not masks:
        raise InputError(f"{folder.name}: {shown} is not white on black; give one PNG for each object, white on black")
    if len(masks) > 1 and all(_is_around(mask) for mask in masks):
        masks, notes = [~mask for mask in masks], (*notes, f"{folder.name}: the masks are black on white")
    painted_map = paint_masks(masks, folder.name, "masks")
    return MaskMap(painted_map.values, (*painted_map.notes, *notes))


def _is_around(mask: Bool[np.ndarray, "h w"]) -> bool:
    return float(np.concatenate([mask[0], mask[-1], mask[:, 0], mask[:, -1]]).mean()) > AROUND_SHARE


def _read_mask(file: Source) -> Bool[np.ndarray, "h w"]:
    array = np.squeeze(_array(file))
    if array.ndim != 2:
        raise InputError(f"{file.name}: one mask must be (h, w), this has shape {array.shape}")
    return np.asarray(array > 0)


def read_arrays(source: Source) -> MaskMap:
    """Ids (h, w), or masks (n, h, w) or (h, w, n); of an archive, the array called `masks` or the only one."""
    array = _array(source)
    if array.ndim > 2 and array.dtype.kind == "f" and np.isfinite(array).all() and 0 <= array.min() < array.max() <= 1:
        array = array >= 0.5  # how likely each pixel is of the object
    if array.dtype.kind not in "iub" and not (array.dtype.kind == "f" and _is_whole(array)):
        raise InputError(f"{source.name}: masks must be whole numbers or true and false, this holds {array.dtype}")
    array = np.squeeze(array) if array.ndim > 3 else array
    if array.ndim == 2 and 0 not in array.shape:
        ids = np.maximum(np.nan_to_num(array), 0).astype(np.int64)
        if ids.max() > np.iinfo(np.int32).max:
            raise InputError(f"{source.name}: ids of masks must be below {np.iinfo(np.int32).max}")
        most = 255 if array.dtype.kind in "bf" else int(np.iinfo(array.dtype).max)
        return without_void(ids.astype(np.int32), most if most <= 65535 else 255)
    if array.ndim == 3 and 0 not in array.shape:
        first = array if array.shape[2] > array.shape[0] or array.shape[0] == 1 else np.moveaxis(array, -1, 0)
        return paint_masks([m > 0 for m in first if (m > 0).any()], source.name, "masks")
    raise InputError(f"{source.name}: masks must be (h, w) ids or (n, h, w), this has shape {array.shape}")


def _array(source: Source) -> np.ndarray:
    try:
        if not source.data.startswith(b"PK\x03\x04"):
            return _load_array(source.data)
        with zipfile.ZipFile(io.BytesIO(source.data)) as archive:
            names = [m.filename for m in archive.infolist() if m.filename.endswith(".npy")]
            wanted = [
                n for n in names if n.removesuffix(".npy") in ("masks", "mask", "instances", "labels", "segmentation")
            ]
            if not wanted and 1 < len(names) <= MAX_STACKED:
                return _array_of_several(archive, names, source.name)
            if len(wanted or names) != 1:
                raise InputError(f"{source.name}: which of its arrays are the masks? call that one 'masks'")
            info = archive.getinfo((wanted or names)[0])
            if info.file_size > MAX_TOTAL_MEGAPIXELS * 1_000_000:
                raise InputError(f"{source.name}: its masks are too large; reduce them first")
            return _load_array(archive.read(info))
    except InputError:
        raise
    except Exception as error:  # a damaged file raises almost anything
        raise InputError(f"{source.name}: the masks are truncated or damaged; write them again with numpy") from error


def _array_of_several(archive: zipfile.ZipFile, names: list[str], name: str) -> np.ndarray:
    """The one array that can be a map, or all of them as one object each."""
    if sum(archive.getinfo(n).file_size for n in names) > MAX_TOTAL_MEGAPIXELS * 1_000_000:
        raise InputError(f"{name}: its masks are too large; reduce them first")
    every = [np.squeeze(_load_array(archive.read(n))) for n in names]
    maps = [a for a in every if a.ndim == 2 and a.dtype.kind in "iub" and min(a.shape) > 4]
    if len(maps) == 1:
        return maps[0]
    if len(maps) != len(names) or len({a.shape for a in maps}) != 1:
        raise InputError(f"{name}: which of its arrays are the masks? call that one 'masks'")
    return np.stack([a > 0 for a in maps])


def _load_array(data: bytes) -> np.ndarray:
    """An array whose header promises no more than the file holds."""
    stream = io.BytesIO(data)
    array_header(stream, len(data))
    return np.asarray(np.load(stream, allow_pickle=False))


def _is_whole(array: np.ndarray) -> bool:
    known = array[np.isfinite(array)]
    return bool(known.size and (known == np.round(known)).all() and np.abs(known).max() < 1e9)
