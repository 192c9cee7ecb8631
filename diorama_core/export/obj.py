"""A scene as Wavefront OBJ with its material file and pictures: metres, +Y up, one `o` per object.

`Kd` is linear, as Blender writes and reads it. As .zip everything is one file; as .obj the material file and pictures
lie in a folder beside it.
"""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from diorama_core.export.files import FAST_DEFLATE, add_entry, companion_folder, whole_file, write_whole
from diorama_core.export.gathering import ExportScene
from diorama_core.export.wavefront import MaterialFile, ObjText
from diorama_core.export.world_meshes import Y_UP, world_meshes
from diorama_core.progress import SILENT, Progress


def write_obj(scene: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write a .zip with everything in it, or an .obj with a folder beside it, as `Writer` says."""
    path = Path(path)
    materials = MaterialFile(scene.materials, pictures="textures/")
    if path.suffix.lower() == ".zip":
        with whole_file(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.compresslevel = FAST_DEFLATE
            with archive.open(f"{path.stem}.obj", "w", force_zip64=True) as stream:
                _write_geometry(scene, stream.write, f"{path.stem}.mtl", materials, progress)
            for name, content in _companions(materials, f"{path.stem}.mtl"):
                add_entry(archive, name, content)
        return
    folder = companion_folder(path)
    with whole_file(path) as temporary, _create(path.parent / folder):
        with temporary.open("wb") as stream:
            _write_geometry(scene, stream.write, f"{folder}/{path.stem}.mtl", materials, progress)
        for name, content in _companions(materials, f"{path.stem}.mtl"):
            (path.parent / folder / name).parent.mkdir(exist_ok=True)
            write_whole(path.parent / folder / name, content)


@contextmanager
def _create(folder: Path) -> Iterator[None]:
    """The folder exists inside the block; one that is new and stays empty goes again."""
    known = folder.exists()
    folder.mkdir(exist_ok=True)
    try:
        yield
    finally:
        if not known and not any(folder.iterdir()):
            folder.rmdir()


def _write_geometry(
    scene: ExportScene,
    write: Callable[[bytes], object],
    material_file: str,
    materials: MaterialFile,
    progress: Progress,
) -> None:
    write(f"# Diorama: metres, +Y up\nmtllib {material_file}\n".encode())
    text = ObjText()
    for mesh in world_meshes(scene, progress, R=Y_UP):
        write(f"o {one_line(mesh.name)}\n".encode())
        for surface in mesh.surfaces:
            write(text.add(surface, materials.name(surface.material)))


def _companions(materials: MaterialFile, material_file: str) -> Iterator[tuple[str, bytes]]:
    yield material_file, materials.text()
    yield from materials.pictures()


def one_line(text: str) -> str:
    """Text without line breaks."""
    return " ".join(text.split()) or "object"
