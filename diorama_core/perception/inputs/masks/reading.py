"""Reading instance masks by the table of their forms, and telling which mask belongs to which box."""

from __future__ import annotations

import io
import zipfile

import numpy as np
from jaxtyping import Bool, Int32, Shaped

from diorama_core.artefacts import Box, LabelledBox
from diorama_core.errors import InputError
from diorama_core.geometry.projection import box_iou
from diorama_core.io.text import number_of
from diorama_core.library.taxonomy import UNKNOWN
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
    MaskContent,
    is_markup,
    is_polygon_list,
    read_cvat_masks,
    read_polygon_list,
    read_segments,
)
from diorama_core.perception.inputs.photos.reading import DecodedPhoto
from diorama_core.perception.inputs.source import Folder, Form, Source, form_of

AROUND_SHARE = 0.6
"""Share of the picture's border that each mask covers, where they are black on white."""
_PICTURES = (".npy", ".png", ".tif", ".tiff", ".bmp", ".gif", ".webp", ".pgm", ".ppm", ".pbm", ".jpg", ".jpeg")

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
        read_segments,
    ),
    Form(
        "CVAT",
        "CVAT for images",
        "polygons and masks of the photo",
        is_markup,
        read_cvat_masks,
    ),
    Form(
        "YOLO polygons",
        "Ultralytics",
        "a class number and the corners of a polygon a line, in shares of the picture",
        is_polygon_list,
        read_polygon_list,
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


MAX_OBJECTS, MANY = 500, 60
SPECK_SHARE = 1e-4
"""An instance or a loose piece of one smaller than this share of the picture is a speck."""
MIN_SPECK_PX = 20
SOFT_COLOURS, SOFT_SHARE, SOFT_WIDTH_PX = 12, 0.1, 4.0
"""Smoothed outlines: fewest colours, smallest share of the picture, and largest width."""
MIN_BORDER_SHARE, MIN_AROUND_SHARE = 0.6, 0.3
"""Shares of the picture's border and area: what is there and called no object is the background."""
MARKED_IOU = 0.5
"""Overlap of a mask's bounds with a box that marks the same."""
EVEN_SHARE = 0.8
"""Share of neighbours with different numbers: if so many differ by one, the numbers are measurements."""
InstanceBoxes = tuple[tuple[int, LabelledBox], ...]


def read_masks(
    source: Folder | Source, boxes: tuple[LabelledBox, ...], photo: DecodedPhoto
) -> tuple[Int32[np.ndarray, "h w"], InstanceBoxes, tuple[str, ...]]:
    """The instance map at the photo's size, each instance's box and class, and warnings worth showing.

    Ids run from 1 in the order in which instances are met from the top left.

    Raises:
        InputError: no masks in any form, of other proportions, or without any instance.
    """
    content = MaskContent(source, photo.photo.name, photo.frame.full_size)
    form = form_of(MASK_FORMS, content)
    assert form is not None  # the last form takes any file
    mask_map = form.read(content)
    values, laid = photo.frame.align_map(source.name, "mask", mask_map.values)
    size = (photo.photo.width, photo.photo.height)
    if (values.shape[1], values.shape[0]) != size:
        values = _resize_nearest(values, size)
    values, around = without_surroundings(with_hard_edges(values), boxes)
    instances, dropped = _without_specks(source.name, values)
    instances, split = split_by_boxes(instances, boxes)
    notes = (*around, *([f"{dropped} specks of the masks were dropped"] if dropped else []), *split)
    instances.setflags(write=False)
    return instances, match_instances(instances, boxes), (*mask_map.notes, *laid, *notes)


def with_hard_edges(values: Int32[np.ndarray, "h w"]) -> Int32[np.ndarray, "h w"]:
    """Many colours between few, as smoothed outlines have them, given to the nearest of the few."""
    ids, inverse = np.unique(values, return_inverse=True)
    if len(ids) < SOFT_COLOURS:
        return values
    height, width = values.shape
    middle = values[1:-1, 1:-1]
    filled: Bool[np.ndarray, "_ _"] = np.ones((height - 2, width - 2), bool)
    for down, across in ((0, 1), (2, 1), (1, 0), (1, 2), (0, 0), (2, 2), (0, 2), (2, 0)):
        beside = values[down : down + height - 2, across : across + width - 2]
        filled &= beside == middle
    # The colours of smoothed outlines nowhere fill three by three pixels.
    hard = np.isin(ids, middle[filled])[inverse.reshape(values.shape)]
    if np.count_nonzero(~np.isin(ids, values[hard])) < SOFT_COLOURS or not 0.0 < (~hard).mean() <= SOFT_SHARE:
        return values
    from scipy.ndimage import distance_transform_edt  # the editor opens without it

    distance, (rows, columns) = distance_transform_edt(~hard, return_indices=True)
    if float(np.percentile(distance[~hard], 95)) > SOFT_WIDTH_PX:
        return values
    return values[rows, columns]


def without_surroundings(
    values: Int32[np.ndarray, "h w"], boxes: tuple[LabelledBox, ...]
) -> tuple[Int32[np.ndarray, "h w"], tuple[str, ...]]:
    """Masks where another number or colour than 0 is what lies around all objects, with 0 there, and the note."""
    if (values == 0).any():
        return values, ()
    border = np.concatenate([values[0], values[-1], values[:, 0], values[:, -1]])
    ids, counts = np.unique(border, return_counts=True)
    around = values == ids[int(np.argmax(counts))]
    given = np.array([b.box for b in boxes], dtype=np.float64).reshape(-1, 4)
    is_marked = len(given) and box_iou(np.array(_extent(around)), given).max() > MARKED_IOU
    if counts.max() < MIN_BORDER_SHARE * len(border) or around.mean() < MIN_AROUND_SHARE or is_marked:
        return values, ()
    note = f"what lies around all others in the masks ({around.mean():.0%}) was taken for the background"
    return np.where(around, 0, values), (note,)


def split_by_boxes(
    instances: Int32[np.ndarray, "h w"], boxes: tuple[LabelledBox, ...]
) -> tuple[Int32[np.ndarray, "h w"], tuple[str, ...]]:
    """Masks of kinds, of which several boxes mark a piece each, as masks of things, and the note."""
    import cv2  # the editor opens without it

    given = np.array([b.box for b in boxes], dtype=np.float64).reshape(-1, 4)
    apart, several = instances.copy(), 0
    for k in range(1, int(instances.max()) + 1) if len(boxes) > 1 else ():
        count, labels = cv2.connectedComponents((instances == k).astype(np.uint8), connectivity=8)
        owners: dict[int, list[int]] = {}
        for piece in range(1, count):
            overlaps = box_iou(np.array(_extent(labels == piece)), given)
            if overlaps.max() > MARKED_IOU:
                owners.setdefault(int(np.argmax(overlaps)), []).append(piece)
        if len(owners) < 2 or len({boxes[index].category for index in owners}) > 1:
            continue
        several += 1
        for pieces in list(owners.values())[1:]:
            apart[np.isin(labels, pieces)] = apart.max() + 1
    note = f"{number_of(several, 'mask')} of several objects, split by the boxes"
    return apart, (note,) if several else ()


def _resize_nearest(values: Shaped[np.ndarray, "h w *c"], size: tuple[int, int]) -> Shaped[np.ndarray, "h2 w2 *c"]:
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
    steps = np.abs(np.diff(values, axis=1))
    if len(large) > MANY and np.mean(steps[steps > 0] == 1) > EVEN_SHARE:
        raise InputError(f"{name}: its numbers change evenly, as in depth or a grey photo; give one number per object")
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
    """The mask without its loose specks, and how many there were; within its bounds they are seen past what is before
    it.
    """
    import cv2  # the editor opens without it

    count, labels, stats, middles = cv2.connectedComponentsWithStats(mask, connectivity=8)
    large = np.flatnonzero(stats[1:, cv2.CC_STAT_AREA] >= least) + 1
    if not len(large):
        return np.zeros(mask.shape, bool), count - 1
    low = stats[large, :2].min(axis=0)
    high = (stats[large, :2] + stats[large, 2:4]).max(axis=0)
    within = ((middles >= low) & (middles < high)).all(axis=1)
    small = [k for k in range(1, count) if stats[k, cv2.CC_STAT_AREA] < least and not within[k]]
    return (labels > 0) & ~np.isin(labels, small), len(small)


def match_instances(instances: Int32[np.ndarray, "h w"], boxes: tuple[LabelledBox, ...]) -> InstanceBoxes:
    """Each instance with the class of the box it overlaps most; "object" where it overlaps none.

    The overlap is that of the mask's bounding box (IoU), so that a sofa's mask is not taken by the pillow's box inside
    it. A box goes whole to the mask that overlaps it most; further masks of the same box keep their own extent.
    """
    extents = {k: _extent(instances == k) for k in range(1, int(instances.max()) + 1)}
    given = np.array([b.box for b in boxes], dtype=np.float64).reshape(-1, 4)
    best: dict[int, tuple[float, int]] = {}
    for k, extent in extents.items():
        overlaps = box_iou(np.array(extent), given)
        if overlaps.size and overlaps.max() > 0:
            best[k] = (float(overlaps.max()), int(overlaps.argmax()))
    owners: dict[int, int] = {}
    for k in sorted(best, key=lambda k: (-best[k][0], k)):
        owners.setdefault(best[k][1], k)
    matched: list[tuple[int, LabelledBox]] = []
    for k, extent in extents.items():
        box = boxes[best[k][1]] if k in best else LabelledBox(extent, UNKNOWN.name, UNKNOWN.name)
        is_owner = k in best and owners[best[k][1]] == k
        matched.append((k, box if is_owner else LabelledBox(extent, box.category, box.label, box.score)))
    return tuple(matched)


def _extent(mask: np.ndarray) -> Box:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return float(columns[0]), float(rows[0]), float(columns[-1] + 1), float(rows[-1] + 1)
