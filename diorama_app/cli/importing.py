"""`diorama import`: a file becomes a project."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from diorama_app.cli.arguments import command, print_note, progress_bar
from diorama_core.errors import InputError

if TYPE_CHECKING:
    from diorama_core.importing.opening import Opened
    from diorama_core.importing.scene_import import Imported
    from diorama_core.progress import Progress


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
    p.add_argument("--photo", type=Path, metavar="FILE", help="taken in a scanned room: looks and kinds come from it")
    p.add_argument("--boxes", type=Path, metavar="FILE", help="of the photo, as in diorama build; otherwise found")
    p.add_argument("--library", metavar="NAME", help="shape library (default: the one the file names, or built-in)")


def _import(a: argparse.Namespace) -> None:
    from diorama_core.importing.apart import imported_apart
    from diorama_core.project.storage import Project

    if (a.output / "scene.json").exists():
        raise InputError(f"{a.output} has a scene already; choose a new folder")
    if a.boxes is not None and a.photo is None:
        raise InputError("--boxes says what is in a photo; name it with --photo")
    with progress_bar() as progress:
        part = progress if a.photo is None else progress.part(0.0, 0.2)
        imported = imported_apart(a.file, a.library, part)
        opened = imported.opened
        warnings: tuple[str, ...] = ()
        if a.photo is not None:
            opened, warnings = _with_photo(a, imported, progress.part(0.2, 1.0))
    project = Project.create(a.output, name=a.file.stem)
    project.update_info(library=imported.library_name)
    project.save_textures(opened.textures)
    if opened.inputs is not None:
        project.save_inputs(opened.inputs)
    project.save_scene(opened.scene)
    for line in (*warnings, *opened.changes):
        print_note(line)
    scene = opened.scene
    print(f"{a.output}: {len(scene.objects)} objects, {len(scene.architecture.planes)} planes")


def _with_photo(a: argparse.Namespace, imported: Imported, progress: Progress) -> tuple[Opened, tuple[str, ...]]:
    """The scan with what the photo shows, and warnings about the photo."""
    import diorama_core as diorama
    from diorama_core.importing.photo_of_scan import with_photo_of_scan
    from diorama_core.layout.recipes import recipe
    from diorama_core.perception.inputs import read_inputs
    from diorama_core.pipeline.presets import stages_for

    read, library = read_inputs(a.photo, boxes=a.boxes), diorama.open_library(imported.library_name)
    opened = with_photo_of_scan(
        imported.opened,
        read.inputs,
        library,
        lambda inputs: stages_for("auto", inputs, library),
        lambda free: recipe("feasible", library, free, depth_measured=True),
        progress,
    )
    return opened, read.warnings
