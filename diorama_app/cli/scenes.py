"""Commands that show and change scenes: serve, optimise, picture."""

from __future__ import annotations

import argparse
import json
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import diorama_core as diorama
from diorama_app.cli.arguments import (
    PROJECTS_HELP,
    RECIPES,
    WITHOUT_PHOTO,
    command,
    progress_bar,
    projects_folder,
    size,
    view,
)
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    import numpy as np

    from diorama_app.serve import Beside, Running


def add_serve(commands: Any) -> None:
    """Declare `diorama serve`."""
    p = command(commands, "serve", _serve, "diorama serve my-room --port 8081")
    p.add_argument("project", nargs="?", type=Path, metavar="PROJECT", help="project folder (default: the example)")
    p.add_argument("--host", default="127.0.0.1", help="address to listen on (default: %(default)s)")
    p.add_argument("--port", type=int, default=8080, help="port to listen on, 0 for any (default: %(default)s)")
    p.add_argument("--projects", type=Path, metavar="DIR", help=PROJECTS_HELP)
    p.add_argument("--no-open", action="store_true", help="do not open a browser window")
    p.add_argument("--low-graphics", action="store_true", help="no shadows or environment light (software WebGL)")
    p.add_argument("--token", metavar="T", help="browsers must give this token: needed for hosts other than this one")
    p.add_argument("--library", metavar="NAME", help="shape library (default: the project's own, or built-in)")
    p.add_argument(
        "--language", default="en", metavar="CODE|FILE.mo", help="language of the page (default: %(default)s)"
    )
    p.add_argument(
        "--frame-origin",
        action="append",
        default=[],
        metavar="ORIGIN",
        help="pages of this origin may show the editor in a frame, such as http://localhost:8888 of a notebook; may be "
        "given several times (default: none may)",
    )


def _serve(a: argparse.Namespace) -> None:
    """Open the editor in the browser."""

    from diorama_app.serve import serve
    from diorama_core.project.storage import Project

    name = a.library
    if name is None:
        name = "built-in" if a.project is None else Project.open(a.project).shared_library_name
    serve(
        project=a.project,
        library=name,
        projects_dir=projects_folder(a.projects),
        host=a.host,
        port=a.port,
        open_browser=not a.no_open,
        low_graphics=a.low_graphics,
        token=a.token,
        frame_origins=a.frame_origin,
        language=a.language,
        beside=_api_beside(),
    )


def _api_beside() -> Beside | None:
    """The HTTP interface beside the editor, where its libraries are installed."""
    if any(find_spec(module) is None for module in ("fastapi", "python_multipart", "uvicorn")):
        return None

    def serve_api(running: Running, token: str | None) -> AbstractContextManager[object]:
        from diorama_app.http_api.beside import api_beside  # the page comes first

        return api_beside(running, token)

    return serve_api


def add_optimise(commands: Any) -> None:
    """Declare `diorama optimise`."""
    p = command(commands, "optimise", _optimise, "diorama optimise my-room --recipe paper")
    p.add_argument("project", type=Path, metavar="PROJECT")
    p.add_argument("--recipe", choices=RECIPES, default=RECIPES[0], help="(default: %(default)s)")
    p.add_argument("--json", action="store_true", help="print the report as JSON")


def _optimise(a: argparse.Namespace) -> None:
    """Run the layout optimiser on a project."""

    from dataclasses import asdict

    from diorama_core.project.lock import ProjectLock

    room = diorama.load(a.project)
    with ProjectLock(a.project, "diorama optimise"), progress_bar() as progress:
        room = diorama.optimise(room, recipe=a.recipe, progress=progress)
        room.save(a.project)
    report = room.layout
    assert report is not None
    if a.json:
        print(json.dumps(asdict(report)))
        return
    width = max((len(name) for name in report.after), default=0)
    for name, after in report.after.items():
        before = report.before.get(name)
        print(f"{name:<{width}}  {'' if before is None else f'{before:10.4f} ->'} {after:10.4f}")
    for reason in report.reasons:
        print(f"note: {reason}")


def add_picture(commands: Any) -> None:
    """Declare `diorama picture`."""
    p = command(commands, "picture", _picture, "diorama picture my-room -o top.png --view top --size 1200x900")
    p.add_argument("project", type=Path, metavar="PROJECT")
    p.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.png")
    p.add_argument(
        "--view",
        type=view,
        metavar="photo|planes|top|front|orbit:DEG|turntable",
        help="planes: floor, walls and ceiling drawn over the photo; turntable: a film, .mp4 or .gif (default: photo, "
        f"or {WITHOUT_PHOTO} where there is none)",
    )
    p.add_argument("--size", type=size, metavar="WxH", help="in pixels (default: the photo's, at most 1280 wide)")
    p.add_argument("--cycles", action="store_true", help="path-traced by Blender's Cycles, where it is installed")
    p.add_argument("--samples", type=int, default=64, metavar="N", help="paths a pixel of --cycles (default: 64)")


def _picture(a: argparse.Namespace) -> None:
    """Draw a project's scene."""

    from diorama_app.projects.pictures import encode_picture
    from diorama_core.io.atomic import write_atomically

    room = diorama.load(a.project)
    if a.view is None:
        a.view = "photo" if room.scene.camera is not None else WITHOUT_PHOTO
    if a.view == "turntable":
        _turntable(room, a)
        return
    kind = {".png": "PNG", ".jpg": "JPEG", ".jpeg": "JPEG"}.get(a.output.suffix.lower())
    if kind is None:
        raise InputError(f"{a.output}: pictures are written as .png or .jpg; choose such a name")
    image = _path_traced(room, a) if a.cycles else diorama.render(room, view=a.view, size=a.size)
    content = encode_picture(image, kind, compress_level=2)  # PNG: a sixth larger in a quarter of the time
    write_atomically(a.output, content, error=InputError)
    print(f"{a.output}: {image.shape[1]}x{image.shape[0]}")


def _path_traced(room: diorama.Reconstruction, a: argparse.Namespace) -> np.ndarray:
    """Render one picture with Cycles."""
    from diorama_core.export.cycles import cycles_picture
    from diorama_core.render.picture import scene_view
    from diorama_core.render.raycast import PinholeView

    view = None if a.view == "planes" else scene_view(room.scene, a.view, a.size)
    if not isinstance(view, PinholeView):
        raise InputError(f"--cycles draws perspective views; choose photo or orbit:DEG instead of {a.view}")
    if a.samples < 1:
        raise InputError(f"--samples {a.samples}: ask for at least one")
    with progress_bar() as progress:
        return cycles_picture(
            room.scene,
            room.library,
            camera=view.camera,
            textures=room.textures,
            samples=a.samples,
            progress=progress,
        )


def _turntable(room: diorama.Reconstruction, a: argparse.Namespace) -> None:
    """Render a turntable video of the scene."""
    from diorama_core.export.turntable import FRAMES, SIZE, write_turntable

    with progress_bar() as progress:
        write_turntable(
            room.scene, room.library, a.output, size=a.size or SIZE, textures=room.textures, progress=progress
        )
    print(f"{a.output}: {FRAMES} frames")
