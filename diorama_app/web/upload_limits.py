"""How much browsers may upload: pure rules, for one file and for all that are under way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

MAX_UPLOAD_BYTES = 128 * 1024 * 1024
MAX_UPLOADS_IN_FLIGHT = 8
MAX_UPLOADS_PER_CLIENT = 3
MAX_BYTES_IN_FLIGHT = 2 * MAX_UPLOAD_BYTES
"""Announced by all uploads that are under way: viser holds them in memory."""
MIN_PART_BYTES = 4096
"""The page sends parts of half a megabyte; very many small ones are only memory."""


@runtime_checkable
class UploadRequest(Protocol):
    """What a page says before it sends a file; nothing of it has been checked."""

    transfer_uuid: str
    filename: Any
    size_bytes: Any
    part_count: Any


@dataclass(frozen=True)
class RunningUpload:
    """An upload that is under way."""

    uuid: str
    page: tuple[int, int]
    total_bytes: int


def why_refused(request: UploadRequest, page: tuple[int, int], running: Sequence[RunningUpload]) -> str | None:
    """Why an upload may not start, in words for the user; None when it may.

    Args:
        request: what the page announces.
        page: number of the server of its project, and of the client there.
        running: uploads of all pages of all projects that are under way.
    """
    size, parts = request.size_bytes, request.part_count
    if not (isinstance(size, int) and isinstance(parts, int) and isinstance(request.filename, str)):
        return "the page sent an invalid request; reload it"
    if size > MAX_UPLOAD_BYTES:
        return (
            f"it has {size / 1e6:.0f} MB, and files up to {MAX_UPLOAD_BYTES / 1e6:.0f} MB can be uploaded; "
            "make it smaller"
        )
    if size < 0 or not 0 <= parts <= size // MIN_PART_BYTES + 2:
        return "the page sent an invalid request; reload it"
    if any(request.transfer_uuid == upload.uuid for upload in running):
        return "it is being uploaded already"
    own = sum(upload.page == page for upload in running)
    if own >= MAX_UPLOADS_PER_CLIENT or len(running) >= MAX_UPLOADS_IN_FLIGHT:
        return "other uploads are under way; try again when they are done"
    if sum(upload.total_bytes for upload in running) + size > MAX_BYTES_IN_FLIGHT:
        return "other large uploads are under way; try again when they are done"
    return None
