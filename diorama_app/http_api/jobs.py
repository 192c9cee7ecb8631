"""Builds for other programs: a bounded queue, one at a time, each a project on disk that says how far it is.

A project's file keeps the job's state, so jobs survive the server: what waited or ran when it ended is taken up again
by the next one, from the stage results that the project holds. The lock of the states is held for moments only, never
while a disk or a build is waited for, since the loop that answers everybody takes it.
"""

from __future__ import annotations

import asyncio
import contextlib
import shutil
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Literal

from diorama_app.http_api.job import Job, State, build_job, line_of, note_job, read_jobs
from diorama_app.projects.begin import begin_project
from diorama_core.errors import Cancelled, DioramaError, ProjectError
from diorama_core.io.bounded import shorten
from diorama_core.io.limited import LimitedProcess
from diorama_core.layout.settings import RecipeName
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.inputs import ReadInputs
from diorama_core.pipeline.presets import Profile
from diorama_core.processes import give_back_memory
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from diorama_core.project.storage import Project

Upload = Literal["photo", "depth", "masks"]
MAX_QUEUED = 32
MAX_TRIES = 2
"""How often a build is begun before its server's end is taken to be its own fault."""


class QueueFullError(DioramaError):
    """No more jobs are taken at the moment."""


class UnknownJobError(DioramaError):
    """There is no job of this name."""


class JobStateError(DioramaError):
    """The job is not in a state in which this can be done."""


class JobQueue:
    """Jobs of one folder of projects. Safe to use from several threads."""

    def __init__(self, projects_dir: Path, library: ShapeLibrary, library_name: str) -> None:
        """Find the folder's jobs; those that were not over are queued again once `start` is called.

        Raises:
            ProjectError: the folder cannot be made.
        """
        try:
            projects_dir.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ProjectError(f"{projects_dir} cannot be made ({error.strerror}); choose another folder") from error
        self.folder = projects_dir
        self.decoder = LimitedProcess()
        """Where uploads are decoded, one after another: neither a bomb nor a crash there ends the server."""
        self._library, self._library_name = library, library_name
        noted = read_jobs(projects_dir)
        self._jobs: dict[str, Job] = {job.id: job for job in noted.values()}
        self._folders = {job.id: folder for folder, job in noted.items()}
        self._waiting = deque(j.id for j in sorted(self._jobs.values(), key=lambda j: j.created) if not j.is_over)
        self._adding = 0
        """Jobs whose projects are being written."""
        self._progress = dict[str, ProgressEvent]()
        self._tokens = dict[str, CancelToken]()
        self._changed = threading.Condition()
        self._writing = threading.Lock()
        """Held while a new project is written, so that two of one name do not meet."""
        self._listeners = set[Callable[[], None]]()
        """Told of every change, under the lock."""
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="builds", daemon=True)

    def start(self) -> None:
        """Begin to build."""
        self._thread.start()

    def close(self) -> None:
        """Stop the running build, which the next server takes up again."""
        with self._changed:
            self._closed = True
            for token in self._tokens.values():
                token.cancel()
            self._tell()
        self.decoder.stop()
        if self._thread.is_alive():
            self._thread.join()

    def add(
        self,
        file_name: str,
        read: ReadInputs,
        uploads: Mapping[Upload, bytes],
        profile: Profile,
        recipe: RecipeName,
    ) -> Job:
        """Queue a build.

        Args:
            file_name: the photo's name, which names the project.
            read: the checked inputs.
            uploads: the files as they came.
            profile: which networks are used.
            recipe: of the layout optimiser.

        Raises:
            QueueFullError: too many wait already.
            ProjectError: the project cannot be written.
        """
        with self._place(), self._writing:
            project = begin_project(self.folder, file_name, read, uploads["photo"])
            try:
                for kind in ("depth", "masks"):
                    if kind in uploads:
                        project.save_upload(kind, uploads[kind])
                project.update_info(library=self._library_name)
                job = Job(project.folder.name, time.strftime("%Y-%m-%dT%H:%M:%S"), profile, recipe)
                note_job(project.folder, job)
            except BaseException:
                shutil.rmtree(project.folder, ignore_errors=True)
                raise
        with self._changed:
            self._folders[job.id] = project.folder
            self._waiting.append(job.id)
            self._keep(job)
        return job

    @contextlib.contextmanager
    def _place(self) -> Iterator[None]:
        """A place in the queue, taken while the project is written."""
        with self._changed:
            count = len(self._waiting) + self._adding
            if count >= MAX_QUEUED or self._closed:
                raise QueueFullError(f"{count} jobs are waiting; try again when some are done")
            self._adding += 1
        try:
            yield
        finally:
            with self._changed:
                self._adding -= 1

    def jobs(self) -> tuple[Job, ...]:
        """All jobs, newest first."""
        with self._changed:
            return tuple(sorted(self._jobs.values(), key=lambda j: (j.created, j.id), reverse=True))

    def job(self, job_id: str) -> Job:
        """A job; raises `UnknownJobError` where there is none."""
        with self._changed:
            if job_id not in self._jobs:
                raise UnknownJobError(f"there is no job {shorten(job_id)!r}")
            return self._jobs[job_id]

    def progress(self, job: Job) -> ProgressEvent:
        """How far a job is."""
        words = {"queued": "waiting for the builds before it", "running": "beginning"}.get(job.state, job.state)
        known = self._progress.get(job.id) if job.state == "running" else None
        return known or ProgressEvent(1.0 if job.state == "done" else 0.0, words)

    def project(self, job_id: str) -> Project:
        """The project of a job; raises `UnknownJobError` where there is none."""
        with self._changed:
            return Project(self._folders[self.job(job_id).id])

    async def wait(self, job_id: str, seconds: float) -> Job:
        """A job once it is over, or as it is after so many seconds. However many wait, no thread does.

        Raises:
            UnknownJobError: there is none.
        """
        loop, changed = asyncio.get_running_loop(), asyncio.Event()

        def notify() -> None:
            with contextlib.suppress(RuntimeError):  # the loop has ended meanwhile
                loop.call_soon_threadsafe(changed.set)

        until = loop.time() + seconds
        with self._changed:
            self._listeners.add(notify)
        try:
            while not (job := self.job(job_id)).is_over and not self._closed and (left := until - loop.time()) > 0:
                changed.clear()
                with contextlib.suppress(asyncio.TimeoutError):
                    await asyncio.wait_for(changed.wait(), left)
            return job
        finally:
            with self._changed:
                self._listeners.discard(notify)

    def cancel(self, job_id: str) -> Job:
        """Stop a job. One that runs stops at its next check.

        Raises:
            UnknownJobError: there is none.
            JobStateError: it is over already.
            ProjectError: it is stopped, and its project cannot be written.
        """
        with self._changed:
            job = self.job(job_id)
            if job.is_over:
                raise JobStateError(f"{job_id} is over already ({job.state})")
            if job.state == "running":
                self._tokens[job_id].cancel()
                return job
            self._waiting.remove(job_id)
            job = self._keep(replace(job, state="cancelled"))
        note_job(self._folders[job_id], job)
        return job

    def remove(self, job_id: str) -> None:
        """Delete a job and its project.

        Raises:
            UnknownJobError: there is none.
            JobStateError: it waits or runs.
            ProjectError: its folder cannot be deleted; the job stays.
        """
        with self._changed:
            job = self.job(job_id)
            if not job.is_over:
                raise JobStateError(f"{job_id} is {job.state}; cancel it first")
            del self._jobs[job_id]
        try:
            shutil.rmtree(self._folders[job_id])
        except FileNotFoundError:
            pass  # somebody was quicker
        except OSError as error:
            with self._changed:
                self._jobs[job_id] = job
            raise ProjectError(f"{job_id} cannot be deleted ({error.strerror or error})") from error

    def _keep(self, job: Job) -> Job:
        """Make this a job's state; the lock is held."""
        self._jobs[job.id] = job
        self._tell()
        return job

    def _tell(self) -> None:
        self._changed.notify_all()
        for listener in self._listeners:
            listener()

    def _work(self) -> None:
        while True:
            with self._changed:
                while not self._waiting and not self._closed:
                    self._changed.wait()
                if self._closed:
                    return
                job = self._jobs[self._waiting.popleft()]
                token = self._tokens[job.id] = CancelToken()
                running = self._keep(replace(job, state="running", tries=job.tries + 1))
            try:
                over = self._finish(job, running, token)
            except Exception as problem:  # one room's defect must not end the builds of all
                over = replace(running, state="failed", error=line_of(problem, job.id))
            give_back_memory()
            with self._changed:
                self._tokens.pop(job.id, None)
                self._progress.pop(job.id, None)
                self._keep(over)

    def _finish(self, job: Job, running: Job, token: CancelToken) -> Job:
        """Build a job; gives what became of it, which its project notes."""
        folder = self._folders[job.id]
        if job.tries >= MAX_TRIES:
            over = replace(job, state="failed", error=f"the program ended {job.tries} times while it built this")
        else:
            note_job(folder, running)
            over = self._build(running, token)
        note_job(folder, over)
        return over

    def _build(self, job: Job, token: CancelToken) -> Job:
        began = time.perf_counter()

        def report(event: ProgressEvent) -> None:
            self._progress[job.id] = event

        state: State = "done"
        error: str | None = None
        try:
            progress = Progress(report, token)
            progress.check()
            build_job(job, self._folders[job.id], self._library, progress)
        except Cancelled:
            if self._closed:
                return replace(job, state="queued", tries=job.tries - 1)
            state = "cancelled"
        except Exception as problem:
            state, error = "failed", line_of(problem, job.id)
        return replace(job, state=state, error=error, seconds=round(time.perf_counter() - began, 2))
