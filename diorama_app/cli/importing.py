"""`diorama import`: a file becomes a project."""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

from diorama_app.cli.arguments import command, print_note, progress_bar, unit
from diorama_core.errors import InputError
from diorama_core.io.text import number_of

if TYPE_CHECKING:
    from diorama_core.importing.opening import Opened
    from diorama_core.library.record import ShapeLibrary
    from diorama_core.progress import Progress
    from diorama_core.project.storage import Project


def add_import(commands: Any) -> None:
    """Declare `diorama import`."""
    p = command(commands, "import", _import, "diorama import room.glb -o my-room")
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
    p.add_argument(
        "--unit",
        type=unit,
        metavar="m|cm|mm|inch|foot|METRES",
        help="of the file's lengths (default: what the file says, or what makes it as large as rooms are)",
    )
    p.add_argument("--library", metavar="NAME", help="shape library (default: the one the file names, or built-in)")


def _import(a: argparse.Namespace) -> None:
    """Make a project from a file: one that Diorama exported comes back as it was."""

    from diorama_core.project.storage import Project

    if (a.output / "scene.json").exists():
        raise InputError(f"{a.output} has a scene already; choose a new folder")
    if a.boxes is not None and a.photo is None:
        raise InputError("--boxes says what is in a photo; name it with --photo")
    existed = a.output.exists()
    project = Project.create(a.output, name=a.file.stem)
    try:
        opened, warnings = _import_into(project, a)
    except BaseException:
        _clear(project, keep_folder=existed)
        raise
    for line in (*warnings, *opened.changes):
        print_note(line)
    scene = opened.scene
    print(f"{a.output}: {number_of(len(scene.objects))}, {number_of(len(scene.architecture.planes), 'plane')}")


def _import_into(project: Project, a: argparse.Namespace) -> tuple[Opened, tuple[str, ...]]:
    """The file's scene in a new project, read back, and warnings."""
    import diorama_core as diorama
    from diorama_core.importing.scene_import import import_scene, read_apart

    warnings: tuple[str, ...] = ()
    with progress_bar() as progress:
        part = progress if a.photo is None else progress.part(0.0, 0.2)
        imported = read_apart(import_scene, a.file, project.shapes_folder, a.library, a.unit, progress=part)
        opened = imported.opened
        project.update_info(library=imported.library_name)
        library = diorama.open_library(project.library_name)
        if a.photo is not None:
            opened, warnings = _with_photo(a, opened, library, progress.part(0.2, 1.0))
    project.save_textures(opened.textures)
    if opened.inputs is not None:
        project.save_inputs(opened.inputs)
    project.save_scene(opened.scene)
    for item in project.load_scene().objects:  # what an import reports as a success can be opened
        library.shape(item.shape_id)
    return opened, warnings


def _clear(project: Project, *, keep_folder: bool) -> None:
    """Leave nothing of a project that did not come about."""
    for path in project.folder.iterdir():
        shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)
    if not keep_folder:
        project.folder.rmdir()


def _with_photo(
    a: argparse.Namespace, opened: Opened, library: ShapeLibrary, progress: Progress
) -> tuple[Opened, tuple[str, ...]]:
    """The scan with what the photo shows, and warnings about the photo."""
    from diorama_core.importing.photo_of_scan import with_photo_of_scan
    from diorama_core.layout.recipes import recipe
    from diorama_core.perception.inputs import read_inputs
    from diorama_core.pipeline.presets import stages_for

    read = read_inputs(a.photo, boxes=a.boxes)
    opened = with_photo_of_scan(
        opened,
        read.inputs,
        library,
        lambda inputs: stages_for("auto", inputs, library),
        lambda free: recipe("feasible", library, free, depth_measured=True),
        progress,
    )
    return opened, read.warnings
