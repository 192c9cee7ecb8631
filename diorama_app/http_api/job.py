"""One photo's way to a scene, and how a project's file keeps it."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, FiniteFloat, TypeAdapter

from diorama_core.errors import DioramaError
from diorama_core.io.text import file_label
from diorama_core.pipeline.presets import Profile
from diorama_core.project.storage import Project

log = logging.getLogger(__name__)

State = Literal["queued", "running", "done", "failed", "cancelled"]
Recipe = Literal["feasible", "paper", "all-in-one"]
JOB = "job"
"""The entry of `project.json` that a job is kept in."""
MAX_LINE = 2000
"""Characters of an error."""


@dataclass(frozen=True)
class Job:
    """One photo's way to a scene."""

    id: str
    """Name of the project's folder, as text."""
    created: Annotated[str, Field(max_length=100)]
    """Local time, ISO 8601."""
    profile: Profile = "auto"
    recipe: Recipe = "feasible"
    state: State = "queued"
    tries: int = 0
    seconds: FiniteFloat | None = None
    """What the build took, once it is over."""
    error: Annotated[str, Field(max_length=MAX_LINE)] | None = None
    """Why it failed, in one line."""

    @property
    def over(self) -> bool:
        """Whether nothing more happens."""
        return self.state in ("done", "failed", "cancelled")


def note_job(folder: Path, job: Job) -> None:
    """Keep a job's state in its project.

    Raises:
        ProjectError: the project's file cannot be read or written.
    """
    Project(folder).update_info(**{JOB: {k: v for k, v in asdict(job).items() if k != "id"}})


def noted_jobs(folder: Path) -> dict[Path, Job]:
    """Jobs that the projects of a folder tell of, by the project's folder; a project that cannot be read is none."""
    found: dict[Path, Job] = {}
    for path in sorted(folder.glob("*/project.json")):
        try:
            entry = Project(path.parent).info().get(JOB)
            if isinstance(entry, dict):
                found[path.parent] = _checked(file_label(path.parent.name), entry)
        except (DioramaError, TypeError, ValueError) as error:
            log.warning("%s is not listed: %s", path.parent, error)
    return found


def _checked(job_id: str, entry: Mapping[str, Any]) -> Job:
    job = TypeAdapter(Job).validate_python({**entry, "id": job_id})
    return replace(job, state="queued") if job.state == "running" else job
