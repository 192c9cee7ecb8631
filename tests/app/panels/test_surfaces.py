from __future__ import annotations

import numpy as np
import pytest

from diorama_app.panels.surfaces import Surfaces
from diorama_app.web.html import Action
from diorama_core.appearance.patterns import COLOURS
from diorama_core.errors import EditRefused
from tests.app.page import Page


@pytest.fixture
def panel(page: Page, client) -> Surfaces:
    return page.put(Surfaces)


def test_nothing_is_shown_until_a_surface_is_chosen(session, client, page, panel) -> None:
    assert "sample" not in page.html
    client.select_surface("wall_1")
    session.ui_thread.wait()
    assert "Wall 1" in page.html
    assert "Metro tiles" in page.html
    client.select(["chair_1"])
    assert client.surface is None


def test_a_wall_is_tiled_painted_and_put_back(session, client, page, panel) -> None:
    client.select_surface("wall_1")
    session.ui_thread.wait()
    page.act("pattern", "metro")
    wall = session.scene.plane("wall_1")
    assert wall.finish is not None
    assert wall.texture in session.textures
    assert session.scene.plane("wall_2").finish is None
    page.act("colour", "sage")
    page.change("scale", "150 %")
    page.change("direction", "-45")
    finish = session.scene.plane("wall_1").finish
    assert finish.colour == COLOURS["sage"]
    assert finish.scale == 1.5
    assert np.degrees(finish.direction_rad) == pytest.approx(315.0)
    page.act("turn", 90)
    assert np.degrees(session.scene.plane("wall_1").finish.direction_rad) == pytest.approx(90.0)
    page.act("before")
    assert session.scene.plane("wall_1") == wall_before()


def wall_before():
    from tests.app.small_room import furnished_scene

    return furnished_scene().plane("wall_1")


def test_all_walls_in_one_step_in_any_colour(session, client, page, panel) -> None:
    client.select_surface("wall_1")
    session.ui_thread.wait()
    page.act("all")
    page.act("pattern", "paint")
    page.change("own", "#405060")
    walls = session.scene.architecture.by_role("wall")
    assert all(w.finish.colour == pytest.approx((64 / 255, 80 / 255, 96 / 255)) for w in walls)
    session.undo(client)
    assert session.scene.plane("wall_1").finish.colour == COLOURS["white"], "one step for all walls"


@pytest.mark.parametrize("words", ["large", "inf", "99999"])
def test_what_is_no_size_changes_nothing(session, client, page, panel, words: str) -> None:
    client.select_surface("floor")
    session.ui_thread.wait()
    page.act("pattern", "boards")
    before = session.scene
    page.change("scale", words)
    assert session.scene is before


def test_walls_offer_doors_and_windows(session, client, page, panel) -> None:
    client.select_surface("wall_1")
    session.ui_thread.wait()
    assert "Add door" in page.html
    with pytest.raises(EditRefused, match="the library has no door"):
        panel._do(Action("opening", "door", add=False))
    client.select_surface("floor")
    session.ui_thread.wait()
    assert "Add door" not in page.html
