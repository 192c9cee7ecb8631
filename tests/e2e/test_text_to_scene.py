"""A room typed as words becomes a furnished scene; the networks that would do more are offered with their licences."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import expect

from diorama_app.serve import Running
from diorama_core.scene.types import Scene
from tests.app.small_room import make_project
from tests.e2e.browser import EditorPage

pytestmark = pytest.mark.browser

BUILD_S = 300
"""A dozen seconds of a free core; test machines are often busy."""


def test_a_described_room_is_furnished_and_networks_are_offered(
    serve: Callable[..., Running],
    visit: Callable[[Running], EditorPage],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("DIORAMA_MODELS", str(tmp_path / "models"))
    for name in ("DIORAMA_IMAGE_BASE_URL", "DIORAMA_LMM_BASE_URL"):
        monkeypatch.delenv(name, raising=False)
    running = serve(make_project(tmp_path / "projects" / "empty", Scene()).folder)
    editor = visit(running)
    editor.tab("Photo")
    expect(editor.button("Create room")).to_be_disabled()
    words = editor.page.locator(".mantine-Flex-root", has_text="Describe a room").locator("input, textarea").first
    words.fill("ein Wohnzimmer mit einem Sofa, zwei Sesseln und einem Blubberkrug")
    expect(editor.page.get_by_text("No image endpoint is set up")).to_be_visible()
    editor.button("Create room").click()
    expect(editor.page.get_by_text("Creating the room you described")).to_be_visible()
    editor.until(
        lambda: editor.session.jobs.status is None and bool(editor.session.scene.objects), "made", seconds=BUILD_S
    )
    kinds = [o.category for o in editor.session.scene.objects]
    assert "sofa" in kinds
    assert kinds.count("armchair") == 2, "German is understood"
    editor.notice("blubberkrug")  # and what is not known is named

    editor.tab("Project")
    expect(editor.page.get_by_text("the room was composed from the library by rules", exact=False)).to_be_visible()
    editor.page.get_by_text("Networks", exact=True).click()
    expect(editor.page.get_by_text("What each stage uses now")).to_be_visible()
    expect(editor.page.get_by_text("outlines by the network that comes along, and by colour")).to_be_visible()
    expect(editor.page.get_by_text(re.compile(r"\b5 MB to download\."))).to_be_visible()
    expect(editor.button("Download networks")).to_be_disabled()
    editor.page.get_by_role("checkbox", name="I accept these licences").check()
    expect(editor.button("Download networks")).to_be_enabled()
