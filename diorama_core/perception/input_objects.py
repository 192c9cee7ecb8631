"""Reading boxes and instance masks, and telling which mask belongs to which box."""

from __future__ import annotations

import re
from typing import Annotated

import numpy as np
from jaxtyping import Int32, Shaped
from PIL import Image
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from diorama_core.artefacts import Box, LabelledBox
from diorama_core.errors import InputError
from diorama_core.geometry.projection import box_iou
from diorama_core.io.bounded import megabytes, parse_json, shortened
from diorama_core.library.labels import understand_label
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS, UNKNOWN
from diorama_core.perception.input_depth import check_same_proportions
from diorama_core.perception.input_photo import Source, load_pixels, open_picture

MAX_OBJECTS = 500
MAX_BOXES_BYTES = 4_000_000
"""Of a boxes file: twenty times what five hundred boxes take."""
MAX_MASK_MEGAPIXELS = 40
MIN_BOX_PX = 2.0
SPECK_SHARE = 1e-4
"""An instance or a loose piece of one smaller than this share of the picture is a speck."""
MIN_SPECK_PX = 20
CLIP_NOTICE_PX = 2.0

_Number = Annotated[float, Field(allow_inf_nan=False, ge=-1e9, le=1e9)]
InstanceBoxes = tuple[tuple[int, LabelledBox], ...]


class _BoxRecord(BaseModel):
    """One entry of a boxes file."""

    model_config = ConfigDict(extra="ignore", populate_by_name=True)

    bbox: tuple[_Number, _Number, _Number, _Number]
    word: Annotated[str, Field(alias="class", max_length=200)] = "object"
    score: Annotated[float, Field(ge=0.0, le=1.0)] = 1.0


_RECORDS = TypeAdapter(list[_BoxRecord])
_EXAMPLE = 'a JSON list of {"bbox": [x1, y1, x2, y2], "class": "chair"}'


def read_boxes(
    source: Source, original_size: tuple[int, int], photo_size: tuple[int, int]
) -> tuple[tuple[LabelledBox, ...], tuple[str, ...]]:
    """Boxes given in pixels of the upright original, in photo pixels, and warnings worth showing.

    Raises:
        InputError: wrong JSON, or a box that is degenerate or wholly outside the picture, named by its index.
    """
    records = _parse(source)
    boxes: list[LabelledBox] = []
    notes: list[str] = []
    scale = (photo_size[0] / original_size[0], photo_size[1] / original_size[1])
    for index, record in enumerate(records):
        word = _tidy(record.word)
        if word.lower() in ARCHITECTURE_WORDS:
            notes.append(f"box {index} ('{word}') is part of the room itself and was left out")
            continue
        box, clipped = _checked_box(source.name, index, record.bbox, original_size)
        if clipped:
            notes.append(f"box {index} ('{word}') reached outside the picture and was clipped")
        category, label, note = understood(word)
        notes += [note] if note else []
        scaled = (box[0] * scale[0], box[1] * scale[1], box[2] * scale[0], box[3] * scale[1])
        boxes.append(LabelledBox(scaled, category, label, record.score))
    return tuple(boxes), tuple(dict.fromkeys(notes))


def understood(word: str) -> tuple[str, str, str]:
    """Category, label and a note for the user, of a word that was given as a class."""
    found = understand_label(word)
    label = UNKNOWN.name if found.exact and found.category is UNKNOWN else word
    return found.category.name, label, found.note


def _parse(source: Source) -> list[_BoxRecord]:
    if len(source.data) > MAX_BOXES_BYTES:
        raise InputError(
            f"{source.name}: {megabytes(len(source.data))} are more than {MAX_OBJECTS} boxes take; boxes are {_EXAMPLE}"
        )
    document = parse_json(source.data, source.name, InputError, advice=f"boxes are {_EXAMPLE}")
    if isinstance(document, list) and len(document) > MAX_OBJECTS:
        raise InputError(
            f"{source.name}: {len(document)} boxes are more than the {MAX_OBJECTS} accepted; keep the furniture"
        )
    try:
        return _RECORDS.validate_python(document)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = shortened(", ".join(str(p) for p in first["loc"]), 60)
        where = f"entry {place}: " if place else ""
        raise InputError(f"{source.name}: {where}{shortened(first['msg'].lower())}; boxes are {_EXAMPLE}") from error


def _tidy(word: str) -> str:
    """One line, single spaces, no control characters: `night_stand` becomes `night stand`."""
    return re.sub(r"[\s_\x00-\x1f\x7f]+", " ", word).strip() or UNKNOWN.name


def _checked_box(
    name: str, index: int, bbox: tuple[float, float, float, float], size: tuple[int, int]
) -> tuple[Box, bool]:
    x1, y1, x2, y2 = bbox
    shown = "[" + ", ".join(f"{v:g}" for v in bbox) + "]"
    if x2 - x1 < MIN_BOX_PX or y2 - y1 < MIN_BOX_PX:
        raise InputError(f"{name}: box {index} {shown} has no area; give [x1, y1, x2, y2] with x1 < x2 and y1 < y2")
    width, height = size
    box = (min(max(x1, 0), width), min(max(y1, 0), height), min(max(x2, 0), width), min(max(y2, 0), height))
    if box[2] - box[0] < MIN_BOX_PX or box[3] - box[1] < MIN_BOX_PX:
        raise InputError(
            f"{name}: box {index} {shown} lies outside the picture ({size[0]} x {size[1]} pixels); correct or remove it"
        )
    return box, max(abs(a - b) for a, b in zip(box, bbox, strict=True)) > CLIP_NOTICE_PX


def read_masks(
    source: Source, boxes: tuple[LabelledBox, ...], photo_size: tuple[int, int]
) -> tuple[Int32[np.ndarray, "h w"], InstanceBoxes, tuple[str, ...]]:
    """The instance map at the photo's size, each instance's box and class, and warnings worth showing.

    Ids run from 1 in the order in which instances are met from the top left.

    Raises:
        InputError: not a mask picture, of other proportions, or without any instance.
    """
    picture = open_picture(source, "mask", MAX_MASK_MEGAPIXELS)
    if picture.format not in ("PNG", "TIFF", "BMP", "GIF", "WEBP", "PPM"):
        raise InputError(f"{source.name}: masks need exact colours, which {picture.format} blurs; save them as PNG")
    load_pixels(picture, source, "mask")
    check_same_proportions(source.name, "mask", picture.size, photo_size)
    try:
        pixels = np.asarray(_plain(picture))
    except (ValueError, OSError, TypeError) as error:  # a palette that is not whole
        raise InputError(f"{source.name}: the masks are damaged; save them again as PNG") from error
    if picture.size != photo_size:
        pixels = _resized(pixels, photo_size)
    instances, dropped = _without_specks(source.name, _values(pixels))
    notes = (f"{dropped} specks of the masks were dropped",) if dropped else ()
    instances.setflags(write=False)
    return instances, match_instances(instances, boxes), notes


def _plain(picture: Image.Image) -> Image.Image | np.ndarray:
    """Ids or colours; transparent is background."""
    if picture.mode in ("RGBA", "LA", "PA"):
        rgba = np.array(picture.convert("RGBA"))
        rgba[rgba[..., 3] < 128] = 0
        return rgba[..., :3]
    return picture.convert("L") if picture.mode == "1" else picture


def _values(pixels: np.ndarray) -> Int32[np.ndarray, "h w"]:
    """One number per colour or id, 0 for black or 0."""
    if pixels.ndim == 2:
        return pixels.astype(np.int32)
    rgb = pixels[..., :3].astype(np.int32)
    return (rgb[..., 0] << 16) | (rgb[..., 1] << 8) | rgb[..., 2]


def _resized(values: Shaped[np.ndarray, "h w *c"], size: tuple[int, int]) -> Shaped[np.ndarray, "h2 w2 *c"]:
    """Nearest neighbour by pixel centres."""
    rows = ((np.arange(size[1]) + 0.5) * values.shape[0] / size[1]).astype(int)
    columns = ((np.arange(size[0]) + 0.5) * values.shape[1] / size[0]).astype(int)
    return values[rows[:, None], columns[None, :]]


def _without_specks(name: str, values: Int32[np.ndarray, "h w"]) -> tuple[Int32[np.ndarray, "h w"], int]:
    """Instances numbered from 1 without specks, and how many specks were dropped."""
    least = max(MIN_SPECK_PX, int(SPECK_SHARE * values.size))
    ids, first, counts = np.unique(values, return_index=True, return_counts=True)
    large = [(f, int(i)) for i, f, c in zip(ids, first, counts, strict=True) if i != 0 and c >= least]
    foreground = int(counts[ids != 0].sum())
    in_specks = int(counts[(ids != 0) & (counts < least)].sum())
    if in_specks > 0.2 * foreground or len(large) > MAX_OBJECTS:
        raise InputError(f"{name}: {len(ids)} colours are no instance mask; give one plain colour per object on black")
    instances = np.zeros(values.shape, dtype=np.int32)
    dropped = int((counts[ids != 0] < least).sum())
    for _, value in sorted(large):
        retained, pieces = _large_pieces((values == value).astype(np.uint8), least)
        dropped += pieces
        if retained.any():
            instances[retained] = instances.max() + 1
    if not instances.any():
        raise InputError(f"{name}: the masks hold no object; paint each object in its own colour on black")
    return instances, dropped


def _large_pieces(mask: np.ndarray, least: int) -> tuple[np.ndarray, int]:
    """The mask without its loose specks, and how many there were."""
    import cv2  # the editor opens without it

    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    small = [k for k in range(1, count) if stats[k, cv2.CC_STAT_AREA] < least]
    return (labels > 0) & ~np.isin(labels, small), len(small)


def match_instances(instances: Int32[np.ndarray, "h w"], boxes: tuple[LabelledBox, ...]) -> InstanceBoxes:
    """Each instance with the class of the box it overlaps most; "object" where it overlaps none.

    The overlap is that of the mask's bounding box (IoU), so that a sofa's mask is not taken by the pillow's box inside
    it. A box goes whole to the mask that overlaps it most; further masks of the same box keep their own extent.
    """
    own = {k: _extent(instances == k) for k in range(1, int(instances.max()) + 1)}
    best: dict[int, tuple[float, int]] = {}
    given = np.array([b.box for b in boxes], dtype=np.float64).reshape(-1, 4)
    for k, extent in own.items():
        overlaps = box_iou(np.array(extent), given)
        if overlaps.size and overlaps.max() > 0:
            best[k] = (float(overlaps.max()), int(overlaps.argmax()))
    matched: list[tuple[int, LabelledBox]] = []
    for k, extent in own.items():
        if k not in best:
            matched.append((k, LabelledBox(extent, UNKNOWN.name, UNKNOWN.name)))
            continue
        score, index = best[k]
        box = boxes[index]
        is_owner = all(o == k or i != index or (s, -o) < (score, -k) for o, (s, i) in best.items())
        matched.append((k, box if is_owner else LabelledBox(extent, box.category, box.label, box.score)))
    return tuple(matched)


def _extent(mask: np.ndarray) -> Box:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return float(columns[0]), float(rows[0]), float(columns[-1] + 1), float(rows[-1] + 1)
