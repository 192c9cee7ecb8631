"""The GLB container: a header, a chunk of JSON and, where there is one, a chunk of binary data.

Specification: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#glb-file-format-specification
"""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Mapping
from typing import Any

MAGIC = b"glTF"
VERSION = 2
_HEADER, _CHUNK = struct.Struct("<4sII"), struct.Struct("<II")
_JSON, _BIN = 0x4E4F534A, 0x004E4942


class GlbError(ValueError):
    """A container that is cut off, of another version or without JSON; the message says which."""


def is_glb(data: bytes) -> bool:
    """Whether a file starts as a GLB does."""
    return data[:4] == MAGIC


def write_glb(document: Mapping[str, Any], binary: bytes | bytearray, *, allow_nan: bool = False) -> bytes:
    """A GLB file.

    Args:
        document: The JSON part; its first buffer's `byteLength` is the caller's to state.
        binary: What that buffer refers to; without any, the file has no binary chunk.
        allow_nan: Write numbers that are none, as they stood in a lenient author's file, instead of a `ValueError`.
    """
    text = json.dumps(document, separators=(",", ":"), allow_nan=allow_nan).encode()
    chunks = [_chunk(_JSON, text, b" "), _chunk(_BIN, binary, b"\0") if binary else b""]
    return b"".join([_HEADER.pack(MAGIC, VERSION, _HEADER.size + sum(map(len, chunks))), *chunks])


def split_glb(data: bytes) -> tuple[bytes, bytes | None]:
    """The JSON text and the binary chunk (None where there is none) of a GLB; chunks of other kinds are skipped.

    Raises:
        GlbError: when the container is malformed.
    """
    if len(data) < _HEADER.size + _CHUNK.size:
        raise GlbError("the GLB ends within its header")
    _, version, length = _HEADER.unpack_from(data)
    if version != VERSION:
        raise GlbError(f"GLB version {version} is not supported; save it as glTF 2.0")
    if length > len(data):
        raise GlbError(f"the GLB is cut off: {len(data)} of {length} bytes")
    chunks: dict[int, bytes] = {}
    for kind, chunk in _chunks(data):
        chunks.setdefault(kind, chunk)
    if _JSON not in chunks:
        raise GlbError("the GLB has no JSON chunk")
    return chunks[_JSON], chunks.get(_BIN)


def whole_glb(data: bytes) -> bytes:
    """The bytes, where they are all of a GLB.

    Raises:
        GlbError: when they are not all of a GLB.
    """
    split_glb(data)
    if not is_glb(data):
        raise GlbError("this is no GLB")
    return data


def read_glb(data: bytes) -> tuple[dict[str, Any], bytes]:
    """The document and the binary data (maybe empty) of a GLB from a trusted writer.

    Files of strangers go through `library.ingest.gltf`, which also checks what the document claims.

    Raises:
        GlbError: when the container is malformed.
    """
    if not is_glb(data):
        raise GlbError("this is no GLB")
    text, binary = split_glb(data)
    return json.loads(text), binary or b""


def _chunk(kind: int, content: bytes | bytearray, padding: bytes) -> bytes:
    padded = bytes(content) + padding * (-len(content) % 4)
    return _CHUNK.pack(len(padded), kind) + padded


def _chunks(data: bytes) -> Iterator[tuple[int, bytes]]:
    at = _HEADER.size
    while at + _CHUNK.size <= len(data):
        length, kind = _CHUNK.unpack_from(data, at)
        start = at + _CHUNK.size
        if start + length > len(data):
            raise GlbError("a chunk of the GLB is cut off")
        yield kind, data[start : start + length]
        at = start + length
