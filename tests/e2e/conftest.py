"""One Chromium, one server and one tab a process; a picture of what failed is kept in `test-artefacts`.

With DIORAMA_TEST_PICTURES=1 there is one of every test's end, for people to look at.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Generator, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext

from diorama_app.serve import Running, start
from diorama_app.session.preferences import Preferences
from diorama_core.library.record import ShapeLibrary
from tests.app.small_room import PlainLibrary, make_project
from tests.e2e.browser import FLAGS, PATIENCE_MS, SIZE, EditorPage, chromium

playwright = pytest.importorskip("playwright.sync_api", reason="the browser tests need playwright (extra 'dev')")

FAILED = pytest.StashKey[bool]()
"""Of a test that failed before its fixtures end."""
ARTEFACTS = Path(__file__).resolve().parents[2] / "test-artefacts" / "screens"

StartServer = Callable[..., Running]

FORGET = """() => {
    for (const key of Object.keys(localStorage)) if (key !== 'diorama-tour') localStorage.removeItem(key);
}"""
"""What a page keeps in the browser, but for the tour that was seen."""


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    item.stash[FAILED] = item.stash.get(FAILED, False) or report.failed
    return report


@pytest.fixture(scope="session")
def program() -> str:
    """Where Chromium is."""
    found = chromium()
    if found is None:
        reason = "NO BROWSER TESTS: there is no Chromium on this machine; install it (apt install chromium)"
        warnings.warn(reason, stacklevel=1)
        pytest.skip(reason)
    return found


@pytest.fixture(scope="session")
def driver() -> Iterator:
    """Playwright, of which a process has one at a time."""
    playwright.expect.set_options(timeout=PATIENCE_MS)  # what is expected may come as late as what is waited for
    with playwright.sync_playwright() as started:
        yield started


@pytest.fixture(scope="session")
def context(driver, program: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator:
    context = driver.chromium.launch_persistent_context(
        str(tmp_path_factory.mktemp("browser")),
        executable_path=program,
        headless=True,
        viewport={"width": SIZE[0], "height": SIZE[1]},
        device_scale_factor=1,
        accept_downloads=True,
        args=FLAGS,
    )
    context.set_default_timeout(PATIENCE_MS)
    yield context
    context.close()


class SharedPage:
    """One server and one tab for all tests of a process: starting them is most of a test's time.

    Models that the tests of a module add are not there for those of another: then both are started anew.
    """

    def __init__(self, context: BrowserContext, folders: pytest.TempPathFactory) -> None:
        self._context, self._folders = context, folders
        self._page: EditorPage | None = None
        self._first_box = (0.0, 0.0, 0.0, 0.0)
        self.libraries = folders.mktemp("libraries")
        """Where the server keeps the models that are added."""

    def page(self) -> EditorPage:
        """The tab, with nothing remembered of other modules and its panels as wide as at first."""
        if self._page is not None:
            self._page.page.evaluate(FORGET)
            self._page.settle()
            if self._page.canvas_box() != self._first_box:
                self.close()
        if self._page is None:
            projects = self._folders.mktemp("shared") / "projects"
            project = make_project(projects / "demo")
            running = start(project=project.folder, projects_dir=projects, low_graphics=True, library=PlainLibrary())
            self._page = EditorPage.open(self._context, running)
            self._first_box = self._page.canvas_box()
        return self._page

    def module_ends(self) -> None:
        """Close the tab and its server if models were added or the page is gone."""
        if any(self.libraries.iterdir()) or (self._page is not None and self._page.page.is_closed()):
            self.close()
            self.libraries = self._folders.mktemp("libraries")

    def close(self) -> None:
        """End server and tab."""
        if self._page is not None:
            self._page.page.close()
            self._page.running.stop()
            self._page = None


@pytest.fixture(scope="session")
def for_all(context, tmp_path_factory: pytest.TempPathFactory) -> Iterator[SharedPage]:
    shared = SharedPage(context, tmp_path_factory)
    yield shared
    shared.close()


@pytest.fixture(scope="module", autouse=True)
def own_models(for_all: SharedPage) -> Iterator[None]:
    """Models that the tests of a module add are not there for those of another."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("DIORAMA_LIBRARIES", str(for_all.libraries))
        yield
    for_all.module_ends()


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[StartServer]:
    """Starts servers that end with the test."""
    running: list[Running] = []

    def begin(project: Path | None = None, library: str | ShapeLibrary = "built-in", port: int = 0) -> Running:
        made = start(project=project, projects_dir=tmp_path / "projects", low_graphics=True, library=library, port=port)
        running.append(made)
        return made

    yield begin
    for one in running:
        one.stop()


@pytest.fixture(scope="module")
def shared_page(for_all: SharedPage) -> EditorPage:
    """The tab that all tests share."""
    return for_all.page()


@pytest.fixture
def visit(context, request: pytest.FixtureRequest) -> Iterator[Callable[[Running], EditorPage]]:
    """Opens tabs that close with the test, which fails on any error of the page."""
    pages: list[EditorPage] = []

    def open_page(running: Running) -> EditorPage:
        pages.append(EditorPage.open(context, running))
        return pages[-1]

    yield open_page
    errors = [error for page in pages for error in page.errors]
    for index, page in enumerate(pages):
        keep_picture(page, f"{request.node.name}-{index}", failed=request.node.stash[FAILED])
        page.page.close()
    assert not errors, errors


@pytest.fixture
def editor(shared_page: EditorPage, tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[EditorPage]:
    """The furnished room in a browser, as somebody finds it who has just come."""
    session = shared_page.running.session
    project = make_project(tmp_path / "projects" / "demo")

    def begin() -> None:
        session.projects_dir = tmp_path / "projects"
        session.shared.clip = None
        client = shared_page.client
        client.view.canvas.close()
        client.preferences = Preferences(numbers=True, build_at_once=False)
        session.open_project(project)

    go_home(shared_page)
    session.jobs.wait(10.0)
    session.ui_thread.post(begin)
    assert session.ui_thread.wait()
    shared_page.dismiss_notices()
    for tab in ("Scene", "Object"):
        shared_page.tab(tab)
    shared_page.settle()
    yield shared_page
    keep_picture(shared_page, request.node.name, failed=request.node.stash[FAILED])
    errors, shared_page.errors = shared_page.errors, []
    session.jobs.cancel()
    shared_page.page.keyboard.press("Escape")
    assert not errors, errors


def go_home(editor: EditorPage) -> None:
    """Back to the first project from wherever the test before went; projects that it made are closed."""
    workspace = editor.running.workspace
    if editor.session is not editor.running.session or len(workspace.editors) > 1:
        editor.page.evaluate("window.__dioGoTo('demo')")
        editor.until(lambda: bool(editor.running.session.clients), "back")
        editor.client_id = max(editor.running.session.clients)
        editor.until(lambda: not any(e.session.clients for e in workspace.editors[1:]), "the others are left")
        workspace.close_unused(at_once=True)


def keep_picture(page: EditorPage, name: str, *, failed: bool = False) -> None:
    """Keep what is on the screen, where people want to look at it; drawing it takes a third of a second."""
    if not failed and "DIORAMA_TEST_PICTURES" not in os.environ:
        return
    if failed:
        print(page.story())  # beside the test's report
    ARTEFACTS.mkdir(parents=True, exist_ok=True)
    page.page.screenshot(path=str(ARTEFACTS / f"{name}.png"))
