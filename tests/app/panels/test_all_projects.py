from __future__ import annotations

import os

import pytest

from diorama_app.panels.all_projects import AllProjects
from diorama_core.project.storage import Project
from tests.app.page import Page
from tests.app.small_room import make_project


@pytest.fixture
def panel(session, page: Page, client) -> AllProjects:
    for k in range(15):
        folder = make_project(session.projects_dir / f"room-{k:02}").folder
        for written in (folder / "scene.json", folder / "stages" / "inputs.zip"):
            os.utime(written, (1e9 + k, 1e9 + k))
    made = page.put(AllProjects)
    client.open_projects()
    return made


def order(page: Page) -> list[str]:
    return [part.split('"', 1)[0] for part in page.html.split('data-name="')[1:]]


def test_every_project_is_reached_searched_and_sorted(session, page, panel) -> None:
    newest_first = [f"room-{k:02}" for k in range(14, -1, -1)]
    assert [name for name in order(page) if name != "demo"] == newest_first
    page.change("sort", "oldest")
    assert [name for name in order(page) if name != "demo"] == newest_first[::-1]
    page.change("sort", "name")
    assert order(page) == ["demo", *newest_first[::-1]]
    page.change("search", "ROOM-07")
    shown = [part.split(">", 1)[0] for part in page.html.split("data-name=")[1:]]
    assert [tag.split('"')[1] for tag in shown if not tag.endswith("hidden")] == ["room-07"]
    page.act("open", "room-00")
    assert session.project.name == "room-00"
    assert "All projects" not in page.html


def test_projects_are_renamed_and_copied(session, page, panel) -> None:
    page.change("rename", "Attic <1>", "room-03")
    assert Project.open(session.projects_dir / "room-03").name == "Attic <1>"
    assert "Attic &lt;1&gt;" in page.html
    page.act("copy", "room-03")
    assert Project.open(session.projects_dir / "room-03-2").name == "Attic <1> 2"


def test_what_is_deleted_is_restored(session, client, page, panel) -> None:
    offers = []
    client.offer = lambda message, label, do: offers.append((message, label, do))
    folder = session.projects_dir / "room-05"
    assert not page.shows("bin", "demo"), "the open project is not deleted"
    for _ in range(2):
        page.act("bin", "room-05")
        assert not folder.exists()
        offers[-1][2]()
        assert Project.open(folder).name == "room-05"
    assert offers[0][:2] == ("room-05 is in the bin.", "Restore")
    page.act("bin", "room-05")
    binned = next((session.projects_dir / ".bin").iterdir()).name
    page.act("unbin", binned)
    assert folder.exists()


@pytest.mark.parametrize("name", ["../demo", "/etc", "gone"])
def test_only_listed_projects_reach_the_disk(session, client, page, panel, name) -> None:
    hidden = [h for kind, label, h in page.made if label == "·"][-1]
    for do in ("open", "bin", "copy", "unbin"):
        page.send(hidden, do, name)
    assert session.project.name == "demo"
    assert client.viser_client.told == ["that project no longer exists"] * 4
