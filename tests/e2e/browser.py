"""A real Chromium on a real server, driven as a person would: mouse and keys on canvas and panels."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar
from urllib.parse import parse_qs, urlsplit

import numpy as np
from playwright.sync_api import BrowserContext, Locator, Page, expect

from diorama_app.serve import Running
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession

T = TypeVar("T")
FLAGS = (
    "--no-sandbox",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-timer-throttling",
    "--disable-backgrounding-occluded-windows",
    "--disable-renderer-backgrounding",
    "--disable-dev-shm-usage",
    "--disable-extensions",
)
SIZE = (1100, 640)
QUERY = "?fixedDpr=0.25"
"""Of a page's address: the 3D view has a quarter of the screen's pixels a side, which software draws in half the time.
What is asked of the picture is its colours; everything else on the page is as sharp as ever."""
PATIENCE_MS = 60_000
LEARN_MS = 300_000
"""The first model of one's own is compared with all built-in shapes, which takes half a minute of a free core once."""

SETTLED = """() => {
    const m = window.__viserMutable, info = window.__viserTestpoints && window.__viserTestpoints.rendererInfo;
    if (!m || !info || m.messageQueue.length > 0) { window.__quietFrom = null; return false; }
    m.requestRender();
    if (window.__quietFrom == null) { window.__quietFrom = info.render.frame; return false; }
    return info.render.frame >= window.__quietFrom + 2;
}"""

PROJECT = """(point) => {
    const m = window.__viserMutable, camera = m.camera, root = m.nodeRefFromName[''];
    const p = camera.position.clone().set(point[0], point[1], point[2]);
    root.updateWorldMatrix(true, false); camera.updateMatrixWorld();
    p.applyMatrix4(root.matrixWorld).project(camera);
    const box = m.canvas.getBoundingClientRect();
    return [box.left + (p.x + 1) / 2 * box.width, box.top + (1 - p.y) / 2 * box.height];
}"""

ON_PHOTO = """([x, y, width, height]) => {
    const box = document.querySelector('.dio-canvas-layer').getBoundingClientRect();
    return [box.left + x / width * box.width, box.top + y / height * box.height];
}"""

BEEN_HERE = (
    "if (location.protocol.startsWith('http')) "
    "{ sessionStorage.setItem('diorama-begun', 'yes'); localStorage.setItem('diorama-tour', 'seen'); }"
)

NOTES = """(() => {
    const notes = window.__notes = [], note = (...words) => {
        notes.push([Math.round(performance.now()), ...words].join(' '));
        if (notes.length > 60) notes.shift();
    };
    const kinds = ['keydown', 'pointerdown', 'pointerup', 'click', 'change', 'focusin', 'focusout'];
    for (const kind of kinds) addEventListener(kind, (event) =>
        note(kind, event.key ?? '', event.target.outerHTML?.slice(0, 120) ?? event.target.nodeName), true);
    const watch = setInterval(() => {
        const m = window.__viserMutable;
        if (!m?.sendMessage || m.sendMessage.noted) return;
        const send = m.sendMessage;
        m.sendMessage = (message) => {
            if (!/Camera|Pointer/.test(message.type)) note('sent', JSON.stringify(message).slice(0, 200));
            return send(message);
        };
        m.sendMessage.noted = true;
    }, 100);
})()"""
"""Notes what a person did to the page and what it sent, for the report of a test that fails."""

HAS_MESH = """(name) => {
    let has = false;
    window.__viserMutable.nodeRefFromName[name]?.traverse((o) => { has ||= o.isMesh; });
    return has;
}"""

ON_CANVAS = "([x, y]) => (document.elementFromPoint(x, y) || {}).tagName === 'CANVAS'"


def chromium() -> str | None:
    """Where a Chromium is, if there is one."""
    known = [shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome", "chrome")]
    return next((path for path in known if path), None)


@dataclass
class EditorPage:
    """One tab of the editor."""

    page: Page
    running: Running
    errors: list[str] = field(default_factory=list)
    client_id: int = -1
    query: str = QUERY

    @property
    def client(self) -> Client:
        """This tab, as the program knows it."""
        clients = self.session.clients
        known = self.session is self.running.session and self.client_id in clients
        return clients[self.client_id] if known else clients[max(clients)]

    @property
    def session(self) -> EditorSession:
        """The session of the project in this tab's address."""
        name = parse_qs(urlsplit(self.page.url).query).get("project", [""])[0]
        sessions = [e.session for e in self.running.workspace.editors]
        return next((s for s in sessions if s.project is not None and s.project.folder.name == name), sessions[0])

    @property
    def selection(self) -> tuple[str, ...]:
        """What is selected in this tab."""
        return self.client.selection

    @classmethod
    def open(
        cls,
        context: BrowserContext,
        running: Running,
        patience_ms: int = PATIENCE_MS,
        *,
        query: str = query,
        newcomer: bool = False,
    ) -> EditorPage:
        page = context.new_page()
        page.add_init_script(NOTES)
        if not newcomer:  # who has been here sees neither the start page nor the tour
            page.add_init_script(BEEN_HERE)
        page.set_default_timeout(patience_ms)
        made = cls(page, running, query=query)
        page.on("pageerror", lambda error: made.errors.append(str(error)))
        made.load()
        return made

    def load(self) -> None:
        joined = set(self.running.session.clients)
        self.page.goto(f"http://127.0.0.1:{self.running.port}/{self.query}")
        self.settle()
        self.until(lambda: bool(set(self.running.session.clients) - joined))
        self.client_id = max(self.running.session.clients)
        self.settle()
        self.dismiss_notices()

    def settle(self) -> None:
        """Wait until the page has handled every message and drawn two frames since."""
        self.page.evaluate("window.__quietFrom = null")
        self.page.wait_for_function(SETTLED, polling=20)

    def until_drawn(self, object_id: str) -> None:
        """Wait until the page has an object's present shape, and the camera stands still."""
        viewport = self.session.viewport
        self.until(lambda: viewport.mesh_name(object_id) is not None, f"the shape of {object_id} is sent")
        self.page.wait_for_function(HAS_MESH, arg=viewport.mesh_name(object_id))
        self.settle()
        position = self.session.scene.object(object_id).pose.position
        self.still(lambda: np.round(self.place_of(position), 1).tolist())

    def at_board(self) -> None:
        """Wait until the photo is there to draw on."""
        self.until(lambda: bool(self.session.clients) and self.client.view.canvas.is_open, "the drawing board is open")
        self.page.wait_for_selector(".dio-canvas-layer")
        self.settle()

    def on_photo(self, x: float, y: float) -> tuple[float, float]:
        """Where a pixel of the photo is on the page."""
        marked = self.client.inputs
        assert marked is not None
        photo = marked.photo
        left, top = self.page.evaluate(ON_PHOTO, [x, y, photo.width, photo.height])
        return float(left), float(top)

    def draw_box(self, box: tuple[float, float, float, float]) -> None:
        """Drag a rectangle on the photo, in its pixels."""
        self.drag(self.on_photo(*box[:2]), self.on_photo(*box[2:]))

    def canvas_box(self) -> tuple[float, float, float, float]:
        """Left, top, width and height of the 3D view on the page."""
        left, top, width, height = self.page.evaluate(
            "(() => { const b = window.__viserMutable.canvas.getBoundingClientRect();"
            " return [b.left, b.top, b.width, b.height]; })()"
        )
        return left, top, width, height

    def on_canvas(self, x: float, y: float) -> bool:
        """Whether nothing covers the canvas at this place of the page."""
        return bool(self.page.evaluate(ON_CANVAS, [x, y]))

    def until(
        self, holds: Callable[[], bool], what: str | Callable[[], str] = "", seconds: float = PATIENCE_MS / 1000
    ) -> None:
        """Poll the program's own state with the page's clock; `what` may tell what is there instead."""
        for _ in range(int(seconds * 20)):
            if holds():
                return
            self.page.wait_for_timeout(50)
        raise AssertionError(f"did not come about: {(what() if callable(what) else what) or holds}")

    def still(self, read: Callable[[], T], apart_ms: int = 400) -> T:
        """A value of the page, once it is the same twice in a row: beside other work the page is slow."""
        before = read()
        for _ in range(50):
            self.page.wait_for_timeout(apart_ms)
            now = read()
            if now == before:
                return now
            before = now
        raise AssertionError(f"does not come to rest: {before}")

    def dismiss_notices(self) -> None:
        """Close what covers the canvas (the warning of software WebGL at the start, too)."""
        closing = "document.querySelectorAll('.mantine-Notification-closeButton').forEach((b) => b.click())"
        self.page.evaluate(closing)
        self.page.wait_for_function("!document.querySelector('.mantine-Notification-closeButton')")

    def unfold(self, folder: str, content: Locator) -> Locator:
        """Open a folder of a panel, unless an earlier test has left it open: its arrow tells, content may come late."""
        header = self.page.get_by_text(folder, exact=True).first
        header.wait_for()
        if header.locator(".tabler-icon-chevron-down").count():
            header.click()
        content.first.wait_for()
        return content

    def button(self, name: str) -> Locator:
        return self.page.get_by_role("button", name=name, exact=True)

    def build_button(self) -> Locator:
        """The button that builds the scene, whose words end with the number of boxes."""
        return self.page.get_by_role("button", name=re.compile(r"^Build scene( \(\d+\))?$")).first

    def tool(self, name: str) -> Locator:
        """A button of the toolbar: what is drawn anew is in its panel for a moment before it takes the bar's place."""
        return self.page.locator("#dio-toolbar").get_by_role("button", name=name, exact=True)

    def menu_tool(self, name: str) -> Locator:
        """A line of the toolbar's menu, which is opened for it."""
        if self.page.locator("html.dio-menu").count() == 0:
            self.tool("More tools").click()
        return self.page.locator("#dio-toolbar .menu").get_by_role("button", name=name, exact=True)

    def numbers(self) -> None:
        """Unfold the fields of the selected object's name, position and size."""
        self.page.get_by_role("button", name="Name, position and size").click()
        self.page.get_by_label("Position: x").wait_for()

    def tab(self, name: str) -> None:
        self.page.get_by_role("tab", name=name, exact=True).click()

    def row(self, label: str, *, exact: bool = True) -> Locator:
        return self.page.locator(".dio .row[data-grab] .name").get_by_text(label, exact=exact)

    def notice(self, words: str) -> None:
        """A notice or a toast with these words is shown."""
        expect(self.page.locator(".mantine-Notification-root, .dio-toast").filter(has_text=words).first).to_be_visible()

    def place_of(self, world: np.ndarray) -> tuple[float, float]:
        """Where a point of the world is on the page."""
        x, y = self.page.evaluate(PROJECT, [float(v) for v in world])
        return float(x), float(y)

    def click_world(self, world: np.ndarray, *, modifiers: tuple[str, ...] = ()) -> None:
        """Click on the canvas where a point of the world is seen."""
        self.settle()
        x, y = self.place_of(world)
        assert self.on_canvas(x, y), f"something covers the canvas at {x:.0f}, {y:.0f}"
        for key in modifiers:
            self.page.keyboard.down(key)
        self.page.mouse.move(x, y)
        self.settle()
        self.page.mouse.click(x, y)
        for key in modifiers:
            self.page.keyboard.up(key)

    def drag(self, start: tuple[float, float], end: tuple[float, float], steps: int = 8) -> None:
        """Drag on the page with the left button."""
        self.page.mouse.move(*start)
        self.settle()
        self.page.mouse.down()
        for i in range(1, steps + 1):
            share = i / steps
            self.page.mouse.move(start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))
            self.page.wait_for_timeout(30)
        self.settle()
        self.page.mouse.up()

    def pull(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Drag as `drag` does, without letting go."""
        self.page.mouse.move(*start)
        self.settle()
        self.page.mouse.down()
        for share in (0.3, 0.6, 1.0):
            self.page.mouse.move(*(a + share * (b - a) for a, b in zip(start, end, strict=True)))
            self.page.wait_for_timeout(80)

    def upload(self, button: str, path: Path) -> None:
        with self.page.expect_file_chooser() as chosen:
            self.button(button).click()
        chosen.value.set_files(str(path))

    def story(self) -> str:
        """What was done last, in the page's view and in the program's."""
        notes = self.page.evaluate("[Math.round(performance.now()), ...window.__notes]")
        entries = self.session.document.history.entries
        focus = self.page.evaluate("document.activeElement.outerHTML.slice(0, 120)")
        steps = ", ".join(entry.label for entry in entries[-6:])
        at = self.session.document.history.cursor - len(entries) + 1
        return f"steps: {steps} (at {at}); focus: {focus}; page:\n" + "\n".join(map(str, notes))

    def picture(self, path: Path) -> None:
        self.settle()
        self.page.screenshot(path=str(path))

    def mean_colour(self, world: np.ndarray, radius: int = 2) -> np.ndarray:
        """What is drawn on the canvas around a point of the world, 0 to 255."""
        import io

        from PIL import Image

        x, y = self.place_of(world)
        clip = {"x": x - radius, "y": y - radius, "width": 2 * radius + 1, "height": 2 * radius + 1}
        return np.asarray(Image.open(io.BytesIO(self.page.screenshot(clip=clip))).convert("RGB")).mean(axis=(0, 1))
