"""Rooms kept in project folders, as a script keeps them."""

from __future__ import annotations

import base64
import io
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import diorama_core as diorama
from diorama_core.api import Reconstruction
from diorama_core.errors import ProjectError
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.small_room import PlainLibrary, furnished_scene
from tests.few_shapes import SEATS


def test_saving_and_loading_give_the_same_room(room: diorama.Reconstruction, tmp_path: Path) -> None:
    room.save(tmp_path / "room")
    again = diorama.load(tmp_path / "room")
    assert again.scene == room.scene
    assert again.textures.keys() == room.textures.keys()
    assert again.library_name == SEATS
    assert again.inputs is not None
    assert room.inputs is not None
    assert np.array_equal(again.inputs.photo.rgb, room.inputs.photo.rgb)
    stages = json.loads((tmp_path / "room" / "project.json").read_text())["stages"]
    assert {s["stage"] for s in stages} >= {"camera", "pose", "layout"}


def test_a_loaded_room_is_saved_where_it_came_from_and_elsewhere(room: diorama.Reconstruction, tmp_path: Path) -> None:
    room.save(tmp_path / "first")
    loaded = diorama.load(tmp_path / "first")
    emptier = replace(loaded, scene=edits.remove(loaded.scene, [loaded.scene.objects[0].id]))
    textures = {p.name: p.read_bytes() for p in (tmp_path / "first" / "textures").iterdir()}
    emptier.save(tmp_path / "first")
    emptier.save(tmp_path / "second")
    assert diorama.load(tmp_path / "first").scene == emptier.scene
    assert {p.name: p.read_bytes() for p in (tmp_path / "first" / "textures").iterdir()} == textures
    second = diorama.load(tmp_path / "second")
    assert second.scene == emptier.scene
    assert second.inputs is not None
    assert second.textures.keys() == loaded.textures.keys()


def test_saving_over_other_files_is_refused(room: diorama.Reconstruction, tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(ProjectError, match="holds other files"):
        room.save(tmp_path)


def test_a_notebook_shows_the_picture_and_the_objects() -> None:
    formatters = pytest.importorskip("IPython.core.formatters", reason="needs IPython")
    room = Reconstruction(furnished_scene(), PlainLibrary(), {})
    shown, _ = formatters.DisplayFormatter().format(room)
    page = shown["text/html"]
    (picture,) = re.findall(r"data:image/jpeg;base64,([^\"]+)", page)
    assert Image.open(io.BytesIO(base64.b64decode(picture))).size == (480, 360)
    assert "5 objects" in page
    assert "chair &lt;b&gt;by the window&lt;/b&gt;" in page, "names are data"


def test_an_empty_room_is_a_line() -> None:
    assert Reconstruction(Scene(), PlainLibrary(), {})._repr_html_() == "<p>0 objects, 0 planes</p>"
