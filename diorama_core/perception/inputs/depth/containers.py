"""The containers of depth: arrays of numpy, pictures, EXR, tables of numbers, and bare dumps of sensors."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Callable

import numpy as np
from jaxtyping import Shaped

from diorama_core.errors import InputError
from diorama_core.perception import exr
from diorama_core.perception.inputs.depth.channels import depth_of_colours, one_channel
from diorama_core.perception.inputs.depth.numpy_files import (
    MAX_DEPTH_MEGAPIXELS,
    DepthContent,
    RawDepth,
    is_npz,
    read_npy,
    read_npz,
)
from diorama_core.perception.inputs.photos.decoding import load_pixels, open_picture
from diorama_core.perception.inputs.source import Form

MIN_SIDE = 24
"""Rows and columns: lists of boxes, cameras and points are narrower."""
_ROW = re.compile(rb"[0-9eE.,;\t +-]+|(?i:[0-9eE.,;\t +-]|nan|inf)+")
_SEPARATED = re.compile(rb"[\s,;]+")


def is_number_table(content: DepthContent) -> bool:
    """Whether its first lines are rows of equally many numbers, as many as a picture has columns."""
    head = content.source.data[:400_000].lstrip(b"\xef\xbb\xbf").splitlines()[:MIN_SIDE]
    counts = {len(_SEPARATED.split(row.strip())) for row in head if _ROW.fullmatch(row)}
    numbers_only = len(head) == MIN_SIDE and all(_ROW.fullmatch(row) for row in head)
    return numbers_only and len(counts) == 1 and min(counts) >= MIN_SIDE


def read_number_table(content: DepthContent) -> RawDepth:
    """The numbers; whole ones are millimetres unless the picture says otherwise."""
    source = content.source
    text = re.sub(rb"[,;\t]+", b" ", source.data.lstrip(b"\xef\xbb\xbf"))
    try:
        values = np.loadtxt(io.BytesIO(text), dtype=np.float64, ndmin=2)
    except (ValueError, OverflowError) as error:
        raise InputError(f"{source.name}: a row of the table of depth is damaged; save it as .npy") from error
    if min(values.shape) < MIN_SIDE:
        raise InputError(f"{source.name}: a table of {values.shape[1]} x {values.shape[0]} numbers is no depth map")
    whole = bool((values == np.round(values)).all()) and float(np.median(values)) > MAX_WHOLE_METRES
    return RawDepth(values.astype(np.int64) if whole else values)


_PICTURE_STARTS = (b"\x89PNG", b"II*\0", b"MM\0*", b"II+\0", b"Pf", b"PF", b"P5", b"\xff\xd8", b"RIFF", b"BM", b"GIF8")
MAX_WHOLE_METRES = 100.0
"""Whole numbers beyond are no metres of a room."""
_DUMPS = (("<u2", 2), ("<f4", 4), (">u2", 2), ("<f2", 2))
"""Numbers of sensors' dumps, most usual first, and their bytes."""
DUMP_SUFFIXES = (".raw", ".bin", ".dat", ".depth", ".data")
_DUMP_WIDTHS = (
    160,
    192,
    224,
    240,
    256,
    320,
    384,
    424,
    480,
    512,
    518,
    576,
    640,
    720,
    768,
    848,
    960,
    1024,
    1280,
    1440,
    1920,
)


def _has_sixteen_bits(data: bytes) -> bool:
    """Whether a PNG has colours of 16 bits, of which Pillow reads the upper eight."""
    return data.startswith(b"\x89PNG") and data[24:26] in (b"\x10\x02", b"\x10\x06")


def _sixteen_bits(data: bytes) -> Shaped[np.ndarray, "h w 3"]:
    import cv2  # the editor opens without it

    return np.asarray(cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED))[..., 2::-1]


def read_exr(content: DepthContent) -> RawDepth:
    """The depth channel; of a point map, the one that is depth."""
    name = content.source.name
    try:
        values, notes = one_channel(exr.read_depth_channels(content.source.data), name)
    except exr.ExrError as error:
        raise InputError(f"{name}: {error}, or as .npy (metres) or 16-bit PNG") from error
    return RawDepth(values, notes)


def read_picture(content: DepthContent) -> RawDepth:
    """One channel of 8, 16 or 32 bits, or of floating-point numbers."""
    source = content.source
    picture = open_picture(source, "depth", MAX_DEPTH_MEGAPIXELS)
    load_pixels(picture, source, "depth")
    if picture.format == "JPEG":
        raise InputError(f"{source.name}: JPEG blurs depth; save it as 16-bit PNG in millimetres or .npy in metres")
    array, packed = np.asarray(picture), tuple[str, ...]()
    if picture.mode in ("RGB", "RGBA"):
        depth = depth_of_colours(_sixteen_bits(source.data) if _has_sixteen_bits(source.data) else array[..., :3])
        if depth is None:
            raise InputError(
                f"{source.name}: depth needs one channel of 16 bits, this has colours for the eye; "
                "save it as 16-bit PNG in millimetres or .npy in metres"
            )
        array, packed = depth
    elif picture.mode == "LA":
        array = array[..., 0]
    elif picture.mode not in ("I;16", "I;16B", "I;16L", "I", "F", "L"):
        raise InputError(
            f"{source.name}: depth needs one channel of 16 bits, this has mode {picture.mode}; "
            "save it as 16-bit PNG in millimetres or .npy in metres"
        )
    notes = ("the depth has 8 bits only, which is coarse",) if array.dtype.itemsize == 1 else ()
    return RawDepth(array, (*packed, *notes))


def is_dump(content: DepthContent) -> bool:
    """Whether its length is that of a map of numbers in the photo's proportions, and nothing says otherwise."""
    return content.source.suffix in ("", *DUMP_SUFFIXES) and _dump_shape(content) is not None


def read_dump(content: DepthContent) -> RawDepth:
    """Numbers without a header: of the readings that fit the length, the most usual whose neighbours are alike."""
    arrays = []
    for kind, size in _DUMPS:
        shape = _shape_of(len(content.source.data), size, content.photo_size)
        if shape is not None:
            values = np.frombuffer(content.source.data, np.dtype(kind)).reshape(shape)
            arrays.append((_roughness(values), kind, values))
    smoothest = min(f[0] for f in arrays)
    _, kind, values = next(f for f in arrays if f[0] <= 2.0 * smoothest)
    native = values.astype(np.dtype(kind).newbyteorder("="))
    words = {"<u2": "16-bit numbers", ">u2": "16-bit numbers", "<f4": "32-bit floats", "<f2": "16-bit floats"}[kind]
    note = f"the depth is a bare dump, read as {values.shape[1]} x {values.shape[0]} {words}"
    return RawDepth(native, (note,))


def _begins(*starts: bytes) -> Callable[[DepthContent], bool]:
    return lambda content: content.source.data.startswith(starts)


DEPTH_FORMS: tuple[Form[DepthContent, RawDepth], ...] = (
    Form(
        "numpy array (.npy)",
        "networks, scripts",
        "metres, or whole numbers by --depth-scale; point maps",
        _begins(b"\x93NUMPY"),
        read_npy,
    ),
    Form(
        "numpy archive (.npz)",
        "Depth Pro, UniDepth, scripts",
        "the array `depth`, or the only one",
        is_npz,
        read_npz,
    ),
    Form(
        "OpenEXR (.exr)",
        "Blender, V-Ray, Unreal",
        "channel Z, or the depth of a point map, in metres",
        _begins(exr.MAGIC),
        read_exr,
    ),
    Form(
        "picture (PNG, TIFF, PFM, PGM)",
        "Kinect, RealSense, TUM RGB-D, ScanNet, KITTI, MiDaS",
        "whole numbers by --depth-scale (millimetres unless the picture says otherwise), or floats in metres",
        _begins(*_PICTURE_STARTS),
        read_picture,
    ),
    Form(
        "table of numbers (.txt, .csv)",
        "numpy's savetxt, MATLAB, spreadsheets",
        "a row for each row of the picture; whole numbers by --depth-scale, others in metres",
        is_number_table,
        read_number_table,
    ),
    Form(
        "bare dump (.raw, .bin)",
        "Kinect, ARKit, RealSense",
        "16-bit numbers or floats whose count has the photo's proportions",
        is_dump,
        read_dump,
    ),
)


def _dump_shape(content: DepthContent) -> tuple[int, int] | None:
    shapes = (_shape_of(len(content.source.data), size, content.photo_size) for _, size in _DUMPS)
    return next((s for s in shapes if s is not None), None)


def _shape_of(length: int, size: int, photo_size: tuple[int, int]) -> tuple[int, int] | None:
    """Rows and columns of so many bytes in the photo's proportions; sensors' usual widths before others."""
    if length % size:
        return None
    count, ratio = length // size, photo_size[0] / photo_size[1]
    middle = math.sqrt(count * ratio)
    near = range(max(1, int(middle * 0.99)), int(middle * 1.01) + 2)
    fitting = [w for w in near if count % w == 0 and abs(w / (count // w) / ratio - 1.0) <= 0.02 and w >= 32]
    known = [w for w in fitting if w in _DUMP_WIDTHS or count // w in _DUMP_WIDTHS] or fitting
    width = min(known, key=lambda w: abs(w - middle), default=None)
    return None if width is None else (count // width, width)


def _roughness(values: np.ndarray) -> float:
    """How much neighbours differ, over how much distant pixels do; infinite where the numbers are none."""
    some = values.astype(np.float64)
    known = np.isfinite(some) & (np.abs(some) < 1e6)
    if known.mean() < 0.5 or np.ptp(some[known]) == 0:
        return math.inf
    some = np.where(known, some, 0.0)
    return float(
        np.abs(np.diff(some, axis=1)).mean()
        / max(np.abs(some - np.roll(some, some.shape[1] // 3, axis=1)).mean(), 1e-12)
    )
