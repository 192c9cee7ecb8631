"""The build of one job, and what is told of one that failed."""

from __future__ import annotations

import logging
import traceback
from pathlib import Path

from diorama_app.http_api.job import MAX_LINE, Job
from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.bounded import shortened
from diorama_core.io.text import clean_text
from diorama_core.library.record import ShapeLibrary
from diorama_core.models.store import ModelStore
from diorama_core.pipeline.stages import Stages
from diorama_core.progress import Progress
from diorama_core.project.storage import Project

log = logging.getLogger(__name__)


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
        return shortened(str(problem), MAX_LINE)
    log.error("the build of %s failed\n%s", job_id, clean_text("".join(traceback.format_exception(problem))))
    return shortened(f"internal error ({type(problem).__name__}: {problem})")
