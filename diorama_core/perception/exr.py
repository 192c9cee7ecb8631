"""Reading the depth channel of an OpenEXR file, of any compression, scan lines or tiles, with the OpenEXR library.

The library is native code; it runs in the decoding process (`io.limited`), so that a damaged file costs one line.
"""

from __future__ import annotations

import io

import numpy as np
from jaxtyping import Float32

from diorama_core.errors import InputError, UnavailableError
from diorama_core.io.limited import LimitedProcess

MAGIC = b"\x76\x2f\x31\x01"
DEPTH_CHANNELS = ("Z", "V", "Y", "depth.Z", "Depth.Z", "ViewLayer.Depth.Z", "depth.V", "Depth.V", "R")
"""Names under which renderers store depth, most telling first."""

COLOURS = ("R", "G", "B")
"""Three channels that may be one depth three times, or the x, y and z of the pixels' points."""
MAX_PIXELS = 40_000_000
MAX_BYTES = 1_200_000_000
"""Size of all channels together, which the library decodes at once."""
MAX_PARTS = 16

_process = LimitedProcess()


class ExrError(InputError):
    """The file is damaged, or of a kind that is not read; the message says which."""


def read_depth_channels(data: bytes) -> Float32[np.ndarray, "h w *c"]:
    """The depth channel of an EXR file as it is stored; of several parts, the first that has one.

    Where only red, green and blue may hold it, all three come back: they may be equal, or the points of the pixels.

    Raises:
        ExrError: not an EXR file, damaged, without such a channel, or larger than a photo.
        UnavailableError: the OpenEXR library is not installed.
    """
    if data[:4] != MAGIC:
        raise ExrError("this is not an EXR file; save it again")
    try:
        return _process.call("the EXR file", decode_depth_channels, data)
    except (ExrError, UnavailableError):
        raise
    except InputError as error:
        raise ExrError(str(error)) from error


def decode_depth_channels(data: bytes) -> Float32[np.ndarray, "h w *c"]:
    """`read_depth_channels` in this process."""
    try:
        import OpenEXR
    except ImportError as error:
        raise UnavailableError("EXR depth needs the OpenEXR library: pip install OpenEXR; or save as .npy") from error
    try:
        about = OpenEXR.File(io.BytesIO(data), header_only=True, num_threads=0)
        headers = [part.header for part in about.parts]
    except Exception as error:  # the library raises almost anything; each means the same to the user
        raise ExrError("the EXR file is truncated or damaged; save it again") from error
    part, name = _find_depth_channel(headers)
    try:
        whole = OpenEXR.File(io.BytesIO(data), separate_channels=True, num_threads=0)
        if len(whole.parts) != len(headers):
            raise ValueError("the library leaves out parts that it cannot read")
        channels = whole.parts[part].channels
        names = [name, *(n for n in COLOURS[1:] if name == COLOURS[0] and n in channels)]
        planes = [np.asarray(channels[n].pixels) for n in names]
    except MemoryError:
        raise
    except Exception as error:  # as above
        raise ExrError("the EXR file is truncated or damaged; save it again") from error
    if any(p.ndim != 2 or p.dtype.kind not in "fu" or p.shape != planes[0].shape for p in planes):
        raise ExrError(f"its channel {name} is no plain picture of numbers; save depth under the name Z")
    with np.errstate(over="ignore", invalid="ignore"):
        values = [p.astype(np.float32) for p in planes]
    return np.stack(values, axis=-1) if len(values) == len(COLOURS) else values[0]


def _find_depth_channel(headers: list[dict]) -> tuple[int, str]:
    """Part and channel of the depth, after all that will be decoded was found to fit into memory."""
    total, match = 0, None
    if len(headers) > MAX_PARTS:
        raise ExrError(f"{len(headers)} parts are more than a depth map has; save it alone")
    for index, header in enumerate(headers):
        if "deep" in str(header.get("type", "")).lower():
            raise ExrError("deep EXR files are not read; save flat pixels")
        low, high = (np.asarray(corner, dtype=object) for corner in header["dataWindow"])
        width, height = (int(n) + 1 for n in high - low)
        if width <= 0 or height <= 0 or width * height > MAX_PIXELS:
            raise ExrError(f"{width} x {height} pixels are not a usable size; save it at the photo's size")
        names = [str(channel.name) for channel in header["channels"]]
        total += width * height * 4 * len(names)
        if total > MAX_BYTES:
            raise ExrError(f"{len(names)} channels of {width} x {height} pixels are too many; save depth alone")
        wanted = next((n for n in DEPTH_CHANNELS if n in names), names[0] if len(names) == 1 else None)
        match = (index, wanted) if match is None and wanted is not None else match
    if match is None:
        names = [str(channel.name) for header in headers for channel in header["channels"]]
        raise ExrError(f"none of its channels ({', '.join(names[:8])[:100]}) is called Z; save depth under that name")
    return match
