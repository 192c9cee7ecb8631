"""The light of the room is set in the page: seen at once, undone, saved, exported."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

from diorama_core.project.storage import Project
from diorama_core.scene.light_settings import PHOTO_LIGHT, LightSettings
from tests.e2e.browser import EditorPage
from tests.e2e.test_handles_and_supports import at_rest

pytestmark = pytest.mark.browser


def light(editor: EditorPage) -> LightSettings:
    return editor.session.scene.light_settings


def open_group(editor: EditorPage) -> None:
    editor.unfold("Light", editor.button("Daylight"))


def test_time_direction_lamps_and_exposure_are_seen_undone_saved_and_exported(
    editor: EditorPage, tmp_path: Path
) -> None:
    editor.page.keyboard.press("t")
    spot = np.array([-1.6, -0.2, 0.0])
    at_rest(editor, spot)
    by_photo = editor.mean_colour(spot).mean()
    open_group(editor)
    editor.button("Daylight").click()
    editor.until(lambda: light(editor).hour is not None, "daylight")
    slider = editor.page.get_by_label("Time of day").and_(editor.page.locator("input"))
    slider.fill("23")
    editor.until(lambda: light(editor).hour == 23.0, "night")
    assert editor.page.locator("[data-clock]").inner_text() == "23:00"
    editor.until(lambda: editor.mean_colour(spot).mean() < 0.6 * by_photo, "night is dark")
    night = editor.mean_colour(spot).mean()
    editor.page.locator(".dio button[data-do=lamp]").first.click()
    editor.until(lambda: light(editor).lamps_on == ("lamp_1",), "the lamp is on")
    lamp = editor.session.viewport.node_name("lamp_1")
    editor.page.wait_for_function(f"!!window.__viserMutable.nodeRefFromName['{lamp}/lamp']")
    slider.fill("9")
    editor.until(lambda: light(editor).hour == 9.0, "morning")
    expect(editor.page.locator("[data-clock]")).to_have_text("09:00")
    expect(editor.page.locator("[data-about]")).to_contain_text("above the horizon")
    dial = editor.page.locator("[data-dial]")
    box = dial.bounding_box()
    assert box is not None
    dial.click(position={"x": box["width"] * 0.9, "y": box["height"] / 2})
    editor.until(lambda: abs(_azimuth(editor)) < 0.1, "the sun stands at the right")
    dial.press("ArrowUp")
    editor.until(lambda: abs(_azimuth(editor) - np.radians(5.0)) < 0.1, "turned by a key")
    exposure = editor.page.get_by_label("Exposure").and_(editor.page.locator("input"))
    exposure.fill("1")
    editor.until(lambda: light(editor).exposure_ev == 1.0, "brighter")
    editor.until(lambda: editor.mean_colour(spot).mean() > night + 40, "the morning is bright")
    editor.session.autosave.flush()
    assert Project.open(editor.session.project.folder).load_scene().light_settings == light(editor)
    editor.tab("Export")
    with editor.page.expect_download() as download:
        editor.button("Export .glb").click()
    download.value.save_as(tmp_path / "room.glb")
    data = (tmp_path / "room.glb").read_bytes()
    document = json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])
    lights = document["extensions"]["KHR_lights_punctual"]["lights"]
    kinds = [entry["type"] for entry in lights if entry["name"] != "even light"]
    assert kinds.count("directional") == 1
    assert kinds.count("point") == 1
    editor.tab("Object")
    editor.page.locator(".dio button[data-do=photo]").first.click()
    editor.until(lambda: light(editor) == PHOTO_LIGHT, "as in the photo")
    editor.page.keyboard.press("Control+z")
    editor.until(lambda: light(editor).exposure_ev == 1.0, "undone")


def _azimuth(editor: EditorPage) -> float:
    from diorama_core.editing.sunlight import sun_azimuth

    settings = light(editor)
    return 9.9 if settings.hour is None else sun_azimuth(settings.hour, settings.north_rad)
