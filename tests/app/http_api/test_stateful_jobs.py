"""Programs send, cancel and delete jobs while builds end in anything, files are damaged and the server starts again."""

from __future__ import annotations

import asyncio
import shutil
import tempfile
import threading
from pathlib import Path

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import Bundle, RuleBasedStateMachine, initialize, invariant, multiple, rule

from diorama_app.http_api import jobs
from diorama_app.http_api.answers import answer_of
from diorama_app.http_api.job import Job
from diorama_app.http_api.jobs import JobQueue, JobStateError, UnknownJobError
from diorama_core.errors import InputError, ProjectError
from diorama_core.perception.inputs import ReadInputs
from diorama_core.progress import Progress
from diorama_core.project.storage import Project
from tests.app.small_room import PlainLibrary, furnished_scene
from tests.faults import Faults
from tests.pipeline.test_codec import example_inputs
from tests.waiting import until

SETTLED_S = 30.0
"""Within which a build that may end has ended, on a busy machine."""


class JobMachine(RuleBasedStateMachine):
    """A queue with builds that end when a rule says so."""

    job_ids = Bundle("job_ids")

    @initialize()
    def begin(self) -> None:
        self.place = Path(tempfile.mkdtemp())
        self.patch = pytest.MonkeyPatch()
        self.patch.setattr(jobs, "build_job", self._build)
        self.faults = Faults()
        self.outcome = "done"
        self.over: dict[str, str] = {}
        """What became of jobs; no later event may change it."""
        self.damaged = set[str]()
        self._start()

    def _start(self) -> None:
        self.may_end = threading.Semaphore(0)
        self.building = ""
        self.queue = JobQueue(self.place, PlainLibrary(), "built-in")
        self.queue.start()

    def _build(self, job: Job, folder: Path, library: object, progress: Progress) -> None:
        self.building = job.id
        while not self.may_end.acquire(timeout=0.002):
            progress.check()
        if self.outcome == "refused":
            raise InputError("this photo cannot be used")
        if self.outcome == "broken":
            raise ZeroDivisionError("a defect")
        Project(folder).save_scene(furnished_scene())

    def _running(self) -> str | None:
        """The job that is being built, once the queue has come to rest."""
        waiting = [j for j in self.queue.jobs() if not j.is_over]
        if not waiting:
            return None
        until(lambda: any(j.state == "running" and j.id == self.building for j in self.queue.jobs()))
        return self.building

    @rule(target=job_ids)
    def send(self):
        self._running()
        try:
            with self.faults.injected():
                job = self.queue.add("room.png", ReadInputs(example_inputs(), ()), {"photo": b"x"}, "auto", "feasible")
        except ProjectError:
            assert self.faults.full
            return multiple()
        return job.id

    @rule(outcome=st.sampled_from(["done", "refused", "broken"]))
    def end_the_running_one(self, outcome: str) -> None:
        running = self._running()
        if running is not None:
            self.outcome = outcome
            self.may_end.release()
            self._settled(running)
            assert self.over[running] == ("done" if outcome == "done" else "failed")

    def _settled(self, job_id: str) -> None:
        job = asyncio.run(self.queue.wait(job_id, SETTLED_S))
        assert job.is_over
        self.over[job_id] = job.state

    @rule(job_id=job_ids)
    def cancel(self, job_id: str) -> None:
        try:
            self.queue.cancel(job_id)
        except UnknownJobError:
            assert job_id not in {j.id for j in self.queue.jobs()}
            return
        except JobStateError:
            assert job_id in self.over
            return
        self._settled(job_id)
        assert self.over[job_id] == "cancelled"

    @rule(job_id=job_ids)
    def delete(self, job_id: str) -> None:
        try:
            self.queue.remove(job_id)
        except (UnknownJobError, JobStateError):
            return
        assert not (self.place / job_id).exists()
        self.over.pop(job_id)
        self.damaged.discard(job_id)

    @rule(job_id=job_ids, how=st.sampled_from(["gone", "info", "scene"]))
    def damage(self, job_id: str, how: str) -> None:
        folder = self.place / job_id
        if job_id not in self.over or not folder.exists():
            return
        self.damaged.add(job_id)
        if how == "gone":
            shutil.rmtree(folder)
        else:
            (folder / ("project.json" if how == "info" else "scene.json")).write_text("{")

    @rule(full=st.booleans())
    def fill_or_empty_the_disk(self, full: bool) -> None:
        self.faults.full = full

    @rule()
    def start_the_server_again(self) -> None:
        before = {job.id: job for job in self.queue.jobs()}
        self.queue.close()
        self._start()
        after = {job.id: job for job in self.queue.jobs()}
        for job_id, job in before.items():
            if job_id in self.damaged:
                continue
            assert after[job_id].is_over == job.is_over, "what was not over is taken up again"
        self.over = {job_id: state for job_id, state in self.over.items() if job_id in after and after[job_id].is_over}

    @invariant()
    def all_are_listed_and_stay_what_they_became(self) -> None:
        if not hasattr(self, "queue"):
            return
        answers = {job.id: answer_of(self.queue, job) for job in self.queue.jobs()}
        for job_id, state in self.over.items():
            assert answers[job_id].state == state
            assert (answers[job_id].objects is not None) == (state == "done" and answers[job_id].error is None)

    def teardown(self) -> None:
        if hasattr(self, "queue"):
            self.queue.close()
            self.patch.undo()
            shutil.rmtree(self.place, ignore_errors=True)


TestJobs = JobMachine.TestCase
TestJobs.settings = settings(max_examples=10, stateful_step_count=20, deadline=None)
