"""Builds for other programs: a bounded queue, one at a time, each a project on disk that says how far it is.

A project's file keeps the job's state, so jobs survive the server: what waited or ran when it ended is taken up again
by the next one, from the stage results that the project holds.
"""

from __future__ import annotations

import logging
import shutil
import threading
import time
from collections import deque
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Literal

from diorama_app.projects.begin import begin_project
from diorama_core.errors import Cancelled, DioramaError, ProjectError
from diorama_core.io.limited import LimitedProcess
from diorama_core.library.record import ShapeLibrary
from diorama_core.models.store import ModelStore
from diorama_core.perception.inputs import ReadInputs
from diorama_core.pipeline.presets import Profile
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from diorama_core.project.storage import Project

log = logging.getLogger(__name__)

State = Literal["queued", "running", "done", "failed", "cancelled"]
Recipe = Literal["feasible", "paper", "all-in-one"]
Upload = Literal["photo", "depth", "masks"]
JOB = "job"
"""The entry of `project.json` that a job is kept in."""
MAX_QUEUED = 32
MAX_TRIES = 2
"""How often a build is begun before its server's end is taken to be its own fault."""


class QueueFullError(DioramaError):
    """No more jobs are taken at the moment."""


class UnknownJobError(DioramaError):
    """There is no job of this name."""


class JobStateError(DioramaError):
    """The job is not in a state in which this can be done."""


@dataclass(frozen=True)
class Job:
    """One photo's way to a scene."""

    id: str
    """Name of the project's folder."""
    created: str
    """Local time, ISO 8601."""
    profile: Profile = "auto"
    recipe: Recipe = "feasible"
    state: State = "queued"
    tries: int = 0
    seconds: float | None = None
    """What the build took, once it is over."""
    error: str | None = None
    """Why it failed, in one line."""

    @property
    def over(self) -> bool:
        """Whether nothing more happens."""
        return self.state in ("done", "failed", "cancelled")


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
        self._jobs: dict[str, Job] = {job.id: job for job in _stored_jobs(projects_dir)}
        self._waiting = deque(j.id for j in sorted(self._jobs.values(), key=lambda j: j.created) if not j.over)
        self._progress = dict[str, ProgressEvent]()
        self._tokens = dict[str, CancelToken]()
        self._changed = threading.Condition()
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
            self._changed.notify_all()
        self.decoder.stop()
        if self._thread.is_alive():
            self._thread.join()

    def add(
        self,
        file_name: str,
        read: ReadInputs,
        uploads: Mapping[Upload, bytes],
        profile: Profile,
        recipe: Recipe,
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
        with self._changed:
            if len(self._waiting) >= MAX_QUEUED or self._closed:
                raise QueueFullError(f"{len(self._waiting)} jobs are waiting; try again when some are done")
            project = begin_project(self.folder, file_name, read, uploads["photo"])
            for kind in ("depth", "masks"):
                if kind in uploads:
                    project.save_upload(kind, uploads[kind])
            project.update_info(library=self._library_name)
            job = self._set(Job(project.folder.name, time.strftime("%Y-%m-%dT%H:%M:%S"), profile, recipe))
            self._waiting.append(job.id)
            self._changed.notify_all()
            return job

    def jobs(self) -> tuple[Job, ...]:
        """All jobs, newest first."""
        with self._changed:
            return tuple(sorted(self._jobs.values(), key=lambda j: (j.created, j.id), reverse=True))

    def job(self, job_id: str) -> Job:
        """A job; raises `UnknownJobError` where there is none."""
        with self._changed:
            if job_id not in self._jobs:
                raise UnknownJobError(f"there is no job {job_id!r}")
            return self._jobs[job_id]

    def progress(self, job_id: str) -> ProgressEvent:
        """How far a job is."""
        job = self.job(job_id)
        words = {"queued": "waiting for the builds before it", "running": "beginning"}.get(job.state, job.state)
        known = self._progress.get(job_id) if job.state == "running" else None
        return known or ProgressEvent(1.0 if job.state == "done" else 0.0, words)

    def project(self, job_id: str) -> Project:
        """The project of a job; raises `UnknownJobError` where there is none."""
        return Project(self.folder / self.job(job_id).id)

    def wait(self, job_id: str, seconds: float) -> Job:
        """A job once it is over, or as it is after so many seconds."""
        until = time.monotonic() + seconds
        with self._changed:
            while not (job := self.job(job_id)).over and (left := until - time.monotonic()) > 0 and not self._closed:
                self._changed.wait(left)
            return job

    def cancel(self, job_id: str) -> Job:
        """Stop a job. One that runs stops at its next check.

        Raises:
            UnknownJobError: there is none.
            JobStateError: it is over already.
        """
        with self._changed:
            job = self.job(job_id)
            if job.over:
                raise JobStateError(f"{job_id} is over already ({job.state})")
            if job.state == "running":
                self._tokens[job_id].cancel()
                return job
            self._waiting.remove(job_id)
            return self._set(replace(job, state="cancelled"))

    def remove(self, job_id: str) -> None:
        """Delete a job and its project.

        Raises:
            UnknownJobError: there is none.
            JobStateError: it waits or runs.
        """
        with self._changed:
            job = self.job(job_id)
            if not job.over:
                raise JobStateError(f"{job_id} is {job.state}; cancel it first")
            try:
                shutil.rmtree(self.folder / job.id)
            except FileNotFoundError:
                pass  # somebody was quicker
            except OSError as error:
                raise ProjectError(f"{job_id} cannot be deleted ({error.strerror})") from error
            del self._jobs[job_id]

    def _set(self, job: Job) -> Job:
        """Keep a job's new state, on disk first."""
        Project(self.folder / job.id).update_info(**{JOB: {k: v for k, v in asdict(job).items() if k != "id"}})
        with self._changed:
            self._jobs[job.id] = job
            self._changed.notify_all()
        return job

    def _work(self) -> None:
        while True:
            with self._changed:
                while not self._waiting and not self._closed:
                    self._changed.wait()
                if self._closed:
                    return
                job = self._jobs[self._waiting.popleft()]
                token = self._tokens[job.id] = CancelToken()
            try:
                self._run(job, token)
            except DioramaError as error:  # the project's own file cannot be written any more
                log.error("%s: %s", job.id, error)
                with self._changed:
                    self._jobs[job.id] = replace(job, state="failed", error=str(error))
                    self._changed.notify_all()
            finally:
                self._tokens.pop(job.id, None)
                self._progress.pop(job.id, None)

    def _run(self, job: Job, token: CancelToken) -> None:
        if job.tries >= MAX_TRIES:
            self._set(replace(job, state="failed", error=f"the program ended {job.tries} times while it built this"))
            return
        job = self._set(replace(job, state="running", tries=job.tries + 1))
        began = time.perf_counter()

        def reported(event: ProgressEvent) -> None:
            self._progress[job.id] = event

        state: State = "done"
        error: str | None = None
        try:
            self._build(job, Progress(reported, token))
        except Cancelled:
            if self._closed:
                self._set(replace(job, state="queued", tries=job.tries - 1))
                return
            state = "cancelled"
        except DioramaError as problem:
            state, error = "failed", str(problem)
        except Exception as problem:  # one room's defect must not end the server
            log.exception("the build of %s failed", job.id)
            state, error = "failed", f"internal error ({type(problem).__name__}: {str(problem)[:200]})"
        self._set(replace(job, state=state, error=error, seconds=round(time.perf_counter() - began, 2)))

    def _build(self, job: Job, progress: Progress) -> None:
        from diorama_core.pipeline.presets import stages_for
        from diorama_core.project.build import build_project
        from diorama_core.project.lock import ProjectLock

        project = Project.open(self.folder / job.id)
        inputs = project.load_inputs()
        if inputs is None:
            raise ProjectError(f"{job.id} has no photo any more; send it again")

        def choose(store: ModelStore) -> Stages:
            return stages_for(job.profile, inputs, self._library, recipe=job.recipe, store=store)

        with ProjectLock(project.folder, "diorama api"):
            warnings = project.info().get("warnings", ())
            build_project(project, inputs, self._library, choose=choose, warnings=warnings, progress=progress)


def _stored_jobs(folder: Path) -> list[Job]:
    """Jobs that the projects of a folder tell of; a project that cannot be read is none."""
    found = []
    for path in sorted(folder.glob("*/project.json")):
        try:
            entry = Project(path.parent).info().get(JOB)
            if isinstance(entry, dict):
                found.append(_checked(path.parent.name, entry))
        except (DioramaError, TypeError, ValueError) as error:
            log.warning("%s is not listed: %s", path.parent, error)
    return found


def _checked(job_id: str, entry: Mapping[str, Any]) -> Job:
    from pydantic import TypeAdapter

    job = TypeAdapter(Job).validate_python({**entry, "id": job_id})
    return replace(job, state="queued") if job.state == "running" else job
