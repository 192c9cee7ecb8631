"""Many people on one server: how long an edit takes to be seen, and what a flood, a slow reader and half requests do.

    python scripts/load.py [--clients 20] [--projects 1] [--objects 60] [--minutes 5] [--every 1.0]
                           [--disturb flood,slow,half]

Every client is a connection that speaks the page's own protocol (`tests/app/wire.py`). It hides or shows an object of
its own about once a second, and measures the time until its own outliner shows that. The servers are processes of their
own, one a project; clients are dealt out. With --disturb, further connections send commands as fast as they can for
nine seconds, never read what they are sent, or begin requests that they do not end. Prints one line a figure.
"""

from __future__ import annotations

import argparse
import json
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections import defaultdict
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from diorama_core.project.storage import Project
from diorama_core.scene.types import Pose, Scene, Support
from tests.app.small_room import furnished_scene, make_project
from tests.app.wire import WirePage

FLOOD_S = 9.0
DISTURBANCES = ("flood", "slow", "half")


class Page:
    """A page of the editor, whose panels' pieces can be found and pressed."""

    def __init__(self, port: int, query: str = "") -> None:
        self.page = WirePage(port, query=query)
        self._numbers = defaultdict[str, int](int)

    def piece(self, mark: str, seconds: float = 120.0) -> tuple[str, str]:
        """The piece of a panel that has this in it, once there is one, and the field that takes its actions."""

        def find() -> tuple[str, str] | None:
            for uuid in list(self.page.elements):
                content = self.content(uuid)
                if mark in content:
                    found = re.search(r"__dioSend\((?:'|&#x27;)([0-9a-f-]+)", content)
                    return (uuid, found[1]) if found else None
            return None

        found: tuple[str, str] = self.page.wait_for(find, seconds)
        return found

    def content(self, uuid: str) -> str:
        return str(self.page.elements.get(uuid, {}).get("content", ""))

    def press(self, field: str, do: str, arg: str) -> None:
        self._numbers[field] += 1
        self.page.set(field, json.dumps([{"do": do, "arg": arg, "add": False, "number": self._numbers[field]}]))


class Person(Page):
    """A page whose outliner is pressed."""

    def __init__(self, port: int) -> None:
        super().__init__(port)
        self.latencies: list[float] = []
        self.lost = 0
        self.outliner, self.field = self.piece('data-do="hide"')

    def hidden(self, object_id: str) -> bool:
        """Whether this page says that an object is hidden."""
        row = rf'data-do="hide" data-arg="{object_id}"[^>]* title="(Hide|Show) '
        found = re.search(row, self.content(self.outliner))
        assert found is not None, f"the outliner has no row for {object_id}"
        return found[1] == "Show"

    def edit(self, object_id: str) -> None:
        """Hide or show an object and wait until the outliner says so."""
        before, began = self.hidden(object_id), time.monotonic()
        self.press(self.field, "hide", object_id)
        try:
            self.page.wait_for(lambda: self.hidden(object_id) != before, 20.0)
        except AssertionError:
            self.lost += 1
            return
        self.latencies.append(time.monotonic() - began)


SERVE = """
import sys
from pathlib import Path
from diorama_app.serve import serve
from diorama_core.library.store import CombinedLibrary, open_library
from tests.app.small_room import PlainLibrary
folder = Path(sys.argv[1])
serve(project=folder, projects_dir=folder.parent, host="127.0.0.1", port=0, open_browser=False, low_graphics=True,
      token=None, library=eval(sys.argv[2]))
"""


def serving(folder: Path, library: str = "PlainLibrary()") -> tuple[subprocess.Popen, int]:
    """A server of a project, and its port; `library` is Python."""
    process, line = started("-c", SERVE, str(folder), library)
    return process, int(re.search(r":(\d+)/", line)[1])


def started(*words: str) -> tuple[subprocess.Popen, str]:
    """A process of Python, and the first line that it prints."""
    command, root = [sys.executable, *words], str(Path(__file__).resolve().parents[1])
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=root)
    assert process.stdout is not None
    return process, process.stdout.readline()


def flood(port: int) -> None:
    person = Person(port)
    until, count = time.monotonic() + FLOOD_S, 0
    ids = [o.id for o in furnished_scene().objects]
    while time.monotonic() < until:
        person.press(person.field, "lock", ids[count % len(ids)])
        count += 1
    print(f"flood: {count} actions in {FLOOD_S:.0f} s", flush=True)
    person.page.close()


def slow_reader(port: int, until: float) -> None:
    page = WirePage(port, read=False)
    time.sleep(max(until - time.monotonic(), 0.0))
    page.socket.socket.close()


def half_requests(port: int, until: float, count: int = 50) -> None:
    begun = []
    for _ in range(count):
        connection = socket.create_connection(("127.0.0.1", port))
        connection.sendall(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Half: ")
        begun.append(connection)
    time.sleep(max(until - time.monotonic(), 0.0))
    for connection in begun:
        connection.close()


def used(process: subprocess.Popen) -> tuple[float, float]:
    """Processor seconds and resident megabytes of a server."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100.0, int(fields[21]) * 4096 / 1e6


def room_of(count: int) -> Scene:
    """The furnished room with so many objects: further chairs in rows."""
    scene, chair = furnished_scene(), furnished_scene().object("chair_1")
    more = tuple(
        replace(
            chair, id=f"more_{i}", label=f"chair {i}", pose=Pose.upright((-2.0 + 0.6 * (i % 8), 4.0 + i // 8, 0.43))
        )
        for i in range(count - len(scene.objects))
    )
    edges = tuple(Support(o.id, "floor") for o in more)
    return replace(scene, objects=(*scene.objects, *more), supports=(*scene.supports, *edges))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--clients", type=int, default=20)
    parser.add_argument("--projects", type=int, default=1)
    parser.add_argument("--objects", type=int, default=60, help="in each project's scene")
    parser.add_argument("--minutes", type=float, default=5.0)
    parser.add_argument("--every", type=float, default=1.0, help="seconds between two edits of one client")
    parser.add_argument("--disturb", default="", help=f"some of {','.join(DISTURBANCES)}")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        scene = room_of(options.objects)
        projects = [make_project(Path(name) / f"projects-{i}" / "demo", scene) for i in range(options.projects)]
        servers = [serving(p.folder) for p in projects]
        try:
            run(options, servers, projects)
        finally:
            for process, _ in servers:
                process.terminate()
            for process, _ in servers:
                process.wait(30)


def run(options: argparse.Namespace, servers: list[tuple[subprocess.Popen, int]], projects: list[Project]) -> None:
    people = [Person(servers[i % len(servers)][1]) for i in range(options.clients)]
    ids = [o.id for o in room_of(options.objects).objects]
    until = time.monotonic() + 60.0 * options.minutes

    def work(number: int) -> None:
        chance = np.random.default_rng(number)
        while time.monotonic() < until:
            time.sleep(float(chance.uniform(0.0, 2.0 * options.every)))
            people[number].edit(ids[number % len(ids)])

    before = [used(process) for process, _ in servers]
    threads = [threading.Thread(target=work, args=(i,)) for i in range(options.clients)]
    port = servers[0][1]
    disturbing = {"half": (half_requests, port, until), "slow": (slow_reader, port, until), "flood": (flood, port)}
    threads += [threading.Thread(target=f, args=a) for name, (f, *a) in disturbing.items() if name in options.disturb]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    taken = np.concatenate([p.latencies for p in people]) * 1e3
    after = [used(process) for process, _ in servers]
    seconds = sum(a[0] - b[0] for a, b in zip(after, before, strict=True))
    print(f"{options.clients} clients on {len(servers)} servers, {options.minutes:g} minutes: {len(taken)} edits")
    print(f"edit to own panel: median {np.median(taken):.0f} ms, p95 {np.percentile(taken, 95):.0f} ms (asked 500)")
    print(f"longest {taken.max():.0f} ms; edits not seen in 20 s: {sum(p.lost for p in people)} (asked 0)")
    print(f"server time: {1e3 * seconds / max(len(taken), 1):.1f} ms an edit; memory {after[0][1]:.0f} MB")
    for person in people:
        person.page.close()
    time.sleep(2.0)  # edits are saved within a second
    whole = sum(p.load_scene().has_object(ids[0]) for p in projects)
    print(f"projects that read back whole: {whole} of {len(projects)}")


if __name__ == "__main__":
    main()
