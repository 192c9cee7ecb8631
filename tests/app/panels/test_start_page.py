from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_app.panels.start_page import EXAMPLES, PICTURES, StartPage
from diorama_core.geometry.planes import plane_rectangle
from tests.app.page import Page


@pytest.fixture
def taken() -> list[tuple[str, bytes]]:
    return []


@pytest.fixture
def panel(page: Page, client, taken) -> StartPage:
    return page.put(StartPage, lambda name, content: taken.append((name, content)))


def test_it_opens_by_itself_only_where_the_program_was_started_without_a_project(session, page, panel) -> None:
    assert "data-auto" not in page.html
    session.greets = True
    panel.refresh()
    assert "data-auto" in page.html
    assert "An empty room" not in page.html, "not before the page asks"
    page.act("begin")
    assert "An empty room" in page.html
    assert all(name in page.html for name in EXAMPLES.values())


def test_escape_closes_it(client, page, panel) -> None:
    panel.open()
    assert client.dialog is not None
    client.dialog()
    assert client.dialog is None
    assert "An empty room" not in page.html


def test_an_empty_room_of_the_lengths_given(session, client, page, panel) -> None:
    panel.open()
    page.change("length", "3.2", "Width")
    page.change("length", "410 cm", "Depth")
    before = session.project
    page.change("length", "much", "Height")
    assert 'value="much"' in page.html, "it stays there to be corrected"
    page.act("empty")
    assert session.project is before, "no room of another height than the one that was typed"
    page.change("length", "2.5", "Height")
    assert "aria-invalid" not in page.html
    page.act("empty")
    np.testing.assert_allclose(plane_rectangle(session.scene.plane("floor"))[2], (3.2, 4.1))
    assert session.scene.plane("wall_1").texture in session.textures
    assert session.project.name == "Empty room"


def test_a_photo_is_taken_and_an_earlier_project_opened(session, client, page, panel, taken) -> None:
    panel.open()
    page.upload("Start with a file", "room.usd", b"no scene")
    panel.open()
    folder = session.project.folder
    page.act("project", folder.name)
    assert session.project.folder == folder
    with pytest.raises(AssertionError, match="nothing on the page"):
        page.act("project", "../elsewhere")


def test_every_example_has_a_picture() -> None:
    for kind in EXAMPLES:
        assert (PICTURES / f"{kind}.jpg").stat().st_size < 20_000, Path(kind)
