"""A scene as a Blender file: its GLB opened in Blender's Python, with collections, lights and the photo's camera."""

from __future__ import annotations

import shutil
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from diorama_core.errors import ExportError
from diorama_core.export.blender import WORKER, run_in_blender
from diorama_core.export.files import whole_file
from diorama_core.export.gathering import ExportScene
from diorama_core.export.gltf import write_gathered
from diorama_core.progress import SILENT, Progress

EVEN_SHARE = 0.9
"""Share of the light from all sides that comes before bounces; by it pictures of three rooms differ least from ours."""
SEEK_TABLE_END = bytes.fromhex("b1ea928f")
"""Last four bytes of the seekable Zstandard files that Blender writes."""


def write_blend(scene: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write a `.blend` with everything in it, as `Writer` says; raises `UnavailableError` where Blender fails.

    Objects are parented to their supporters and keep their custom properties; the photo lies behind the camera's view.
    """
    with whole_file(Path(path)) as temporary, tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        plain = replace(scene, options=replace(scene.options, compression="none"))
        write_gathered(plain, folder / "room.glb", progress.part(0.0, 0.3))
        job: dict[str, object] = {"glb": str(folder / "room.glb"), "blend": str(folder / "room.blend")}
        job["lighting"] = "SPEC" if scene.options.lights == "photometric" else "COMPAT"
        if scene.even_light is not None:
            job["around"] = EVEN_SHARE * scene.even_light.lux / np.pi
        if scene.camera is not None:
            k = scene.camera.intrinsics
            job["camera"] = {"width": k.width, "height": k.height, "fx": k.fx, "fy": k.fy, "cx": k.cx, "cy": k.cy}
        if scene.photo is not None:
            Image.fromarray(np.ascontiguousarray(scene.photo)).save(folder / "photo.png")
            job["photo"] = str(folder / "photo.png")
        progress.report(0.3, "opening the scene in Blender")
        run_in_blender(WORKER, job, name="Blender", progress=progress.part(0.3, 1.0))
        blend = folder / "room.blend"
        # Blender says nothing where a disk is full: the table at the end of a compressed file is missing.
        if not blend.is_file() or not blend.read_bytes().endswith(SEEK_TABLE_END):
            raise ExportError(
                f"cannot write {path}: Blender's file is not whole; free some space or choose another disk"
            )
        shutil.copyfile(blend, temporary)
