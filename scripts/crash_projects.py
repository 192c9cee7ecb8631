"""Kills of the work on projects: edits, builds, further photos and the API's jobs. See `crash.py`."""

from __future__ import annotations

import asyncio
import shutil
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from diorama_app.http_api.job import read_jobs
from diorama_app.http_api.jobs import JobQueue
from diorama_app.session.autosave import Autosave
from diorama_app.session.recovery import Recovery
from diorama_core.artefacts import FurtherPhoto, Inputs, LabelledBox
from diorama_core.errors import DioramaError
from diorama_core.io.atomic import remove_leftovers
from diorama_core.io.bounded import read_json
from diorama_core.perception.inputs import ReadInputs
from diorama_core.pipeline import codec
from diorama_core.project.build import build_project
from diorama_core.project.further_photos import load_photos, note_placed, save_photos
from diorama_core.project.lock import ProjectLock
from diorama_core.project.storage import Project, read_scene
from diorama_core.scene.edits import rename
from scripts.killing import Say, Work, duration, killed, unreadable
from tests.app.small_room import PlainLibrary, make_project, plain_photo
from tests.io.test_bombs import png

Figures = tuple[int, str, int]
"""How many kills, what to print of them, and how much of it is wrong."""
Going = Callable[[int], bool]
"""Whether to go on after so many kills."""
KEPT = 5
"""Photos of a project, and jobs that are not deleted."""
JOB_S = 600.0
"""A build that takes longer is a fault."""


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
    inputs = _small_inputs()
    with tempfile.TemporaryDirectory() as name:
        root, number, finished, wrong, parts, killed_within = Path(name), 0, 0, 0, 0, 0

        def build(folder: Path) -> Work:
            def work(say: Say) -> None:
                project = Project.create(folder)
                with ProjectLock(folder, "crash"):
                    build_project(project, inputs, PlainLibrary())

            return work

        whole_s = duration(build(root / "whole"))
        expected = (root / "whole" / "scene.json").read_bytes()
        while going(killed_within):
            folder = root / f"room-{number}"
            ended = killed(build(folder), float(chance.uniform(0.0, 1.05 * whole_s)))
            killed_within += not ended.finished
            wrong += sum(unreadable(lambda p=p: codec.load(p.read_bytes())) for p in folder.glob("stages/*.zip"))
            parts += remove_leftovers(folder, 0.0)
            if (folder / "scene.json").exists():
                wrong += (folder / "scene.json").read_bytes() != expected
            if ended.finished:
                finished, number = finished + 1, number + 1
    said = f"{finished} builds finished ({whole_s:.1f} s each), {wrong} wrong, {parts} parts of files removed"
    return killed_within, said, wrong


def _small_inputs() -> Inputs:
    boxes = (LabelledBox((60.0, 50.0, 110.0, 105.0), "table", "dining table"),)
    return Inputs(replace(plain_photo(160, 120), name="room.png"), boxes)


def photos(going: Going, chance: np.random.Generator) -> Figures:
    """See the module."""
    acknowledged = wrong = kills = left = number = 0
    with tempfile.TemporaryDirectory() as name:
        project = make_project(Path(name) / "demo")
        scene = project.load_scene()

        def work(say: Say) -> None:
            at, kept = number, load_photos(project)[0]
            with ProjectLock(project.folder, "crash"):
                while True:
                    at, before = at + 1, kept
                    kept = (*kept, FurtherPhoto(f"photo-{at}", _small_inputs()))[-KEPT:]
                    save_photos(project, kept, before)
                    note_placed(project, rename(scene, "chair_1", f"photo {at}"))
                    say(str(at))

        while going(kills):
            ended, kills = killed(work, float(chance.uniform(0.0, 1.0)), from_first=True), kills + 1
            told = [int(line) for line in ended.lines]
            found, damage = load_photos(project)
            listed = [int(p.name.removeprefix("photo-")) for p in found]
            wrong += len(damage) + (listed[-1] not in (told[-1], told[-1] + 1)) + _unreadable_notes(project)
            acknowledged, number = acknowledged + len(told), listed[-1]
            left += remove_leftovers(project.folder, 0.0)
    return kills, f"{acknowledged} photos acknowledged, {wrong} wrong, {left} parts of files removed", wrong


def _unreadable_notes(project: Project) -> int:
    paths = (project.scene_path, *project.stages_folder.glob("*.json"))
    return sum(unreadable(lambda p=p: read_json(p, DioramaError, most=p.stat().st_size)) for p in paths)


def jobs(going: Going, chance: np.random.Generator) -> Figures:
    """See the module."""
    read, photo = ReadInputs(_small_inputs(), ()), png(160, 120, 8, 2, 3)
    known, acknowledged, wrong, kills, left = dict[str, str](), 0, 0, 0, 0
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)

        def serve(say: Say, count: int) -> None:
            queue = JobQueue(root, PlainLibrary(), "built-in")
            queue.start()
            for number in range(count):
                job = queue.add(f"room-{kills}-{number}.png", read, {"photo": photo}, "embedded", "feasible")
                say(f"{job.id} waits")
                if number % 2 == 1:
                    queue.cancel(job.id)
                for waiting in [j for j in queue.jobs() if not j.is_over]:
                    say(f"{waiting.id} {asyncio.run(queue.wait(waiting.id, JOB_S)).state}")
                for old in queue.jobs()[KEPT:]:
                    say(f"{old.id} leaves")
                    queue.remove(old.id)
                    say(f"{old.id} is_gone")
            queue.close()

        serve(lambda line: None, 1)  # here: it loads what every fork would load
        whole_s = duration(lambda say: serve(say, 1))
        while going(kills):
            ended = killed(lambda say: serve(say, 99), float(chance.uniform(0.0, 2.0 * whole_s)))
            kills, acknowledged = kills + 1, acknowledged + len(ended.lines)
            known |= dict(map(str.split, ended.lines))
            wrong += _wrong_jobs(root, known)
            folders = {folder for folder, job in read_jobs(root).items() if known.get(job.id) != "leaves"}
            for folder in set(root.iterdir()) - folders:  # of what was not acknowledged, or was half deleted
                shutil.rmtree(folder)
                left += 1
    return kills, f"{acknowledged} states acknowledged, {wrong} wrong, {left} half projects", wrong


def _wrong_jobs(root: Path, known: dict[str, str]) -> int:
    """How many jobs are not what was acknowledged of them."""
    found = {job.id: job.state for job in read_jobs(root).values()}
    count = sum((root / job_id).exists() for job_id, state in known.items() if state == "is_gone")
    for job_id in [j for j, state in known.items() if state not in ("leaves", "is_gone")]:
        state = found.get(job_id)
        count += state is None or (known[job_id] != "waits" and state != known[job_id])
        count += state == "done" and unreadable(lambda job_id=job_id: read_scene(root / job_id / "scene.json"))
    return count
