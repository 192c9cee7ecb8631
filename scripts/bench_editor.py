"""Measure the editor as a person feels it, in a real Chromium on a room of sixty objects, or on a home.

    python scripts/bench_editor.py [--objects 60] [--rooms 1] [--library built-in|plain] [--only start,load,swap,...]

Run it on a quiet machine: everything (server, browser, software WebGL) shares its cores. The server runs with low
graphics, as it should where there is no graphics card. Prints one line a figure: what was measured, the median and
worst, the processor time each took here (server and test driver, whatever else the machine does), and what is asked.
A figure that cannot be taken says why, and the next one follows.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from playwright.sync_api import Browser, BrowserContext, Page, sync_playwright
from playwright.sync_api import Error as BrowserError

from diorama_app.serve import Running, start
from diorama_app.viewport.scene_view import MESH_NAMES
from diorama_core.library.record import ShapeLibrary
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from diorama_core.scene.belief import Belief
from diorama_core.scene.types import Architecture, Candidate, HomeRoom, Pose, Scene, SceneObject, Support
from tests.app.small_room import PlainLibrary, photo_camera, room_planes
from tests.e2e.browser import FLAGS, EditorPage, chromium

ROUNDS = 12
PATIENCE_MS = 120_000
SHOWN = """([name, value]) => new Promise((done, fail) => {
    // There when it is in the scene; on the screen when a picture was drawn after it was not yet there.
    const end = Date.now() + 120000, render = window.__viserTestpoints.rendererInfo.render;
    const there = () => {
        const node = window.__viserMutable.nodeRefFromName[name];
        if (!node || value !== null) return Boolean(node) && Math.abs(node.position.x - value) < 1e-3;
        let meshes = 0;
        node.traverse((o) => { if (o.isMesh || o.isInstancedMesh) meshes += 1; });
        return meshes > 0;
    };
    let before = render.frame;
    const look = () => {
        if (!there()) before = render.frame;
        else if (render.frame > before) return requestAnimationFrame(() => done(Date.now()));
        if (Date.now() > end) fail(new Error(`${name} was never drawn`));
        else requestAnimationFrame(look);
    };
    look();
})"""
WATCH = """(names) => {
    window.__frames = [];
    const mine = window.__watch = (window.__watch || 0) + 1;
    let last = null;
    const look = () => {
        if (mine !== window.__watch) return;  // another figure watches now
        const nodes = names.map((name) => window.__viserMutable.nodeRefFromName[name]).filter((n) => n);
        const at = nodes.length ? nodes.map((n) => n.position.x + n.position.z).join() : last;
        if (at !== last) { last = at; window.__frames.push([Date.now(), at]); }
        requestAnimationFrame(look);
    };
    look();
}"""
TORN = """([a, b]) => {
    window.__torn = 0; window.__seen = 0;
    let last = null;
    const look = () => {
        const refs = window.__viserMutable.nodeRefFromName, p = refs[a], q = refs[b];
        if (p && q) {
            const now = p.position.x;
            if (now !== last) {
                window.__seen += 1;
                if (Math.abs((q.position.x - p.position.x) - window.__gap) > 1e-4) window.__torn += 1;
                last = now;
            }
        }
        requestAnimationFrame(look);
    };
    const refs = window.__viserMutable.nodeRefFromName;
    window.__gap = refs[b].position.x - refs[a].position.x;
    look();
}"""


def furnished(library: ShapeLibrary, count: int, columns: int = 8, width: float = 18.0, depth: float = 16.0) -> Scene:
    """A large room with `count` objects on a grid, a third of them standing on others."""
    shapes = [s for s in library.shapes() if s.category in ("chair", "table", "lamp", "armchair", "sofa", "vase")]
    by_category: dict[str, list] = {}
    for shape in shapes:
        by_category.setdefault(shape.category, []).append(shape)
    tables = by_category["table"]
    small = by_category.get("vase") or by_category["lamp"]
    others = [s for name, of_one in by_category.items() if name not in ("table", "vase") for s in of_one]
    objects: list[SceneObject] = []
    supports: list[Support] = []

    def add(name: str, shape, position: tuple[float, float, float], parent: str) -> None:
        pose = Pose.upright((position[0], position[1], position[2] + shape.size_m[2] / 2))
        rivals = [shape, *(r for r in by_category[shape.category] if r.id != shape.id)][:6]
        candidates = tuple(Candidate(r.id, r.size_m, 0.9 - 0.1 * i, pose) for i, r in enumerate(rivals))
        objects.append(SceneObject(name, name, shape.category, shape.id, shape.size_m, pose, candidates))
        supports.append(Support(name, parent))

    spot = 0
    while len(objects) < count:
        x, y = 1.9 * (spot % columns - 0.5 * columns) + 1.0, 1.9 * (spot // columns) + 0.8
        if spot % 2 == 0 and len(objects) + 1 < count:
            table = library.shape(tables[spot // 2 % len(tables)].id)
            add(f"table_{spot}", table, (x, y, 0.0), "floor")
            add(f"small_{spot}", small[spot // 2 % len(small)], (x, y, table.size_m[2]), f"table_{spot}")
        else:
            add(f"other_{spot}", others[spot % len(others)], (x, y, 0.0), "floor")
        spot += 1
    planes = room_planes(width=width, depth=depth, height=2.7)
    return Scene(photo_camera(), Architecture(planes), tuple(objects), tuple(supports))


def home(library: ShapeLibrary, count: int, rooms: int) -> Scene:
    """A home of equal rooms in rows of five, which share `count` objects."""
    size = 8.0
    one = furnished(library, count // rooms, columns=4, width=size, depth=size)
    planes, objects, supports, named = [], [], [], []
    for k in range(rooms):
        shift = np.array([(size + 0.2) * (k % 5), (size + 0.2) * (k // 5), 0.0])
        planes += [replace(p, id=f"{p.id}_{k}", polygon=p.polygon + shift) for p in one.architecture.planes]
        for item in one.objects:
            pose = item.pose.move(shift)
            rivals = tuple(replace(c, pose=pose) for c in item.candidates)
            objects.append(replace(item, id=f"{item.id}_{k}", pose=pose, candidates=rivals))
        supports += [Support(f"{s.child}_{k}", f"{s.parent}_{k}", s.relation) for s in one.supports]
        named.append(HomeRoom(f"room_{k}", f"room {k + 1}", f"floor_{k}"))
    return Scene(photo_camera(), Architecture(tuple(planes)), tuple(objects), tuple(supports), rooms=tuple(named))


def line(what: str, milliseconds: list[float], asked: str, processor_s: float | None = None) -> None:
    values = np.sort(np.asarray(milliseconds))
    each = "" if processor_s is None else f"   processor {1000 * processor_s / len(values):5.0f} ms each"
    print(
        f"{what:34s} median {np.median(values):7.0f} ms   95 % {np.quantile(values, 0.95):7.0f} ms   "
        f"worst {values[-1]:7.0f} ms   "
        f"n {len(values):3d}   asked {asked}{each}",
        flush=True,
    )


def wait_for_scene(page: Page, last_mesh: str, count: int) -> None:
    """Until the last object's mesh is there, a frame was drawn, and the panel says how many objects there are."""
    page.wait_for_function("window.__viserMutable && window.__viserMutable.nodeRefFromName", polling=20)
    page.evaluate(SHOWN, [last_mesh, None])
    page.get_by_text(f"{count} objects").first.wait_for()


class Bench:
    """One server, one project, as many tabs as a figure needs."""

    def __init__(self, browser: Browser, returning: BrowserContext, running: Running) -> None:
        self.browser, self.running, self.session = browser, running, running.session
        self.returning = returning
        """A browser that was here before, as a person's is."""
        self.page = self._open()

    def _window(self) -> BrowserContext:
        """A window of its own: tabs behind another one hardly draw."""
        return self.browser.new_context(viewport={"width": 1280, "height": 720}, device_scale_factor=1)

    def _open(self) -> EditorPage:
        return EditorPage.open(self._window(), self.running, PATIENCE_MS, query="")

    def start(self) -> None:
        """From the command on a shell to its address, and on to every object on the screen of a new tab."""
        served, usable = [], []
        project = self.session.project
        assert project is not None
        last = f"{self.session.viewport.node_name(self.session.scene.objects[-1].id)}/v1"
        command = [sys.executable, "-m", "diorama_app.cli", "serve", str(project.folder)]
        for _ in range(3):
            begun = time.monotonic()
            process = subprocess.Popen(
                [*command, "--no-open", "--port", "0", "--low-graphics"],
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
            )
            try:
                assert process.stdout is not None
                address = re.search(r"http://\S+", process.stdout.readline())
                assert address is not None, "the server did not start"
                served.append(1000 * (time.monotonic() - begun))
                page = self.returning.new_page()
                page.set_default_timeout(PATIENCE_MS)
                page.goto(address[0], wait_until="commit")
                wait_for_scene(page, last, len(self.session.scene.objects))
                usable.append(1000 * (time.monotonic() - begun))
                page.close()
            finally:
                process.terminate()
                process.wait(20)
        line("command to its address", served, "-")
        line("command to usable scene", usable, "< 6000")

    def load(self) -> None:
        """A tab that opens, until every object's mesh is there and a frame was drawn."""
        taken, used = [], time.process_time()
        last = str(self.session.viewport.mesh_name(self.session.scene.objects[-1].id))
        for _ in range(5):
            page = self.returning.new_page()
            page.set_default_timeout(PATIENCE_MS)
            begun = time.monotonic()
            page.goto(f"http://127.0.0.1:{self.running.port}/", wait_until="commit")
            wait_for_scene(page, last, len(self.session.scene.objects))
            taken.append(1000 * (time.monotonic() - begun))
            page.close()
        line("page to usable scene", taken, "< 4000", time.process_time() - used)

    def swap(self) -> None:
        """From the click on an alternative to its mesh on the screen."""
        taken, used = [], 0.0
        page, client = self.page.page, self.page.client
        items = [o for o in self.session.scene.objects if len({c.shape_id for c in o.candidates}) > 1][:ROUNDS]
        for item in items:
            self._do(lambda i=item: client.select((i.id,)))
            self.page.settle()
            node = self.session.viewport.node_name(item.id)
            shown = str(self.session.viewport.mesh_name(item.id))
            following = f"{node}/v{(int(shown.rsplit('/v', 1)[1]) + 1) % MESH_NAMES}"
            other = next(c.shape_id for c in item.candidates if c.shape_id != item.shape_id)
            tile = page.locator(f'.dio .tile[data-do="swap"][data-arg="{other}"]').first
            tile.scroll_into_view_if_needed()
            self.page.settle()
            used -= time.process_time()
            click = (
                "([tile, what]) => { const begun = Date.now(); tile.click(); "
                f"return ({SHOWN})(what).then((at) => at - begun); }}"
            )
            taken.append(page.evaluate(click, [tile.element_handle(), [following, None]]))
            used += time.process_time()
        line("swap to visible", taken, "< 300", used)

    def answer(self) -> None:
        """From the key that answers a question of the review to the next question."""
        taken, used, page = [], 0.0, self.page.page
        belief = Belief(kinds=(("chair", 0.6), ("armchair", 0.4)), fronts=(0.7, 0.1, 0.1, 0.1))
        known = tuple(
            replace(o, belief=replace(belief, kinds=((o.category, 0.6), *belief.kinds[1:])))
            for o in self.session.scene.objects
        )
        self._do(lambda: self.session.commit("doubt", replace(self.session.scene, objects=known)))
        page.locator(".job.card").get_by_role("button", name="Review").click()
        page.wait_for_selector(".review")
        for k in range(2 * ROUNDS):
            self.page.settle()
            used -= time.process_time()
            press = """(digit) => new Promise((done) => {
                const words = () => document.querySelector(".dio .review")?.innerText;
                const before = words(), begun = Date.now();
                const look = () => {
                    if (words() !== before) done(Date.now() - begun);
                    else requestAnimationFrame(look);
                };
                document.querySelector(`.dio .review [data-digit="${digit}"]`).click();
                look();
            })"""
            taken.append(page.evaluate(press, str(1 + k % 2)))
            used += time.process_time()
        line("answer to the next question", taken, "< 1000", used)

    def undo(self) -> None:
        """From Ctrl+Z to the frame that shows it."""
        taken, used, page = [], 0.0, self.page.page
        item = self.session.scene.objects[0]
        node = self.session.viewport.node_name(item.id)
        page.mouse.move(640, 400)
        for k in range(ROUNDS):
            x0 = float(self.session.scene.object(item.id).pose.position[0])
            pose = self.session.scene.object(item.id).pose.move((0.1 + 0.01 * k, 0.0, 0.0))
            self._do(lambda p=pose: self.session.edit("move", lambda s: edits.move(s, item.id, p), by=self.page.client))
            page.wait_for_timeout(1500)  # it comes and rests
            used -= time.process_time()
            press = (
                "(what) => { const begun = Date.now(); document.body.dispatchEvent(new KeyboardEvent('keydown', "
                "{key: 'z', code: 'KeyZ', ctrlKey: true, bubbles: true})); "
                f"return ({SHOWN})(what).then((at) => at - begun); }}"
            )
            taken.append(page.evaluate(press, [node, x0]))
            used += time.process_time()
        line("undo", taken, "< 150", used)

    def drag(self) -> None:
        """From a mouse move to the frame in which the object has followed."""
        page = self.page.page
        self._do(lambda: self.page.client.select(()))
        self.page.client.view.camera.move(np.array([0.0, -7.0, 7.0]), np.array([0.0, 3.0, 0.0]))
        self.page.settle()
        near = [o for o in self.session.scene.objects if np.abs(o.pose.position[:2]).max() < 9.0]  # in the first room
        others = [o for o in near if o.id.startswith("other")]
        item = min(others, key=lambda o: float(o.size_m[0] * o.size_m[1]))  # it stays free of its neighbours
        self.page.until(
            lambda: self.session.preparer.ready(o.shape_id for o in self.session.scene.objects), seconds=600
        )
        node = self.session.viewport.node_name(item.id)
        x, y = self.page.place_of(item.pose.position)
        page.mouse.move(x, y)
        self.page.settle()
        page.mouse.down()
        page.mouse.move(x + 12, y)
        page.wait_for_timeout(400)
        page.evaluate(WATCH, [node])
        taken, used = [], time.process_time()
        try:
            for k in range(30):
                page.wait_for_timeout(60)
                begun = page.evaluate("() => { window.__frames.length = 0; return Date.now(); }")
                page.mouse.move(x + 12 + 2 * (1 + k % 10), y)
                page.wait_for_function("window.__frames.length > 0", polling=5)
                taken.append(page.evaluate("window.__frames[0][0]") - begun)
        finally:
            page.mouse.up()
        used = time.process_time() - used
        line("drag: move to moved frame", taken, "median < 120, of a home 95 % < 80", used)

    def optimiser(self) -> None:
        """Pictures a second while the published recipe runs, and how many show one object moved without another."""
        page = self.page.page
        lifted = {
            o.id: o.pose.move((0.05, 0.0, 0.08)) for o in self.session.scene.objects if not o.id.startswith("small")
        }
        self._do(lambda: self.session.edit("lift", lambda s: edits.place(s, lifted)))
        self.page.settle()
        page.evaluate(WATCH, [self.session.viewport.node_name(o.id) for o in self.session.scene.objects])
        from diorama_app.commands.optimise import optimise

        self._do(lambda: optimise(self.page.client.session, "paper", by=self.page.client))
        deadline = time.monotonic() + 300
        while self.session.jobs.status is not None and time.monotonic() < deadline:
            page.wait_for_timeout(200)
        assert self.session.document.history.current.label == "arrange the layout", "the layout was not arranged"
        self.page.settle()
        stamps = np.array([t for t, _ in page.evaluate("window.__frames")], dtype=float)
        gaps = np.diff(stamps)
        gaps = gaps[gaps < 2000]
        rate = 1000.0 / float(np.median(gaps)) if len(gaps) else 0.0
        print(f"{'optimiser preview':34s} {rate:7.1f} pictures/s   n {len(stamps)}   asked >= 10", flush=True)
        self._tearing()

    def _tearing(self) -> None:
        """Two objects moved together twenty times a second: frames in which only one has moved."""
        page, items = self.page.page, self.session.scene.objects
        a, b = items[0], items[-1]
        page.evaluate(TORN, [self.session.viewport.node_name(a.id), self.session.viewport.node_name(b.id)])
        for k in range(100):
            shift = 0.3 * np.sin(k / 5)
            poses = {o.id: o.pose.move((shift, 0.0, 0.0)) for o in items}
            self.session.ui_thread.post(lambda p=poses: self.session.viewport.preview(p), key="preview")
            page.wait_for_timeout(50)
        torn, seen = page.evaluate("[window.__torn, window.__seen]")
        self._do(self.session.refresh)
        print(f"{'torn frames':34s} {torn:7d} of {seen}   asked 0", flush=True)

    def four(self) -> None:
        """Four browsers on one project: from one person's edit to the last one's frame."""
        tabs = [self.page, *(self._open() for _ in range(3))]
        item = self.session.scene.objects[0]
        node = self.session.viewport.node_name(item.id)
        taken, used = [], time.process_time()
        for k in range(ROUNDS):
            self.page.page.wait_for_timeout(1500)  # until every tab has drawn what came before, finely
            pose = self.session.scene.object(item.id).pose.move((0.05 + 0.01 * k, 0.0, 0.0))
            for tab in tabs:
                tab.page.evaluate(
                    f"(what) => {{ window.__at = null; ({SHOWN})(what).then((at) => {{ window.__at = at; }}); }}",
                    [node, float(pose.position[0])],
                )
            begun = time.time() * 1000
            client = tabs[k % 4].client
            client.post(lambda p=pose, g=client: self.session.edit("move", lambda s: edits.move(s, item.id, p), by=g))
            for tab in tabs:
                tab.page.wait_for_function("window.__at !== null", polling=10)
            taken.append(max(tab.page.evaluate("window.__at") for tab in tabs) - begun)
        used = time.process_time() - used
        for tab in tabs[1:]:
            tab.page.context.close()
        line("four browsers in step", taken, "< 300", used)

    def _do(self, task: Callable[[], object]) -> None:
        self.session.ui_thread.post(task)
        self.session.ui_thread.wait(60.0)


FIGURES = ("start", "load", "swap", "answer", "undo", "drag", "optimiser", "four")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--objects", type=int, default=60)
    parser.add_argument("--rooms", type=int, default=1)
    parser.add_argument("--library", choices=("built-in", "plain"), default="built-in")
    parser.add_argument("--only", default=",".join(FIGURES))
    options = parser.parse_args()
    unknown = set(options.only.split(",")) - set(FIGURES)
    if unknown:
        parser.error(f"--only knows {', '.join(FIGURES)}, not {', '.join(sorted(unknown))}")
    if options.library == "plain":
        library: ShapeLibrary = PlainLibrary()
    else:
        from diorama_core.library.catalogue import built_in_library

        library = built_in_library()
    folder = Path(tempfile.mkdtemp(prefix="bench-editor-"))
    project = Project.create(folder / "projects" / "bench", name="bench")
    single = options.rooms == 1
    scene = furnished(library, options.objects) if single else home(library, options.objects, options.rooms)
    project.save_scene(scene)
    running = start(project=project.folder, projects_dir=folder / "projects", low_graphics=True, library=library)
    try:
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=chromium(), headless=True, args=list(FLAGS))
            returning = driver.chromium.launch_persistent_context(
                str(folder / "browser"),
                executable_path=chromium(),
                headless=True,
                viewport={"width": 1280, "height": 720},
                device_scale_factor=1,
                args=list(FLAGS),
            )
            print(
                f"{len(scene.objects)} objects, rooms: {options.rooms}, {options.library} shapes, "
                "software WebGL, low graphics",
                flush=True,
            )
            bench = Bench(browser, returning, running)
            for name in options.only.split(","):
                try:
                    getattr(bench, name)()
                except (BrowserError, AssertionError) as error:
                    print(f"{name}: NOT MEASURED: {str(error).splitlines()[0]}", flush=True)
            returning.close()
            browser.close()
    finally:
        running.stop()
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
