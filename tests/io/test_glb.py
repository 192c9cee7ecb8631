"""GLB containers: what is written is read back, by us and by another reader; what is broken is refused."""

from __future__ import annotations

import io
import json
import struct
from typing import Any

import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.io.glb import GlbError, is_glb, read_glb, split_glb, write_glb

JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**53), 2**53)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=4),
    max_leaves=12,
)
DOCUMENTS = st.dictionaries(st.text(max_size=8), JSON, max_size=6)


@given(document=DOCUMENTS, binary=st.binary(max_size=50))
def test_what_is_written_is_read_back(document: dict[str, Any], binary: bytes) -> None:
    data = write_glb(document, binary)
    found, content = read_glb(data)
    assert found == document
    assert content[: len(binary)] == binary
    assert content[len(binary) :] == b"\0" * (-len(binary) % 4)
    assert len(data) % 4 == 0
    assert struct.unpack_from("<I", data, 8)[0] == len(data)
    assert (split_glb(data)[1] is None) == (not binary)


def test_another_reader_agrees() -> None:
    box = trimesh.creation.box((1, 2, 3))
    document, binary = read_glb(trimesh.Scene(box).export(file_type="glb"))
    again = trimesh.load_scene(io.BytesIO(write_glb(document, binary)), file_type="glb")
    assert sorted(again.extents) == [1, 2, 3]


def test_chunks_of_other_kinds_are_skipped_and_the_first_of_a_kind_counts() -> None:
    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack("<I4s", len(content), kind) + content

    chunks = [chunk(b"XTRA", b"1234"), chunk(b"JSON", b'{"a": 1}'), chunk(b"BIN\0", b"abcd"), chunk(b"JSON", b"{}  ")]
    body = b"".join(chunks)
    assert read_glb(struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body) == ({"a": 1}, b"abcd")


@given(cut=st.integers(0, 10_000), document=DOCUMENTS, binary=st.binary(max_size=30))
def test_a_file_that_is_cut_off_is_refused(cut: int, document: dict[str, Any], binary: bytes) -> None:
    data = write_glb(document, binary)
    with pytest.raises(GlbError):
        read_glb(data[: cut % len(data)])


def test_other_versions_other_files_and_lengths_beyond_the_end_are_refused() -> None:
    data = write_glb({}, b"1234")
    with pytest.raises(GlbError, match="version 1 is not supported"):
        split_glb(data[:4] + struct.pack("<I", 1) + data[8:])
    with pytest.raises(GlbError, match="no JSON"):
        split_glb(data[:16] + b"XTRA" + data[20:])
    with pytest.raises(GlbError, match="chunk of the GLB is cut off"):
        split_glb(data[:12] + struct.pack("<I", 2**31) + data[16:])
    with pytest.raises(GlbError, match="no GLB"):
        read_glb(json.dumps({"asset": {"version": "2.0"}}).encode())
    assert not is_glb(b"{}")


def test_numbers_that_are_none_are_written_only_on_request() -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_glb({"extras": float("nan")}, b"")
    assert b"NaN" in write_glb({"extras": float("nan")}, b"", allow_nan=True)
