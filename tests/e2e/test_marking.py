"""Marks by clicks: proposals are accepted, named by keys and dropped; `test_short_journeys.py` builds such marks."""

from __future__ import annotations

import json
import time

import numpy as np
import pytest
from playwright.sync_api import expect

from diorama_app.projects.example import EXAMPLE
from diorama_app.session.preferences import Preferences
from diorama_core.artefacts import LabelledBox
from diorama_core.io.assets import has_own_recogniser
from diorama_core.models.boxes import overlaps
from tests.app.small_room import PlainLibrary, make_project
from tests.e2e.browser import EditorPage

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(not has_own_recogniser(), reason="no weights are shipped"),
]
HELD = "([x, y]) => document.elementFromPoint(x, y).closest('.dio-canvas-proposal') !== null"


@pytest.fixture
def proposed(editor: EditorPage) -> EditorPage:
    """The example's photo was uploaded and proposals lie on it."""
    editor.tab("Photo")
    editor.upload("Upload a photo", EXAMPLE / "photo.jpg")
    editor.until(lambda: editor.session.is_unbuilt, "a project of its own")
    editor.at_board()
    editor.dismiss_notices()
    editor.page.wait_for_selector(".dio-canvas-proposal", timeout=60_000)
    editor.settle()
    return editor


def boxes(editor: EditorPage) -> tuple[LabelledBox, ...]:
    assert editor.session.inputs is not None
    return editor.session.inputs.boxes


def test_a_room_is_marked_by_clicks_and_keys(proposed: EditorPage) -> None:
    editor, page = proposed, proposed.page
    proposals, on = page.locator(".dio-canvas-proposal"), page.locator(".dio-canvas-box.on")
    count = proposals.count()
    assert 1 <= count <= 10

    page.keyboard.press("Tab")
    expect(page.locator(".dio-canvas-proposal.at")).to_have_count(1)
    page.keyboard.press("Enter")
    editor.until(lambda: len(boxes(editor)) == 1, "accepted")
    expect(on).to_have_count(1)
    expect(on.locator("button.likely")).to_have_count(4)
    expect(page.locator(".dio-canvas-mask")).to_be_visible()
    second = on.locator("button.likely").nth(1).inner_text().removeprefix("2").strip()
    page.keyboard.press("2")
    editor.until(lambda: boxes(editor)[0].label == second, "named by a key")

    editor.settle()
    left = proposals.count()
    page.keyboard.press("Tab")
    expect(page.locator(".dio-canvas-mask")).to_have_count(0)
    page.keyboard.press("Delete")
    expect(proposals).to_have_count(left - 1)
    assert len(boxes(editor)) == 1, "a proposal was dropped, not the box"

    sofa = (875.0, 565.0)
    page.mouse.click(*editor.on_photo(*sofa))
    editor.until(lambda: len(boxes(editor)) == 2, "what was clicked is a box")
    x1, y1, x2, y2 = boxes(editor)[1].box
    assert x1 <= sofa[0] <= x2
    assert y1 <= sofa[1] <= y2
    expect(on.locator("input")).to_be_visible()
    on.locator("input").fill("sofa")
    page.keyboard.press("Enter")
    editor.until(lambda: boxes(editor)[1].category == "sofa", "typing overrides")
    expect(editor.build_button()).to_have_text("Build scene (2)")


def test_twelve_objects_are_marked_in_a_minute(proposed: EditorPage, capsys: pytest.CaptureFixture[str]) -> None:
    """One click each, and a key or a word where the likeliest name is not the right one."""
    editor, page = proposed, proposed.page
    on = page.locator(".dio-canvas-box.on")
    known = json.loads((EXAMPLE / "boxes.json").read_text())["boxes"]
    wanted = ["picture", "picture", "clock", "mirror", "ceiling lamp", "bowl", "bookshelf", "sofa", "pillow"]
    wanted += ["pillow", "vase", "lamp"]
    begun, actions = time.perf_counter(), 0
    for k, name in enumerate(wanted):
        box = [b["bbox"] for b in known if b["class"] == name][wanted[:k].count(name)]
        if name in ("pillow", "vase", "lamp"):  # where the boxes of the sofa and the bookshelf are marked
            page.keyboard.down("Shift")
        page.mouse.click(*editor.on_photo((box[0] + box[2]) / 2, (box[1] + box[3]) / 2))
        page.keyboard.up("Shift")
        actions += 1
        editor.until(lambda k=k: len(boxes(editor)) == k + 1, f"{name} is marked")
        overlap = overlaps(np.array([boxes(editor)[k].box]), np.array([box], dtype=float))[0, 0]
        assert overlap > 0.5, f"{name}: {boxes(editor)[k].box} is not {box}"
        expect(on.locator("button.likely")).to_have_count(4)
        if boxes(editor)[k].label == name:
            continue
        likely = [text.split(maxsplit=1)[1] for text in on.locator("button.likely").all_inner_texts()]
        if name in likely:
            page.keyboard.press(str(likely.index(name) + 1))
        else:
            on.locator("input").fill(name)
            page.keyboard.press("Enter")
        actions += 1
        editor.until(lambda k=k, name=name: boxes(editor)[k].label == name, f"it is a {name}")
    seconds = time.perf_counter() - begun
    with capsys.disabled():
        print(f"\n12 objects: {actions} clicks, keys and words, {seconds:.1f} s")
    assert [b.label for b in boxes(editor)] == wanted
    assert actions <= 18
    assert seconds < 60


def test_a_click_where_nothing_is_says_so(proposed: EditorPage, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("diorama_core.perception.foundation.proposals.find_clicked_box", lambda *_: None)
    editor = proposed
    free = next(
        spot
        for spot in ((5.0, 5.0), (1275.0, 5.0), (640.0, 955.0))
        if not editor.page.evaluate(HELD, list(editor.on_photo(*spot)))
    )
    editor.page.mouse.click(*editor.on_photo(*free))
    editor.notice("Nothing was recognised there")
    assert not boxes(editor)


def test_building_is_above_the_fold_on_every_screen(visit, serve, tmp_path) -> None:
    editor = visit(serve(make_project(tmp_path / "projects" / "demo").folder, library=PlainLibrary()))
    editor.client.preferences = Preferences(build_at_once=False)
    editor.tab("Photo")
    editor.upload("Upload a photo", EXAMPLE / "photo.jpg")
    editor.page.wait_for_selector(".dio-canvas-proposal", timeout=60_000)
    for width, height in ((1440, 900), (1280, 720), (390, 844)):
        editor.page.wait_for_function("!window.__dioTabWanted")  # so that nothing asks for the tab any more
        editor.page.set_viewport_size({"width": width, "height": height})
        if width < height:
            editor.page.wait_for_selector("html.dio-phone")
        expect(editor.button("Build at once")).to_be_in_viewport(ratio=1.0)
        expect(editor.button("Accept all")).to_be_in_viewport(ratio=1.0)
    editor.page.locator(".dio-canvas").get_by_role("button", name="Done").click()
    expect(editor.build_button()).to_be_in_viewport(ratio=1.0)
