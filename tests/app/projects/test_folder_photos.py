from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from diorama_app.projects.folder_photos import photos_of, read_camera
from diorama_app.projects.options import BuildOptions
from diorama_core.errors import InputError


def _touch(folder: Path, *names: str) -> None:
    for name in names:
        (folder / name).write_text(name)


def test_photos_come_with_what_lies_beside_them(tmp_path: Path) -> None:
    _touch(tmp_path, "a.JPG", "a.boxes.json", "a.depth.npy", "b.png", "b.masks.png", ".hidden.jpg", "notes.txt")
    (tmp_path / "a.camera.json").write_text(json.dumps({"intrinsics": [500, 500, 320, 240]}))
    (tmp_path / "deeper.jpg").mkdir()
    found, remarks = photos_of(tmp_path)
    assert [p.project for p in found] == ["a", "b"]
    first, second = (p.files() for p in found)
    assert (first.boxes, first.depth, first.masks) == (tmp_path / "a.boxes.json", tmp_path / "a.depth.npy", None)
    assert first.intrinsics == (500.0, 500.0, 320.0, 240.0)
    assert (second.boxes, second.masks) == (None, tmp_path / "b.masks.png")
    assert remarks == ()


def test_photos_of_one_name_become_two_projects(tmp_path: Path) -> None:
    _touch(tmp_path, "a.jpg", "a.png")
    assert [p.project for p in photos_of(tmp_path)[0]] == ["a.jpg", "a.png"]


def test_a_side_file_without_its_photo_is_said(tmp_path: Path) -> None:
    _touch(tmp_path, "a.jpg", "chair.boxes.json")
    assert photos_of(tmp_path)[1] == ("chair.boxes.json: there is no photo of this name; it is not used",)


@pytest.mark.parametrize("names", [(), ("notes.txt",), ("room.depth.png",)])
def test_a_folder_without_photos_is_refused(tmp_path: Path, names: tuple[str, ...]) -> None:
    _touch(tmp_path, *names)
    with pytest.raises(InputError, match="holds no photo"):
        photos_of(tmp_path)


def test_two_files_of_one_kind_are_refused(tmp_path: Path) -> None:
    _touch(tmp_path, "a.jpg", "a.depth.png", "a.depth.npy")
    with pytest.raises(InputError, match="two files of its depth"):
        photos_of(tmp_path)


def test_the_key_follows_content_and_options(tmp_path: Path) -> None:
    _touch(tmp_path, "a.jpg", "a.boxes.json")
    (photo,), options = photos_of(tmp_path)[0], BuildOptions()
    key = photo.key(options)
    (tmp_path / "a.jpg").touch()
    assert photo.key(options) == key, "the same content"
    assert photo.key(replace(options, recipe="paper")) != key
    (tmp_path / "a.boxes.json").write_text("[]")
    assert photo.key(options) != key


@pytest.mark.parametrize(
    "text", ["[]", "{}", '{"fov_deg": "wide"}', '{"fov_deg": true}', '{"intrinsics": [1, 2, 3]}', '{"zoom": 2}', "{"]
)
def test_a_camera_that_makes_no_sense_is_one_line(tmp_path: Path, text: str) -> None:
    path = tmp_path / "a.camera.json"
    path.write_text(text)
    with pytest.raises(InputError, match=r"a\.camera\.json"):
        read_camera(path)
    path.write_text('{"fov_deg": 60}')
    assert read_camera(path) == (None, 60.0)
