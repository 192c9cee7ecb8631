from __future__ import annotations

import asyncio
import json
import shutil
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from fastapi import FastAPI

from diorama_app.http_api import jobs
from diorama_app.http_api.job import Job
from diorama_app.http_api.jobs import MAX_TRIES, JobQueue, JobStateError, QueueFullError, UnknownJobError
from diorama_app.http_api.routes import create_app
from diorama_app.web.visitors import Visitors
from diorama_core.errors import ProjectError
from diorama_core.perception.inputs import read_inputs
from diorama_core.progress import Progress
from diorama_core.project.storage import Project
from tests.app.http_api.asgi import messages
from tests.app.small_room import PlainLibrary, furnished_scene, make_project
from tests.cli.room_photo import write_room
from tests.waiting import until


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
    assert Project.open(projects / first.id).info()["library"] == "built-in"
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
    over = asyncio.run(queue.wait(job.id, 20.0))
    queue.close()
    assert over.state == "failed"
    assert "ended 2 times" in (over.error or "")


async def _asked(app: FastAPI, method: str, path: str) -> tuple[int, dict]:
    """What an application answers, without a server."""
    sent = await messages(app, method=method, path=path)
    body = b"".join(m.get("body", b"") for m in sent[1:])
    headers = dict(sent[0]["headers"])
    if headers.get(b"content-type") == b"application/json":
        return sent[0]["status"], json.loads(body)
    return sent[0]["status"], {k.decode(): v.decode("latin-1") for k, v in headers.items()}


def _ask(queue: JobQueue, method: str, path: str) -> tuple[int, dict]:
    return asyncio.run(_asked(create_app(queue, Visitors("127.0.0.1")), method, path))


def _done(projects: Path, name: str) -> Path:
    """A project with a scene and a finished job."""
    project = make_project(projects / name)
    project.update_info(job={"created": "2026-11-28T03:00:00", "state": "done"})
    return project.folder


DAMAGES: dict[str, Callable[[Path], object]] = {
    "gone": shutil.rmtree,
    "moved": lambda folder: folder.rename(folder.with_name("elsewhere")),
    "info cut": lambda folder: (folder / "project.json").write_text("{"),
    "info of others": lambda folder: (folder / "project.json").write_text("[]"),
    "scene gone": lambda folder: (folder / "scene.json").unlink(),
    "scene cut": lambda folder: (folder / "scene.json").write_text("{"),
    "scene a folder": lambda folder: ((folder / "scene.json").unlink(), (folder / "scene.json").mkdir()),
    "notes are no list": lambda folder: Project(folder).update_info(notes=7),
    "notes of anything": lambda folder: Project(folder).update_info(
        notes=[{"a": 1}, None, "x" * 10_000, "half \ud800"]
    ),
}
"""What may happen to a job's project while the server runs."""


@pytest.mark.parametrize("kind", DAMAGES)
def test_one_damaged_job_does_not_hide_the_others(tmp_path: Path, kind: str) -> None:
    """A project that was damaged or moved made the list of all jobs an internal error."""
    _done(tmp_path, "good")
    bad = _done(tmp_path, "bad")
    queue = _queue(tmp_path)
    DAMAGES[kind](bad)
    status, told = _ask(queue, "GET", "/v1/jobs")
    assert status == 200
    jobs = {job["id"]: job for job in told["jobs"]}
    assert (jobs["good"]["error"], jobs["good"]["objects"] > 0) == (None, True)
    assert jobs["bad"]["state"] == "done"
    assert (jobs["bad"]["error"] is None) == kind.startswith("notes")
    assert all(len(note) <= 300 for note in jobs["bad"]["notes"])
    assert _ask(queue, "GET", "/v1/jobs/bad") == (200, jobs["bad"])
    for way in ("scene", "picture", "export/glb"):
        status, told = _ask(queue, "GET", f"/v1/jobs/bad/{way}")
        assert status == 200 or ("error" in told and "\n" not in told["error"]), (way, told)


@pytest.mark.parametrize(
    "job", [{"seconds": float("1e400")}, {"error": "x" * 5000}, {"created": 7}, {"seconds": "nan"}]
)
def test_a_noted_job_of_odd_values_is_none(tmp_path: Path, job: dict) -> None:
    folder = _done(tmp_path, "odd")
    document = json.loads((folder / "project.json").read_text())
    (folder / "project.json").write_text(json.dumps(document | {"job": document["job"] | job}))
    assert _ask(_queue(tmp_path), "GET", "/v1/jobs") == (200, {"jobs": []})


@pytest.mark.parametrize("name", ["запись", 'a"b', "b\udce9te", "with space"])
def test_a_job_in_a_folder_of_any_name_is_exported(tmp_path: Path, name: str) -> None:
    """A name that is no Latin-1 could not be put into a header; a quote ended the file's name there."""
    project = Project(_done(tmp_path, name))
    project.save_scene(replace(furnished_scene(), objects=(), supports=()))  # of no shapes, which a library would have
    queue = _queue(tmp_path)
    (job,) = _ask(queue, "GET", "/v1/jobs")[1]["jobs"]
    status, headers = asyncio.run(
        _asked(create_app(queue, Visitors("127.0.0.1")), "GET", f"/v1/jobs/{job['id']}/export/svg")
    )
    assert (status, headers["content-disposition"]) == (200, 'attachment; filename="scene.svg"')


def test_patient_pollers_hold_no_thread(tmp_path: Path) -> None:
    """Forty of them, as many as there are threads for requests, kept everybody else waiting for 42 seconds."""
    job = _add(_queue(tmp_path), tmp_path)
    queue = _queue(tmp_path)

    async def crowd() -> tuple[float, set[str]]:
        app = create_app(queue, Visitors("127.0.0.1"))
        pollers = [asyncio.create_task(_asked(app, "GET", f"/v1/jobs/{job.id}?wait_s=50")) for _ in range(100)]
        await asyncio.sleep(0.1)
        began, threads = time.monotonic(), threading.active_count()
        assert (await _asked(app, "GET", "/v1/formats"))[0] == 200
        took = time.monotonic() - began
        assert threading.active_count() <= threads + 1
        queue.cancel(job.id)
        return took, {told["state"] for _, told in await asyncio.gather(*pollers)}

    took, states = asyncio.run(asyncio.wait_for(crowd(), 30.0))
    assert states == {"cancelled"}, "whoever waits is told at once"
    assert took < 10.0


def test_a_job_can_be_cancelled_at_any_moment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between being taken from the queue and being begun, a job was in neither state."""

    def build(job: Job, folder: Path, library: object, progress: Progress) -> None:
        for _ in range(200):
            progress.check()
            time.sleep(0.005)

    monkeypatch.setattr(jobs, "build_job", build)
    queue = _queue(tmp_path / "projects")
    queue.start()
    states = []
    for number in range(25):
        job = _add(queue, tmp_path)
        time.sleep(0.0004 * number)
        assert queue.cancel(job.id).state in ("running", "cancelled")
        states.append(asyncio.run(queue.wait(job.id, 20.0)).state)
    queue.close()
    assert set(states) == {"cancelled"}


def test_a_build_that_ends_in_anything_leaves_the_queue_alive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def build(job: Job, folder: Path, library: object, progress: Progress) -> None:
        (folder / "project.json").unlink()  # the state can be noted nowhere any more
        raise MemoryError("no more")

    monkeypatch.setattr(jobs, "build_job", build)
    queue = _queue(tmp_path / "projects")
    queue.start()
    for _ in range(2):
        over = asyncio.run(queue.wait(_add(queue, tmp_path).id, 20.0))
        assert over.state == "failed"
    queue.close()


def test_what_cannot_be_deleted_stays_a_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _done(tmp_path, "room")
    queue = _queue(tmp_path)

    def refused(path: Path) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(jobs.shutil, "rmtree", refused)
    assert _ask(queue, "DELETE", "/v1/jobs/room") == (500, {"error": "room cannot be deleted (Permission denied)"})
    assert queue.job("room").state == "done"


def _job(folder: Path, created: str, **changes: object) -> str:
    make_project(folder).update_info(job={"created": created, "state": "queued", **changes})
    return folder.name


def test_jobs_are_listed_newest_first_and_built_oldest_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    built: list[str] = []
    monkeypatch.setattr(jobs, "build_job", lambda job, *rest: built.append(job.id))
    for day, name in ((2, "b"), (1, "c"), (2, "a"), (3, "d")):
        _job(tmp_path / name, f"2026-11-0{day}T03:00:00")
    _job(tmp_path / "over", "2026-11-04T03:00:00", state="done")
    queue = _queue(tmp_path)
    assert [job.id for job in queue.jobs()] == ["over", "d", "b", "a", "c"]
    queue.start()
    until(lambda: all(job.is_over for job in queue.jobs()), "all are built")
    queue.close()
    assert (built[0], set(built[1:3]), built[3:]) == ("c", {"a", "b"}, ["d"])
    assert all(job.state == "done" and job.error is None for job in queue.jobs())
    with pytest.raises(JobStateError, match="c is over already"):
        queue.cancel("c")


def test_what_the_end_of_a_server_stopped_is_built_by_the_next(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun = threading.Event()

    def build(job: Job, folder: Path, library: object, progress: Progress) -> None:
        progress.report(0.5, "half way")
        begun.set()
        while True:
            progress.check()

    monkeypatch.setattr(jobs, "build_job", build)
    job_id = _job(tmp_path / "room", "2026-11-01T03:00:00", tries=1)
    queue = _queue(tmp_path)
    assert (queue.progress(queue.job(job_id)).fraction, queue._thread.daemon) == (0.0, True)
    queue.start()
    assert begun.wait(60.0)
    running = queue.job(job_id)
    assert (running.state, running.tries) == ("running", 2)
    assert queue.progress(running).message == "half way"
    with pytest.raises(JobStateError, match="room is running; cancel it first"):
        queue.remove(job_id)
    queue.close()
    assert (queue.job(job_id).state, queue.job(job_id).tries) == ("queued", 1)
    with pytest.raises(QueueFullError):
        _add(queue, tmp_path)
    assert _queue(tmp_path).job(job_id) == queue.job(job_id)
    monkeypatch.setattr(jobs, "build_job", lambda *about: None)
    later = _queue(tmp_path)
    later.start()
    over = asyncio.run(later.wait(job_id, 60.0))
    later.close()
    assert (over.state, over.tries) == ("done", 2)
    assert over.seconds is not None
    assert 0.0 <= over.seconds < 60.0
    assert later.progress(over).fraction == 1.0
    assert _queue(tmp_path).job(job_id) == over, "its project has it"


def test_who_waits_gets_the_job_as_it_is_when_the_time_or_the_server_is_over(tmp_path: Path) -> None:
    job_id = _job(tmp_path / "room", "2026-11-01T03:00:00")
    queue = _queue(tmp_path)

    async def close_meanwhile() -> str:
        waiting = asyncio.create_task(queue.wait(job_id, 600.0))
        while not queue._listeners:
            await asyncio.sleep(0)
        queue.close()
        return (await asyncio.wait_for(waiting, 60.0)).state

    assert asyncio.run(queue.wait(job_id, 0.01)).state == "queued"
    assert queue._listeners == set()
    assert asyncio.run(close_meanwhile()) == "queued"
    assert queue._listeners == set()
    with pytest.raises(UnknownJobError):
        asyncio.run(queue.wait("none", 1.0))


def test_a_job_that_cannot_be_written_leaves_nothing_and_holds_no_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(jobs, "MAX_QUEUED", 1)
    queue = _queue(tmp_path / "projects")
    with monkeypatch.context() as full:
        full.setattr(jobs, "note_job", refuse)
        for _ in range(2):
            with pytest.raises(ProjectError, match="the disk is full"):
                _add(queue, tmp_path)
    assert list((tmp_path / "projects").iterdir()) == []
    assert queue.jobs() == ()
    assert _add(queue, tmp_path).state == "queued"


def refuse(*about: object) -> None:
    raise ProjectError("the disk is full")


def test_a_job_that_is_being_written_has_its_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jobs, "MAX_QUEUED", 1)
    queue, real = _queue(tmp_path / "projects"), jobs.note_job

    def while_another_asks(folder: Path, job: Job) -> None:
        with pytest.raises(QueueFullError, match="1 jobs are waiting"), queue._place():
            pass
        real(folder, job)

    monkeypatch.setattr(jobs, "note_job", while_another_asks)
    job = _add(queue, tmp_path)
    assert Project(tmp_path / "projects" / job.id).uploads().keys() == {"photo"}


def test_a_job_whose_project_somebody_deleted_can_be_removed(tmp_path: Path) -> None:
    _done(tmp_path, "room")
    queue = _queue(tmp_path)
    shutil.rmtree(tmp_path / "room")
    queue.remove("room")
    assert queue.jobs() == ()


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ProjectError, match=r"cannot be made \(Not a directory\)"):
        _queue(tmp_path / "file" / "projects")


def test_what_runs_is_noted_and_what_was_cancelled_while_it_waited_is_never_built(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    projects, begun, go, built = tmp_path / "new" / "projects", threading.Event(), threading.Event(), []

    def build(job: Job, folder: Path, library: PlainLibrary, progress: Progress) -> None:
        built.append(job.id)
        begun.set()
        go.wait(60.0)

    monkeypatch.setattr(jobs, "build_job", build)
    queue = _queue(projects)
    first, second, third = (_add(queue, tmp_path) for _ in range(3))
    queue.start()
    assert begun.wait(60.0)
    assert Project.open(projects / first.id).info()["job"]["state"] == "running"
    queue.cancel(second.id)
    go.set()
    assert asyncio.run(queue.wait(third.id, 60.0)).state == "done"
    assert built == [first.id, third.id]
    assert queue.job(second.id).state == "cancelled"
    queue.close()
