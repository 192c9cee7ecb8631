"""Reading measured depth: 16-bit PNG or TIFF in units, `.npy` or EXR in metres; missing is 0 afterwards."""

from __future__ import annotations

import io
import math
from typing import Literal

import numpy as np
from jaxtyping import Float32, Shaped
from numpy.lib import format as npy

from diorama_core.errors import InputError
from diorama_core.perception import exr
from diorama_core.perception.input_photo import Source, load_pixels, open_picture

DepthEncoding = Literal["linear", "sunrgbd"]
"""How a PNG's 16 bits mean distance: as they are, or rotated by three bits as in SUN RGB-D."""

ASPECT_TOLERANCE = 0.02
FARTHEST_M = 80.0
"""Larger values mean that the sensor measured nothing."""
SKY_M = 1e4
"""What renderers write where there is nothing (Blender 1e10, half floats 65504) is beyond this."""
ROOM_MEDIAN_M = (0.15, 20.0)
"""Median depth of a photo of a room; outside, the unit is wrong."""
MIN_COVERAGE = 0.01
MAX_DEPTH_MEGAPIXELS = 40
LOW_COVERAGE = 0.2


def read_depth(
    source: Source, depth_scale: float, encoding: DepthEncoding, photo_size: tuple[int, int]
) -> tuple[Float32[np.ndarray, "h w"], tuple[str, ...]]:
    """Depth in metres at the photo's size (width, height), 0 where missing, and warnings worth showing.

    Raises:
        InputError: when it is no depth, its unit is implausible, or its proportions are not the photo's.
    """
    if not np.isfinite(depth_scale) or depth_scale <= 0:
        raise InputError(
            f"--depth-scale {depth_scale:g}: give a positive number of units per metre, 1000 for millimetres"
        )
    raw, in_metres = _decode(source)
    if raw.ndim != 2 or 0 in raw.shape:
        raise InputError(f"{source.name}: depth must be a picture of one channel, this has shape {raw.shape}")
    depth = raw.astype(np.float32) if in_metres else _scaled(raw, depth_scale, encoding)
    depth = _cleaned(depth, in_metres)
    notes = _check_plausible(source.name, depth, raw, in_metres, depth_scale, encoding)
    resized, more = _at_size(source.name, depth, photo_size)
    resized.setflags(write=False)
    return resized, (*notes, *more)


def _decode(source: Source) -> tuple[Shaped[np.ndarray, "h w"], bool]:
    """Raw values, and whether they are metres already."""
    if source.data.startswith(b"\x93NUMPY"):
        return _decode_npy(source), True
    if source.data.startswith(exr.MAGIC):
        try:
            return exr.read_depth_channel(source.data), True
        except exr.ExrError as error:
            raise InputError(f"{source.name}: {error}, or as .npy (metres) or 16-bit PNG") from error
    picture = open_picture(source, "depth", MAX_DEPTH_MEGAPIXELS)
    if picture.mode not in ("I;16", "I;16B", "I;16L", "I", "F"):
        raise InputError(
            f"{source.name}: depth needs one channel of 16 bits, this has mode {picture.mode}; "
            "save it as 16-bit PNG in millimetres or .npy in metres"
        )
    array = np.asarray(load_pixels(picture, source, "depth"))
    return array, picture.mode == "F"


def _decode_npy(source: Source) -> Float32[np.ndarray, "h w"]:
    """A 2D array of floats; the header is not trusted to allocate more than the file holds."""
    stream = io.BytesIO(source.data)
    try:
        version = npy.read_magic(stream)
        shape, _, dtype = npy.read_array_header_1_0(stream) if version == (1, 0) else npy.read_array_header_2_0(stream)
        if dtype.kind != "f":
            raise InputError(f"{source.name}: depth in .npy must be floats in metres, this holds {dtype}")
        if len(shape) == 3 and 1 in (shape[0], shape[2]):
            pass
        elif len(shape) != 2:
            raise InputError(f"{source.name}: depth must be two-dimensional, this has shape {shape}")
        count = math.prod(shape)
        if count > MAX_DEPTH_MEGAPIXELS * 1_000_000:
            raise InputError(
                f"{source.name}: {count / 1e6:.0f} megapixels of depth are too many; save the photo's size"
            )
        if count * dtype.itemsize > len(source.data):
            raise ValueError("fewer numbers than the header states")
        array = np.load(io.BytesIO(source.data), allow_pickle=False)
    except InputError:
        raise
    except Exception as error:  # a damaged header raises almost anything
        raise InputError(
            f"{source.name}: the .npy depth is truncated or damaged; write it again with numpy.save"
        ) from error
    with np.errstate(over="ignore"):
        return np.squeeze(array).astype(np.float32)


def _scaled(raw: Shaped[np.ndarray, "h w"], depth_scale: float, encoding: DepthEncoding) -> Float32[np.ndarray, "h w"]:
    """Units as metres, in strips: the division takes four times the room of the result."""
    depth = np.empty(raw.shape, np.float32)
    for row in range(0, len(raw), 256):
        strip = raw[row : row + 256]
        depth[row : row + 256] = (_unrotated(strip) if encoding == "sunrgbd" else strip) / depth_scale
    return depth


def _unrotated(values: Shaped[np.ndarray, "*n"]) -> Shaped[np.ndarray, "*n"]:
    """SUN RGB-D's storage undone: the 16 bits were rotated left by three."""
    v = values.astype(np.uint32)
    return ((v >> 3) | (v << 13)) & 0xFFFF


def _cleaned(depth_m: Float32[np.ndarray, "h w"], in_metres: bool) -> Float32[np.ndarray, "h w"]:
    """NaN, infinities, zero, negative values and a renderer's sky all mean missing."""
    with np.errstate(invalid="ignore"):
        seen = np.isfinite(depth_m) & (depth_m > 0) & (depth_m < (SKY_M if in_metres else np.inf))
    return np.where(seen, depth_m, 0).astype(np.float32)


def _check_plausible(
    name: str,
    depth_m: Float32[np.ndarray, "h w"],
    raw: Shaped[np.ndarray, "h w"],
    in_metres: bool,
    depth_scale: float,
    encoding: DepthEncoding,
) -> tuple[str, ...]:
    valid = depth_m[depth_m > 0]
    if depth_m.ndim != 2 or valid.size <= MIN_COVERAGE * depth_m.size:
        raise InputError(f"{name}: the depth is empty or nearly so; leave it out or choose another file")
    median = float(np.median(valid))
    if not ROOM_MEDIAN_M[0] <= median <= ROOM_MEDIAN_M[1]:
        raise InputError(f"{name}: {_unit_advice(median, raw, in_metres, depth_scale, encoding)}")
    far = depth_m > FARTHEST_M
    depth_m[far] = 0.0
    if valid.size < LOW_COVERAGE * depth_m.size:
        return (f"only {100 * valid.size / depth_m.size:.0f} % of the depth is measured",)
    return ()


def _unit_advice(
    median: float, raw: Shaped[np.ndarray, "h w"], in_metres: bool, depth_scale: float, encoding: DepthEncoding
) -> str:
    read_as = f"read this way the middle depth is {median:.3g} m, which is no room"
    if in_metres:
        return f"{read_as}; the numbers must be metres"
    if encoding == "linear":
        turned = _unrotated(raw[raw > 0]) / depth_scale
        if ROOM_MEDIAN_M[0] <= float(np.median(turned)) <= ROOM_MEDIAN_M[1] and median > ROOM_MEDIAN_M[1]:
            return f"{read_as}; it looks like SUN RGB-D's rotated bits: add --depth-encoding sunrgbd"
    return f"{read_as}; set --depth-scale (units per metre, now {depth_scale:g}) or --depth-encoding"


def _at_size(
    name: str, depth_m: Float32[np.ndarray, "h w"], photo_size: tuple[int, int]
) -> tuple[Float32[np.ndarray, "_ _"], tuple[str, ...]]:
    """Nearest neighbour, so that no depth is invented between a chair's edge and the wall behind it."""
    height, width = depth_m.shape
    if (width, height) == photo_size:
        return depth_m, ()
    check_same_proportions(name, "depth", (width, height), photo_size)
    import cv2  # the editor opens without it

    resized = cv2.resize(depth_m, photo_size, interpolation=cv2.INTER_NEAREST_EXACT)
    if width * 2 < photo_size[0]:
        return resized, (f"the depth ({width} x {height}) is much coarser than the photo",)
    return resized, ()


def check_same_proportions(name: str, what: str, size: tuple[int, int], photo_size: tuple[int, int]) -> None:
    """Refuse what cannot lie pixel on pixel over the photo.

    Raises:
        InputError: when the proportions differ by more than `ASPECT_TOLERANCE`.
    """
    ratio = (size[0] / size[1]) / (photo_size[0] / photo_size[1])
    if abs(ratio - 1.0) <= ASPECT_TOLERANCE:
        return
    turned = abs((size[1] / size[0]) / (photo_size[0] / photo_size[1]) - 1.0) <= ASPECT_TOLERANCE
    advice = "turn it upright like the photo" if turned else f"give the {what} of this very photo"
    raise InputError(
        f"{name}: the {what} is {size[0]} x {size[1]}, the upright photo is {photo_size[0]} x {photo_size[1]}; {advice}"
    )
