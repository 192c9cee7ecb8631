"""Pictures as files and inside pages, and small ones of projects: their scene as it is drawn, or their photo."""

from __future__ import annotations

import base64
import hashlib
import io
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from diorama_app.projects.manage import mtime
from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.io.bounded import read_picture
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.project.storage import Project

SIZE = (240, 180)
FROM_OUTSIDE = "orbit:20"
"""Where a scene without a photo is seen from: half turned, so that two walls are behind the furniture."""
MAX_PIXELS = 100_000_000


def encode_picture(picture: Image.Image | UInt8[np.ndarray, "h w c"], kind: str, **options: Any) -> bytes:
    """A picture as a file of a kind that Pillow writes, such as PNG, with its options."""
    content = io.BytesIO()
    image = picture if isinstance(picture, Image.Image) else Image.fromarray(picture)
    image.save(content, kind, **options)
    return content.getvalue()


def jpeg_uri(jpeg: bytes) -> str:
    """A JPEG as it stands inside a page."""
    return "data:image/jpeg;base64," + base64.b64encode(jpeg).decode()


def picture_uri(picture: Image.Image | UInt8[np.ndarray, "h w c"], kind: str, **options: Any) -> str:
    """A picture as it stands inside a page, as a file of this kind."""
    content = encode_picture(picture, kind, **options)
    return f"data:image/{kind.lower()};base64," + base64.b64encode(content).decode()


def project_picture(folder: Path) -> bytes | None:
    """A PNG of a project, drawn once after each change and cached on disk; None where there is nothing to draw.

    Raises:
        DioramaError: the project cannot be read.
    """
    name = hashlib.sha256(str(folder.resolve()).encode()).hexdigest()[:24]
    cached = default_cache_dir() / "projects" / f"{name}.png"
    if cached.exists() and cached.stat().st_mtime > mtime(folder):
        return cached.read_bytes()
    image = _draw(folder)
    if image is None:
        return None
    content = encode_picture(image, "PNG")
    write_atomically(cached, content, error=ProjectError)
    return content


def _draw(folder: Path) -> Image.Image | None:
    from diorama_core.api import load, render  # the renderer takes a second to load; pages without pictures do without

    project = Project.open(folder)
    if project.has_scene:
        room = load(folder)
        view = FROM_OUTSIDE if room.scene.camera is None else "photo"
        return Image.fromarray(render(room, view=view, size=SIZE))
    try:
        photo = Image.fromarray(read_picture(folder / "photo.jpg", ProjectError, most_pixels=MAX_PIXELS, within=SIZE))
    except DioramaError:
        return None
    photo.thumbnail(SIZE)
    return photo
