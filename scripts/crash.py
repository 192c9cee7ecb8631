"""Kills at random moments: is everything that was acknowledged there afterwards, and nothing half?

    python scripts/crash.py [--kills 200] [--minutes 60] [--only edits,builds,optimiser,exports,library,uploads]

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

Needs pytest and hypothesis. Prints a line a kind; `wrong` counts what cannot be read, has other content than promised,
or is left running. Exits with 1 when anything is.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import select
import signal
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
os.environ["OMP_NUM_THREADS"] = "1"  # threads do not survive a fork

import numpy as np
import trimesh

import scripts.needs  # noqa: F401  # ends with a line where a package is missing
from diorama_app.projects.uploads import Upload, read_packed
from diorama_app.session.autosave import Autosave
from diorama_app.session.recovery import Recovery
from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.errors import DioramaError
from diorama_core.export import export_scene
from diorama_core.io.atomic import remove_leftovers
from diorama_core.io.limited import LimitedProcess
from diorama_core.layout.recipes import recipe
from diorama_core.library.ingest.adding import add_models, model_files, sources
from diorama_core.library.ingest.guess import Given
from diorama_core.library.ingest.known_shapes import known_shapes
from diorama_core.library.store.stored import StoredLibrary
from diorama_core.pipeline import codec
from diorama_core.progress import Progress
from diorama_core.project.build import build_project
from diorama_core.project.lock import ProjectLock
from diorama_core.project.storage import Project, read_scene
from diorama_core.scene.edits import rename
from diorama_core.scene.types import Pose
from diorama_core.workers import FinishedItem
from tests.app.small_room import PlainLibrary, furnished_scene, make_project, plain_photo
from tests.io.test_bombs import png
from tests.processes import runs

Say = Callable[[str], None]
Work = Callable[[Say], None]
Figures = tuple[int, str, int]
"""How many kills, what to print of them, and how much of it is wrong."""
Going = Callable[[int], bool]
"""Whether to go on after so many kills."""
FORMATS = {"glb": "room.glb", "obj": "room.zip", "stl": "room.stl", "svg": "room.svg"}
GONE_S = 120.0
"""How long a process that should end is waited for."""


@dataclass
class Ended:
    """What is known of a process that was killed, or ended before."""

    lines: list[str] = field(default_factory=list)
    """What it said, to the end."""
    finished: bool = False
    children: tuple[int, ...] = ()
    """Processes that it had started when it was killed."""


class FailedError(Exception):
    """The work itself failed."""


def killed(work: Work, after_s: float, *, from_first: bool = False) -> Ended:
    """Run `work` in a fork of this process and kill it.

    Args:
        work: Told how to say what is acknowledged, in lines.
        after_s: From its start, or from its first line.
        from_first: Count from the first line.
    """
    ours, theirs = os.pipe()
    process = os.fork()
    if process == 0:
        os.close(ours)
        _work_and_exit(work, theirs)
    os.close(theirs)
    with os.fdopen(ours, "rb") as pipe:
        said = bytearray()
        if from_first:
            said += os.read(pipe.fileno(), 65536)
        ended = _read_until(pipe.fileno(), said, time.monotonic() + after_s)
        children = () if ended else _children(process)
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
        while part := os.read(pipe.fileno(), 65536) if not _shared(children) else b"":
            said += part
    os.waitpid(process, 0)
    lines = said.decode().split("\n")[:-1]  # what follows the last line's end is half a line
    if lines and lines[-1].startswith("failed"):
        raise FailedError("\n".join(lines))
    return Ended([line for line in lines if line != "finished"], lines[-1:] == ["finished"], children)


def _work_and_exit(work: Work, pipe: int) -> None:
    def say(line: str) -> None:
        os.write(pipe, f"{line}\n".encode())

    try:
        work(say)
        say("finished")
    except BaseException:  # the process ends here: the line is all that is heard of it
        say("failed " + traceback.format_exc().replace("\n", " | "))
    os._exit(0)


def _read_until(pipe: int, said: bytearray, until: float) -> bool:
    """Take up what is said until a time; whether the process ended before."""
    while (left := until - time.monotonic()) > 0:
        if select.select([pipe], [], [], left)[0]:
            part = os.read(pipe, 65536)
            if not part:
                return True
            said += part
    return False


def _shared(children: tuple[int, ...]) -> bool:
    """Whether others may hold the pipe open, so that its end says nothing."""
    return bool(children)


def _children(process: int) -> tuple[int, ...]:
    path = Path(f"/proc/{process}/task/{process}/children")
    return tuple(map(int, path.read_text().split())) if path.exists() else ()


def _duration(work: Work) -> float:
    """How long the work takes when nobody kills it."""
    began = time.monotonic()
    assert killed(work, 600.0).finished
    return time.monotonic() - began


def edits(going: Going, chance: np.random.Generator) -> Figures:
    """See the module."""
    acknowledged = wrong = kills = 0
    lost_s = 0.0
    with tempfile.TemporaryDirectory() as name:
        project, unsaved, number = make_project(Path(name) / "demo"), Path(name) / "unsaved", 0

        def work(say: Say) -> None:
            ProjectLock(project.folder, "crash")
            saver, scene, at = Autosave(print, Recovery(unsaved)), project.load_scene(), number
            while True:
                at += 1
                scene = rename(scene, "chair_1", f"edit {at}")
                saver.save_soon(project, scene)
                say(f"{at} {time.time()}")
                time.sleep(0.02)  # faster than anybody edits

        while going(kills):
            ended, kills = killed(work, float(chance.uniform(0.0, 1.0)), from_first=True), kills + 1
            times = {int(n): float(t) for n, t in (line.split() for line in ended.lines)}
            acknowledged, number = acknowledged + len(times), max(times)
            found = [0]
            for path in (project.scene_path, *unsaved.glob("*.json")):
                try:
                    label = read_scene(path).object("chair_1").label
                    found.append(int(label.split()[-1]) if label.startswith("edit ") else 0)
                except DioramaError:
                    wrong += 1
            missing = [t for n, t in times.items() if n > max(found)]
            lost_s = max(lost_s, max(times.values()) - min(missing) if missing else 0.0)
            with ProjectLock(project.folder, "after"):
                Recovery(unsaved).clean_up(project)
    return kills, f"{acknowledged} edits acknowledged, {wrong} wrong, at most {lost_s:.2f} s lost", wrong


def builds(going: Going, chance: np.random.Generator) -> Figures:
    """See the module."""
    boxes = (LabelledBox((60.0, 50.0, 110.0, 105.0), "table", "dining table"),)
    inputs = Inputs(replace(plain_photo(160, 120), name="room.png"), boxes)
    with tempfile.TemporaryDirectory() as name:
        root, number, finished, wrong, parts, killed_within = Path(name), 0, 0, 0, 0, 0

        def build(folder: Path) -> Work:
            def work(say: Say) -> None:
                project = Project.create(folder)
                with ProjectLock(folder, "crash"):
                    build_project(project, inputs, PlainLibrary())

            return work

        whole_s = _duration(build(root / "whole"))
        expected = (root / "whole" / "scene.json").read_bytes()
        while going(killed_within):
            folder = root / f"room-{number}"
            ended = killed(build(folder), float(chance.uniform(0.0, 1.05 * whole_s)))
            killed_within += not ended.finished
            wrong += _unreadable_stages(folder)
            parts += remove_leftovers(folder, 0.0)
            if (folder / "scene.json").exists():
                wrong += (folder / "scene.json").read_bytes() != expected
            if ended.finished:
                finished, number = finished + 1, number + 1
    said = f"{finished} builds finished ({whole_s:.1f} s each), {wrong} wrong, {parts} parts of files removed"
    return killed_within, said, wrong


def _unreadable_stages(folder: Path) -> int:
    count = 0
    for path in folder.glob("stages/*.zip"):
        try:
            codec.load(path.read_bytes())
        except DioramaError:
            count += 1
    return count


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

        whole_s = _duration(work)
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
            whole_s = _duration(export(made, folder))
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
    known_shapes()  # learnt once a machine, before the first library
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

        whole_s = _duration(add(root / "whole"))
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
    wrong = 0
    for shape_id in shapes:
        try:
            library.shape(shape_id)
            library.mesh(shape_id)
        except DioramaError:
            wrong += 1
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


KINDS = {f.__name__: f for f in (edits, builds, optimiser, exports, library, uploads)}


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--kills", type=int, default=200)
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
