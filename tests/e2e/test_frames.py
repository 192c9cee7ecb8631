"""The editor in a frame of another page, such as a notebook's: where that page's origin is named, and nowhere else."""

from __future__ import annotations

import http.server
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext

from diorama_app.serve import Running, start
from tests.app.small_room import PlainLibrary, make_project
from tests.e2e.browser import BEEN_HERE, PATIENCE_MS, QUERY

pytestmark = pytest.mark.browser

DRAWN = "window.__viserMutable && window.__viserMutable.nodeRefFromName && window.__viserMutable.nodeRefFromName['']"


@pytest.fixture
def notebook() -> Iterator[Callable[[str], str]]:
    """Serves a page of an origin of its own that frames an address; gives where it is."""
    framed: list[str] = []

    class Page(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(f'<iframe src="{framed[0]}" width="1000" height="600"></iframe>'.encode())

        def log_message(self, *_: object) -> None:
            return None

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Page)
    threading.Thread(target=server.serve_forever, daemon=True).start()

    def origin(address: str = "") -> str:
        framed[:] = [address]
        return f"http://localhost:{server.server_port}"

    yield origin
    server.shutdown()
    server.server_close()


@pytest.mark.parametrize("allowed", [True, False])
def test_only_pages_of_a_named_origin_show_the_editor(
    context: BrowserContext, notebook: Callable[[str], str], tmp_path: Path, allowed: bool
) -> None:
    project = make_project(tmp_path / "projects" / "demo").folder
    origins = (notebook("") if allowed else "http://localhost:1",)
    running: Running = start(
        project=project, projects_dir=project.parent, low_graphics=True, library=PlainLibrary(), frame_origins=origins
    )
    page, refused = context.new_page(), list[str]()
    page.on("console", lambda message: refused.append(message.text) if "frame-ancestors" in message.text else None)
    try:
        page.add_init_script(BEEN_HERE)
        page.goto(notebook(f"http://127.0.0.1:{running.port}/{QUERY}"))
        frame = page.frames[1]
        if allowed:
            frame.wait_for_function(DRAWN, timeout=PATIENCE_MS)
            frame.get_by_role("tab", name="Scene", exact=True).first.wait_for(timeout=PATIENCE_MS)
            page.wait_for_timeout(500)
            assert not refused
        else:
            page.wait_for_function("!!document.querySelector('iframe')")
            assert refused
            assert frame.evaluate("document.querySelector('canvas')") is None
            assert not running.session.clients
        page.screenshot(path=str(tmp_path / "frame.png"))
    finally:
        page.close()
        running.stop()
