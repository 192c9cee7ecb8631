"""What a notebook shows of a room, as IPython asks for it."""

from __future__ import annotations

import base64
import io
import re

import pytest
from PIL import Image

from diorama_core.api import Reconstruction
from diorama_core.scene.types import Scene
from tests.app.small_room import PlainLibrary, furnished_scene


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
