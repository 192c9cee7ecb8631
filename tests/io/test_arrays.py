from __future__ import annotations

import io
import zipfile

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as some

from diorama_core.io import arrays
from diorama_core.io.arrays import array_of, arrays_of

NUMBERS = st.sampled_from([np.uint8, np.int32, np.float16, np.float32, np.float64, np.bool_])


def npy(value: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, value)
    return buffer.getvalue()


@given(some.arrays(NUMBERS, some.array_shapes(min_dims=0, max_dims=4, min_side=0)))
def test_arrays_come_back_as_they_were(value: np.ndarray) -> None:
    again = array_of(npy(value))
    np.testing.assert_array_equal(again, value)
    assert again.dtype == value.dtype
    assert not again.flags.writeable


@pytest.mark.parametrize("value", [np.zeros((3, 4), np.float32), np.arange(5), np.float64(2.0), np.zeros((0, 2), bool)])
def test_what_numpy_writes_is_read_without_the_parser(value: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(arrays.npy, "read_array_header_1_0")
    np.testing.assert_array_equal(array_of(npy(np.asarray(value))), value)


def test_headers_are_not_believed() -> None:
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "|u1", "fortran_order": False, "shape": (1 << 50,)})
    with pytest.raises(ValueError, match="another size"):
        array_of(header.getvalue() + bytes(100))
    with pytest.raises(ValueError):
        array_of(npy(np.arange(9))[:-1])
    with pytest.raises(ValueError):
        array_of(npy(np.array([{}], dtype=object)))


def test_archives_are_capped_before_they_are_unpacked(monkeypatch: pytest.MonkeyPatch) -> None:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, a=np.zeros(100_000, np.uint8), b=np.arange(3))
    found = arrays_of(buffer.getvalue(), ["b", "a"])
    np.testing.assert_array_equal(found[0], np.arange(3))
    with pytest.raises(KeyError):
        arrays_of(buffer.getvalue(), ["c"])
    size = sum(info.file_size for info in zipfile.ZipFile(buffer).infolist())
    monkeypatch.setattr(arrays, "MAX_ARCHIVE_BYTES", size)
    assert len(arrays_of(buffer.getvalue(), ["b"])) == 1
    monkeypatch.setattr(arrays, "MAX_ARCHIVE_BYTES", size - 1)
    with pytest.raises(ValueError, match="unpack"):
        arrays_of(buffer.getvalue(), ["b"])
    with pytest.raises(zipfile.BadZipFile):
        arrays_of(b"no archive", ["b"])


@pytest.mark.parametrize("version", [(1, 0), (2, 0)])
def test_headers_that_others_write_are_read(version: tuple[int, int]) -> None:
    """Keys in another order, which the quick reader does not know."""
    value = np.arange(12.0).reshape(3, 4)
    text = b"{'shape': (3, 4), 'fortran_order': False, 'descr': '<f8'}\n"
    size = len(text).to_bytes(2 if version == (1, 0) else 4, "little")
    content = b"\x93NUMPY" + bytes(version) + size + text + value.tobytes()
    np.testing.assert_array_equal(array_of(content), value)


def test_an_entry_of_another_size_than_its_archive_says_is_refused() -> None:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a.npy", b"abc")
    content = bytearray(buffer.getvalue())
    listed = content.index(b"PK\x01\x02") + 24
    assert int.from_bytes(content[listed : listed + 4], "little") == 3
    content[listed : listed + 4] = (10).to_bytes(4, "little")
    with zipfile.ZipFile(io.BytesIO(content)) as archive, pytest.raises(ValueError, match="another size than stated"):
        arrays.entry(archive, "a.npy")
