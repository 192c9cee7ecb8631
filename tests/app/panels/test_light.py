from __future__ import annotations

from dataclasses import replace

import pytest

from diorama_app.panels.light import LightPanel, light_state
from diorama_core.scene.light_settings import PHOTO_LIGHT, LightSettings
from diorama_core.scene.types import Scene
from tests.app.page import Page
from tests.geometry.test_sun import room


@pytest.fixture
def panel(page: Page, client) -> LightPanel:
    return page.put(LightPanel)


def light(session) -> LightSettings:
    return session.scene.light_settings


def test_daylight_is_set_changed_in_one_step_each_and_taken_back(session, client, page, panel) -> None:
    assert "As in the photo" in page.html
    page.act("day")
    assert light(session).hour is not None
    for hour in ("12", "15.5", "17.25"):
        page.change("hour", hour)
    assert light(session).hour == 17.25
    assert session.document.history.current.label == "time of day 17:15"
    page.change("sun", "90")
    page.change("exposure", "0.7")
    assert light(session).exposure_ev == pytest.approx(0.7)
    session.undo(client)
    session.undo(client)
    session.undo(client)
    assert light(session).hour == 10.0, "all hours were one step"
    page.act("photo")
    assert light(session) == PHOTO_LIGHT


def test_lamps_one_by_one_and_all(session, client, page, panel) -> None:
    page.act("lamp", "lamp_1")
    assert light(session).lamps_on == ("lamp_1",)
    assert session.document.history.current.label == "switch lamp on"
    page.act("lamp", "lamp_1")
    assert light(session).lamps_on == ()


def test_nonsense_is_refused_and_changes_nothing(session, client, page, panel) -> None:
    for what, words in (("hour", "noon"), ("exposure", "nan"), ("sun", "")):
        page.change(what, words)
    assert light(session) == PHOTO_LIGHT
    page.change("sun", "30")
    assert light(session) == PHOTO_LIGHT, "no sun to turn"


def test_an_empty_project_has_no_light_to_set_and_the_page_is_told_the_windows() -> None:
    told = light_state(replace(room(), light_settings=LightSettings(hour=12.0)))
    assert told["windows"] == [[-0.5, 2.0, 0.5, 2.0]]
    assert len(told["outline"]) == 4
    assert told["up"] == pytest.approx(0.7071, abs=1e-3)
    assert light_state(Scene())["azimuth"] is None
