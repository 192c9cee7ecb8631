"""How errors are told: one JSON line with the status that fits, and what the OpenAPI document says of them."""

from __future__ import annotations

from typing import Any

from fastapi import Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException as StarletteHTTPException

from diorama_app.http_api.answers import ErrorAnswer
from diorama_app.http_api.jobs import JobStateError, QueueFullError, UnknownJobError
from diorama_app.http_api.open_projects import StaleVersionError, UnknownProjectError
from diorama_core.errors import DioramaError, EditRefused, ExportError, InputError, UnavailableError
from diorama_core.io.text import clean_text

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


def documented(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The errors of an address for the OpenAPI document; those of access are everywhere."""
    return {s: {"model": ErrorAnswer, "description": WORDS[s]} for s in (401, 403, *statuses)}


def told(request: Request, error: Exception) -> Response:
    """An error as its one line, with the status that fits."""
    if isinstance(error, StarletteHTTPException):
        return JSONResponse({"error": clean_text(str(error.detail))}, error.status_code, error.headers)
    if isinstance(error, RequestValidationError):
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"][1:]) or "the request"
        return JSONResponse({"error": clean_text(f"{where}: {first['msg']}")}, 422)
    status = next((status for kind, status in STATUS.items() if isinstance(error, kind)), 500)
    return JSONResponse({"error": clean_text(" ".join(str(error).split()))}, status)
