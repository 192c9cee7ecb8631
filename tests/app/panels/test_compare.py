from __future__ import annotations

from diorama_app.panels.compare import Compare
from tests.app.page import Page

SLIDER = "Photo over model"


def test_the_slider_lays_the_photo_over_the_model(session, client, page: Page, views) -> None:
    panel = Compare(page, client, views)
    panel.refresh()
    page.write(SLIDER, 40)
    assert client.view.camera.through_photo
    assert client.view.photo.opacity == 0.4
    panel.refresh()
    assert page.field(SLIDER).value == 40, "a value in the hand is left alone"
    views.room_view(client)
    panel.refresh()
    assert page.field(SLIDER).value == 0


def test_without_a_photo_there_is_nothing_to_compare(session, client, page: Page, views) -> None:
    session.photo = None
    Compare(page, client, views).refresh()
    assert not page.field(SLIDER).visible
