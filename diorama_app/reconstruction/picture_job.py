"""Pictures and films of the scene, ray-cast beside everything else, handed to the browser that asked."""

from __future__ import annotations

import io
import tempfile
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Literal

from PIL import Image

from diorama_app.reconstruction.export_job import file_stem, hand_over
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_core.errors import EditRefused, InputError
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene

PictureView = Literal["here", "photo", "turntable"]
MAX_WIDTH, MAX_FILM_WIDTH = 4096, 1280
FILM_ASPECT = 4 / 3


def take_picture(client: Client, view: PictureView, width: int) -> None:
    """Draw the scene and hand the picture over.

    Args:
        client: who asks; "here" is what that person sees.
        view: "here", "photo" (the photo's camera) or "turntable" (a film that goes once around the scene).
        width: of the picture in pixels.

    Raises:
        EditRefused: there is nothing to draw, or no photo.
        InputError: the width cannot be used.
    """
    session = client.session
    scene = session.scene
    if not any(not o.hidden for o in scene.objects) and not scene.architecture.planes:
        raise EditRefused("there is nothing to draw yet; build or open a scene first")
    size = picture_size(client, view, width)
    stem = file_stem(session.project.name if session.project is not None else "scene")
    if view == "turntable":
        suffix = film_suffix()
        film = partial(_film, client, scene, size, f"{stem}-turntable{suffix}")
        session.jobs.start("picture", _("Rendering a turntable film"), film)
        return
    if view == "here":
        scene = replace(scene, camera=client.view.camera.for_picture(*size))
    still = partial(_still, client, scene, size, f"{stem}-{size[0]}x{size[1]}.png")
    session.jobs.start("picture", _("Rendering a picture"), still)


def picture_size(client: Client, view: PictureView, width: int) -> tuple[int, int]:
    """Width and height of a picture: the proportions of the 3D view, of the photo, or of a film.

    Raises:
        EditRefused: the scene has no photo.
        InputError: the width cannot be used.
    """
    most = MAX_FILM_WIDTH if view == "turntable" else MAX_WIDTH
    if not 16 <= width <= most:
        said = _("a picture {width} pixels wide cannot be made here; choose 16 to {most}")
        raise InputError(said.format(width=width, most=most))
    if view == "turntable":
        return width // 2 * 2, round(width / FILM_ASPECT / 2) * 2  # H.264 asks for even numbers
    if view == "here":
        return width, max(1, round(width / max(client.view.camera.aspect, 0.1)))
    camera = client.session.scene.camera
    if camera is None:
        raise EditRefused("this scene has no photo; draw it from this view")
    return width, max(1, round(width * camera.intrinsics.height / camera.intrinsics.width))


def film_suffix() -> str:
    """How films end: MP4 where PyAV is installed, GIF otherwise."""
    from importlib.util import find_spec

    return ".gif" if find_spec("av") is None else ".mp4"


def _still(client: Client, scene: Scene, size: tuple[int, int], name: str, progress: Progress) -> None:
    from diorama_core.render.picture import picture

    session = client.session
    pixels = picture(
        scene, session.library, size=size, textures=dict(session.textures), progress=progress.part(0.0, 0.95)
    )
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, "PNG")
    hand_over(client, name, buffer.getvalue(), progress)


def _film(client: Client, scene: Scene, size: tuple[int, int], name: str, progress: Progress) -> None:
    from diorama_core.export.turntable import write_turntable

    session = client.session
    with tempfile.TemporaryDirectory(prefix="film-") as folder:
        path = Path(folder) / name
        textures = dict(session.textures)
        write_turntable(scene, session.library, path, size=size, textures=textures, progress=progress.part(0.0, 0.95))
        content = path.read_bytes()
    hand_over(client, name, content, progress)
