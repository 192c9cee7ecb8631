"""The addresses of the HTTP API. Its OpenAPI document, `/openapi.json`, is made from this module."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Annotated, Any

from fastapi import APIRouter, Depends, FastAPI, Form, HTTPException, Query, Request, Response
from fastapi.exceptions import RequestValidationError
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException as StarletteHTTPException

import diorama_core as diorama
from diorama_app.http_api.access import Guard
from diorama_app.http_api.answers import (
    FILE,
    PICTURE,
    VIEWS,
    FormatAnswer,
    JobAnswer,
    JobList,
    answer_of,
    error_docs,
    file_answer,
    format_of,
    png,
    respond,
)
from diorama_app.http_api.forms import PhotoForm
from diorama_app.http_api.jobs import JobQueue, Upload
from diorama_app.http_api.open_projects import OpenProjects
from diorama_app.http_api.project_routes import MAX_WAIT_S, project_router
from diorama_app.projects import uploads as sent
from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_app.web.visitors import Visitors
from diorama_core.errors import DioramaError, ProjectError
from diorama_core.export.gathering import ExportOptions
from diorama_core.io.bounded import read_json
from diorama_core.layout.settings import RecipeName
from diorama_core.pipeline.presets import Profile

ABOUT = """Photos of rooms become 3D scenes. Send a photo to `/v1/jobs`, ask for the job until its state is `done`, and
fetch its scene, a picture or a file for other programs. Lengths are metres and +Z is up, if a format does not say
otherwise. Every error is `{"error": "one line"}`."""
MAX_AT_ONCE = 2
"""Scenes that are drawn or exported at a time; others wait, without a thread."""
router = APIRouter(prefix="/v1", responses=error_docs())
format_router = APIRouter(prefix="/v1", responses=error_docs())


def _queue(request: Request) -> JobQueue:
    return request.app.state.queue


Queue = Annotated[JobQueue, Depends(_queue)]


@router.post("/jobs", status_code=202, operation_id="create_job", responses=error_docs(400, 408, 413, 422, 429, 503))
def create_job(
    queue: Queue,
    form: PhotoForm,
    profile: Annotated[Profile, Form(description="Which networks are used.")] = "auto",
    recipe: Annotated[RecipeName, Form(description="The layout optimiser.")] = "feasible",
) -> JobAnswer:
    """Send a photo, with what is known of it, and queue its build."""
    read = sent.decode(form, queue.decoder)
    content: dict[Upload, Any] = {"photo": form.photo, "depth": form.depth, "masks": form.masks}
    given = {kind: data for kind, data in content.items() if data is not None}
    return answer_of(queue, queue.add(form.name, read, given, profile, recipe))


@router.get("/jobs", operation_id="list_jobs")
def list_jobs(queue: Queue) -> JobList:
    """All jobs, newest first."""
    return JobList(jobs=[answer_of(queue, job) for job in queue.jobs()])


@router.get("/jobs/{job_id}", operation_id="get_job", responses=error_docs(404, 422))
async def get_job(
    queue: Queue,
    job_id: str,
    wait_s: Annotated[
        float, Query(ge=0, le=MAX_WAIT_S, description="Wait so long for the job's end before answering.")
    ] = 0.0,
) -> JobAnswer:
    """How far a job is."""
    return await run_in_threadpool(answer_of, queue, await queue.wait(job_id, wait_s))


@router.post("/jobs/{job_id}/cancel", operation_id="cancel_job", responses=error_docs(404, 409, 422))
def cancel_job(queue: Queue, job_id: str) -> JobAnswer:
    """Stop a job that waits or runs; one that runs stops within seconds. Its project stays."""
    return answer_of(queue, queue.cancel(job_id))


@router.delete(
    "/jobs/{job_id}",
    status_code=204,
    operation_id="delete_job",
    response_class=Response,
    responses=error_docs(404, 409, 422),
)
def delete_job(queue: Queue, job_id: str) -> Response:
    """Delete a job that is over, with its project."""
    queue.remove(job_id)
    return Response(status_code=204)


@router.get("/jobs/{job_id}/scene", operation_id="get_scene", responses=error_docs(404, 422, 500))
def get_scene(queue: Queue, job_id: str) -> dict[str, Any]:
    """The scene file of a finished job; docs/scene-file.md describes it."""
    path = _project(queue, job_id) / "scene.json"
    document = read_json(path, ProjectError)
    if not isinstance(document, dict):
        raise ProjectError(f"{path} is no scene file; build the scene again")
    return document


@router.get(
    "/jobs/{job_id}/picture",
    operation_id="get_picture",
    response_class=Response,
    responses={**PICTURE, **error_docs(404, 422, 500)},
)
async def get_picture(
    request: Request,
    queue: Queue,
    job_id: str,
    view: Annotated[str, Query(description=VIEWS, max_length=80)] = "photo",
    width: Annotated[int, Query(ge=16, le=2048)] = 640,
    height: Annotated[int, Query(ge=16, le=2048)] = 480,
) -> Response:
    """A picture of a finished job's scene."""
    folder = _project(queue, job_id)
    async with request.app.state.few:
        content = await run_in_threadpool(lambda: png(diorama.load(folder), view, (width, height)))
    return Response(content, media_type="image/png")


@router.get(
    "/jobs/{job_id}/export/{format_name}",
    operation_id="export_scene",
    response_class=Response,
    responses={**FILE, **error_docs(404, 422, 500, 501)},
)
async def export_scene(
    request: Request,
    queue: Queue,
    job_id: str,
    format_name: str,
    ceiling: Annotated[bool, Query(description="Whether ceilings are in it.")] = True,
    texture_size: Annotated[int | None, Query(ge=16, le=8192, description="Longest side of pictures.")] = None,
) -> Response:
    """A finished job's scene as a file for other programs; `/v1/formats` lists them."""
    format_, folder = format_of(format_name), _project(queue, job_id)
    options = ExportOptions(ceiling=ceiling, max_texture_px=texture_size)
    async with request.app.state.few:
        return await run_in_threadpool(lambda: file_answer(diorama.load(folder), job_id, format_, options))


@format_router.get("/formats", operation_id="list_formats")
def list_formats() -> list[FormatAnswer]:
    """The formats of `export`."""
    return [FormatAnswer(name=n, title=f.title, suffix=f.suffixes[0]) for n, f in EXPORT_FORMATS.items()]


def create_app(queue: JobQueue | None, visitors: Visitors, opened: OpenProjects | None = None) -> FastAPI:
    """The application: builds, where there is a queue, and projects, where there is an editor in this process."""
    # No pages with documentation: those that FastAPI offers load their scripts from other servers.
    app = FastAPI(title="Diorama", version="1", description=ABOUT, docs_url=None, redoc_url=None)
    described = app.openapi
    app.openapi = lambda: _with_files(described())
    app.state.queue, app.state.opened = queue, opened
    app.state.few = asyncio.Semaphore(MAX_AT_ONCE)
    if queue is not None:
        app.include_router(router)
    if opened is not None:
        app.include_router(project_router)
    app.include_router(format_router)
    app.add_middleware(Guard, visitors=visitors)
    for kind in (DioramaError, RequestValidationError, StarletteHTTPException):
        app.add_exception_handler(kind, respond)
    return app


def _with_files(document: dict[str, Any]) -> dict[str, Any]:
    """The document; files say `format: binary`, too: without it generators of clients take them for text."""
    for form in document["components"]["schemas"].values():
        for field in form.get("properties", {}).values():
            for kind in (field, *field.get("anyOf", ())):
                if "contentMediaType" in kind:
                    kind["format"] = "binary"
    return document


def _project(queue: JobQueue, job_id: str) -> Path:
    """The project of a job that is done."""
    job = queue.job(job_id)
    if job.state != "done":
        raise HTTPException(404, f"{job_id} has no scene: it is {job.state}")
    return queue.project(job_id).folder
