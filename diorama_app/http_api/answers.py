"""What the API answers about jobs: the forms, and how a job's files become one, whatever state they are in."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

from pydantic import BaseModel, Field

from diorama_app.http_api.job import Job, State
from diorama_app.http_api.jobs import JobQueue
from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.bounded import shortened
from diorama_core.project.storage import read_scene

MAX_NOTES, MAX_NOTE_LENGTH = 50, 300
MAX_COUNTED = 2048
"""Scenes whose objects are counted once, for as long as their files stay as they are."""


class ErrorAnswer(BaseModel):
    """Every error."""

    error: str = Field(description="What was wrong and what to do, in one line.")


class JobAnswer(BaseModel):
    """A job: one photo's way to a scene. It is also a project of the editor, in the server's folder."""

    id: str
    state: State
    progress: float = Field(ge=0, le=1, description="Share of the work that is done.")
    message: str = Field(description="What is happening now.")
    created: str = Field(description="Local time of the server, ISO 8601.")
    seconds: float | None = Field(description="What the build took; null before its end.")
    error: str | None = Field(description="Why it failed; null where it did not.")
    objects: int | None = Field(description="Number of objects of the scene; null where there is none yet.")
    notes: list[str] = Field(description="What to know about the inputs and the result.")


class JobList(BaseModel):
    """Jobs, newest first."""

    jobs: list[JobAnswer]


class FormatAnswer(BaseModel):
    """A format of `export`."""

    name: str
    title: str
    suffix: str


def answer_of(queue: JobQueue, job: Job) -> JobAnswer:
    """A job as it is told. What cannot be read of its files is its error: a list of jobs must not fail for one."""
    progress, notes, objects, damage = queue.progress(job), list[str](), None, None
    try:
        project = queue.project(job.id)
        notes = _notes(project.info())
        objects = _object_count(project.scene_path) if job.state == "done" else None
    except DioramaError as error:
        damage = shortened(str(error))
    return JobAnswer(
        id=job.id,
        state=job.state,
        progress=progress.fraction,
        message=progress.message,
        created=job.created,
        seconds=job.seconds,
        error=job.error or damage,
        objects=objects,
        notes=notes,
    )


def _notes(info: dict[str, Any]) -> list[str]:
    """What the project's build had to say; a file from elsewhere may hold anything there."""
    listed = info.get("notes") or info.get("warnings")
    return [shortened(str(n), MAX_NOTE_LENGTH) for n in (listed if isinstance(listed, list) else [])[:MAX_NOTES]]


def _object_count(path: Path) -> int:
    try:
        about = path.stat()
    except OSError as error:
        raise ProjectError(f"{path} cannot be read ({error.strerror}); build the scene again") from error
    return _counted(path, about.st_mtime_ns, about.st_size, about.st_ino)


@lru_cache(maxsize=MAX_COUNTED)
def _counted(path: Path, written_ns: int, size: int, inode: int) -> int:
    """Objects of a scene file as it was written then."""
    return len(read_scene(path).objects)
