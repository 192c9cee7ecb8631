"""What is downloaded: one file, whatever a format writes. Sizes of pictures that the page can make."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import pytest

from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_app.reconstruction.written_files import (
    MAX_FILM_WIDTH,
    MAX_WIDTH,
    download_suffix,
    file_stem,
    film_suffix,
    pack,
    picture_size,
    size_in_words,
    take_picture,
)
from diorama_app.session.client import Client
from diorama_core.errors import EditRefused, InputError
from diorama_core.scene.types import Architecture, Scene


@pytest.mark.parametrize(("name", "suffix"), [("glb", ".glb"), ("mjcf", ".zip"), ("obj", ".zip"), ("html", ".html")])
def test_formats_of_several_files_are_downloaded_as_a_zip(name: str, suffix: str) -> None:
    assert download_suffix(EXPORT_FORMATS[name]) == suffix


def test_one_file_is_handed_over_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "room.glb").write_bytes(b"model")
    assert pack(tmp_path, "room.zip") == ("room.glb", b"model")


def test_a_file_with_companions_is_packed_with_their_places(tmp_path: Path) -> None:
    (tmp_path / "room.usda").write_text("stage")
    (tmp_path / "room_files").mkdir()
    (tmp_path / "room_files" / "wood.png").write_bytes(b"picture")
    name, content = pack(tmp_path, "room-usda.zip")
    assert name == "room-usda.zip"
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert {n: archive.read(n) for n in archive.namelist()} == {
            "room.usda": b"stage",
            "room_files/wood.png": b"picture",
        }


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("My room", "My-room"),
        ("../../etc/passwd", "etc-passwd"),
        ("Wohnküche", "Wohnküche"),
        ("…", "scene"),
        ("", "scene"),
    ],
)
def test_names_of_projects_become_names_of_files(name: str, stem: str) -> None:
    assert file_stem(name) == stem


def test_sizes_are_said_in_words() -> None:
    assert [size_in_words(n) for n in (3, 1500, 2_345_678)] == ["1 kB", "2 kB", "2.3 MB"]


def test_sizes_follow_the_photo_the_view_and_what_films_need(client: Client) -> None:
    camera = client.session.scene.camera
    assert camera is not None
    width, height = picture_size(client, "photo", 800)
    assert width == 800
    assert height == round(800 * camera.intrinsics.height / camera.intrinsics.width)
    film = picture_size(client, "turntable", 641)
    assert film[0] % 2 == film[1] % 2 == 0
    assert film[0] == 640
    assert film_suffix() in (".gif", ".mp4")


@pytest.mark.parametrize(("view", "width"), [("here", 15), ("photo", MAX_WIDTH + 1), ("turntable", MAX_FILM_WIDTH + 1)])
def test_widths_beyond_the_limits_are_refused_in_one_line(client: Client, view: str, width: int) -> None:
    with pytest.raises(InputError, match=f"{width} pixels wide"):
        picture_size(client, view, width)


def test_nothing_to_draw_is_said(client: Client) -> None:
    client.session.commit("empty", Scene(camera=None, architecture=Architecture(())))
    with pytest.raises(EditRefused, match="nothing to draw"):
        take_picture(client, "here", 640)
