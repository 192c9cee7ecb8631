"""Many people over all features for long: what each kind of action takes, and whether memory and threads come back.

    python scripts/soak.py [--people 20] [--projects 5] [--minutes 30] [--seed 0]

One server of the editor with several projects, and one of the API, each a process of its own. Every person is a
connection that speaks the page's protocol; two of twenty are programs that use the API. A person edits an object of
their own most of the time, and now and then gives an edit in words, exports, looks at other photos of the room, opens a
scan, or begins a project of a photo and builds it. Prints a line a kind of action (how many, median, p95), memory after
the first fifth and at the end (asked: within 10 %), threads before and after, and edits that are lost (asked: none).
"""

from __future__ import annotations

import argparse
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import threading
import time
import traceback
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np
import trimesh
from PIL import Image

import scripts.needs  # noqa: F401  # ends with a line where a package is missing
from diorama_core.project.lock import OWNER
from diorama_core.project.storage import Project
from scripts.load import Page, room_of, serving, started
from tests.app.http_api.openapi_client import Client
from tests.app.small_room import make_project, plain_photo
from tests.app.wire import WirePage

WEIGHTS = {"edit": 80, "words": 6, "export": 5, "photo": 3, "scan": 0.3, "build": 0.15}
"""What a person does next. An action a second makes a build in ten minutes and a scan in five of each person: twenty
who began one every minute would ask for four times the processor's time of two cores."""
PATIENCE_S = 180.0
OBJECTS = 40
WARM_UP = 0.2
API = 0.1
"""Of the people, those that are programs."""
LIBRARY = 'CombinedLibrary([PlainLibrary(), open_library("built-in")])'
"""Of the editor: a scan's objects get shapes of the built-in one, those of the rooms that are edited are plain."""
BUSY = "is still running"
"""What a page says where another job is under way."""
SETTLED_S = 75.0
"""After which a project that nobody looks at is closed."""


class BusyError(Exception):
    """Another person's job is under way in the project."""


class Figures:
    """What was measured; several threads write."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self.seconds = defaultdict[str, list[float]](list)
        self.failed = defaultdict[str, list[str]](list)
        self.busy = defaultdict[str, int](int)
        """Refused, since another person's job was under way in the project."""

    def timed(self, kind: str, act: Callable[[], object]) -> None:
        began = time.monotonic()
        try:
            act()
        except BusyError:
            with self._lock:
                self.busy[kind] += 1
            return
        except Exception as error:  # counted, and the person goes on
            with self._lock:
                where = [f.line for f in traceback.extract_tb(error.__traceback__) if f.filename == __file__][-1]
                self.failed[kind].append(f"{type(error).__name__}: {str(error)[:100]}, in: {where}")
            return
        with self._lock:
            self.seconds[kind].append(time.monotonic() - began)


def _until(holds: Callable[[], object]) -> None:
    until = time.monotonic() + PATIENCE_S
    while not holds():
        if time.monotonic() > until:
            raise TimeoutError("it never came")
        time.sleep(0.05)


def _png(seed: int) -> bytes:
    rgb = plain_photo(160, 120).rgb.copy()
    rgb[:4, :4] = seed % 251
    buffer = io.BytesIO()
    Image.fromarray(rgb).save(buffer, "PNG")
    return buffer.getvalue()


def _scan(seed: int) -> bytes:
    """Points of a room of its own size, with a table in it."""
    chance = np.random.default_rng(seed)
    room = trimesh.creation.box((4.0 + seed % 3, 3.0, 2.5))
    room.invert()
    table = trimesh.creation.box((1.2, 0.8, 0.7), trimesh.transformations.translation_matrix((0.5, 0.2, -0.9)))
    points = [
        trimesh.sample.sample_surface(m, n, seed=int(chance.integers(1000)))[0]
        for m, n in ((room, 9000), (table, 2000))
    ]
    return bytes(trimesh.PointCloud(np.vstack(points)).export(file_type="ply"))


class Person(Page):
    """One page, and an object of its own in the project that it shows."""

    def __init__(self, port: int, folder: Path, own: str, figures: Figures, seed: int) -> None:
        super().__init__(port, f"?project={folder.name}")
        self.port, self.folder, self.own, self.figures = port, folder, own, figures
        self.name = f"{folder.name}-{own}"
        self.chance = np.random.default_rng(seed)
        self.hidden = False
        """As this person set it last."""

    def _act(self, mark: str, do: str, arg: object) -> str:
        uuid, field = self.piece(mark, PATIENCE_S)
        self.press(field, do, arg if isinstance(arg, str) else json.dumps(arg))
        return uuid

    def _shown(self, uuid: str, pattern: str) -> bool:
        return re.search(pattern, self.content(uuid)) is not None

    def _holds(self, *words: str) -> bool:
        """Whether a piece of a panel has all of these in it."""
        return any(all(w in self.content(uuid) for w in words) for uuid in list(self.page.elements))

    def edit(self) -> None:
        """Hide or show the own object, until the own outliner says so."""
        self.hidden = not self.hidden
        uuid = self._act('data-do="hide"', "hide", self.own)
        now = "Show" if self.hidden else "Hide"
        self.page.wait_for(lambda: self._shown(uuid, rf'data-arg="{self.own}"[^>]* title="{now} '), PATIENCE_S)

    def words(self) -> None:
        self._act(
            'data-change="ask"', "ask", ["", str(self.chance.choice(["make all chairs red", "move the lamp left"]))]
        )
        self._until(lambda: self._holds('aria-label="Proposed edits"'))
        uuid, _ = self.piece('aria-label="Proposed edits"', PATIENCE_S)
        self._act('aria-label="Proposed edits"', "cancel", "")
        self.page.wait_for(lambda: not self._shown(uuid, "Proposed edits"), PATIENCE_S)

    def export(self) -> None:
        name = str(self.chance.choice(["glb", "svg", "obj", "usdz", "sh3d"]))
        began = time.monotonic()
        self._act('data-do="export"', "choose", name)
        self._act('data-do="export"', "export", "")
        self._until(lambda: any(m["at"] > began and "StartDownload" in m["type"] for m in list(self.page.messages)))

    def photo(self) -> None:
        """One more photo of the room."""
        folder = self.folder / "photos"
        count = len(list(folder.glob("*.zip")))
        if count >= 6:
            return  # enough for a project
        self._send("Add a photo of this room", f"more-{self.chance.integers(10**9)}.png", _png(count))
        self._until(lambda: len(list(folder.glob("*.zip"))) > count)

    def scan(self) -> None:
        self._send("Open a file", f"scan-{self.name}.ply", _scan(int(self.chance.integers(100))))
        self._begun(f"scan-{self.name}")

    def build(self) -> None:
        """A project of a photo, built on a page of its own."""
        self._send("New from a photo", f"photo-{self.name}.png", _png(int(self.chance.integers(200))))
        folder = self._begun(f"photo-{self.name}", scene=False)
        page, self.page = self.page, WirePage(self.port, query=f"?project={folder.name}")
        try:
            self.page.wait_for(lambda: self._holds("__dioCanvas.told", "image/jpeg"), PATIENCE_S)
            self._act('id="dio-canvas-send"', "draw", [60.0, 50.0, 110.0, 105.0])
            self.page.wait_for(lambda: self._holds("Build scene (1)"), PATIENCE_S)
            self._act('data-do="build"', "build", "")
            self._until((folder / "scene.json").exists)
        finally:
            self.page.close()
            self.page = page

    def _until(self, holds: Callable[[], object]) -> None:
        """Wait, unless the page says that a job of somebody else is under way."""
        count = len(self.page.notices)
        _until(lambda: holds() or any(BUSY in n for n in self.page.notices[count:]))
        if not holds():
            raise BusyError

    def _send(self, label: str, name: str, content: bytes) -> None:
        self.before = {p.name for p in self.folder.parent.iterdir()}
        self.page.upload(self.page.element(label, "UploadButton"), name, content)

    def _begun(self, stem: str, *, scene: bool = True) -> Path:
        """The new project's folder, once it is whole."""

        def found() -> Path | None:
            new = [p for p in self.folder.parent.glob(f"{stem}*") if p.name not in self.before]
            whole = "scene.json" if scene else "stages/inputs.zip"
            begun = (p for p in new if (p / whole).exists() and (p / "project.json").exists())
            return next((p for p in begun if scene or not (p / OWNER).exists()), None)  # who made it has let it go

        self._until(found)
        folder = found()
        assert folder is not None
        return folder

    def work(self, until: float) -> None:
        kinds, weights = list(WEIGHTS), np.array(list(WEIGHTS.values()), float)
        while time.monotonic() < until:
            kind = str(self.chance.choice(kinds, p=weights / weights.sum()))
            self.figures.timed(kind, getattr(self, kind))
            time.sleep(float(self.chance.uniform(0.0, 2.0)))


def program(url: str, figures: Figures, until: float, seed: int) -> None:
    """Send a photo, wait, take the scene and a file, delete."""
    client = Client(url)
    while time.monotonic() < until:

        def job() -> None:
            made = client.create_job(photo=(f"api-{seed}.png", _png(seed)), profile="embedded", fov_deg=60)
            assert made.status == 202, made.body
            job_id = made.body["id"]
            _until(lambda: client.get_job(job_id=job_id, wait_s=20).body["state"] in ("done", "failed"))
            for answer in (client.get_scene(job_id=job_id), client.export_scene(job_id=job_id, format_name="glb")):
                assert answer.status == 200, answer.body
            assert client.delete_job(job_id=job_id).status == 204

        figures.timed("api job", job)
        figures.timed("api list", lambda: client.list_jobs().body["jobs"])


def api(folder: Path) -> tuple[subprocess.Popen[str], str]:
    process, line = started("-m", "diorama_app.cli", "api", "--port", "0", "--projects", str(folder))
    return process, line.split(" at ")[1].split()[0]


def state(process: subprocess.Popen[str]) -> tuple[float, int]:
    """Resident megabytes and threads of a server."""
    text = Path(f"/proc/{process.pid}/status").read_text()
    rss, threads = re.search(r"VmRSS:\s+(\d+)", text), re.search(r"Threads:\s+(\d+)", text)
    assert rss is not None
    assert threads is not None
    return int(rss[1]) / 1e3, int(threads[1])


def run(options: argparse.Namespace, place: Path) -> int:
    scene = room_of(OBJECTS)
    folders = [make_project(place / "projects" / f"room-{i}", scene).folder for i in range(options.projects)]
    (editor, port), (service, url) = serving(folders[0], LIBRARY), api(place / "jobs")
    try:
        return measure(options, folders, (editor, port), (service, url))
    finally:
        for process in (editor, service):
            process.terminate()
        for process in (editor, service):
            process.wait(60)


def measure(options: argparse.Namespace, folders: list[Path], editor: Any, service: Any) -> int:
    figures, ids = Figures(), [o.id for o in room_of(OBJECTS).objects]
    before, loads = [state(editor[0]), state(service[0])], [os.getloadavg()[0]]
    until = time.monotonic() + 60.0 * options.minutes
    programs = round(API * options.people)
    people = [
        Person(editor[1], folders[i % len(folders)], ids[-1 - i // len(folders)], figures, options.seed + i)
        for i in range(options.people - programs)
    ]
    threads = [threading.Thread(target=p.work, args=(until,)) for p in people]
    threads += [threading.Thread(target=program, args=(service[1], figures, until, i)) for i in range(programs)]
    for thread in threads:
        thread.start()
    time.sleep(60.0 * options.minutes * WARM_UP)
    warm = [state(editor[0]), state(service[0])]
    loads.append(os.getloadavg()[0])
    for thread in threads:
        thread.join()
    after = [state(editor[0]), state(service[0])]
    loads.append(os.getloadavg()[0])
    for person in people:
        person.page.close()
    time.sleep(SETTLED_S)
    return told(figures, people, (before, warm, after, [state(editor[0]), state(service[0])]), loads)


def told(figures: Figures, people: list[Person], states: Any, loads: list[float]) -> int:
    for kind in sorted({*figures.seconds, *figures.failed, *figures.busy}):
        taken, failed = np.array(figures.seconds[kind]) * 1e3, figures.failed[kind]
        times = f"median {np.median(taken):.0f} ms, p95 {np.percentile(taken, 95):.0f} ms" if len(taken) else "never"
        print(f"{kind:9} {len(taken):5} done, {len(failed)} failed, {figures.busy[kind]} while busy; {times}")
        for line in sorted(set(failed))[:5]:
            print(f"          {line}")
    before, warm, after, left = states
    for number, name in enumerate(("editor", "API")):
        growth = 100.0 * (after[number][0] / warm[number][0] - 1.0)
        memory = f"{warm[number][0]:.0f} MB after a fifth, {after[number][0]:.0f} MB at the end"
        threads = f"{before[number][1]} before, {after[number][1]} at the end, {left[number][1]} after"
        print(f"{name}: memory {memory} ({growth:+.1f} %, asked within 10); threads {threads}")
    print(
        "load average: " + ", ".join(f"{load:.0f}" for load in loads) + " (at the beginning, after a fifth, at the end)"
    )
    lost = sum(Project(p.folder).load_scene().object(p.own).hidden != p.hidden for p in people)
    print(f"edits lost: {lost} of {len(people)} people (asked 0)")
    return 1 if lost else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--people", type=int, default=20)
    parser.add_argument("--projects", type=int, default=5)
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=0)
    with tempfile.TemporaryDirectory() as place:
        return run(parser.parse_args(), Path(place))


if __name__ == "__main__":
    sys.exit(main())
