"""The scene as one HTML file that opens without a server: viser's own viewer with the scene inside it.

It is lit as in the editor, and has a title and buttons for its views and for a walk (`static/viewer.html`,
`static/walk.js`) in place of viser's tree of nodes. The file needs nothing from the network. Viser's client is under
the Apache licence 2.0, which allows handing it on; the notice is kept in the file.
"""

from __future__ import annotations

import contextlib
import html
import io
import json
import re
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import viser
from jaxtyping import Float

from diorama_app.strings import _, translate_script
from diorama_app.viewport.camera import DEFAULT_FOV_RAD, NARROW_FOV_RAD, fitting_fov, room_view, side_view
from diorama_app.viewport.mesh_assets import ShapeBytes
from diorama_app.viewport.room_light import RoomLightView
from diorama_app.web.responses import STATIC
from diorama_app.web.viser_adapter import stop_server
from diorama_core.editing.walking import walk_of
from diorama_core.errors import UnavailableError
from diorama_core.export.files import write_whole
from diorama_core.export.gathering import ExportScene
from diorama_core.export.gltf import write_gathered
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.progress import SILENT, Progress
from diorama_core.scene.types import Camera, Scene

Y_UP_TO_WORLD = (float(np.sqrt(0.5)), float(np.sqrt(0.5)), 0.0, 0.0)
"""Turns a GLB (+Y up) into the world (+Z up), as a quaternion w, x, y, z."""
NOTICE = "<!-- Viewer: viser (https://viser.studio), Apache License 2.0. Scene: Diorama. -->"
ASPECTS = (0.45, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0, 2.6)
"""Width over height of the windows for which views are framed; a window takes the widest that fits into it."""

View = tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"], float]
"""Where the eye is, the point that it looks at (world, metres), and the vertical field of view (rad)."""


def write_html(scene: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write a gathered scene as a self-contained page, whole or not at all.

    Raises:
        ExportError: when it cannot be written.
        UnavailableError: when viser's client is not installed with it.
        Cancelled: when asked to stop.
    """
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "scene.glb"
        write_gathered(_cutaway(scene), model, progress.part(0.0, 0.5))
        content = model.read_bytes()
    progress.report(0.5, "packing the viewer")
    page = _page(content, scene)
    progress.check()
    write_whole(Path(path), page.encode())


def _cutaway(scene: ExportScene) -> ExportScene:
    """The scene with the inner faces of its planes only, so that one looks into the room from every side.

    It is lit by the viewer, as in the editor.
    """
    keys = {p.mesh for p in scene.planes}
    meshes = {k: replace(m, surfaces=m.surfaces[:1]) if k in keys else m for k, m in scene.meshes.items()}
    return replace(scene, meshes=meshes, lights=(), options=replace(scene.options, lights="none"))


def _page(glb: bytes, gathered: ExportScene) -> str:
    views = {_(name): [_view_json(gathered, name, aspect) for aspect in ASPECTS] for name in _names(gathered.scene)}
    with _quiet_server() as server:
        server.scene.set_up_direction("+z")
        server.scene.world_axes.visible = False
        _light(server, gathered)
        server.scene.add_glb("/scene", glb, wxyz=Y_UP_TO_WORLD, cast_shadow=False, receive_shadow=False)
        try:
            page = server.get_scene_serializer().as_html()
        except FileNotFoundError as error:
            raise UnavailableError("viser's web client is missing; install viser again from its wheel") from error
    title, walk = html.escape(gathered.name), walk_of(gathered.scene)
    # As functions: in a template, a backslash of the name would be an escape.
    page = re.sub(r"<title>.*?</title>", lambda match: f"<title>{title}</title>", page, count=1, flags=re.DOTALL)
    replacements = {
        "VIEWS": json.dumps(views),
        "ASPECTS": json.dumps(ASPECTS),
        "WALK_PLAN": "null" if walk is None else walk.json,
    }
    scripts = [translate_script((STATIC / name).read_text(encoding="utf-8")) for name in ("walk.js", "viewer.html")]
    replacements["WALKING"] = scripts[0]
    over = re.sub("|".join(replacements), lambda match: replacements[match[0]], scripts[1])
    return page.replace("<head>", f"<head>{NOTICE}", 1).replace("</head>", f"{over}</head>", 1)


def _light(server: viser.ViserServer, gathered: ExportScene) -> None:
    """The light and the exposure of the editor on a computer without a graphics card."""
    nodes = {}
    for number, node in enumerate(gathered.objects):
        nodes[node.id] = f"/objects/{number}"
        R, position = node.T_world[:3, :3], node.T_world[:3, 3]
        server.scene.add_frame(nodes[node.id], show_axes=False, wxyz=quaternion_wxyz(R), position=position)
    light = RoomLightView(server, ShapeBytes(gathered.library, light=True))
    light.begin(low_graphics=True)
    light.show(gathered.scene, nodes.get)


def _names(scene: Scene) -> tuple[str, ...]:
    """The views that a scene has; the first is seen at first."""
    return ("Photo", "Room", "Top") if scene.camera is not None else ("Room", "Top")


def _view_json(gathered: ExportScene, name: str, aspect: float) -> list[list[float] | float]:
    """A view as the page is told it: eye, point, field of view."""
    eye, target, fov_rad = _view(gathered.scene, name, aspect)
    return [[round(float(v), 4) for v in eye], [round(float(v), 4) for v in target], round(fov_rad, 4)]


def _view(scene: Scene, name: str, aspect: float) -> View:
    """A view of the editor in a window of this aspect ratio."""
    camera = scene.camera
    if name == "Photo" and camera is not None:
        k, ahead = camera.intrinsics, camera.T_world_camera[:3, 2]
        fov_rad = fitting_fov(k.width, k.height, k.fx, k.fy, k.cx, k.cy, aspect)
        return camera.position, camera.position + ahead * _distance(scene, camera), fov_rad
    if name == "Top":
        return *side_view(scene, np.array([0.0, -1e-3, 1.0]), aspect), float(NARROW_FOV_RAD)
    return *room_view(scene, aspect), float(DEFAULT_FOV_RAD)


@contextlib.contextmanager
def _quiet_server() -> Iterator[viser.ViserServer]:
    """A server that nobody connects to: viser collects a scene in one."""
    with contextlib.redirect_stdout(io.StringIO()):  # viser prints its address whatever it is told
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    try:
        yield server
    finally:
        stop_server(server)


def _distance(scene: Scene, camera: Camera) -> float:
    """How far before the camera one turns around: at the middle of what stands in view."""
    centres = np.array([o.pose.position for o in scene.objects]).reshape(-1, 3)
    depth = camera.to_camera(centres)[:, 2]
    ahead = depth[depth > 0.3]
    return float(np.median(ahead)) if len(ahead) else 3.0
