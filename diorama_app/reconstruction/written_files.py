"""Files that are made beside everything else and handed to the browser that asked: the scene for other programs, and
pictures and films of it.
"""

from __future__ import annotations

import io
import re
import tempfile
import zipfile
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from PIL import Image

from diorama_app.projects.formats import EXPORT_FORMATS
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_core.errors import EditRefused, ExportError, InputError
from diorama_core.export import Format, export_scene
from diorama_core.export.files import FAST_DEFLATE
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene

if TYPE_CHECKING:
    from diorama_core.export.gathering import ExportOptions


def export(client: Client, format_name: str, options: ExportOptions) -> None:
    """Write the scene in one of `EXPORT_FORMATS` and hand it over whole, or not at all.

    Raises:
        EditRefused: there is nothing to write.
        ExportError: there is no such format.
        UnavailableError: its optional library is missing.
    """
    session = client.session
    scene, project, textures, photo = session.scene, session.project, dict(session.textures), session.photo
    if not scene.objects and not scene.architecture.planes:
        raise EditRefused("there is nothing to export yet; build or open a scene first")
    if format_name not in EXPORT_FORMATS:
        message = _("cannot export as {format!r}; choose a format from the list").format(format=format_name)
        raise ExportError(message)
    chosen = EXPORT_FORMATS[format_name]
    chosen.writer()  # says at once what is missing
    name = project.name if project is not None else "scene"
    info = project.info() if project is not None else None
    stem = file_stem(name)

    def work(progress: Progress) -> None:
        with tempfile.TemporaryDirectory(prefix="export-") as folder:
            export_scene(
                scene,
                session.library,
                Path(folder) / f"{stem}{download_suffix(chosen)}",
                chosen,
                options=options,
                textures=textures,
                photo=None if photo is None else photo.rgb,
                name=name,
                provenance=info,
                progress=progress.part(0.0, 0.95),
            )
            file_name, content = pack(Path(folder), f"{stem}-{chosen.name}.zip")
        hand_over(client, file_name, content, progress)

    session.jobs.start("export", _("Exporting {title}").format(title=_(chosen.title)), work)


def hand_over(client: Client, name: str, content: bytes, progress: Progress) -> None:
    """Download a finished file in the browser that asked for it; not when it was cancelled meanwhile.

    Args:
        client: the browser that asked.
        name: of the file.
        content: of the file.
        progress: reports and cancellation.
    """
    progress.report(0.98, _("downloading {name}").format(name=name))

    def download() -> None:
        client.view.download(name, content)
        message = _("{name} ({size}) is in your downloads.").format(name=name, size=size_in_words(len(content)))
        client.notice(message, "good")

    client.post(download)


def download_suffix(chosen: Format) -> str:
    """How the one file ends that is downloaded: a format of several files is packed where it can be."""
    return ".zip" if ".zip" in chosen.suffixes else chosen.suffixes[0]


def pack(folder: Path, zip_name: str) -> tuple[str, bytes]:
    """What was written into a folder as one file: that file, or a zip of all of them.

    Returns:
        Its name and its content.
    """
    files = sorted(p for p in folder.rglob("*") if p.is_file())
    if len(files) == 1:
        return files[0].name, files[0].read_bytes()
    with tempfile.TemporaryFile() as whole:
        with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED, compresslevel=FAST_DEFLATE) as archive:
            for file in files:
                archive.write(file, file.relative_to(folder).as_posix())
        whole.seek(0)
        return zip_name, whole.read()


def file_stem(name: str) -> str:
    """A project's name as the beginning of a file name."""
    return re.sub(r"[^\w.-]+", "-", name).strip("-.")[:80] or "scene"


def size_in_words(count: int) -> str:
    """A number of bytes as people write it."""
    return f"{count / 1e6:.1f} MB" if count >= 100_000 else f"{max(1, round(count / 1e3))} kB"


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
        scene = replace(scene, camera=client.view.camera.to_picture_camera(*size))
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
        message = _("a picture {width} pixels wide cannot be made here; choose 16 to {most}")
        raise InputError(message.format(width=width, most=most))
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
