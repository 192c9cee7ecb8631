"""Exported files are whole or not there, and what killed programs left of them goes."""

from __future__ import annotations

import os
import time
import zipfile
from pathlib import Path

import pytest

from diorama_core.export.files import PART, add_entry, whole_file, write_package, write_whole


def _old(path: Path) -> Path:
    at = time.time() - 7200.0
    os.utime(path, (at, at))
    return path


def test_what_killed_programs_left_is_removed_and_nothing_else(tmp_path: Path) -> None:
    left = tmp_path / f"{PART}abc.glb"
    left.write_bytes(b"half")
    _old(left)
    folder = tmp_path / f"{PART}def"
    (folder / "room_files").mkdir(parents=True)
    _old(folder)
    young, own = tmp_path / f"{PART}ghi.glb", tmp_path / ".room.abc.glb"
    young.write_bytes(b"another program writes it")
    own.write_bytes(b"the user's")
    _old(own)
    write_whole(tmp_path / "room.glb", b"whole")
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted([young.name, own.name, "room.glb"])


def test_a_failure_leaves_the_older_file_and_no_part(tmp_path: Path) -> None:
    path = tmp_path / "room.glb"
    write_whole(path, b"older")

    def entries():
        yield "room_files/a.bin", b"a"
        raise RuntimeError("the writer fails")

    def write_half() -> None:
        with whole_file(path) as temporary:
            temporary.write_bytes(b"half")
            raise RuntimeError("the writer fails")

    with pytest.raises(RuntimeError):
        write_half()
    with pytest.raises(RuntimeError):
        write_package(tmp_path / "room.obj", "room.obj", entries())
    assert path.read_bytes() == b"older"
    assert [p.name for p in tmp_path.iterdir()] == ["room.glb"]


@pytest.mark.skipif(os.name != "posix", reason="modes are those of POSIX")
@pytest.mark.parametrize("umask", [0o022, 0o077])
def test_the_mode_is_what_the_umask_says(umask: int, tmp_path: Path) -> None:
    before = os.umask(umask)
    try:
        write_whole(tmp_path / "room.glb", b"whole")
        write_package(tmp_path / "room.obj", "room.obj", [("room_files/a.bin", b"a"), ("room.obj", b"main")])
    finally:
        os.umask(before)
    files = [p for p in tmp_path.rglob("*") if p.is_file()]
    assert {p.stat().st_mode & 0o777 for p in files} == {0o666 & ~umask}
    assert len(files) == 3


def test_entries_of_zips_are_the_same_at_any_time_and_pictures_are_stored(tmp_path: Path) -> None:
    text, picture = b"v 0 0 0\n" * 1000, bytes(range(256)) * 10
    written = []
    for name in ("one.zip", "two.zip"):
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            add_entry(archive, "a/model.obj", text)
            add_entry(archive, "a/oak.png", picture)
        written.append((tmp_path / name).read_bytes())
        time.sleep(0.01)
    assert written[0] == written[1]
    with zipfile.ZipFile(tmp_path / "one.zip") as archive:
        assert (archive.read("a/model.obj"), archive.read("a/oak.png")) == (text, picture)
        assert archive.getinfo("a/model.obj").compress_size < len(text) / 10
        assert archive.getinfo("a/oak.png").compress_type == zipfile.ZIP_STORED
