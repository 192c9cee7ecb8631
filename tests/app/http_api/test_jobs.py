from __future__ import annotations

import json
from pathlib import Path

import pytest

from diorama_app.http_api import jobs
from diorama_app.http_api.jobs import MAX_TRIES, JobQueue, JobStateError, QueueFullError, UnknownJobError
from diorama_core.perception.inputs import read_inputs
from diorama_core.project.storage import Project
from tests.app.small_room import PlainLibrary
from tests.cli.room_photo import write_room


def _queue(folder: Path) -> JobQueue:
    return JobQueue(folder, PlainLibrary(), "built-in")


def _add(queue: JobQueue, folder: Path):
    photo, boxes = write_room(folder)
    content = photo.read_bytes()
    return queue.add("room.png", read_inputs(content, boxes=boxes), {"photo": content}, "embedded", "feasible")


def test_the_queue_is_bounded_and_kept_on_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jobs, "MAX_QUEUED", 2)
    projects = tmp_path / "projects"
    queue = _queue(projects)
    first, second = _add(queue, tmp_path), _add(queue, tmp_path)
    with pytest.raises(QueueFullError, match="2 jobs are waiting"):
        _add(queue, tmp_path)
    assert len(list(projects.iterdir())) == 2, "what is refused leaves nothing behind"
    with pytest.raises(JobStateError):
        queue.remove(first.id)
    assert queue.cancel(first.id).state == "cancelled"
    queue.remove(first.id)
    with pytest.raises(UnknownJobError):
        queue.job(first.id)
    assert _queue(projects).jobs() == (second,)


def test_what_cannot_be_read_is_no_job(tmp_path: Path) -> None:
    queue = _queue(tmp_path / "projects")
    good = _add(queue, tmp_path)
    for name, job in (("a", {"state": "asleep", "created": "now"}), ("b", "x"), ("c", {"more": 1})):
        Project.create(tmp_path / "projects" / name).update_info(job=job)
    (tmp_path / "projects" / "d").mkdir()
    (tmp_path / "projects" / "d" / "project.json").write_text("{")
    assert [job.id for job in _queue(tmp_path / "projects").jobs()] == [good.id]


def test_a_build_that_ends_its_server_is_not_begun_for_ever(tmp_path: Path) -> None:
    job = _add(_queue(tmp_path / "projects"), tmp_path)
    path = tmp_path / "projects" / job.id / "project.json"
    document = json.loads(path.read_text())
    document["job"] |= {"state": "running", "tries": MAX_TRIES}
    path.write_text(json.dumps(document))
    queue = _queue(tmp_path / "projects")
    assert queue.job(job.id).state == "queued"
    queue.start()
    over = queue.wait(job.id, 20.0)
    queue.close()
    assert over.state == "failed"
    assert "ended 2 times" in (over.error or "")
