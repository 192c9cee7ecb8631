"""The start page and the tour: what a newcomer sees first."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import BrowserContext, expect

from diorama_app.app import Editor
from diorama_app.serve import Running, start
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.project.storage import Project
from tests.app.small_room import PlainLibrary, make_project
from tests.e2e.browser import QUERY, EditorPage
from tests.e2e.conftest import FAILED, keep_picture
from tests.ports import free, lasting_port
from tests.waiting import until

pytestmark = pytest.mark.browser


@pytest.fixture
def library() -> str | PlainLibrary:
    """The built-in shapes, of which the example is in the view behind; it takes a while to be drawn."""
    return "built-in"


@pytest.fixture
def newcomer(
    context: BrowserContext,
    serve: Callable[..., Running],
    library: str | PlainLibrary,
    request: pytest.FixtureRequest,
) -> Iterator[EditorPage]:
    page = EditorPage.open(context, serve(library=library), newcomer=True)
    yield page
    keep_picture(page, request.node.name, failed=request.node.stash[FAILED])
    page.page.close()
    assert not page.errors, page.errors


@pytest.mark.parametrize("library", [PlainLibrary()], ids=["plain"])
def test_an_empty_room_is_begun_and_the_tour_comes_once(newcomer: EditorPage) -> None:
    page, begun = newcomer.page, newcomer.page.locator("#dio-start")
    expect(begun).to_be_visible(timeout=30_000)
    for name, length in (("Width", "3.5"), ("Depth", "4.2")):
        page.get_by_label(f"{name} of the room").fill(length)
    newcomer.button("Create empty room").click()
    newcomer.until(lambda: newcomer.session.project is not None and newcomer.session.project.name == "Empty room")
    page.wait_for_url("**project=**")  # the tour begins anew in the page of the room
    expect(begun).to_have_count(0)
    floor = newcomer.session.scene.plane("floor")
    np.testing.assert_allclose(plane_rectangle(floor)[2], (3.5, 4.2))
    tour = page.get_by_role("dialog", name="Tour")
    expect(tour).to_be_visible()
    for step in range(1, 7):
        expect(tour).to_contain_text(f"{step} of 6")
        tour.locator(".main").click()
    expect(tour).to_have_count(0)
    page.reload()
    newcomer.settle()
    page.wait_for_selector("#dio-toolbar")
    page.wait_for_timeout(2500)
    expect(begun).to_have_count(0)
    expect(tour).to_have_count(0)


@pytest.mark.parametrize("library", [PlainLibrary()], ids=["plain"])
def test_what_is_no_picture_is_said_and_the_start_page_stays(newcomer: EditorPage, tmp_path: Path) -> None:
    page, begun = newcomer.page, newcomer.page.locator("#dio-start")
    expect(begun).to_be_visible(timeout=30_000)
    bad, good = tmp_path / "bad.jpg", tmp_path / "room.png"
    bad.write_bytes(b"no picture")
    Image.fromarray(np.full((240, 320, 3), 128, np.uint8)).save(good)
    with page.expect_file_chooser() as chosen:
        begun.locator("label.main").click()
    chosen.value.set_files(str(bad))
    newcomer.notice("not a picture")
    expect(begun).to_be_visible()
    with page.expect_file_chooser() as chosen:
        begun.locator("label.main").click()
    chosen.value.set_files(str(good))
    newcomer.until(lambda: newcomer.session.is_unbuilt, "a project of its own")
    newcomer.at_board()
    expect(begun).to_have_count(0)
    expect(page.locator("#dio-tour")).to_have_count(0)


def test_an_example_is_furnished_and_the_tour_is_skipped(newcomer: EditorPage) -> None:
    page = newcomer.page
    page.locator("#dio-start .tile", has_text="Study").click()
    newcomer.until(lambda: newcomer.session.project is not None and newcomer.session.project.name == "Study")
    assert len(newcomer.session.scene.objects) > 5
    page.get_by_role("dialog", name="Tour").get_by_role("button", name="Skip").click()
    expect(page.locator("#dio-tour")).to_have_count(0)
    expect(page.locator(".dio .row[data-grab]").first).to_be_visible()


def test_keys_stay_in_the_start_page_and_escape_leads_to_the_room_behind(newcomer: EditorPage) -> None:
    page = newcomer.page
    expect(page.get_by_text("Choose a photo")).to_be_focused()
    for _ in range(24):
        page.keyboard.press("Tab")
        assert page.evaluate("document.querySelector('#dio-start').contains(document.activeElement)")
    with page.expect_file_chooser():
        page.get_by_text("Choose a photo").click()
    page.get_by_text("Choose a photo").focus()
    page.keyboard.press("7")
    page.keyboard.press("Escape")
    expect(page.locator("#dio-start")).to_have_count(0)
    newcomer.settle()
    expect(page.locator("#dio-plan")).to_have_count(0)
    assert newcomer.session.project is not None
    assert newcomer.session.project.name == "Example"


def test_a_server_with_a_project_shows_it_at_once_and_the_start_page_when_asked(
    context, serve: Callable[..., Running], tmp_path: Path
) -> None:
    page = EditorPage.open(context, serve(make_project(tmp_path / "projects" / "mine").folder), newcomer=True)
    page.page.wait_for_timeout(1000)
    expect(page.page.locator("#dio-start")).to_have_count(0)
    page.tab("Project")
    page.button("Start page").click()
    expect(page.page.locator("#dio-start")).to_be_visible()
    page.page.locator("#dio-start").get_by_role("button", name="mine").click()
    expect(page.page.locator("#dio-start")).to_have_count(0)
    page.page.close()


@pytest.mark.slow
def test_a_connection_that_comes_again_brings_the_start_page_back_until_it_was_used(
    context: BrowserContext, serve: Callable[..., Running]
) -> None:
    port = lasting_port()
    running = serve(library=PlainLibrary(), port=port)
    page = EditorPage.open(context, running, newcomer=True).page
    begun, lost = page.locator("#dio-start"), page.locator("#dio-lost")
    expect(begun).to_be_visible()
    for close, count in ((False, 1), (True, 0)):
        if close:
            page.keyboard.press("Escape")
            expect(begun).to_have_count(0)
        running.stop()
        expect(lost).to_be_visible(timeout=15_000)
        page.evaluate("document.getElementById('dio-start')?.remove()")
        running = serve(library=PlainLibrary(), port=port)
        expect(lost).to_be_hidden(timeout=30_000)
        page.wait_for_timeout(4000)
        expect(begun).to_have_count(count)
    page.close()


@pytest.mark.slow
def test_the_tour_waits_while_somebody_types(context, serve: Callable[..., Running]) -> None:
    editor = EditorPage.open(context, serve())
    page, tour = editor.page, editor.page.get_by_role("dialog", name="Tour")
    field = page.get_by_placeholder("make all chairs wooden")
    field.click()
    page.evaluate("localStorage.removeItem('diorama-tour'); sessionStorage.setItem('diorama-tour-wanted', 'begun')")
    page.wait_for_timeout(2500)
    expect(tour).to_have_count(0)
    page.keyboard.type("remove the rug")
    expect(field).to_have_value("remove the rug")
    field.blur()
    expect(tour).to_be_visible()
    page.close()


def test_a_page_that_came_before_the_editor_is_greeted(
    context: BrowserContext, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The port opens before the editor is there: the server's own browser window often comes in between."""
    opens, shown, port = Editor.open_first, threading.Event(), lasting_port()

    def late(editor: Editor, project: Project | None) -> None:
        shown.wait(60.0)
        opens(editor, project)

    monkeypatch.setattr(Editor, "open_first", late)
    with ThreadPoolExecutor(1) as threads:
        starting = threads.submit(start, projects_dir=tmp_path, port=port, low_graphics=True, library=PlainLibrary())
        until(lambda: not free(port))
        page = context.new_page()
        with page.expect_websocket():
            page.goto(f"http://127.0.0.1:{port}/{QUERY}")
        page.wait_for_function("window.__viserMutable?.canvas")
        page.wait_for_timeout(500)  # the page has told viser its first camera
        shown.set()
        running = starting.result()
    expect(page.locator("#dio-start")).to_be_visible()
    page.close()
    running.stop()


def test_a_refused_length_is_told_over_the_start_page_and_beside_the_tools(newcomer: EditorPage) -> None:
    page = newcomer.page
    page.get_by_label("Width of the room").fill("-3")
    newcomer.button("Create empty room").click()
    notice = page.locator(".mantine-Notification-root").filter(has_text="give 1 to 30 m")
    notice.scroll_into_view_if_needed()  # which waits until it has come to rest: it slides in from above
    seen = notice.bounding_box()
    tools = page.locator("#dio-toolbar .bars").bounding_box()
    assert seen is not None
    assert tools is not None
    assert seen["y"] >= tools["y"] + tools["height"]
    on_top = "([x, y]) => document.elementFromPoint(x, y).closest('.mantine-Notification-root') !== null"
    assert page.evaluate(on_top, [seen["x"] + seen["width"] / 2, seen["y"] + seen["height"] / 2])
    expect(page.locator("#dio-start")).to_be_visible()
