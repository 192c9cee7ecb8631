"""The form in which a photo is sent, with what is known of it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from fastapi import Depends, File, Form, UploadFile

from diorama_app.projects.uploads import Upload
from diorama_core.errors import InputError
from diorama_core.io.text import clean_text


def sent_photo(
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
) -> Upload:
    """What was sent, as it is read from pages, too."""
    return Upload(
        photo.file.read(),
        Path(clean_text(photo.filename or "photo")).name or "photo",
        depth=None if depth is None else depth.file.read(),
        depth_scale=depth_scale,
        intrinsics=None if intrinsics is None else _four_numbers(intrinsics),
        fov_deg=fov_deg,
        boxes=None if boxes is None else clean_text(boxes).encode(),
        masks=None if masks is None else masks.file.read(),
    )


PhotoForm = Annotated[Upload, Depends(sent_photo)]


def _four_numbers(text: str) -> tuple[float, float, float, float]:
    try:
        fx, fy, cx, cy = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"intrinsics {text[:60]!r}: give four numbers in pixels, fx,fy,cx,cy") from None
    return fx, fy, cx, cy
