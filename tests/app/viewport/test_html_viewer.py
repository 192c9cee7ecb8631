"""The self-contained viewer; tests/e2e/test_html_viewer.py opens it."""

from __future__ import annotations

import html
import re

import pytest

from diorama_app.viewport.html_viewer import write_html
from diorama_core.errors import Cancelled
from diorama_core.export.gathering import gather
from diorama_core.progress import CancelToken, Progress
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()


def test_the_page_names_the_scene_and_its_viewer(tmp_path, capsys) -> None:
    write_html(gather(furnished_room(LIBRARY), LIBRARY, name="My <room>"), tmp_path / "room.html")
    page = (tmp_path / "room.html").read_text()
    assert "<title>My &lt;room&gt;</title>" in page
    assert "Apache License 2.0" in page
    assert not re.search(r"<(script|link)[^>]+(src|href)=.?https?:", page)
    printed = capsys.readouterr().out.splitlines()
    assert {line for line in printed if "Server stopped" not in line} == set()  # a server of an earlier test may say so


@pytest.mark.parametrize("name", [r"C:\temp\1 \g<0>", "half \udce9", "\\"])
def test_any_name_becomes_the_title_as_it_is(tmp_path, name: str) -> None:
    """The name was taken for a template, in which a backslash begins an escape."""
    write_html(gather(furnished_room(LIBRARY), LIBRARY, name=name), tmp_path / "room.html")
    title = html.escape(name.replace("\udce9", "\ufffd"))
    assert f"<title>{title}</title>" in (tmp_path / "room.html").read_text()


def test_cancelling_leaves_nothing(tmp_path) -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        write_html(gather(furnished_room(LIBRARY), LIBRARY), tmp_path / "room.html", Progress(token=token))
    assert list(tmp_path.iterdir()) == []
