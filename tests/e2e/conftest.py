"""One Chromium per run, one server per test."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from diorama_app.server import Running, start
from diorama_core.library.record import ShapeLibrary
from tests.app.small_room import PlainLibrary, make_project
from tests.e2e.browser import FLAGS, SIZE, EditorPage, chromium

playwright = pytest.importorskip("playwright.sync_api", reason="the browser tests need playwright (extra 'dev')")

StartServer = Callable[..., Running]


@pytest.fixture(scope="session")
def context(tmp_path_factory: pytest.TempPathFactory) -> Iterator:
    executable = chromium()
    if executable is None:
        reason = "NO BROWSER TESTS: there is no Chromium on this machine; install it (apt install chromium)"
        warnings.warn(reason, stacklevel=1)
        pytest.skip(reason)
    with playwright.sync_playwright() as driver:
        context = driver.chromium.launch_persistent_context(
            str(tmp_path_factory.mktemp("browser")),
            executable_path=executable,
            headless=True,
            viewport={"width": SIZE[0], "height": SIZE[1]},
            device_scale_factor=1,
            accept_downloads=True,
            args=FLAGS,
        )
        yield context
        context.close()


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[StartServer]:
    """Starts servers that end with the test."""
    running: list[Running] = []

    def begin(project: Path | None = None, library: ShapeLibrary | None = None, **options: object) -> Running:
        made = start(
            project=project,
            projects_dir=tmp_path / "projects",
            low_graphics=True,
            library=library,
            **options,  # type: ignore[arg-type]
        )
        running.append(made)
        return made

    yield begin
    for one in running:
        one.stop()


@pytest.fixture
def furnished(serve: StartServer, tmp_path: Path) -> Running:
    """A server on the small furnished room, with plain shapes."""
    project = make_project(tmp_path / "projects" / "demo")
    return serve(project.folder, PlainLibrary())


@pytest.fixture
def visit(context, request: pytest.FixtureRequest) -> Iterator[Callable[[Running], EditorPage]]:
    """Opens tabs that close with the test, which fails on any error of the page."""
    pages: list[EditorPage] = []

    def open_page(running: Running) -> EditorPage:
        pages.append(EditorPage.open(context, running))
        return pages[-1]

    yield open_page
    errors = [error for page in pages for error in page.errors]
    folder = os.environ.get("DIORAMA_SCREENSHOTS")
    for index, page in enumerate(pages):
        if folder:
            Path(folder).mkdir(parents=True, exist_ok=True)
            page.page.screenshot(path=str(Path(folder) / f"{request.node.name}-{index}.png"))
        page.page.close()
    assert not errors, errors


@pytest.fixture
def editor(furnished: Running, visit: Callable[[Running], EditorPage]) -> EditorPage:
    """The furnished room in a browser."""
    return visit(furnished)
