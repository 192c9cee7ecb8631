"""Kills at random moments: is everything that was acknowledged there afterwards, and nothing half?

    python scripts/crash.py [--kills 125] [--minutes 60]
                            [--only edits,builds,optimiser,exports,library,uploads,photos,jobs]

Each kind of work runs in a process that is forked from this one, which has loaded everything, and is killed (SIGKILL)
at a random moment of the time that the work takes. Then its files are read as the next program would read them:

- `edits` edits and saves as the editor does. The newest edit that the project or an unsaved copy has is compared with
  the newest one that was acknowledged.
- `builds` builds a room from a photo; a killed build resumes. Stage results read back; there is no scene or a whole
  one; a finished one has the bytes of a build that nobody killed.
- `optimiser` optimises a room and saves it. Its scene is the one before or the one after.
- `exports` writes four formats over older files. Each is the older one or the new one.
- `library` adds models; a killed run resumes. Every shape that is listed reads back; a finished library has them all.
- `uploads` decodes uploads. The decoding process ends with the program.
- `photos` adds photos of the room to a project. Those that are listed read back, and each that was acknowledged is.
- `jobs` sends, cancels and deletes jobs of the API. Each has the state that was acknowledged, and a done one its scene.

Needs pytest and hypothesis. Prints a line a kind; `wrong` counts what cannot be read, has other content than promised,
or is left running. Exits with 1 when anything is.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
os.environ["OMP_NUM_THREADS"] = "1"  # threads do not survive a fork

import numpy as np
import trimesh

import scripts.needs  # noqa: F401  # ends with a line where a package is missing
from diorama_app.projects.uploads import Upload, read_packed
from diorama_core.errors import DioramaError
from diorama_core.export import export_scene
from diorama_core.io.atomic import remove_leftovers
from diorama_core.io.limited import LimitedProcess
from diorama_core.layout.recipes import recipe
from diorama_core.library.ingest.adding import add_models
from diorama_core.library.ingest.finding import model_files, sources
from diorama_core.library.ingest.given import Given
from diorama_core.library.ingest.known_shapes import load_known_shapes
from diorama_core.library.store.stored import StoredLibrary
from diorama_core.progress import Progress
from diorama_core.project.lock import ProjectLock
from diorama_core.scene.edits import rename
from diorama_core.scene.types import Pose
from diorama_core.workers import FinishedItem
from scripts.crash_projects import Figures, Going, builds, edits, jobs, photos
from scripts.killing import Say, Work, duration, killed, unreadable
from tests.app.small_room import PlainLibrary, furnished_scene, make_project
from tests.io.test_bombs import png
from tests.processes import runs

FORMATS = {"glb": "room.glb", "obj": "room.zip", "stl": "room.stl", "svg": "room.svg"}
GONE_S = 120.0
"""How long a process that should end is waited for."""


def optimiser(going: Going, chance: np.random.Generator) -> Figures:
    """See the module."""
    scene = replace(furnished_scene(), objects=furnished_scene().objects[:3], supports=furnished_scene().supports[:3])
    offset = np.array((0.2, -0.3, 0.05))
    askew = tuple(replace(o, pose=Pose.upright(o.pose.T_world_object[:3, 3] + offset)) for o in scene.objects)
    before = replace(scene, objects=askew)
    with tempfile.TemporaryDirectory() as name:
        project = make_project(Path(name) / "demo", before)
        first = project.scene_path.read_bytes()
        layout = recipe("all-in-one", PlainLibrary(), depth_measured=False)
        layout.optimise(before, Progress())  # here: it loads what every fork would load

        def work(say: Say) -> None:
            with ProjectLock(project.folder, "crash"):
                project.save_scene(layout.optimise(project.load_scene(), Progress())[0])

        whole_s = duration(work)
        second = project.scene_path.read_bytes()
        assert second != first, "the optimiser left the scene as it was"
        wrong = saved = killed_within = 0
        while going(killed_within):
            project.save_scene(before)
            killed_within += not killed(work, float(chance.uniform(0.0, 1.05 * whole_s))).finished
            now = project.scene_path.read_bytes()
            wrong += now not in (first, second)
            saved += now == second
            remove_leftovers(project.folder, 0.0)
    return killed_within, f"{saved} saved ({whole_s:.2f} s each), {wrong} wrong", wrong


def exports(going: Going, chance: np.random.Generator) -> Figures:
    """See the module."""
    scene, library = furnished_scene(), PlainLibrary()
    other = rename(replace(scene, objects=scene.objects[:3], supports=scene.supports[:3]), "chair_1", "armchair")

    def export(made: Any, folder: Path) -> Work:
        def work(say: Say) -> None:
            for kind, file in FORMATS.items():
                export_scene(made, library, folder / file, kind)
                say(kind)

        return work

    with tempfile.TemporaryDirectory() as name:
        folder, versions = Path(name), []
        export(scene, folder)(lambda line: None)  # here: it loads what every fork would load
        for made in (scene, other):
            whole_s = duration(export(made, folder))
            versions.append({file: (folder / file).read_bytes() for file in FORMATS.values()})
        assert all(versions[0][file] != versions[1][file] for file in FORMATS.values())
        wrong = replaced = left = killed_within = number = 0
        while going(killed_within):
            number += 1
            ended = killed(export((scene, other)[number % 2], folder), float(chance.uniform(0.0, 1.05 * whole_s)))
            killed_within += not ended.finished
            for file in FORMATS.values():
                wrong += (folder / file).read_bytes() not in (versions[0][file], versions[1][file])
            done = {FORMATS[kind] for kind in ended.lines}
            wrong += sum((folder / f).read_bytes() != versions[number % 2][f] for f in done)
            replaced += len(done)
            left += _removed(p for p in folder.iterdir() if p.name not in FORMATS.values())
    said = f"{replaced} files replaced ({whole_s:.2f} s for four), {wrong} wrong, {left} parts of files removed"
    return killed_within, said, wrong


def _removed(paths: Iterable[Path]) -> int:
    found = list(paths)
    for path in found:
        path.unlink()
    return len(found)


class _Here:
    """Works in this process: the store is what is tried, not the pool."""

    count = 1

    def map(self, function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[FinishedItem[Any, Any]]:
        """See `diorama_core.workers.Workers`."""
        for item in items:
            yield FinishedItem(item, function(item))


def library(going: Going, chance: np.random.Generator) -> Figures:
    """See the module."""
    load_known_shapes()  # learnt once a machine, before the first library
    with tempfile.TemporaryDirectory() as name:
        models, root = Path(name) / "models", Path(name)
        models.mkdir()
        for number, size in enumerate(((0.5, 0.5, 0.9), (1.6, 0.8, 0.7), (0.4, 0.3, 1.8), (2.0, 0.9, 0.8))):
            trimesh.Scene(trimesh.creation.box(size)).export(models / f"model-{number}.glb")
        found = sources(models, model_files(models)[0], Given(up="+z", unit_m=1.0), {})

        def add(folder: Path) -> Work:
            def work(say: Say) -> None:
                add_models(found, StoredLibrary(folder, create=True), _Here())

            return work

        whole_s = duration(add(root / "whole"))
        expected = {s.id: s for s in StoredLibrary(root / "whole").shapes()}
        number = finished = wrong = seen = killed_within = 0
        while going(killed_within):
            folder = root / f"library-{number}"
            ended = killed(add(folder), float(chance.uniform(0.0, 1.05 * whole_s)))
            killed_within += not ended.finished
            if (folder / "library.sqlite").exists():
                shapes, faults = _read_library(folder)
                wrong, seen = wrong + faults + (ended.finished and shapes != expected), seen + len(shapes)
            if ended.finished:
                finished, number = finished + 1, number + 1
    said = f"{finished} libraries finished ({whole_s:.1f} s each), {seen} shapes read back, {wrong} wrong"
    return killed_within, said, wrong


def _read_library(folder: Path) -> tuple[dict[str, Any], int]:
    """Its shapes, and how many cannot be read."""
    try:
        library = StoredLibrary(folder, create=True)
        shapes = {s.id: s for s in library.shapes()}
    except DioramaError:
        return {}, 1
    wrong = sum(unreadable(lambda s=s: (library.shape(s), library.mesh(s))) for s in shapes)
    library.close()
    return shapes, wrong


def uploads(going: Going, chance: np.random.Generator) -> Figures:
    """See the module."""
    data = png(3000, 2000, 8, 2, 3)

    def work(say: Say) -> None:
        process = LimitedProcess()
        while True:
            process.call("p", read_packed, Upload(data, "p.png"))
            say("read")

    began = time.monotonic()
    killed(work, 0.0, from_first=True)
    first_s = time.monotonic() - began
    read = left = started = kills = 0
    longest_s = 0.0
    while going(kills):
        ended, kills = killed(work, float(chance.uniform(0.0, 2.0 * first_s))), kills + 1
        read, started, began = read + len(ended.lines), started + len(ended.children), time.monotonic()
        while any(map(runs, ended.children)) and time.monotonic() - began < GONE_S:
            time.sleep(0.01)  # the processes are not ours to wait for
        longest_s = max(longest_s, time.monotonic() - began)
        left += sum(map(runs, ended.children))
    said = f"{read} read, {started} decoding processes, {left} left running; the last ended after {longest_s:.1f} s"
    return kills, said, left


KINDS = {f.__name__: f for f in (edits, builds, optimiser, exports, library, uploads, photos, jobs)}


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--kills", type=int, default=125)
    parser.add_argument("--minutes", type=float, default=60.0, help="of each kind at most")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default=",".join(KINDS))
    options = parser.parse_args()
    all_wrong = 0
    for name in options.only.split(","):
        began = time.monotonic()
        until = began + 60.0 * options.minutes
        kills, said, wrong = KINDS[name](
            lambda done, until=until: done < options.kills and time.monotonic() < until,
            np.random.default_rng(options.seed),
        )
        all_wrong += wrong
        print(f"{name}: {kills} kills in {time.monotonic() - began:.0f} s, {said}", flush=True)
    return 1 if all_wrong else 0


if __name__ == "__main__":
    sys.exit(main())
