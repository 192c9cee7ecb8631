"""Nothing is asked of any network: serve, build and export run where there is none, and the kernel is watched.

`unshare` makes a namespace of its own with loopback only. Python itself reports the connections and look-ups of names
that its code tries; where `strace` is installed it lists those of native code and of other processes too.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.few_shapes import stored_seats

ROOT = Path(__file__).resolve().parents[2]
CONNECT = re.compile(r"connect\(\d+, \{sa_family=AF_INET6?, .*?(?:inet_addr\(\"|AF_INET6, \")([0-9a-f.:]+)\"")

WATCH = """
import os, sys
def _watch(event, given):
    address = given[1] if event == "socket.connect" else given[0]
    where = address[0] if isinstance(address, tuple) else address
    if isinstance(where, bytes):
        where = where.decode()
    local = where is None or str(where).startswith(("127.", "::1", "localhost", "/", "\\0")) or str(where) == ""
    if not local and str(where) != __import__("socket").gethostname():
        with open(os.environ["ASKED"], "a") as stream:
            stream.write(f"{event} {where}\\n")
sys.addaudithook(lambda event, given: event in ("socket.connect", "socket.getaddrinfo") and _watch(event, given))
"""
SERVE = """
import sys, urllib.request
from pathlib import Path
from diorama_app.serve import start
from tests.app.small_room import PlainLibrary
running = start(project=Path(sys.argv[1]), projects_dir=Path(sys.argv[1]).parent, library=PlainLibrary())
with urllib.request.urlopen(running.url) as page:
    assert page.status == 200 and len(page.read()) > 1000
running.stop()
"""
BUILD_AND_EXPORT = """
import tests.small_planes
from diorama_app.cli import main
photo, boxes, library, built, model = sys.argv[2:]
assert main(["build", photo, "-o", built, "--boxes", boxes, "--library", library]) == 0
assert main(["export", built, "--format", "glb", "-o", model]) == 0
"""


def cut_off() -> list[str]:
    """A command's beginning that cuts it off from every network; skips where that is not allowed."""
    loopback_up = 'ip link set lo up 2>/dev/null; exec "$@"'
    prefix = ["unshare", "--net", "--map-root-user", "sh", "-c", loopback_up, "sh"]
    if not shutil.which("unshare") or subprocess.run([*prefix, "true"], capture_output=True).returncode:
        pytest.skip("needs unshare and the right to make a network namespace")
    return prefix


def traced(tmp_path: Path) -> list[str]:
    if not shutil.which("strace"):
        return []
    return ["strace", "-f", "--seccomp-bpf", "-qq", "-e", "trace=connect", "-o", str(tmp_path / "trace")]


def run(prefix: list[str], asked: Path, code: str, *arguments: object) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "HF_HUB_OFFLINE": ""}
    environment["ASKED"] = str(asked)
    command = [*prefix, sys.executable, "-c", WATCH + code, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=300)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]


def test_a_connection_would_be_seen(tmp_path: Path) -> None:
    code = """
import socket
for address in (("192.0.2.1", 80), ("127.0.0.1", 9)):
    try:
        socket.create_connection(address, timeout=0.2)
    except OSError:
        pass
"""
    watched = traced(tmp_path)
    run([*cut_off(), *watched], tmp_path / "asked", code)
    assert "socket.connect 192.0.2.1" in (tmp_path / "asked").read_text()
    assert "127.0.0.1" not in (tmp_path / "asked").read_text()
    if watched:
        assert "192.0.2.1" in CONNECT.findall((tmp_path / "trace").read_text())


@pytest.mark.slow
def test_serving_building_and_exporting_need_no_network(tmp_path: Path) -> None:
    from tests.app.small_room import make_project

    prefix, watched = cut_off(), traced(tmp_path)
    project = make_project(tmp_path / "projects" / "demo")
    rows = np.linspace(230, 90, 240)[:, None, None] * np.ones((1, 320, 3))
    Image.fromarray(rows.astype(np.uint8)).save(tmp_path / "room.png")
    (tmp_path / "boxes.json").write_text('[{"bbox": [90, 120, 200, 220], "class": "chair"}]')
    photo, boxes, *made = (tmp_path / name for name in ("room.png", "boxes.json", "built", "room.glb"))
    given = (project.folder, photo, boxes, stored_seats(), *made)
    run([*prefix, *watched], tmp_path / "asked", SERVE + BUILD_AND_EXPORT, *given)
    assert not (tmp_path / "asked").exists(), (tmp_path / "asked").read_text()
    if watched:
        asked = {a for a in CONNECT.findall((tmp_path / "trace").read_text()) if not a.startswith(("127.", "::1"))}
        assert not asked, f"connections were tried to {asked}"
    assert (tmp_path / "room.glb").stat().st_size > 1000
