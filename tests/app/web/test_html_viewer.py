"""The self-contained viewer, in a real browser without a network."""

from __future__ import annotations

import io
import re

import numpy as np
import pytest
from PIL import Image

from diorama_app.web.html_viewer import write_html
from diorama_core.errors import Cancelled
from diorama_core.export.gathering import gather
from diorama_core.progress import CancelToken, Progress
from tests.e2e.browser import FLAGS, chromium
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()


def test_the_page_names_the_scene_and_its_viewer(tmp_path, capsys) -> None:
    write_html(gather(furnished_room(LIBRARY), LIBRARY, name="My <room>"), tmp_path / "room.html")
    page = (tmp_path / "room.html").read_text()
    assert "<title>My &lt;room&gt;</title>" in page
    assert "Apache License 2.0" in page
    assert not re.search(r"<(script|link)[^>]+(src|href)=.?https?:", page)
    printed = capsys.readouterr().out.splitlines()
    assert {line for line in printed if "Server stopped" not in line} == set()  # a server of an earlier test may say so


def test_cancelling_leaves_nothing(tmp_path) -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        write_html(gather(furnished_room(LIBRARY), LIBRARY), tmp_path / "room.html", Progress(token=token))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.browser
def test_it_opens_from_disk_and_shows_the_room(tmp_path) -> None:
    from playwright.sync_api import sync_playwright

    program = chromium()
    if program is None:
        pytest.skip("needs Chromium")
    scene = furnished_room(LIBRARY)
    write_html(gather(scene, LIBRARY), tmp_path / "room.html")
    asked: list[str] = []
    errors: list[str] = []
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=program, args=list(FLAGS))
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
        browser.close()
    assert errors == []
    assert [u for u in asked if u.startswith("http")] == []
    assert shows_the_ball(pixels), "the red ball on the table is seen"


def shows_the_ball(pixels: np.ndarray) -> bool:
    red, green, blue = pixels[..., 0], pixels[..., 1], pixels[..., 2]
    return bool(((red > 90) & (red > 2.2 * green) & (red > 2.2 * blue)).sum() > 30)
