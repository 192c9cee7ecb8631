"""Files that can be made again: made once, made again when damaged, never an error."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest

from diorama_core.io.derived import derive, read_arrays, read_derived, write_arrays, write_derived
from tests.somebody_else import delete_first


def test_bytes_are_made_once(tmp_path: Path) -> None:
    path, made = tmp_path / "kind" / "file", []
    for _ in range(3):
        assert derive(path, lambda: made.append(1) or b"content", bytes) == b"content"
    assert len(made) == 1


def test_what_is_damaged_is_made_again(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    path = tmp_path / "file.json"
    path.write_bytes(b"[1, 2")
    assert derive(path, lambda: b"[1, 2, 3]", json.loads) == [1, 2, 3]
    assert path.read_bytes() == b"[1, 2, 3]"
    assert caplog.text.count("is damaged") == 1
    path.unlink()
    os.mkfifo(path)
    assert derive(path, lambda: b"[4]", json.loads) == [4], "nobody waits for a pipe"


def test_arrays_come_back_as_they_were(tmp_path: Path) -> None:
    path = tmp_path / "file.npz"
    arrays = {"a": np.arange(6, dtype=np.uint16).reshape(2, 3), "b": np.array(1.5), "c": np.zeros((0, 3), np.float32)}
    write_arrays(path, arrays)
    found = read_arrays(path, "c", "a", "b")
    assert found is not None
    for array, name in zip(found, "cab", strict=True):
        np.testing.assert_array_equal(array, arrays[name])
        assert array.dtype == arrays[name].dtype


@pytest.mark.parametrize("damage", ["absent", "empty", "cut", "text", "other arrays", "pickle"])
def test_a_damaged_file_counts_as_absent(tmp_path: Path, damage: str) -> None:
    path = tmp_path / "file.npz"
    write_arrays(path, {"a": np.arange(100)})
    whole = path.read_bytes()
    if damage == "absent":
        path.unlink()
    elif damage == "other arrays":
        write_arrays(path, {"b": np.arange(3)})
    elif damage == "pickle":
        np.savez(path, a=np.array([{}], dtype=object))
    else:
        path.write_bytes({"empty": b"", "cut": whole[: len(whole) // 2], "text": b"no archive"}[damage])
    assert read_arrays(path, "a") is None


def test_a_folder_that_cannot_be_written_costs_one_warning(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    (tmp_path / "taken").write_text("a file")
    path = tmp_path / "taken" / "file"
    assert derive(path, lambda: b"content", bytes) == b"content"
    assert len(caplog.records) == 1
    assert "cannot cache files" in caplog.text
    assert read_derived(path) is None


def test_the_least_recently_used_files_make_room(tmp_path: Path) -> None:
    arrays = {"a": np.zeros(1000, np.uint8)}
    for age, name in enumerate(["newest", "middle", "oldest"]):
        write_arrays(tmp_path / name, arrays)
        os.utime(tmp_path / name, (1e9 - age, 1e9 - age))
    size = (tmp_path / "oldest").stat().st_size
    assert read_arrays(tmp_path / "oldest", "a", mark_use=True) is not None
    write_arrays(tmp_path / "coming", arrays, limit_bytes=3 * size)
    assert {p.name for p in tmp_path.iterdir()} == {"newest", "oldest", "coming"}
    write_derived(tmp_path / "small", b"", limit_bytes=0)
    assert {p.name for p in tmp_path.iterdir()} == {"small"}


def test_room_is_made_to_the_byte_whoever_else_makes_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    delete_first(monkeypatch)
    for age, name in enumerate(["newer", "older"]):
        write_derived(tmp_path / name, bytes(10))
        os.utime(tmp_path / name, (1e9 - age, 1e9 - age))
    write_derived(tmp_path / "first", bytes(5), limit_bytes=25)
    assert {p.name for p in tmp_path.iterdir()} == {"newer", "older", "first"}
    write_derived(tmp_path / "second", bytes(5), limit_bytes=29)
    assert {p.name for p in tmp_path.iterdir()} == {"newer", "first", "second"}
