"""Masks in several files, and in files that are no pictures: arrays, run lengths, polygons."""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Iterator
from typing import Any

import numpy as np
from jaxtyping import Bool
from numpy.lib import format as npy
from PIL import Image, ImageDraw

from diorama_core.errors import InputError
from diorama_core.io.bounded import parse_json
from diorama_core.perception.inputs.boxes.nested import size_in
from diorama_core.perception.inputs.masks.pictures import MAX_MASK_MEGAPIXELS, one_object, without_void
from diorama_core.perception.inputs.masks.run_lengths import decoded_runs
from diorama_core.perception.inputs.masks.stack import MAX_STACKED, MaskMap, painted
from diorama_core.perception.inputs.source import Folder, Source

_PICTURES = (".png", ".tif", ".tiff", ".bmp", ".gif", ".webp", ".pgm", ".ppm", ".pbm")
MAX_TOTAL_MEGAPIXELS = 600
"""Of all masks of a folder or a file together."""


def read_folder_of_masks(folder: Folder) -> MaskMap:
    """One file per object: white on black (SAM's amg.py), or cut out of the photo (SAM 3D Objects)."""
    pictures = [f for f in folder.files if f.suffix in _PICTURES]
    if not pictures:
        raise InputError(f"{folder.name}: holds no mask; give one PNG for each object, white on black")
    masks: list[Bool[np.ndarray, "h w"]] = []
    for file in pictures[: MAX_STACKED + 1]:
        mask = one_object(file)
        if mask.size * (len(masks) + 1) > MAX_TOTAL_MEGAPIXELS * 1_000_000:
            raise InputError(f"{folder.name}: its masks have too many pixels together; reduce them first")
        if mask.any() and not mask.all():
            masks.append(mask)
    return painted(masks, folder.name, "masks")


def read_arrays(source: Source) -> MaskMap:
    """Ids (h, w), or masks (n, h, w) or (h, w, n); of an archive, the array called `masks` or the only one."""
    array = _array(source)
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
        return painted([m > 0 for m in first if (m > 0).any()], source.name, "masks")
    raise InputError(f"{source.name}: masks must be (h, w) ids or (n, h, w), this has shape {array.shape}")


def read_segments(source: Source) -> MaskMap:
    """Run lengths (COCO, SAM) and polygons (COCO, LabelMe) of JSON."""
    document = parse_json(source.data, source.name, InputError, advice="masks are pictures, arrays or COCO's segments")
    size = size_in(document)
    masks: list[Bool[np.ndarray, "h w"]] = []
    for segment in _segments(document):
        mask = decoded_runs(segment, source.name) if isinstance(segment, dict) else _polygon(segment, size, source.name)
        if sum(m.size for m in masks) + mask.size > MAX_TOTAL_MEGAPIXELS * 1_000_000:
            raise InputError(f"{source.name}: its masks have too many pixels together; reduce them first")
        if mask.any():
            masks.append(mask)
    return painted(masks, source.name, "segments")


def _segments(value: Any, level: int = 0) -> Iterator[Any]:
    """Objects with `size` and `counts`, and lists of polygons, of everything in a document."""
    if level > 6:
        return
    if isinstance(value, list):
        for inner in value:
            yield from _segments(inner, level + 1)
    elif isinstance(value, dict):
        if "counts" in value and "size" in value:
            yield value
            return
        points = value.get("points")
        if value.get("shape_type") == "polygon" and isinstance(points, list) and len(points) > 2:
            yield [points]
            return
        segmentation = value.get("segmentation")
        if isinstance(segmentation, list) and segmentation and all(isinstance(p, list) for p in segmentation):
            yield segmentation
            return
        for inner in value.values():
            yield from _segments(inner, level + 1)


def _polygon(rings: list[Any], size: tuple[int, int] | None, name: str) -> Bool[np.ndarray, "h w"]:
    """Rings of x, y, x, y... or of [x, y] filled."""
    if size is None or size[0] * size[1] > MAX_MASK_MEGAPIXELS * 1_000_000:
        raise InputError(f"{name}: polygons need the size of the picture (width and height) beside them")
    canvas = Image.new("L", size)
    try:
        for ring in rings:
            points = [float(v) for p in ring for v in (p if isinstance(p, list) else [p])]
            pairs = list(zip(points[::2], points[1::2], strict=False))
            if len(pairs) > 2 and all(math.isfinite(v) and abs(v) < 1e6 for p in pairs for v in p):
                ImageDraw.Draw(canvas).polygon(pairs, fill=1)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{name}: a polygon is not a list of numbers; export it again") from error
    return np.asarray(canvas) > 0


def _array(source: Source) -> np.ndarray:
    try:
        if not source.data.startswith(b"PK\x03\x04"):
            return _checked_array(source.data)
        with zipfile.ZipFile(io.BytesIO(source.data)) as archive:
            names = [m.filename for m in archive.infolist() if m.filename.endswith(".npy")]
            wanted = [
                n for n in names if n.removesuffix(".npy") in ("masks", "mask", "instances", "labels", "segmentation")
            ]
            if len(wanted or names) != 1:
                raise InputError(f"{source.name}: which of its arrays are the masks? call that one 'masks'")
            info = archive.getinfo((wanted or names)[0])
            if info.file_size > MAX_TOTAL_MEGAPIXELS * 1_000_000:
                raise InputError(f"{source.name}: its masks are too large; reduce them first")
            return _checked_array(archive.read(info))
    except InputError:
        raise
    except Exception as error:  # a damaged file raises almost anything
        raise InputError(f"{source.name}: the masks are truncated or damaged; write them again with numpy") from error


def _checked_array(data: bytes) -> np.ndarray:
    """An array whose header promises no more than the file holds."""
    stream = io.BytesIO(data)
    version = npy.read_magic(stream)
    shape, _, dtype = npy.read_array_header_1_0(stream) if version == (1, 0) else npy.read_array_header_2_0(stream)
    if dtype.hasobject or math.prod(shape) * dtype.itemsize > len(data):
        raise ValueError("fewer numbers than the header states")
    return np.asarray(np.load(io.BytesIO(data), allow_pickle=False))


def _is_whole(array: np.ndarray) -> bool:
    known = array[np.isfinite(array)]
    return bool(known.size and (known == np.round(known)).all() and np.abs(known).max() < 1e9)
