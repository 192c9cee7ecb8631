"""Small files that would unpack to very much are refused, or read, within a fixed memory.

Each reader runs in a process of its own that may take so much memory, one file after another.
"""

from __future__ import annotations

import io
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from diorama_core.errors import DioramaError
from diorama_core.io.limited import LimitedProcess
from diorama_core.perception.inputs import read_inputs
from diorama_core.pipeline import codec

MEMORY = 1_400_000_000
"""Address space; Python with its libraries takes about 0.5 of it."""


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width: int, height: int, bits: int, colour: int, channels: int) -> bytes:
    """A plain picture of many pixels in few bytes: a block of a hundred packed lines, again and again."""
    line = 1 + width * channels * bits // 8
    packer = zlib.compressobj(9, wbits=-15)
    block = packer.compress(bytes(100 * line)) + packer.flush(zlib.Z_FULL_FLUSH)
    rest = packer.compress(bytes(height % 100 * line)) + packer.flush()
    checksum = struct.pack(">I", height * line % 65521 << 16 | 1)  # Adler-32 of so many zeros
    header = struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)
    data = b"\x78\xda" + block * (height // 100) + rest + checksum
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def stage_zip(entries: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, content in entries.items():
            archive.writestr(name, content)
    return buffer.getvalue()


def npy_of(shape: tuple[int, ...], content: bytes) -> bytes:
    buffer = io.BytesIO()
    np.lib.format.write_array_header_1_0(buffer, {"descr": "|u1", "fortran_order": False, "shape": shape})
    return buffer.getvalue() + content


def read_photo_bytes(data: bytes) -> None:
    read_inputs(data, name="bomb.png")


def read_depth_bytes(data: bytes) -> None:
    read_inputs(png(640, 480, 8, 2, 3), name="p.png", depth=data)


def read_mask_bytes(data: bytes) -> None:
    read_inputs(png(640, 480, 8, 2, 3), name="p.png", masks=data)


def read_boxes_bytes(data: bytes) -> None:
    read_inputs(png(640, 480, 8, 2, 3), name="p.png", boxes=data)


def read_stage(data: bytes) -> None:
    codec.load(data)


BOMBS: dict[str, tuple[Callable[[bytes], None], Callable[[], bytes]]] = {
    "photo of 118 megapixels": (read_photo_bytes, lambda: png(12_000, 9_800, 8, 2, 3)),
    "photo of 63 megapixels, transparent": (read_photo_bytes, lambda: png(9_000, 7_000, 8, 6, 4)),
    "photo of 63 megapixels, 16 bits": (read_photo_bytes, lambda: png(9_000, 7_000, 16, 0, 1)),
    "depth of 118 megapixels": (read_depth_bytes, lambda: png(12_800, 9_600, 16, 0, 1)),
    "depth of 39 megapixels": (read_depth_bytes, lambda: png(7_200, 5_400, 16, 0, 1)),
    "masks of 39 megapixels": (read_mask_bytes, lambda: png(7_200, 5_400, 8, 2, 3)),
    "boxes of 111 MB": (read_boxes_bytes, lambda: b"[" + b'{"bbox":[1,2,30,40]},' * 5_300_000 + b"1]"),
    "boxes nested deeply": (read_boxes_bytes, lambda: b"[" * 3_900_000),
    "stage of one huge array": (
        read_stage,
        lambda: stage_zip({"tree.json": b'{"array": 0}', "0.npy": npy_of((450_000_000,), bytes(450_000_000))}),
    ),
    "stage of many arrays": (
        read_stage,
        lambda: stage_zip(
            {"tree.json": b'{"array": 0}', **{f"{i}.npy": npy_of((30_000_000,), bytes(30_000_000)) for i in range(15)}}
        ),
    ),
    "stage with a huge tree": (read_stage, lambda: stage_zip({"tree.json": b"[" + b"[]," * 12_000_000 + b"1]"})),
    "stage nested deeply": (read_stage, lambda: stage_zip({"tree.json": b'{"tuple":[' * 200_000})),
    "stage that states less than it holds": (
        read_stage,
        lambda: lying(stage_zip({"tree.json": b'{"array": 0}', "0.npy": npy_of((9,), bytes(450_000_000))})),
    ),
}


def lying(data: bytes) -> bytes:
    """An archive with small stated sizes."""
    honest = 450_000_000 + len(npy_of((9,), b""))
    return data.replace(struct.pack("<I", honest), struct.pack("<I", 500))


@pytest.fixture(scope="module")
def process_of() -> Iterator[Callable[[Callable[[bytes], None]], LimitedProcess]]:
    """The process of a reader: to start one takes longer than most bombs."""
    processes: dict[Callable[[bytes], None], LimitedProcess] = {}
    yield lambda read: processes.setdefault(read, LimitedProcess(memory=MEMORY, seconds=60.0))
    for process in processes.values():
        process.close()


@pytest.mark.slow
@pytest.mark.parametrize("name", BOMBS)
def test_bombs_end_within_the_memory_of_a_photo(
    process_of: Callable[[Callable[[bytes], None]], LimitedProcess], name: str
) -> None:
    read, made = BOMBS[name]
    line = ""
    try:
        process_of(read).call(name, read, made())
    except DioramaError as error:
        line = str(error)
    assert "needs more memory" not in line, "it was not refused beforehand"
    assert "takes too long" not in line
    assert len(line) < 400


def test_stage_results_within_the_caps_are_read() -> None:
    masks = tuple(np.zeros((1200, 1600), bool) for _ in range(10))
    again = codec.load(codec.dump(masks))
    assert all(np.array_equal(a, b) for a, b in zip(again, masks, strict=True))
