"""What can be known of a file before it is read."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest

from diorama_core.errors import InputError
from diorama_core.io.contained import content_of, unpack
from diorama_core.io.file_heads import OTHER_FILES, head_of, what_else


def zipped(path: Path, **files: bytes) -> Path:
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in files.items():
            archive.writestr(name.replace("__", "/"), content)
    return path


def test_an_archive_is_told_by_its_bytes_and_lists_its_files(tmp_path: Path) -> None:
    head = head_of(zipped(tmp_path / "scan.bin", keyframes__depth=b""))
    assert head.is_zip
    assert head.names == ("keyframes/depth",)


def test_a_missing_file_is_said_to_be_missing(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not exist"):
        head_of(tmp_path / "no.glb")


def test_a_folder_lists_what_is_in_it(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "b.png").write_bytes(b"x")
    head = head_of(tmp_path)
    assert head.is_folder
    assert head.has(".PNG")
    assert head.names == ("a/b.png",)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.blend", b"BLENDER-v300", "Blender"),
        ("a.glb", b"version https://git-lfs.github.com/spec/v1", "Git LFS"),
        ("a.obj", b"<!DOCTYPE html><html>", "web page"),
        ("a.skp", b"\xff\xfe", "SketchUp"),
        ("a.json", b'{"frames": [{"transform_matrix": []}]}', "nerfstudio"),
        ("a.json", b'{"images": [], "annotations": []}', "boxes"),
        ("a.glb", b"", "empty"),
        ("a.jpg", b"\xff\xd8\xff\xe0", "picture"),
        ("a.stp", b"ISO-10303-21;", "STEP"),
    ],
)
def test_what_is_not_read_is_said_in_words(tmp_path: Path, name: str, content: bytes, said: str) -> None:
    (tmp_path / name).write_bytes(content)
    other = what_else(head_of(tmp_path / name))
    assert other is not None
    assert said in f"{other.name}: {other.advice}"


def test_every_other_file_has_advice() -> None:
    assert all(other.name and other.advice for other in OTHER_FILES)


def test_an_archive_is_unpacked_for_a_while_and_its_only_folder_entered(tmp_path: Path) -> None:
    path = zipped(tmp_path / "a.zip", scan__room__a=b"1", scan__room__b=b"2")
    with unpack(path) as folder:
        inside = content_of(folder)
        assert inside.name == "room"
    assert not folder.exists()


def test_a_bomb_and_a_broken_archive_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "bomb.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("zeros", bytes(30_000_000))
    with pytest.raises(InputError, match="unpacks to"), unpack(path, most=10_000_000):
        pass
    (tmp_path / "cut.zip").write_bytes(path.read_bytes()[:200])
    with pytest.raises(InputError, match="cannot be unpacked"), unpack(tmp_path / "cut.zip"):
        pass
