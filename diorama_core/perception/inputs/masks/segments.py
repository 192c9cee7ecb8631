"""Masks of annotation tools in JSON, text and XML: run lengths, bitmaps and polygons."""

from __future__ import annotations

import base64
import math
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Bool, UInt8
from PIL import Image, ImageDraw

from diorama_core.errors import InputError
from diorama_core.io.bounded import parse_json
from diorama_core.perception.inputs.boxes.entry import BoxText, Size
from diorama_core.perception.inputs.boxes.markup import image_of, is_cvat
from diorama_core.perception.inputs.boxes.nested import objects_of, size_in, size_of
from diorama_core.perception.inputs.boxes.reading import parse_box_text
from diorama_core.perception.inputs.boxes.tools import (
    is_data_set,
    is_via,
    photo_of_data_set,
    regions_of,
    rows_of_results,
)
from diorama_core.perception.inputs.masks.pictures import MAX_MASK_MEGAPIXELS, MaskMap, one_object, paint_masks
from diorama_core.perception.inputs.source import Folder, Source

MAX_TOTAL_MEGAPIXELS = 600
"""Limit of all masks of a folder or a file together."""


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


def read_segments(content: MaskContent) -> MaskMap:
    """Run lengths (COCO, SAM), bitmaps (Supervisely) and polygons (COCO, LabelMe, VIA) of JSON."""
    source, photo_size = content.source, content.photo_size
    document = parse_json(source.data, source.name, InputError, advice="masks are pictures, arrays or COCO's segments")
    document, size = _photo_annotations(BoxText(source, document, content.photo_name, photo_size))
    masks: list[Bool[np.ndarray, "h w"]] = []
    for segment in _segments(document):
        mask = _mask(segment, size or photo_size, source.name)
        if sum(m.size for m in masks) + mask.size > MAX_TOTAL_MEGAPIXELS * 1_000_000:
            raise InputError(f"{source.name}: its masks have too many pixels together; reduce them first")
        if mask.any():
            masks.append(mask)
    return paint_masks(masks, source.name, "segments")


def is_polygon_list(content: MaskContent) -> bool:
    """Whether it is text of YOLO's form with polygons."""
    try:
        rows = [line.split() for line in content.source.data[:4_000_000].decode().splitlines() if line.strip()]
        numbers = [[float(v) for v in row] for row in rows]
    except ValueError:
        return False
    polygons = all(len(r) >= 7 and len(r) % 2 for r in numbers)
    return bool(numbers) and polygons and all(min(r[1:]) >= -0.1 and max(r[1:]) <= 1.1 for r in numbers)


def read_polygon_list(content: MaskContent) -> MaskMap:
    """Polygons in shares of the picture."""
    source, photo_size = content.source, content.photo_size
    masks = []
    for line in source.data.decode().splitlines():
        shares = [float(v) for v in line.split()[1:]]
        if shares:
            pixels = [v * photo_size[k % 2] for k, v in enumerate(shares)]
            masks.append(fill_polygon([pixels], photo_size, source.name))
    return paint_masks([m for m in masks if m.any()], source.name, "polygons")


def _photo_annotations(text: BoxText) -> tuple[Any, Size | None]:
    """Annotations of the photo in a document, and the size of the annotated picture where it states one."""
    if is_data_set(text):
        image, annotations = photo_of_data_set(text)
        return annotations, size_of(image.get("width"), image.get("height"))
    if is_via(text):
        return regions_of(text), None
    rows = objects_of(text.document)
    if rows and all("image_id" in r for r in rows):
        return rows_of_results(rows, text), None
    return text.document, size_in(text.document)


def _mask(segment: Any, size: Size, name: str) -> Bool[np.ndarray, "h w"]:
    if isinstance(segment, dict):
        if "rle" in segment:
            return decode_brush(segment, name)
        return _bitmap(segment, size, name) if "data" in segment else decode_runs(segment, name)
    return fill_polygon(segment, size, name)


def _bitmap(segment: dict[str, Any], size: Size, name: str) -> Bool[np.ndarray, "h w"]:
    """Supervisely's: a packed picture of the object, and where its upper left corner is."""
    mask = np.zeros(size[::-1], bool)
    try:
        packed = base64.b64decode(segment["data"], validate=True)
        picture = zlib.decompressobj().decompress(packed, MAX_MASK_MEGAPIXELS * 1_000_000)
        part = one_object(Source(picture, name))
        x, y = (int(v) for v in segment["origin"])
    except (ValueError, TypeError, KeyError, zlib.error, OverflowError) as error:
        raise InputError(f"{name}: the bitmap of an object is damaged; export it again") from error
    if part is None or x < 0 or y < 0 or y + part.shape[0] > size[1] or x + part.shape[1] > size[0]:
        raise InputError(f"{name}: the bitmap of an object reaches beyond the picture; export it again")
    mask[y : y + part.shape[0], x : x + part.shape[1]] = part
    return mask


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
        brush = value.get("value")
        if isinstance(brush, dict) and brush.get("format") == "rle" and isinstance(brush.get("rle"), list):
            yield {"rle": brush["rle"], "size": [value.get("original_height"), value.get("original_width")]}
            return
        bitmap = value.get("bitmap")
        if isinstance(bitmap, dict) and "data" in bitmap and "origin" in bitmap:
            yield bitmap
            return
        rings = _outline(value)
        if rings is not None:
            yield rings
            return
        for inner in value.values():
            yield from _segments(inner, level + 1)


def _outline(value: dict[str, Any]) -> list[Any] | None:
    """The polygons of one annotation, whatever the program calls them; None where it has none."""
    points, across, down = (value.get(k) for k in ("points", "all_points_x", "all_points_y"))
    segments, segmentation = value.get("segments"), value.get("segmentation")
    if isinstance(segments, dict):  # Ultralytics
        across, down = segments.get("x"), segments.get("y")
    if isinstance(across, list) and isinstance(down, list):
        return [[[x, y] for x, y in zip(across, down, strict=False)]]
    if isinstance(points, dict) and isinstance(points.get("exterior"), list) and len(points["exterior"]) > 2:
        return [points["exterior"]]
    if isinstance(points, list) and len(points) > 2:
        if all(isinstance(p, dict) and {"x", "y"} <= p.keys() for p in points):
            return [[[p["x"], p["y"]] for p in points]]  # Roboflow
        if value.get("shape_type") == "polygon":
            return [points]
    if isinstance(segmentation, list) and segmentation and all(isinstance(p, list) for p in segmentation):
        return segmentation
    return None


def fill_polygon(rings: list[Any], size: Size, name: str) -> Bool[np.ndarray, "h w"]:
    """Rings of x, y, x, y... or of [x, y] filled.

    Raises:
        InputError: the picture is too large, or a ring holds no numbers.
    """
    if size[0] * size[1] > MAX_MASK_MEGAPIXELS * 1_000_000:
        raise InputError(f"{name}: its picture of {size[0]} x {size[1]} pixels is too large for masks")
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


def is_markup(content: MaskContent) -> bool:
    """Whether it is XML."""
    return content.source.data.lstrip(b"\xef\xbb\xbf \r\n\t")[:1] == b"<"


def read_cvat_masks(content: MaskContent) -> MaskMap:
    """The polygons and masks of the photo in CVAT's XML."""
    source, photo_size = content.source, content.photo_size
    text = parse_box_text(source, content.photo_name, photo_size)
    image = image_of(text.document.findall("image"), text) if isinstance(text.document, Element) else None
    if not is_cvat(text) or image is None:
        raise InputError(f"{source.name}: this XML holds no masks; give CVAT's, JSON with polygons, or pictures")
    try:
        size = int(image.get("width") or photo_size[0]), int(image.get("height") or photo_size[1])
        if not 0 < size[0] * size[1] <= MAX_MASK_MEGAPIXELS * 1_000_000:
            raise ValueError(size)
        figures = [f for f in image if f.tag in ("polygon", "mask")]
        if len(figures) * size[0] * size[1] > MAX_TOTAL_MEGAPIXELS * 1_000_000:
            raise InputError(f"{source.name}: its masks have too many pixels together; reduce them first")
        masks = [_figure_mask(figure, size, source.name) for figure in figures]
    except (ValueError, OverflowError) as error:
        raise InputError(f"{source.name}: a mask of this CVAT file is damaged; export it again") from error
    return paint_masks([m for m in masks if m.any()], source.name, "segments")


def _figure_mask(figure: Element, size: Size, name: str) -> Bool[np.ndarray, "h w"]:
    if figure.tag == "polygon":
        pairs = [[float(v) for v in pair.split(",")] for pair in (figure.get("points") or "").split(";")]
        return fill_polygon([pairs], size, name)
    left, top, width, height = (int(figure.get(key) or 0) for key in ("left", "top", "width", "height"))
    runs = [int(v) for v in (figure.get("rle") or "").split(",")]
    inside = min(left, top) >= 0 and left + width <= size[0] and top + height <= size[1]
    if not inside or min(runs) < 0 or sum(runs) != width * height:
        raise ValueError(runs)
    mask = np.zeros(size[::-1], bool)
    part = np.repeat(np.arange(len(runs)) % 2 == 1, runs).reshape(height, width)
    mask[top : top + height, left : left + width] = part
    return mask


def whole_numbers(value: object) -> list[int]:
    """The entries of a list of numbers; raises `ValueError` where it is no such list."""
    if not isinstance(value, list) or not all(isinstance(v, int | float) for v in value):
        raise ValueError("no list of numbers")
    return [int(v) for v in value]


def decode_runs(segment: Mapping[str, Any], name: str) -> Bool[np.ndarray, "h w"]:
    """The mask of an object with `size` (height, width) and `counts`.

    Raises:
        InputError: the counts do not make up the size.
    """
    size, counts = segment.get("size"), segment.get("counts")
    try:
        height, width = whole_numbers(size)
        runs = _unpack_counts(counts) if isinstance(counts, str) else whole_numbers(counts)
    except (ValueError, OverflowError):
        raise InputError(f"{name}: its run lengths are damaged; export the masks again") from None
    if height <= 0 or width <= 0 or height * width > MAX_MASK_MEGAPIXELS * 1_000_000:
        raise InputError(f"{name}: masks of {width} x {height} pixels are no usable size; give those of the photo")
    if min(runs, default=0) < 0 or sum(runs) != height * width:
        raise InputError(f"{name}: run lengths of {sum(runs)} pixels are not those of {width} x {height}; export again")
    inside = np.arange(len(runs)) % 2 == 1
    return np.repeat(inside, runs).reshape(width, height).T


def decode_brush(segment: Mapping[str, Any], name: str) -> Bool[np.ndarray, "h w"]:
    """The mask of Label Studio's brush: a picture of four channels, of which the last is the mask.

    Its packed bytes are a list under `rle`, beside `size` (height, width).

    Raises:
        InputError: the bytes do not make up the size.
    """
    try:
        height, width = whole_numbers(segment.get("size"))
        packed = bytes(whole_numbers(segment.get("rle")))
        if (
            not 0 < height * width <= MAX_MASK_MEGAPIXELS * 1_000_000
            or int.from_bytes(packed[:4]) != 4 * height * width
        ):
            raise ValueError(segment.get("size"))
        values = np.concatenate(list(_words(packed, 4 * height * width)))
        return np.asarray(values[3::4].reshape(height, width) > 127)
    except (ValueError, OverflowError, TypeError):
        raise InputError(f"{name}: the run lengths of a brush are damaged; export the masks again") from None


def _words(packed: bytes, count: int) -> Iterator[UInt8[np.ndarray, "_"]]:
    """The words of thi.ng's run lengths: 32 bits of count, the words' and four lengths' bits, then runs."""
    bits = "".join(format(byte, "08b") for byte in packed)
    at, done = 32, 0

    def number(width: int) -> int:
        nonlocal at
        at += width
        return int(bits[at - width : at], 2)

    word = number(5) + 1
    if word != 8:
        raise ValueError(word)
    widths = [number(4) + 1 for _ in range(4)]
    while done < count:
        same = number(1)
        length = number(widths[number(2)]) + 1
        done += length
        if same:
            yield np.full(length, number(word), np.uint8)
        else:
            yield np.array([number(word) for _ in range(length)], np.uint8)
    if done != count:
        raise ValueError(done)


def _unpack_counts(text: str) -> list[int]:
    """The counts of COCO's text: five bits a character, lowest first, from the third count on as differences."""
    runs: list[int] = []
    value, shift = 0, 0
    for letter in text:
        bits = ord(letter) - 48
        if not 0 <= bits < 64 or shift > 40:
            raise ValueError(text)
        value |= (bits & 0x1F) << shift
        shift += 5
        if bits & 0x20:
            continue
        if bits & 0x10:
            value -= 1 << shift
        runs.append(value + runs[-2] if len(runs) > 2 else value)
        value, shift = 0, 0
    return runs
