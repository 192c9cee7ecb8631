"""The self-contained viewer, in a real browser without a network."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_app.web.html_viewer import write_html
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


def shows_the_ball(pixels: np.ndarray) -> bool:
    red, green, blue = pixels[..., 0], pixels[..., 1], pixels[..., 2]
    return bool(((red > 90) & (red > 2.2 * green) & (red > 2.2 * blue)).sum() > 30)
