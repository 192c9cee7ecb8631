"""The containers of depth: arrays of numpy, pictures, EXR, and bare dumps of sensors."""

from __future__ import annotations

import io
import math
import zipfile
from dataclasses import dataclass

import numpy as np
from jaxtyping import Shaped
from numpy.lib import format as npy

from diorama_core.errors import InputError
from diorama_core.perception import exr
from diorama_core.perception.inputs.depth.channels import one_channel
from diorama_core.perception.inputs.depth.voids import only_sure
from diorama_core.perception.inputs.form import Form
from diorama_core.perception.inputs.photos.decoding import load_pixels, open_picture
from diorama_core.perception.inputs.source import Source

MAX_DEPTH_MEGAPIXELS = 40
_DEPTH_NAMES = ("depth", "depth_m", "depths", "metric_depth", "depth_map", "pred_depth", "pred", "z", "dpt", "arr_0")
_RELATIVE_NAMES = ("inverse_depth", "inv_depth", "disparity", "disp")
_PICTURE_STARTS = (b"\x89PNG", b"II*\0", b"MM\0*", b"II+\0", b"Pf", b"PF", b"P5", b"\xff\xd8", b"RIFF", b"BM", b"GIF8")
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


@dataclass(frozen=True)
class DepthContent:
    """A file, and the photo's size, whose proportions a bare dump must have."""

    source: Source
    photo_size: tuple[int, int]


@dataclass(frozen=True, eq=False)
class RawDepth:
    """The numbers of a depth map as they are stored."""

    values: Shaped[np.ndarray, "h w"]
    is_float: bool
    notes: tuple[str, ...] = ()
    stated_kind: str | None = None
    """"inverse" where the array's name says so."""


def is_npy(content: DepthContent) -> bool:
    """Whether it is an array of numpy."""
    return content.source.data.startswith(b"\x93NUMPY")


def read_npy(content: DepthContent) -> RawDepth:
    """An array, after its header was found to promise no more than the file holds."""
    array = _array(content.source.data, content.source.name)
    values, notes = one_channel(array, content.source.name)
    return RawDepth(values, values.dtype.kind == "f", notes)


def is_npz(content: DepthContent) -> bool:
    """Whether it is an archive of numpy's arrays."""
    data = content.source.data
    return data.startswith(b"PK\x03\x04") and b".npy" in data[:300]


def read_npz(content: DepthContent) -> RawDepth:
    """The array called `depth`, or the only one that can be a map."""
    name = content.source.name
    try:
        with zipfile.ZipFile(io.BytesIO(content.source.data)) as archive:
            if sum(m.file_size for m in archive.infolist()) > MAX_DEPTH_MEGAPIXELS * 24_000_000:
                raise InputError(f"{name}: its arrays are too large for a depth map; save depth alone")
            arrays = {m.filename.removesuffix(".npy"): archive.read(m) for m in archive.infolist()}
    except InputError:
        raise
    except Exception as error:  # a damaged archive raises almost anything
        raise InputError(f"{name}: the .npz file is truncated or damaged; write it again with numpy.savez") from error
    read = {k: _array(v, f"{name}: {k}") for k, v in arrays.items() if v.startswith(b"\x93NUMPY")}
    maps = {k: v for k, v in read.items() if v.dtype.kind in "fiu" and np.squeeze(v).ndim in (2, 3)}
    known = next((k for k in (*_DEPTH_NAMES, *_RELATIVE_NAMES) if k in maps), None)
    if known is None and len(maps) != 1:
        listed = ", ".join(read)[:120] or "nothing"
        raise InputError(f"{name}: which of its arrays is the depth ({listed})? call it 'depth', or save it as .npy")
    key = known or next(iter(maps))
    values, notes = one_channel(maps[key], name)
    kind = "inverse" if key in _RELATIVE_NAMES else None
    values, more = _trusted(values, read, key)
    return RawDepth(values, values.dtype.kind == "f", (*notes, *more), kind)


def is_exr(content: DepthContent) -> bool:
    """Whether it is an OpenEXR file."""
    return content.source.data.startswith(exr.MAGIC)


def read_exr(content: DepthContent) -> RawDepth:
    """The depth channel; of a point map, the one that is depth."""
    name = content.source.name
    try:
        values, notes = one_channel(exr.read_depth_channels(content.source.data), name)
    except exr.ExrError as error:
        raise InputError(f"{name}: {error}, or as .npy (metres) or 16-bit PNG") from error
    return RawDepth(values, True, notes)


def is_picture(content: DepthContent) -> bool:
    """Whether it begins as a picture does."""
    return content.source.data.startswith(_PICTURE_STARTS)


def read_picture(content: DepthContent) -> RawDepth:
    """One channel of 8, 16 or 32 bits, or of floating-point numbers."""
    source = content.source
    picture = open_picture(source, "depth", MAX_DEPTH_MEGAPIXELS)
    load_pixels(picture, source, "depth")
    if picture.format == "JPEG":
        raise InputError(f"{source.name}: JPEG blurs depth; save it as 16-bit PNG in millimetres or .npy in metres")
    array = np.asarray(picture)
    if picture.mode in ("RGB", "RGBA", "LA"):
        colours = array[..., : 1 if picture.mode == "LA" else 3]
        if (colours != colours[..., :1]).any():
            raise InputError(
                f"{source.name}: depth needs one channel of 16 bits, this has colours for the eye; "
                "save it as 16-bit PNG in millimetres or .npy in metres"
            )
        array = colours[..., 0]
    elif picture.mode not in ("I;16", "I;16B", "I;16L", "I", "F", "L"):
        raise InputError(
            f"{source.name}: depth needs one channel of 16 bits, this has mode {picture.mode}; "
            "save it as 16-bit PNG in millimetres or .npy in metres"
        )
    notes = ("the depth has 8 bits only, which is coarse",) if array.dtype.itemsize == 1 else ()
    return RawDepth(array, array.dtype.kind == "f", notes)


def is_dump(content: DepthContent) -> bool:
    """Whether its length is that of a map of numbers in the photo's proportions, and nothing says otherwise."""
    return content.source.suffix in ("", *DUMP_SUFFIXES) and _dump_shape(content) is not None


def read_dump(content: DepthContent) -> RawDepth:
    """Numbers without a header: of the readings that fit the length, the most usual whose neighbours are alike."""
    found = []
    for kind, size in _DUMPS:
        shape = _shape_of(len(content.source.data), size, content.photo_size)
        if shape is not None:
            values = np.frombuffer(content.source.data, np.dtype(kind)).reshape(shape)
            found.append((_roughness(values), kind, values))
    smoothest = min(f[0] for f in found)
    _, kind, values = next(f for f in found if f[0] <= 2.0 * smoothest)
    native = values.astype(np.dtype(kind).newbyteorder("="))
    words = {"<u2": "16-bit numbers", ">u2": "16-bit numbers", "<f4": "32-bit floats", "<f2": "16-bit floats"}[kind]
    note = f"the depth is a bare dump, read as {values.shape[1]} x {values.shape[0]} {words}"
    return RawDepth(native, native.dtype.kind == "f", (note,))


DEPTH_FORMS: tuple[Form[DepthContent, RawDepth], ...] = (
    Form(
        "numpy array (.npy)",
        "networks, scripts",
        "metres, or whole numbers by --depth-scale; point maps",
        is_npy,
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
        is_exr,
        read_exr,
    ),
    Form(
        "picture (PNG, TIFF, PFM, PGM)",
        "Kinect, RealSense, TUM RGB-D, ScanNet, KITTI, MiDaS",
        "whole numbers by --depth-scale (millimetres unless the picture says otherwise), or floats in metres",
        is_picture,
        read_picture,
    ),
    Form(
        "bare dump (.raw, .bin)",
        "Kinect, ARKit, RealSense",
        "16-bit numbers or floats whose count has the photo's proportions",
        is_dump,
        read_dump,
    ),
)


def _array(data: bytes, name: str) -> np.ndarray:
    """An array of numbers; the header is not trusted to allocate more than the file holds."""
    stream = io.BytesIO(data)
    try:
        version = npy.read_magic(stream)
        shape, _, dtype = npy.read_array_header_1_0(stream) if version == (1, 0) else npy.read_array_header_2_0(stream)
        if dtype.kind not in "fiub":
            raise InputError(f"{name}: depth in .npy must be floats in metres or whole numbers, this holds {dtype}")
        count = math.prod(shape)
        if count > MAX_DEPTH_MEGAPIXELS * 1_000_000 * 3:
            raise InputError(f"{name}: {count / 1e6:.0f} megapixels of depth are too many; save the photo's size")
        if count * dtype.itemsize > len(data):
            raise ValueError("fewer numbers than the header states")
        return np.asarray(np.load(io.BytesIO(data), allow_pickle=False))
    except InputError:
        raise
    except Exception as error:  # a damaged header raises almost anything
        raise InputError(f"{name}: the .npy depth is truncated or damaged; write it again with numpy.save") from error


def _trusted(
    values: Shaped[np.ndarray, "h w"], arrays: dict[str, np.ndarray], key: str
) -> tuple[Shaped[np.ndarray, "h w"], tuple[str, ...]]:
    """The map without the pixels that a mask of the same file excludes."""
    for name in ("confidence", "conf", "depth_conf", "confidence_map"):
        level = np.squeeze(arrays[name]) if name in arrays else None
        if level is not None and level.shape == values.shape and level.dtype.kind in "bu":
            return only_sure(values, level, f"its {name}")
        if level is not None:
            return values, (f"its {name} is no map of whole numbers as large as the depth; it was not used",)
    for name in ("mask", "valid", "valid_mask"):
        mask = np.squeeze(arrays[name]) if name in arrays and name != key else None
        if mask is not None and mask.shape == values.shape and 0 < np.count_nonzero(mask) < mask.size:
            return np.where(mask != 0, values, 0), (f"{np.mean(mask == 0):.0%} of the depth is excluded by its {name}",)
    return values, ()


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
