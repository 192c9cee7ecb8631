"""Kills at random moments: is everything that was acknowledged there afterwards, and nothing half?

    python scripts/crash.py [--kills 200] [--seed 0] [--only edits,stages,uploads]

`edits`: a process edits and saves as the editor does and prints each edit; it is killed, and the newest edit that
the project or an unsaved copy has is compared with what was printed. `stages`: a process writes stage results; every
one that is there afterwards reads back. `uploads`: a process decodes uploads; its decoding process ends with it.
Prints one line a kind: kills, edits acknowledged, files damaged, the most that was lost.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from diorama_app.session.recovery import Recovery
from diorama_core.errors import DioramaError
from diorama_core.pipeline import codec
from diorama_core.project.lock import ProjectLock
from diorama_core.project.storage import Project, read_scene
from tests.app.small_room import make_project

ROOT = Path(__file__).resolve().parents[1]

EDITS = """
import sys, time
from pathlib import Path
from diorama_app.session.recovery import Recovery
from diorama_app.session.autosave import Autosave
from diorama_core.project.lock import ProjectLock
from diorama_core.project.storage import Project
from diorama_core.scene.edits import rename
project = Project.open(Path(sys.argv[1]))
lock = ProjectLock(project.folder, "crash")
saver = Autosave(print, Recovery(Path(sys.argv[2])))
scene = project.load_scene()
number = int(sys.argv[3])
while True:
    number += 1
    scene = rename(scene, "chair_1", f"edit {number}")
    saver.save_soon(project, scene)
    print(number, time.time(), flush=True)
    time.sleep(0.02)
"""
STAGES = """
import sys
from pathlib import Path
import numpy as np
from diorama_core.pipeline import codec
from diorama_core.io.atomic import write_atomically
number = 0
while True:
    number += 1
    data = codec.dump((np.full((300, 400), number, np.int32),))
    write_atomically(Path(sys.argv[1]) / f"depth-{number % 7}.zip", data)
    print(number, flush=True)
"""
UPLOADS = """
import sys
from diorama_app.session.reading import Upload, read_packed
from diorama_core.io.limited import LimitedProcess
from tests.io.test_bombs import png
process, data = LimitedProcess(), png(3000, 2000, 8, 2, 3)
while True:
    process.call("p", read_packed, Upload(data, "p.png"))
    print(process._process.pid, flush=True)
"""


def killed(code: str, arguments: list[str], after_s: float) -> list[str]:
    """The lines that a process printed until it was killed, counted from its first."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    process = subprocess.Popen(
        [sys.executable, "-c", code, *arguments], stdout=subprocess.PIPE, text=True, env=environment
    )
    assert process.stdout is not None
    first = process.stdout.readline()
    time.sleep(after_s)
    process.kill()
    lines = [first, *process.stdout.readlines()]
    process.wait()
    process.stdout.close()
    return [line for line in lines if line.endswith("\n")]


def edits(kills: int, random: np.random.Generator) -> str:
    acknowledged = damaged = 0
    lost_s = 0.0
    with tempfile.TemporaryDirectory() as name:
        project, unsaved = make_project(Path(name) / "demo"), Path(name) / "unsaved"
        number = 0
        for _ in range(kills):
            lines = killed(EDITS, [str(project.folder), str(unsaved), str(number)], float(random.uniform(0.0, 1.5)))
            times = {int(n): float(t) for n, t in (line.split() for line in lines)}
            ended = max(times.values())
            acknowledged += len(times)
            retained = [project.scene_path, *unsaved.glob("*.json")]
            found = [0]
            for path in retained:
                try:
                    label = read_scene(path).object("chair_1").label
                    found.append(int(label.split()[-1]) if label.startswith("edit ") else 0)
                except DioramaError:
                    damaged += 1
            missing = [t for n, t in times.items() if n > max(found)]
            lost_s = max(lost_s, ended - min(missing) if missing else 0.0)
            number = max(times)
            with ProjectLock(project.folder, "after"):
                Recovery(unsaved).clean_up(Project.open(project.folder))
    return f"edits: {kills} kills, {acknowledged} acknowledged, {damaged} files damaged, at most {lost_s:.2f} s lost"


def stages(kills: int, random: np.random.Generator) -> str:
    written = damaged = 0
    with tempfile.TemporaryDirectory() as name:
        for _ in range(kills):
            written += len(killed(STAGES, [name], float(random.uniform(0.0, 0.3))))
            for path in Path(name).glob("*.zip"):
                try:
                    codec.load(path.read_bytes())
                except DioramaError:
                    damaged += 1
    return f"stages: {kills} kills, {written} written, {damaged} files damaged"


def uploads(kills: int, random: np.random.Generator) -> str:
    left = read = 0
    for _ in range(kills):
        lines = killed(UPLOADS, [], float(random.uniform(0.0, 0.5)))
        read += len(lines)
        time.sleep(1.0)
        left += any(Path(f"/proc/{line.strip()}").exists() for line in lines[-1:])
    return f"uploads: {kills} kills, {read} read, {left} decoding processes left behind"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="edits,stages,uploads")
    options = parser.parse_args()
    kinds = {"edits": edits, "stages": stages, "uploads": uploads}
    for name in options.only.split(","):
        print(kinds[name](options.kills, np.random.default_rng(options.seed)), flush=True)


if __name__ == "__main__":
    main()
