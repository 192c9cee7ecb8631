"""Reading one channel of an OpenEXR file: enough for depth maps as renderers write them.

Single-part scan-line files with 16- or 32-bit floats, uncompressed or with RLE, ZIPS or ZIP compression. After the
OpenEXR file layout (openexr.com/en/latest/OpenEXRFileLayout.html). The installed OpenCV has no reader for it.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32

MAGIC = b"\x76\x2f\x31\x01"
DEPTH_CHANNELS = ("Z", "V", "Y", "depth.Z", "Depth.Z", "ViewLayer.Depth.Z", "depth.V", "Depth.V", "R")
"""Names under which renderers store depth, most telling first."""

_TYPES: dict[int, np.dtype] = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
_LINES_PER_BLOCK = {0: 1, 1: 1, 2: 1, 3: 16}
_NAMES = {4: "PIZ", 5: "PXR24", 6: "B44", 7: "B44A", 8: "DWAA", 9: "DWAB"}
_TILED, _DEEP, _MULTI_PART = 0x200, 0x800, 0x1000
_MAX_PIXELS = 120_000_000
_DAMAGED = "the EXR file is truncated or damaged; save it again"


class ExrError(ValueError):
    """The file is damaged, or of a kind that is not read; the message says which."""


@dataclass(frozen=True)
class _Header:
    width: int
    height: int
    top: int
    compression: int
    channels: tuple[tuple[str, np.dtype], ...]
    end: int


def read_depth_channel(data: bytes) -> Float32[np.ndarray, "h w"]:
    """The depth channel of an EXR file as it is stored.

    Raises:
        ExrError: not an EXR file, damaged, without such a channel, or of a kind that is not read.
    """
    try:
        header = _header(data)
        rows = _rows(data, header)
    except (struct.error, zlib.error, IndexError, KeyError, UnicodeDecodeError, ValueError) as error:
        if isinstance(error, ExrError):
            raise
        raise ExrError(_DAMAGED) from error
    return rows


def _header(data: bytes) -> _Header:
    if data[:4] != MAGIC:
        raise ExrError("this is not an EXR file; save it again")
    flags = struct.unpack_from("<I", data, 4)[0]
    if flags & (_TILED | _DEEP | _MULTI_PART):
        raise ExrError("tiled, deep and multi-part EXR files are not read; save single-part scan lines")
    fields, at = {}, 8
    while data[at] != 0:
        name, at = _text(data, at)
        _, at = _text(data, at)
        size = struct.unpack_from("<I", data, at)[0]
        fields[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    compression = fields["compression"][0]
    if compression not in _LINES_PER_BLOCK:
        raise ExrError(
            f"{_NAMES.get(compression, 'this')} compression is not read in EXR; save it with ZIP compression"
        )
    left, top, right, bottom = struct.unpack("<4i", fields["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    if width <= 0 or height <= 0 or width * height > _MAX_PIXELS:
        raise ExrError(f"{width} x {height} pixels are not a usable size; save it at the photo's size")
    return _Header(width, height, top, compression, _channels(fields["channels"]), at + 1)


def _channels(field: bytes) -> tuple[tuple[str, np.dtype], ...]:
    """Names and types in the order in which a line stores them."""
    found: list[tuple[str, np.dtype]] = []
    at = 0
    while field[at] != 0:
        name, at = _text(field, at)
        kind, _, x_step, y_step = struct.unpack_from("<iIii", field, at)
        if (x_step, y_step) != (1, 1):
            raise ExrError("EXR channels of reduced resolution are not read; save full resolution")
        found.append((name, _TYPES[kind]))
        at += 16
    return tuple(found)


def _text(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _rows(data: bytes, header: _Header) -> Float32[np.ndarray, "h w"]:
    names = [name for name, _ in header.channels]
    wanted = next((n for n in DEPTH_CHANNELS if n in names), names[0] if len(names) == 1 else None)
    if wanted is None:
        raise ExrError(f"none of its channels ({', '.join(names)}) is called Z; save depth under that name")
    before = sum(t.itemsize for n, t in header.channels[: names.index(wanted)]) * header.width
    kind = header.channels[names.index(wanted)][1]
    line_bytes = sum(t.itemsize for _, t in header.channels) * header.width
    per_block = _LINES_PER_BLOCK[header.compression]
    blocks = -(-header.height // per_block)
    offsets = struct.unpack_from(f"<{blocks}Q", data, header.end)
    out = np.zeros((header.height, header.width), dtype=np.float32)
    for offset in offsets:
        y, size = struct.unpack_from("<iI", data, offset)
        first = y - header.top
        lines = min(per_block, header.height - first)
        raw = _unpacked(data[offset + 8 : offset + 8 + size], lines * line_bytes, header.compression)
        block = np.frombuffer(raw, np.uint8).reshape(lines, line_bytes)
        values = np.ascontiguousarray(block[:, before : before + kind.itemsize * header.width]).view(kind)
        with np.errstate(over="ignore"):
            out[first : first + lines] = values
    return out


def _unpacked(packed: bytes, size: int, compression: int) -> bytes:
    """Undo compression, then the predictor and the interleaving that make it effective."""
    if compression == 0 or len(packed) == size:
        return packed
    shuffled = _run_lengths(packed) if compression == 1 else zlib.decompressobj().decompress(packed, size)
    if len(shuffled) != size:
        raise ExrError(_DAMAGED)
    steps = np.frombuffer(shuffled, np.uint8).astype(np.int64)
    steps[1:] -= 128
    plain = np.cumsum(steps).astype(np.uint8)
    half = (size + 1) // 2
    out = np.empty(size, np.uint8)
    out[0::2], out[1::2] = plain[:half], plain[half:]
    return out.tobytes()


def _run_lengths(packed: bytes) -> bytes:
    out, at = bytearray(), 0
    while at < len(packed):
        count = packed[at] - 256 if packed[at] > 127 else packed[at]
        if count < 0:
            out += packed[at + 1 : at + 1 - count]
            at += 1 - count
        else:
            out += packed[at + 1 : at + 2] * (count + 1)
            at += 2
    return bytes(out)
