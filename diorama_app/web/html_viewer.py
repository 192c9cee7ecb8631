"""The scene as one HTML file that opens without a server: viser's own viewer with the scene inside it.

The file needs nothing from the network. Viser's client is under the Apache licence 2.0, which allows handing it on; the
notice is kept in the file.
"""

from __future__ import annotations

import contextlib
import html
import io
import re
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import viser

from diorama_app.web.lights import add_even_light, add_main_light
from diorama_app.web.viser_adapter import stop_server
from diorama_core.errors import UnavailableError
from diorama_core.export.files import write_whole
from diorama_core.export.gathering import ExportScene
from diorama_core.export.gltf import write_gathered
from diorama_core.progress import Progress
from diorama_core.render.picture import framing_camera
from diorama_core.scene.types import Camera

Y_UP_TO_WORLD = (float(np.sqrt(0.5)), float(np.sqrt(0.5)), 0.0, 0.0)
"""Turns a GLB (+Y up) into the world (+Z up), as a quaternion w, x, y, z."""
NOTICE = "<!-- Viewer: viser (https://viser.studio), Apache License 2.0. Scene: Diorama. -->"
BACKGROUND = "<style>canvas[data-engine] { background: linear-gradient(#f3f5f8, #dfe4eb); }</style>"
"""As in the editor: a white room stands out from it."""
OVERVIEW = np.array([0.45, 0.75, -0.48])
"""Direction of view where there is no photo camera."""


def write_html(scene: ExportScene, path: Path, progress: Progress | None = None) -> None:
    """Write a gathered scene as a self-contained page, whole or not at all.

    Raises:
        ExportError: when it cannot be written.
        UnavailableError: when viser's client is not installed with it.
        Cancelled: when asked to stop.
    """
    progress = progress or Progress()
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "scene.glb"
        write_gathered(_seen_from_outside(scene), model, progress.part(0.0, 0.5))
        content = model.read_bytes()
    progress.report(0.5, "packing the viewer")
    page = _page(content, scene)
    progress.check()
    write_whole(Path(path), page.encode())


def _seen_from_outside(scene: ExportScene) -> ExportScene:
    """The scene with the inner faces of its planes only, so that one looks into the room from every side.

    It is lit by the viewer, as in the editor.
    """
    keys = {p.mesh for p in scene.planes}
    meshes = {k: replace(m, surfaces=m.surfaces[:1]) if k in keys else m for k, m in scene.meshes.items()}
    return replace(scene, meshes=meshes, lights=(), options=replace(scene.options, lights="none"))


def _page(glb: bytes, scene: ExportScene) -> str:
    with _quiet_server() as server:
        server.scene.set_up_direction("+z")
        server.scene.world_axes.visible = False
        light = scene.scene.light
        server.scene.configure_default_lights(enabled=light is None, cast_shadow=False)
        add_even_light(server.scene, sky=0.5, around=0.45)
        if light is not None:
            add_main_light(server.scene, light, cast_shadow=False)
        server.scene.add_glb("/scene", glb, wxyz=Y_UP_TO_WORLD, cast_shadow=False, receive_shadow=False)
        camera = scene.camera or _overview(scene)
        T = camera.T_world_camera
        server.initial_camera.position = T[:3, 3]
        server.initial_camera.look_at = T[:3, 3] + T[:3, 2] * _distance(scene, camera)
        server.initial_camera.up = (0.0, 0.0, 1.0)
        server.initial_camera.fov = camera.intrinsics.vertical_fov_rad
        try:
            page = server.get_scene_serializer().as_html()
        except FileNotFoundError as error:
            raise UnavailableError("viser's web client is missing; install viser again from its wheel") from error
    title = html.escape(scene.name)
    # As a function: in a template, a backslash of the name would be an escape.
    page = re.sub(r"<title>.*?</title>", lambda _: f"<title>{title}</title>", page, count=1, flags=re.DOTALL)
    return page.replace("<head>", f"<head>{NOTICE}{BACKGROUND}", 1)


@contextlib.contextmanager
def _quiet_server() -> Iterator[viser.ViserServer]:
    """A server that nobody connects to: viser collects a scene in one."""
    with contextlib.redirect_stdout(io.StringIO()):  # viser prints its address whatever it is told
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    try:
        yield server
    finally:
        stop_server(server)


def _overview(scene: ExportScene) -> Camera:
    points = [p.plane.polygon for p in scene.planes] + [o.item.corners_world for o in scene.objects]
    every = np.concatenate(points) if points else np.array([[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]])
    return framing_camera(every, OVERVIEW, 1280, 960)


def _distance(scene: ExportScene, camera: Camera) -> float:
    """How far before the camera one turns around: at the middle of what stands in view."""
    centres = np.array([o.item.pose.position for o in scene.objects]).reshape(-1, 3)
    depth = camera.to_camera(centres)[:, 2]
    ahead = depth[depth > 0.3]
    return float(np.median(ahead)) if len(ahead) else 3.0
