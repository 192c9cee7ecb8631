from __future__ import annotations

import pytest

from diorama_app.panels.projects import Projects
from tests.app.page import Page
from tests.app.small_room import make_project


@pytest.fixture
def taken() -> list:
    return []


@pytest.fixture
def panel(session, page: Page, client, commands, taken) -> Projects:
    make_project(session.projects_dir / "other")
    return page.put(Projects, commands, lambda name, content: taken.append((name, content)))


def test_projects_are_listed_and_opened(session, page, panel) -> None:
    page.act("open", "other")
    assert session.project.name == "other"
    assert page.shows("open", "demo")


def test_a_project_is_renamed(session, page, panel) -> None:
    page.change("rename", "Living <room>")
    assert session.project.name == "Living <room>"
    assert "Living &lt;room&gt;" in page.html


@pytest.mark.parametrize("name", ["../demo", "/etc", "gone"])
def test_only_listed_names_reach_the_disk(session, client, page, panel, name) -> None:
    hidden = [h for kind, label, h in page.made if label == "·"][-1]
    page.send(hidden, "open", name)
    assert session.project.name == "demo"
    assert client.viser_client.told == ["that project no longer exists"]


def test_notes_of_the_build_are_told(session, page, panel) -> None:
    session.notes = ("the floor was guessed <badly>",)
    panel.refresh()
    assert "The floor was guessed &lt;badly&gt;." in page.html


def test_a_new_photo_is_handed_on(page, panel, taken) -> None:
    page.upload("New from a photo", "room.jpg", b"picture")
    assert taken == [("room.jpg", b"picture")]


def test_without_a_project_it_says_so(session, page, panel) -> None:
    session.project = None
    panel.refresh()
    assert "No project is open" in page.html
