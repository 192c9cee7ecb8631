"""Pictures and files of a scene as answers, whether its project is open or on disk."""

from __future__ import annotations

import io
import re
import tempfile
from pathlib import Path
from typing import Any

from fastapi import HTTPException, Response
from PIL import Image

import diorama_core as diorama
from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_core.export import Format
from diorama_core.export.gathering import ExportOptions

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
        from diorama_core.perception.language.marks import marked
        from diorama_core.render.picture import instances_seen

        seen = instances_seen(room.scene, room.library, view=view, size=size)
        shown = {o.id: seen == k for k, o in enumerate(room.scene.objects)}
        shown = {name: mask for name, mask in shown.items() if mask.any()}
        picture = marked(picture, list(shown.values()), list(shown))
    content = io.BytesIO()
    Image.fromarray(picture).save(content, "PNG")
    return content.getvalue()


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
