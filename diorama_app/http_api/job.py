"""One photo's way to a scene: how a project's file keeps it, its build, and what is told of one that failed."""

from __future__ import annotations

import logging
import traceback
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, FiniteFloat, TypeAdapter

from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.bounded import shorten
from diorama_core.io.text import clean_text, file_label
from diorama_core.layout.settings import RecipeName
from diorama_core.library.record import ShapeLibrary
from diorama_core.models.store import ModelStore
from diorama_core.pipeline.presets import Profile
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import Progress
from diorama_core.project.storage import Project

log = logging.getLogger(__name__)

State = Literal["queued", "running", "done", "failed", "cancelled"]
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
    recipe: RecipeName = "feasible"
    state: State = "queued"
    tries: int = 0
    seconds: FiniteFloat | None = None
    """What the build took, once it is over."""
    error: Annotated[str, Field(max_length=MAX_LINE)] | None = None
    """Why it failed, in one line."""

    @property
    def is_over(self) -> bool:
        """True if nothing more happens."""
        return self.state in ("done", "failed", "cancelled")


def note_job(folder: Path, job: Job) -> None:
    """Keep a job's state in its project.

    Raises:
        ProjectError: the project's file cannot be read or written.
    """
    Project(folder).update_info(**{JOB: {k: v for k, v in asdict(job).items() if k != "id"}})


def read_jobs(folder: Path) -> dict[Path, Job]:
    """Jobs that the projects of a folder tell of, by the project's folder; a project that cannot be read is none."""
    jobs: dict[Path, Job] = {}
    for path in sorted(folder.glob("*/project.json")):
        try:
            entry = Project(path.parent).info().get(JOB)
            if isinstance(entry, dict):
                jobs[path.parent] = _read(file_label(path.parent.name), entry)
        except (DioramaError, TypeError, ValueError) as error:
            log.warning("%s is not listed: %s", path.parent, error)
    return jobs


def _read(job_id: str, entry: Mapping[str, Any]) -> Job:
    job = TypeAdapter(Job).validate_python({**entry, "id": job_id})
    return replace(job, state="queued") if job.state == "running" else job


def build_job(job: Job, folder: Path, library: ShapeLibrary, progress: Progress) -> None:
    """Build a job's scene from what its project holds.

    Args:
        job: what is built.
        folder: its project's.
        library: where shapes come from.
        progress: told how far it is; stops it on request.

    Raises:
        ProjectError: the project cannot be read or written, or another program has it open.
        InputError, UnavailableError: the inputs cannot be used.
        Cancelled: on request.
    """
    from diorama_core.pipeline.presets import stages_for
    from diorama_core.project.build import build_project
    from diorama_core.project.lock import ProjectLock

    project = Project.open(folder)
    inputs = project.load_inputs()
    if inputs is None:
        raise ProjectError(f"{job.id} has no photo any more; send it again")

    def choose(store: ModelStore) -> Stages:
        return stages_for(job.profile, inputs, library, recipe=job.recipe, store=store)

    with ProjectLock(project.folder, "diorama api"):
        warnings = project.info().get("warnings", ())
        build_project(project, inputs, library, choose=choose, warnings=warnings, progress=progress)


def line_of(problem: Exception, job_id: str) -> str:
    """Why a build failed, in one line; what is unexpected is logged in full."""
    if isinstance(problem, DioramaError):
        return shorten(str(problem), MAX_LINE)
    log.error("the build of %s failed\n%s", job_id, clean_text("".join(traceback.format_exception(problem))))
    return shorten(f"internal error ({type(problem).__name__}: {problem})")
