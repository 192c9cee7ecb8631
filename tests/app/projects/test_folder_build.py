from __future__ import annotations

import json
import os
import shutil
import signal
import threading
from contextlib import contextmanager
from pathlib import Path

import pytest

from diorama_app.projects.folder_build import RECORD, build_photos, report_of
from diorama_app.projects.folder_photos import photos_of
from diorama_app.projects.options import BuildOptions
from diorama_core.errors import Cancelled, ProjectError
from diorama_core.progress import CancelToken, Progress
from diorama_core.project.lock import OWNER
from diorama_core.workers import LocalWorkers
from tests.cli.room_photo import BOXES, write_room
from tests.few_shapes import SEATS, stored_seats
from tests.processes import quick_workers
from tests.waiting import until

__all__ = ["quick_workers"]
OPTIONS = BuildOptions(profile="embedded", library=SEATS)


@pytest.fixture
def folder(tmp_path: Path, quick_workers: None) -> Path:
    """Two photos with boxes, and the library of the builds."""
    stored_seats()
    photo, boxes = write_room(tmp_path, marked=1)
    photos = tmp_path / "photos"
    photos.mkdir()
    for name in ("a", "b"):
        shutil.copy(photo, photos / f"{name}.png")
        shutil.copy(boxes, photos / f"{name}.boxes.json")
    return photos


@contextmanager
def killing(project: Path, times: int):
    """Kill -9 for the process that builds this project, as the system does when memory ends; so many times."""
    killed: list[int] = []
    over = threading.Event()

    def watch() -> None:
        while len(killed) < times and not over.wait(0.02):
            try:
                process = json.loads((project / OWNER).read_text())["process"]
            except (OSError, ValueError):
                continue
            if process not in killed:
                os.kill(process, signal.SIGKILL)
                killed.append(process)

    watcher = threading.Thread(target=watch)
    watcher.start()
    yield killed
    over.set()
    watcher.join()


@pytest.mark.posix
@pytest.mark.slow
def test_a_killed_worker_costs_its_own_photo_a_second_try_and_what_died_twice_is_built_by_the_next_run(
    folder: Path, tmp_path: Path
) -> None:
    output, photos = tmp_path / "out", photos_of(folder)[0]
    with killing(output / "a", 1) as once, killing(output / "b", 2) as twice:
        first = build_photos(photos, OPTIONS, output, LocalWorkers(2), Progress())
    assert (len(once), len(twice)) == (1, 2)
    assert [(bool(r.error), r.tries) for r in first] == [(False, 2), (True, 2)]
    assert first[0].picture.exists()
    assert len(first[0].report["objects"]) == 1
    assert "without an answer" in first[1].error
    edited = output / "a" / "scene.json"
    edited.write_text(edited.read_text() + "\n")
    before = edited.stat().st_mtime_ns
    (folder / "b.boxes.json").write_text(json.dumps(BOXES))
    second = build_photos(photos, OPTIONS, output, LocalWorkers(1), Progress())
    assert [(r.error, r.kept) for r in second] == [("", True), ("", False)]
    assert edited.stat().st_mtime_ns == before, "what is finished is left as it is"
    assert [len(r.report["objects"]) for r in second] == [1, 2]


def test_on_cancellation_what_is_done_stays(folder: Path, tmp_path: Path) -> None:
    output, photos, token = tmp_path / "out", photos_of(folder)[0], CancelToken()
    (folder / "a.png").write_text("no picture")
    with pytest.raises(Cancelled):
        build_photos(photos, OPTIONS, output, LocalWorkers(1), Progress(lambda event: token.cancel(), token))
    until(lambda: not any((output / p.project / OWNER).exists() for p in photos), "no build goes on", seconds=180.0)


def test_a_place_that_cannot_be_written_is_one_line(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ProjectError, match="choose another place"):
        build_photos(photos_of(folder)[0], OPTIONS, tmp_path / "file" / "out", LocalWorkers(1), Progress())


@pytest.mark.parametrize("record", ["", "[]", '{"key": "k"}', '{"key": "other", "report": {}}'])
def test_a_record_that_is_not_of_this_build_is_none(tmp_path: Path, record: str) -> None:
    (tmp_path / RECORD).write_text(record)
    (tmp_path / "scene.json").write_text("{}")
    assert report_of(tmp_path, "k") is None
    (tmp_path / RECORD).write_text('{"key": "k", "report": {"notes": []}}')
    assert report_of(tmp_path, "k") == {"notes": []}
    (tmp_path / "scene.json").unlink()
    assert report_of(tmp_path, "k") is None
