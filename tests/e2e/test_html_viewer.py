"""The self-contained viewer, in a real browser without a network."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect
from shapely.geometry import Point, Polygon

from diorama_app.viewport.html_viewer import write_html
from diorama_core.editing.footprints import footprint_of
from diorama_core.editing.walking import RADIUS_M
from diorama_core.export.gathering import gather
from diorama_core.scene.types import RoomLight
from tests.e2e.browser import FLAGS
from tests.primitives import PrimitiveLibrary, furnished_room

pytestmark = pytest.mark.browser

LIBRARY = PrimitiveLibrary()


@pytest.mark.parametrize("light", [None, RoomLight((0.0, 0.6, 0.8), 0.6)], ids=["even", "from one side"])
def test_it_opens_from_disk_and_shows_the_room(driver, program: str, tmp_path: Path, light: RoomLight | None) -> None:
    scene = replace(furnished_room(LIBRARY), light=light)
    write_html(gather(scene, LIBRARY), tmp_path / "room.html")
    asked: list[str] = []
    errors: list[str] = []
    with driver.chromium.launch(executable_path=program, args=list(FLAGS)) as browser:
        context = browser.new_context(viewport={"width": 480, "height": 360}, offline=True)
        page = context.new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("request", lambda request: asked.append(request.url))
        page.goto((tmp_path / "room.html").as_uri())
        pixels = np.zeros(0)
        for _ in range(20):
            page.wait_for_timeout(1000)
            pixels = np.asarray(Image.open(io.BytesIO(page.screenshot(timeout=60_000))).convert("RGB")).astype(int)
            if shows_the_ball(pixels):
                break
    assert errors == []
    assert [u for u in asked if u.startswith("http")] == []
    assert shows_the_ball(pixels), "the red ball on the table is seen"
    assert (pixels.min(axis=2) > 250).mean() < 0.3, "it is not lit so brightly that all is white"


def test_title_views_and_exposure_are_the_editors_and_there_is_no_tree(driver, program: str, tmp_path: Path) -> None:
    room = furnished_room(LIBRARY)
    dark = replace(room, light=None, light_settings=replace(room.light_settings, exposure_ev=-1.0))
    write_html(gather(dark, LIBRARY, name="The <b>room</b> `${1}`"), tmp_path / "room.html")
    with driver.chromium.launch(executable_path=program, args=list(FLAGS)) as browser:
        page = browser.new_context(viewport={"width": 480, "height": 360}, offline=True).new_page()
        page.goto((tmp_path / "room.html").as_uri())
        expect(page.get_by_role("heading")).to_have_text("The <b>room</b> `${1}`")
        page.wait_for_function(f"!!window.__viserMutable?.nodeRefFromName['/scene'] && ({LIGHTS})().length > 1")
        assert sorted(page.evaluate(LIGHTS)) == pytest.approx([0.2, 1.5]), "half of the editor's"
        expect(page.locator("#root button:visible")).to_have_count(0)
        eyes = []
        for name in ("Photo", "Room", "Top"):
            button = page.get_by_role("button", name=name)
            button.click()
            expect(button).to_have_attribute("aria-pressed", "true")
            page.wait_for_timeout(500)
            eyes.append(page.evaluate(EYE))
        page.screenshot(path=str(tmp_path / "top.png"), timeout=60_000)
    assert room.camera is not None
    np.testing.assert_allclose(eyes[0], room.camera.position, atol=1e-3)
    assert eyes[1][2] > room.camera.position[2], "the room is seen from above"
    assert eyes[2][2] > eyes[1][2] + 5.0, "from far above, with hardly any perspective"


LIGHTS = """() => { const found = []; window.__viserMutable.scene?.traverse((o) =>
    o.isDirectionalLight && o.visible && found.push(o.intensity)); return found; }"""
EYE = """() => { const m = window.__viserMutable;
    return m.nodeRefFromName[''].worldToLocal(m.camera.position.clone()).toArray(); }"""


def shows_the_ball(pixels: np.ndarray) -> bool:
    red, green, blue = pixels[..., 0], pixels[..., 1], pixels[..., 2]
    return bool(((red > 90) & (red > 2.2 * green) & (red > 2.2 * blue)).sum() > 30)


def test_a_walk_through_the_room_crosses_no_wall(driver, program: str, tmp_path: Path) -> None:
    """Keys into every direction, at a run; all the while a body's breadth from walls and furniture."""
    room = furnished_room(LIBRARY)
    write_html(gather(room, LIBRARY), tmp_path / "room.html")
    with driver.chromium.launch(executable_path=program, args=list(FLAGS)) as browser:
        page = browser.new_context(viewport={"width": 320, "height": 240}, offline=True).new_page()
        page.goto((tmp_path / "room.html").as_uri())
        page.wait_for_function("!!window.__viserMutable?.nodeRefFromName['/scene']")
        page.get_by_role("button", name="Walk").click()
        expect(page.get_by_role("button", name="Walk", exact=True)).to_have_attribute("aria-pressed", "true")
        page.evaluate(f"({TRACED})()")
        page.keyboard.down("Shift")
        for keys in ("w", "wd", "d", "sd", "s", "sa", "a", "wa", "wd", "e", "w", "q", "w"):
            for key in keys:
                page.keyboard.down(key)
            page.wait_for_timeout(900)
            for key in keys:
                page.keyboard.up(key)
        page.keyboard.up("Shift")
        trace = np.array(page.evaluate("window.__trace"))
        eye = page.evaluate(EYE)
        page.keyboard.press("Escape")
        expect(page.get_by_role("button", name="Photo")).to_have_attribute("aria-pressed", "true")
        assert page.evaluate("window.__dioWalk.place()") is None
        assert room.camera is not None
        away = f"([x, y, z]) => {{ const [a, b, c] = ({EYE})(); return Math.hypot(a - x, b - y, c - z); }}"
        page.wait_for_function(f"(eye) => ({away})(eye) < 1e-3", arg=room.camera.position.tolist())
    outline = Polygon(room.architecture.by_role("floor")[0].polygon[:, :2])
    stands = [Polygon(footprint_of(o)) for o in room.objects if o.category in ("table", "chair")]
    assert np.linalg.norm(np.diff(trace, axis=0), axis=1).sum() > 3.0, "some metres"
    assert np.ptp(trace, axis=0).min() > 0.5
    assert np.linalg.norm(np.diff(trace, axis=0), axis=1).max() < 0.5, "no leap"
    np.testing.assert_allclose(eye[:2], trace[-1], atol=0.01)
    for x, y in trace:
        assert outline.contains(Point(x, y))
        assert min(Point(x, y).distance(g) for g in (outline.exterior, *stands)) > RADIUS_M - 0.011


TRACED = """() => { window.__trace = []; const note = () => {
    const now = window.__dioWalk.place(); if (now) window.__trace.push(now.at);
    requestAnimationFrame(note); }; note(); }"""
