"""The page around the room: first paint, what stays in view, panels' widths, a phone, a dead server."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page, expect
from viser._gui_handles import MainPanelHandle, PanelHandle

from diorama_app.projects.begin import begin_project
from diorama_app.serve import Running
from diorama_core.perception.inputs import read_inputs
from diorama_core.progress import Progress
from tests.app.small_room import PlainLibrary, make_project
from tests.e2e.browser import BEEN_HERE, PROJECT, QUERY, SIZE, EditorPage
from tests.e2e.conftest import keep_picture
from tests.ports import lasting_port

pytestmark = pytest.mark.browser

FOREIGN = ("Inactive", "ws://", "WorldAxes", "Viser", "Dev Settings", "Software WebGL")
ROOM_ABOVE_SHEET = """() => {
    const room = window.__viserMutable.canvas.getBoundingClientRect();
    const sheet = document.querySelector('#root .mantine-Paper-root[style*="position: fixed"]').getBoundingClientRect();
    return room.width === 390 && room.bottom > 300 && sheet.left === 0 && sheet.width === 390
        && Math.abs(room.bottom - sheet.top) <= 2;
}"""
"""On a screen 390 pixels wide; nothing of the room is under the sheet."""
SEEN_TEXT = "document.body.innerText"


@pytest.fixture
def resized(editor: EditorPage) -> Iterator[Page]:
    yield editor.page
    editor.page.set_viewport_size({"width": SIZE[0], "height": SIZE[1]})
    editor.settle()


def test_the_first_thing_seen_is_ours(context, serve: Callable[..., Running], tmp_path) -> None:
    running = serve(make_project(tmp_path / "projects" / "demo").folder, PlainLibrary())
    page = context.new_page()
    page.goto(f"http://127.0.0.1:{running.port}/{QUERY}", wait_until="commit")
    page.wait_for_selector("#dio-loading, #dio-toolbar", state="attached")
    assert page.title() == "Diorama"
    while not page.evaluate("document.documentElement.classList.contains('dio-ready')"):
        seen = page.evaluate(SEEN_TEXT)
        assert not [word for word in FOREIGN if word in seen], seen
        page.wait_for_timeout(20)
    page.wait_for_timeout(500)
    seen = page.evaluate(SEEN_TEXT)
    assert not [word for word in FOREIGN if word in seen], seen
    assert page.title() == "Diorama"
    page.close()


def test_a_panel_that_lost_its_width_gets_it_once_it_is_there(context, serve, visit, tmp_path, monkeypatch) -> None:
    """viser docks a panel at 300 px if its width is lost on the way, as may happen on a slow page."""
    send, lost = MainPanelHandle.set_width, iter([True, True])

    def lose_the_first(panel: MainPanelHandle, width: float) -> None:
        if not next(lost, False):
            send(panel, width)

    for kind in (MainPanelHandle, PanelHandle):
        monkeypatch.setattr(kind, "set_width", lose_the_first)
    page = visit(serve(make_project(tmp_path / "projects" / "demo").folder, PlainLibrary()))
    widths = "[...document.querySelectorAll('[data-dock-region]')].map((e) => e.offsetWidth)"
    page.until(lambda: max(page.page.evaluate(widths)) < 270, lambda: f"panels {page.page.evaluate(widths)}")


@pytest.mark.parametrize(("width", "height"), [(1440, 900), (1280, 720)])
def test_panels_leave_the_room_and_the_tools_stay(editor: EditorPage, resized: Page, width: int, height: int) -> None:
    resized.set_viewport_size({"width": width, "height": height})
    widths = "[innerWidth, ...[...document.querySelectorAll('[data-dock-region]')].map((e) => e.offsetWidth)]"
    editor.until(
        lambda: editor.canvas_box()[2] >= 0.6 * width,
        lambda: f"most of the window is the room's: {editor.canvas_box()}, window, panels {resized.evaluate(widths)}",
    )
    editor.settle()
    left, _, across, _ = editor.canvas_box()
    for tab in ("Scene", "Photo", "Arrange", "Project", "Object", "Library", "Export"):
        editor.tab(tab)
        cut = resized.evaluate(
            "[...document.querySelectorAll('.dio .row .name, .dio button, [role=tab]')].filter((e) => e.offsetParent &&"
            " e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).overflowX !== 'visible').map((e) => e.innerText)"
        )
        assert not cut, f"cut off in {tab}: {cut}"
        box = resized.locator("#dio-toolbar").bounding_box()
        assert box is not None
        assert box["x"] >= left - 1
        assert box["x"] + box["width"] <= left + across + 1
        assert box["y"] < 40
        assert box["height"] <= 44, "the tools are one row"
    corners = np.concatenate([p.polygon for p in editor.session.scene.architecture.planes])
    editor.tool("Room").click()
    editor.settle()
    left, top, across, down = editor.canvas_box()
    bar = resized.locator("#dio-toolbar").bounding_box()
    assert bar is not None
    for corner in corners:
        x, y = editor.place_of(corner)
        assert left <= x <= left + across, "the whole room is in view"
        assert bar["y"] + bar["height"] - 6 <= y <= top + down


def test_tabs_stay_while_what_is_below_them_scrolls(editor: EditorPage, resized: Page) -> None:
    resized.set_viewport_size({"width": 1280, "height": 420})
    editor.settle()
    resized.get_by_text("Light", exact=True).first.scroll_into_view_if_needed()
    viewport = resized.locator(".mantine-ScrollArea-viewport", has=resized.get_by_role("tab", name="Scene", exact=True))
    viewport.first.hover()
    resized.mouse.wheel(0, 3000)
    resized.wait_for_function("(element) => element.scrollTop > 40", arg=viewport.first.element_handle())
    editor.tab("Arrange")
    top = viewport.first.bounding_box()
    tab = resized.get_by_role("tab", name="Arrange", exact=True).bounding_box()
    assert top is not None
    assert tab is not None
    assert abs(tab["y"] - top["y"]) < 12
    editor.tab("Project")
    resized.get_by_label("Project name").fill("A bedroom with two lamps, a wardrobe, an armchair and a rug")
    resized.keyboard.press("Enter")
    expect(resized.locator(".dio .row.tall b", has_text="A bedroom")).to_be_visible()
    across = resized.evaluate("(e) => [e.scrollWidth, e.clientWidth]", viewport.first.element_handle())
    assert across[0] <= across[1] <= 260, "a long name is cut, and widens nothing"


def test_on_a_phone_the_panel_is_a_sheet_and_the_room_above_it(
    context, serve: Callable[..., Running], tmp_path
) -> None:
    running = serve(make_project(tmp_path / "projects" / "demo").folder, PlainLibrary())
    page = context.new_page()
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(f"http://127.0.0.1:{running.port}/{QUERY}")
    page.wait_for_selector("html.dio-ready.dio-phone")
    page.wait_for_function(ROOM_ABOVE_SHEET)
    for name in ("Scene", "Photo", "Arrange", "Project", "Object", "Library", "Export"):
        expect(page.get_by_role("tab", name=name, exact=True)).to_have_count(1)
    page.get_by_role("tab", name="Library", exact=True).click()
    expect(page.get_by_label("Category")).to_be_visible()
    bar = page.locator("#dio-toolbar").bounding_box()
    assert bar is not None
    assert bar["x"] >= 0
    assert bar["x"] + bar["width"] <= 390, "every tool is on the screen"
    corners = np.concatenate([p.polygon for p in running.session.scene.architecture.planes])
    spread = (
        f"(points) => {{ const x = points.map({PROJECT}).map((p) => p[0]); return Math.max(...x) - Math.min(...x); }}"
    )
    page.wait_for_function(f"(points) => ({spread})(points) > 0.75 * 390", arg=corners.tolist())
    page.close()


@pytest.mark.parametrize(("width", "height"), [(1440, 900), (1280, 720)])
def test_the_whole_room_is_seen_at_first_and_after_the_window_changed(
    context, serve: Callable[..., Running], tmp_path, width: int, height: int
) -> None:
    running = serve(make_project(tmp_path / "projects" / "demo").folder, PlainLibrary())
    corners = np.concatenate([p.polygon for p in running.session.scene.architecture.planes]).tolist()
    in_view = f"""(points) => {{ const b = window.__viserMutable?.canvas?.getBoundingClientRect();
        return b && document.querySelector("html.dio-ready") && points.map({PROJECT}).every(([x, y]) =>
            x >= b.left && x <= b.right && y >= b.top && y <= b.bottom); }}"""
    page = context.new_page()
    page.add_init_script(BEEN_HERE)
    page.set_viewport_size({"width": width, "height": height})
    page.goto(f"http://127.0.0.1:{running.port}/{QUERY}")
    page.wait_for_selector("html.dio-ready")
    page.wait_for_function(in_view, arg=corners)
    page.set_viewport_size({"width": 900, "height": height})
    page.wait_for_function(in_view, arg=corners)
    page.close()


def test_on_a_phone_an_unfinished_project_opens_where_its_boxes_are_drawn(
    context, serve: Callable[..., Running], tmp_path
) -> None:
    photo = tmp_path / "room.png"
    Image.fromarray(np.full((240, 320, 3), 128, np.uint8)).save(photo)
    content = photo.read_bytes()
    running = serve(make_project(tmp_path / "projects" / "demo").folder, PlainLibrary())
    read = read_inputs(content, name="room.png")
    begin_project(tmp_path / "projects", "room.png", read, content)
    page = context.new_page()
    page.add_init_script(BEEN_HERE)
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(f"http://127.0.0.1:{running.port}/?project=room")
    page.wait_for_selector("html.dio-ready.dio-phone")
    expect(page.get_by_role("tab", name="Export", exact=True)).to_have_count(1)
    page.wait_for_timeout(2500)
    expect(page.locator(".dio-canvas-layer")).to_be_visible()
    expect(page.get_by_role("tab", name="Photo", exact=True)).to_have_attribute("aria-selected", "true")
    page.get_by_role("tab", name="Project", exact=True).click()
    page.wait_for_timeout(1000)
    expect(page.get_by_role("tab", name="Project", exact=True)).to_have_attribute("aria-selected", "true")
    page.close()


def test_what_is_rarely_used_is_in_a_menu_that_stays_for_its_switches(editor: EditorPage) -> None:
    client = editor.client
    menu = editor.page.locator("#dio-toolbar .menu")
    expect(menu).to_be_hidden()
    names = client.preferences.names
    editor.menu_tool("Names").click()
    editor.until(lambda: client.preferences.names is not names, "names are switched")
    expect(menu).to_be_visible()
    expect(menu.get_by_role("button", name="Names")).to_have_attribute("aria-pressed", str(not names).lower())
    expect(editor.tool("More tools")).to_have_attribute("aria-expanded", "true")
    editor.page.keyboard.press("Escape")
    expect(menu).to_be_hidden()
    editor.menu_tool("Front view").click()
    expect(menu).to_be_hidden()
    editor.tool("More tools").click()
    left, top, _, down = editor.canvas_box()
    editor.page.mouse.click(left + 30, top + down - 30)
    expect(menu).to_be_hidden()


def test_the_running_job_is_in_view_in_every_tab_with_what_it_found(editor: EditorPage) -> None:
    go_on = threading.Event()

    def work(progress: Progress) -> None:
        progress.report(0.3, "outlining objects")
        progress.part(0.2, 0.3).report_finding("9 objects")
        while not go_on.wait(0.02):
            progress.report(0.5, "finding shapes")

    editor.session.ui_thread.post(lambda: editor.session.jobs.start("build", "Building the scene", work))
    strip = editor.page.locator("#dio-job")
    expect(strip).to_be_visible()
    for tab in ("Project", "Photo", "Scene"):
        editor.tab(tab)
        box = strip.bounding_box()
        assert box is not None
        assert 0 <= box["y"] <= SIZE[1] - box["height"]
    expect(strip).to_contain_text("Finding shapes")
    expect(strip).to_contain_text("9 objects")
    expect(strip).to_contain_text("left", timeout=10_000)
    strip.get_by_role("button", name="Cancel").click()
    editor.until(lambda: editor.session.jobs.status is None, "cancelled")
    expect(strip).to_be_hidden()
    go_on.set()


@pytest.mark.slow
def test_a_dead_server_is_told_and_the_page_goes_on_by_itself(
    context, serve: Callable[..., Running], visit: Callable[[Running], EditorPage], tmp_path
) -> None:
    folder, port = make_project(tmp_path / "projects" / "demo").folder, lasting_port()
    running = serve(folder, PlainLibrary(), port=port)
    editor = visit(running)
    running.stop()
    expect(editor.page.locator("#dio-lost")).to_be_visible(timeout=15_000)
    expect(editor.page.locator("#dio-lost")).to_contain_text("Your work is saved")
    serve(folder, PlainLibrary(), port=port)
    expect(editor.page.locator("#dio-lost")).to_be_hidden(timeout=30_000)
    editor.page.wait_for_selector("#dio-toolbar")


SQUARE = """() => [...document.querySelectorAll('#root *, .mantine-Modal-root *, [id^=dio-] *')].filter((e) => {
    const s = getComputedStyle(e), b = e.getBoundingClientRect();
    if (b.width < 12 || b.height < 12 || s.visibility === 'hidden') return false;
    const drawn = (side) => parseFloat(s[`border${side}Width`]) > 0 && !/, 0\\)$/.test(s[`border${side}Color`]);
    const edged = ['Top', 'Right', 'Bottom', 'Left'].every(drawn) || e.matches('.mantine-Modal-content');
    return edged && parseFloat(s.borderTopLeftRadius) < 4;
}).map((e) => `${e.tagName} ${e.className} ${e.getAttribute('aria-label') ?? ''}`)"""
"""What has an edge all around it and square corners."""


def test_nothing_has_square_corners(editor: EditorPage) -> None:
    editor.row("dining table").click()
    square: set[str] = set()
    for tab in ("Scene", "Photo", "Arrange", "Project", "Object", "Library", "Export"):
        editor.tab(tab)
        editor.settle()
        square |= {f"{tab}: {what}" for what in editor.page.evaluate(SQUARE)}
    editor.page.keyboard.press("Shift+?")
    editor.page.locator(".mantine-Modal-content").wait_for()
    square |= {f"help: {what}" for what in editor.page.evaluate(SQUARE)}
    keep_picture(editor, "help")
    editor.page.keyboard.press("Escape")
    assert not square


def test_escape_in_the_search_of_all_projects_leads_back(editor: EditorPage) -> None:
    editor.tab("Project")
    editor.page.get_by_role("button", name="All projects").first.click()
    search = editor.page.get_by_label("Search projects")
    expect(search).to_be_focused()
    editor.page.keyboard.press("Escape")
    expect(search).to_have_count(0)
