"""`diorama import`: a file becomes a project."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from diorama_app.cli.arguments import command, progress_bar
from diorama_core.errors import InputError


def add_import(commands: Any) -> None:
    """Declare `diorama import`."""
    p = command(
        commands,
        "import",
        _import,
        "Make a project from a file: one that Diorama exported comes back as it was.",
        "diorama import room.glb -o my-room",
    )
    p.add_argument(
        "file",
        type=Path,
        metavar="FILE",
        help="GLB, glTF, USD, USDZ, Sweet Home 3D (.sh3d), a RoomPlan scan (.usdz, .json), a point cloud (.ply, .las, "
        ".laz, .e57), or the folder of a scan of Polycam or 3D Scanner App",
    )
    p.add_argument("-o", "--output", type=Path, required=True, metavar="PROJECT", help="project folder to write")
    p.add_argument("--library", metavar="NAME", help="shape library (default: the one the file names, or built-in)")


def _import(a: argparse.Namespace) -> None:
    from diorama_core.importing.apart import imported_apart
    from diorama_core.project.storage import Project

    if (a.output / "scene.json").exists():
        raise InputError(f"{a.output} has a scene already; choose a new folder")
    with progress_bar() as progress:
        imported = imported_apart(a.file, a.library, progress)
    project = Project.create(a.output, name=a.file.stem)
    project.update_info(library=imported.library_name)
    project.save_textures(imported.opened.textures)
    if imported.opened.inputs is not None:
        project.save_inputs(imported.opened.inputs)
    project.save_scene(imported.opened.scene)
    for line in imported.opened.changes:
        print(f"diorama: note: {line}", file=sys.stderr)
    scene = imported.opened.scene
    print(f"{a.output}: {len(scene.objects)} objects, {len(scene.architecture.planes)} planes")
