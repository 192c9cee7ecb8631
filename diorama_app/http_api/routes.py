"""The addresses of the HTTP API. Its OpenAPI document, `/openapi.json`, is made from this module."""

from __future__ import annotations

import asyncio
import io
import re
import tempfile
from pathlib import Path
from typing import Annotated, Any, Literal

from fastapi import APIRouter, FastAPI, File, Form, HTTPException, Query, Request, Response, UploadFile
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from PIL import Image
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException as StarletteHTTPException

import diorama_core as diorama
from diorama_app.http_api.access import Guard
from diorama_app.http_api.answers import FormatAnswer, JobAnswer, JobList, Problem, answer_of
from diorama_app.http_api.jobs import JobQueue, JobStateError, QueueFullError, UnknownJobError, Upload
from diorama_app.projects import uploads as sent
from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_app.web.visitors import Visitors
from diorama_core.errors import DioramaError, ExportError, InputError, ProjectError, UnavailableError
from diorama_core.export import Format
from diorama_core.export.gathering import ExportOptions
from diorama_core.io.bounded import read_json
from diorama_core.io.text import clean_text

ABOUT = """Photos of rooms become 3D scenes. Send a photo to `/v1/jobs`, ask for the job until its state is `done`, and
fetch its scene, a picture or a file for other programs. Lengths are metres and +Z is up, if a format does not say
otherwise. Every error is `{"error": "one line"}`."""
BINARY = {"schema": {"type": "string", "format": "binary"}}
MAX_AT_ONCE = 2
"""Scenes that are drawn or exported at a time; others wait, without a thread."""
_PLAIN_NAME = re.compile(r"[A-Za-z0-9._-]{1,100}")
MAX_WAIT_S = 60.0
STATUS: dict[type[DioramaError], int] = {
    UnknownJobError: 404,
    JobStateError: 409,
    InputError: 422,
    ExportError: 422,
    QueueFullError: 429,
    UnavailableError: 501,
}


def _errors(*statuses: int) -> dict[int | str, dict[str, Any]]:
    words = {
        400: "The request cannot be read.",
        401: "The token is missing or wrong.",
        403: "The host or origin is refused.",
        404: "There is no such job, scene or format.",
        408: "The request did not go on.",
        409: "The job's state does not allow it.",
        413: "The request is too large.",
        422: "An input cannot be used.",
        429: "Too many jobs wait.",
        500: "The job's files were damaged.",
        501: "An optional part of the server is missing.",
        503: "Too many uploads at once.",
    }
    return {s: {"model": Problem, "description": words[s]} for s in (401, 403, *statuses)}


router = APIRouter(prefix="/v1", responses=_errors())
Profile = Literal["auto", "embedded", "foundation"]
Recipe = Literal["feasible", "paper", "all-in-one"]


@router.post("/jobs", status_code=202, operation_id="create_job", responses=_errors(400, 408, 413, 422, 429, 503))
def create_job(
    request: Request,
    photo: Annotated[UploadFile, File(description="JPEG, PNG, WebP, TIFF and others.")],
    boxes: Annotated[
        str | None,
        Form(description='JSON list of {"bbox": [x1, y1, x2, y2], "class": "chair"}, pixels of the upright photo.'),
    ] = None,
    masks: Annotated[UploadFile | None, File(description="PNG, one colour or id per object, black is none.")] = None,
    depth: Annotated[UploadFile | None, File(description="16-bit PNG, .npy in metres, or EXR.")] = None,
    depth_scale: Annotated[float | None, Form(gt=0, description="Units of depth per metre; empty: inferred.")] = None,
    intrinsics: Annotated[str | None, Form(description="fx,fy,cx,cy in pixels of the upright photo.")] = None,
    fov_deg: Annotated[float | None, Form(description="Horizontal field of view, instead of intrinsics.")] = None,
    profile: Annotated[Profile, Form(description="Which networks are used.")] = "auto",
    recipe: Annotated[Recipe, Form(description="The layout optimiser.")] = "feasible",
) -> JobAnswer:
    """Send a photo, with what is known of it, and queue its build."""
    name = Path(clean_text(photo.filename or "photo")).name or "photo"
    files: dict[Upload, UploadFile | None] = {"photo": photo, "masks": masks, "depth": depth}
    content = {kind: file.file.read() for kind, file in files.items() if file is not None}
    upload = sent.Upload(
        content["photo"],
        name,
        depth=content.get("depth"),
        depth_scale=depth_scale,
        intrinsics=None if intrinsics is None else _four_numbers(intrinsics),
        fov_deg=fov_deg,
        boxes=None if boxes is None else clean_text(boxes).encode(),
        masks=content.get("masks"),
    )
    queue = _queue(request)
    read = sent.decoded(upload, queue.decoder)
    return answer_of(queue, queue.add(name, read, content, profile, recipe))


@router.get("/jobs", operation_id="list_jobs")
def list_jobs(request: Request) -> JobList:
    """All jobs, newest first."""
    queue = _queue(request)
    return JobList(jobs=[answer_of(queue, job) for job in queue.jobs()])


@router.get("/jobs/{job_id}", operation_id="get_job", responses=_errors(404, 422))
async def get_job(
    request: Request,
    job_id: str,
    wait_s: Annotated[
        float, Query(ge=0, le=MAX_WAIT_S, description="Wait so long for the job's end before answering.")
    ] = 0.0,
) -> JobAnswer:
    """How far a job is."""
    queue = _queue(request)
    return await run_in_threadpool(answer_of, queue, await queue.wait(job_id, wait_s))


@router.post("/jobs/{job_id}/cancel", operation_id="cancel_job", responses=_errors(404, 409, 422))
def cancel_job(request: Request, job_id: str) -> JobAnswer:
    """Stop a job that waits or runs; one that runs stops within seconds. Its project stays."""
    queue = _queue(request)
    return answer_of(queue, queue.cancel(job_id))


@router.delete(
    "/jobs/{job_id}",
    status_code=204,
    operation_id="delete_job",
    response_class=Response,
    responses=_errors(404, 409, 422),
)
def delete_job(request: Request, job_id: str) -> Response:
    """Delete a job that is over, with its project."""
    _queue(request).remove(job_id)
    return Response(status_code=204)


@router.get("/jobs/{job_id}/scene", operation_id="get_scene", responses=_errors(404, 422, 500))
def get_scene(request: Request, job_id: str) -> dict[str, Any]:
    """The scene file of a finished job; docs/scene-file.md describes it."""
    path = _finished(request, job_id) / "scene.json"
    document = read_json(path, ProjectError)
    if not isinstance(document, dict):
        raise ProjectError(f"{path} is no scene file; build the scene again")
    return document


@router.get(
    "/jobs/{job_id}/picture",
    operation_id="get_picture",
    response_class=Response,
    responses={200: {"content": {"image/png": BINARY}, "description": "The picture."}, **_errors(404, 422, 500)},
)
async def get_picture(
    request: Request,
    job_id: str,
    view: Annotated[str, Query(description="photo, planes, top, front or orbit:DEG.", max_length=40)] = "photo",
    width: Annotated[int, Query(ge=16, le=2048)] = 640,
    height: Annotated[int, Query(ge=16, le=2048)] = 480,
) -> Response:
    """A picture of a finished job's scene."""
    folder = _finished(request, job_id)
    async with request.app.state.few:
        content = await run_in_threadpool(_picture, folder, view, (width, height))
    return Response(content, media_type="image/png")


@router.get(
    "/jobs/{job_id}/export/{format_name}",
    operation_id="export_scene",
    response_class=Response,
    responses={
        200: {"content": {"application/octet-stream": BINARY}, "description": "The file."},
        **_errors(404, 422, 500, 501),
    },
)
async def export_scene(
    request: Request,
    job_id: str,
    format_name: str,
    ceiling: Annotated[bool, Query(description="Whether ceilings are in it.")] = True,
    texture_size: Annotated[int | None, Query(ge=16, le=8192, description="Longest side of pictures.")] = None,
) -> Response:
    """A finished job's scene as a file for other programs; `/v1/formats` lists them."""
    if format_name not in EXPORT_FORMATS:
        raise HTTPException(404, f"there is no format {format_name!r}; see /v1/formats")
    folder, format_ = _finished(request, job_id), EXPORT_FORMATS[format_name]
    options = ExportOptions(ceiling=ceiling, max_texture_px=texture_size)
    name = f"{job_id if _PLAIN_NAME.fullmatch(job_id) else 'scene'}{format_.suffixes[0]}"
    async with request.app.state.few:
        content = await run_in_threadpool(_exported, folder, name, format_, options)
    named = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(content, media_type="application/octet-stream", headers=named)


@router.get("/formats", operation_id="list_formats")
def list_formats() -> list[FormatAnswer]:
    """The formats of `export`."""
    return [FormatAnswer(name=n, title=f.title, suffix=f.suffixes[0]) for n, f in EXPORT_FORMATS.items()]


def create_app(queue: JobQueue, visitors: Visitors) -> FastAPI:
    """The application.

    Args:
        queue: does the work.
        visitors: who may ask.
    """
    # No pages with documentation: those that FastAPI offers load their scripts from other servers.
    app = FastAPI(title="Diorama", version="1", description=ABOUT, docs_url=None, redoc_url=None)
    described = app.openapi
    app.openapi = lambda: _with_files(described())
    app.state.queue = queue
    app.state.few = asyncio.Semaphore(MAX_AT_ONCE)
    app.include_router(router)
    app.add_middleware(Guard, visitors=visitors)
    for kind in (DioramaError, RequestValidationError, StarletteHTTPException):
        app.add_exception_handler(kind, _told)
    return app


def _with_files(document: dict[str, Any]) -> dict[str, Any]:
    """The document; files say `format: binary`, too: without it generators of clients take them for text."""
    for form in document["components"]["schemas"].values():
        for field in form.get("properties", {}).values():
            for kind in (field, *field.get("anyOf", ())):
                if "contentMediaType" in kind:
                    kind["format"] = "binary"
    return document


def _told(request: Request, error: Exception) -> Response:
    """An error as its one line, with the status that fits."""
    if isinstance(error, StarletteHTTPException):
        return JSONResponse({"error": clean_text(str(error.detail))}, error.status_code, error.headers)
    if isinstance(error, RequestValidationError):
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"][1:]) or "the request"
        return JSONResponse({"error": clean_text(f"{where}: {first['msg']}")}, 422)
    status = next((status for kind, status in STATUS.items() if isinstance(error, kind)), 500)
    return JSONResponse({"error": clean_text(" ".join(str(error).split()))}, status)


def _queue(request: Request) -> JobQueue:
    return request.app.state.queue


def _picture(folder: Path, view: str, size: tuple[int, int]) -> bytes:
    content = io.BytesIO()
    Image.fromarray(diorama.render(diorama.load(folder), view=view, size=size)).save(content, "PNG")
    return content.getvalue()


def _exported(folder: Path, name: str, format_: Format, options: ExportOptions) -> bytes:
    with tempfile.TemporaryDirectory() as place:
        path = Path(place, name)
        diorama.export(diorama.load(folder), path, format=format_, options=options)
        return path.read_bytes()


def _finished(request: Request, job_id: str) -> Path:
    """The project of a job that is done."""
    queue = _queue(request)
    job = queue.job(job_id)
    if job.state != "done":
        raise HTTPException(404, f"{job_id} has no scene: it is {job.state}")
    return queue.project(job_id).folder


def _four_numbers(text: str) -> tuple[float, float, float, float]:
    try:
        fx, fy, cx, cy = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"intrinsics {text[:60]!r}: give four numbers in pixels, fx,fy,cx,cy") from None
    return fx, fy, cx, cy
