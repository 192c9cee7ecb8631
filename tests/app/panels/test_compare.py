from __future__ import annotations

import pytest

from diorama_app.panels.compare import Compare
from tests.app.page import Page


@pytest.fixture
def panel(client, page: Page, views) -> Compare:
    made = Compare(page, client, views)
    client.panels = [made]
    made.refresh()
    return made


def test_the_slider_lays_the_photo_over_the_model(client, page: Page, views, panel: Compare) -> None:
    page.change("over", "40")
    assert client.view.camera.through_photo
    assert client.view.photo.opacity == 0.4
    panel.refresh()
    assert 'value="0"' in page.html, "a slider in the hand is not drawn anew"
    page.change("over", "100")
    views.room_view(client)
    panel.refresh()
    assert client.view.photo.opacity == 0.0
    views.overlay(client, 1.0)
    panel.refresh()
    assert 'value="100"' in page.html, "what a command shows is seen on the slider"


@pytest.mark.parametrize("written", ["", "-5", "much"])
def test_what_is_no_share_changes_nothing(client, page: Page, panel: Compare, written: str) -> None:
    page.change("over", written)
    assert client.view.photo.opacity == 0.0


def test_without_a_photo_there_is_nothing_to_compare(session, client, page: Page, views) -> None:
    session.photo = None
    Compare(page, client, views).refresh()
    assert not page.shows("over", kind="change")


def test_on_the_drawing_board_it_is_not_in_the_way(client, page: Page, panel: Compare, monkeypatch) -> None:
    monkeypatch.setattr(type(client.view.canvas), "is_open", property(lambda _: True))
    panel.refresh()
    assert not page.shows("over", kind="change")
