"""What the API answers about jobs and errors, and pictures and files of a scene: the forms, how a job's files become
one, whatever state they are in, and one JSON line with the status that fits.
"""

from __future__ import annotations

import re
import tempfile
from functools import lru_cache
from pathlib import Path
from typing import Any

from fastapi import HTTPException, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field
from starlette.exceptions import HTTPException as StarletteHTTPException

import diorama_core as diorama
from diorama_app.http_api.job import Job, State
from diorama_app.http_api.jobs import JobQueue, JobStateError, QueueFullError, UnknownJobError
from diorama_app.http_api.open_projects import StaleVersionError, UnknownProjectError
from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_app.projects.pictures import encode_picture
from diorama_core.errors import DioramaError, EditRefused, ExportError, InputError, ProjectError, UnavailableError
from diorama_core.export import Format
from diorama_core.export.gathering import ExportOptions
from diorama_core.io.bounded import shorten
from diorama_core.io.text import clean_text
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
        damage = shorten(str(error))
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
    return [shorten(str(n), MAX_NOTE_LENGTH) for n in (listed if isinstance(listed, list) else [])[:MAX_NOTES]]


def _object_count(path: Path) -> int:
    try:
        about = path.stat()
    except OSError as error:
        raise ProjectError(f"{path} cannot be read ({error.strerror}); build the scene again") from error
    return _count(path, about.st_mtime_ns, about.st_size, about.st_ino)


@lru_cache(maxsize=MAX_COUNTED)
def _count(path: Path, written_ns: int, size: int, inode: int) -> int:
    """Objects of a scene file as it was written then."""
    return len(read_scene(path).objects)


STATUS: dict[type[DioramaError], int] = {
    UnknownJobError: 404,
    UnknownProjectError: 404,
    JobStateError: 409,
    StaleVersionError: 409,
    EditRefused: 422,
    InputError: 422,
    ExportError: 422,
    QueueFullError: 429,
    UnavailableError: 501,
}
WORDS = {
    400: "The request cannot be read.",
    401: "The token is missing or wrong.",
    403: "The host or origin is refused.",
    404: "There is no such job, project, object, scene or format.",
    408: "The request did not go on.",
    409: "The job's state does not allow it, or the scene has changed since that version.",
    413: "The request is too large.",
    422: "An input cannot be used, or an edit cannot be done.",
    429: "Too many jobs wait.",
    500: "The files were damaged.",
    501: "An optional part of the server is missing, or it is busy.",
    503: "Too many uploads at once.",
}


def error_docs(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The errors of an address for the OpenAPI document; those of access are everywhere."""
    return {s: {"model": ErrorAnswer, "description": WORDS[s]} for s in (401, 403, *statuses)}


def respond(request: Request, error: Exception) -> Response:
    """An error as its one line, with the status that fits."""
    if isinstance(error, StarletteHTTPException):
        return JSONResponse({"error": clean_text(str(error.detail))}, error.status_code, error.headers)
    if isinstance(error, RequestValidationError):
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"][1:]) or "the request"
        return JSONResponse({"error": clean_text(f"{where}: {first['msg']}")}, 422)
    status = next((status for kind, status in STATUS.items() if isinstance(error, kind)), 500)
    return JSONResponse({"error": clean_text(" ".join(str(error).split()))}, status)


VIEWS = "photo, planes, top, front, orbit:DEG, or look:X,Y,Z:X,Y,Z from a point of the world toward another."
BINARY = {"schema": {"type": "string", "format": "binary"}}
PICTURE: dict[int | str, dict[str, Any]] = {200: {"content": {"image/png": BINARY}, "description": "The picture."}}
FILE: dict[int | str, dict[str, Any]] = {
    200: {"content": {"application/octet-stream": BINARY}, "description": "The file."}
}
_PLAIN_NAME = re.compile(r"[A-Za-z0-9._-]{1,100}")


def png(room: diorama.Reconstruction, view: str, size: tuple[int, int], *, ids: bool = False) -> bytes:
    """A picture of a scene.

    Args:
        room: the scene.
        view: one of `VIEWS`.
        size: width and height in pixels; with ids small pictures are enlarged, so that they can be read.
        ids: whether objects are outlined and named by their ids.
    """
    picture = diorama.render(room, view=view, size=size)
    if ids and view != "planes":
        from diorama_core.perception.language.marks import draw_marks
        from diorama_core.render.picture import instances_seen

        seen = instances_seen(room.scene, room.library, view=view, size=size)
        shown = {o.id: seen == k for k, o in enumerate(room.scene.objects)}
        shown = {name: mask for name, mask in shown.items() if mask.any()}
        picture = draw_marks(picture, list(shown.values()), list(shown))
    return encode_picture(picture, "PNG")


def format_of(name: str) -> Format:
    """A format by its name; answers 404 where there is none."""
    if name not in EXPORT_FORMATS:
        raise HTTPException(404, f"there is no format {name[:40]!r}; see /v1/formats")
    return EXPORT_FORMATS[name]


def file_answer(room: diorama.Reconstruction, name: str, format_: Format, options: ExportOptions) -> Response:
    """A scene in a format, to be saved under a name with the format's ending.

    Args:
        room: the scene.
        name: of the file, without an ending.
        format_: one of `EXPORT_FORMATS`.
        options: of the format.
    """
    name = f"{name if _PLAIN_NAME.fullmatch(name) else 'scene'}{format_.suffixes[0]}"
    with tempfile.TemporaryDirectory() as place:
        path = Path(place, name)
        diorama.export(room, path, format=format_, options=options)
        content = path.read_bytes()
    named = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(content, media_type="application/octet-stream", headers=named)
