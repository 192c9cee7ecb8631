"""A scene as Wavefront OBJ with its material file and pictures: metres, +Y up, one `o` per object.

Metallic and roughness follow the common extension of MTL (`Pm`, `Pr`); `Kd` is linear, as Blender writes and reads it.
As .zip everything is one file; as .obj the material file and pictures lie in a folder beside it.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from diorama_core.export.files import companion_folder, whole_file, write_whole
from diorama_core.export.gathering import ExportScene
from diorama_core.export.text import index_rows, number_rows
from diorama_core.export.world_meshes import Y_UP, WorldMesh, world_meshes
from diorama_core.io.atomic import ByteSink
from diorama_core.progress import Progress
from diorama_core.render.appearance import Material, Surface

DECIMALS = 5
"""A hundredth of a millimetre."""
FAST_DEFLATE = 1
_JPEG_FROM_PX = 512 * 512
_MAP_KEYWORDS = {"normalTexture": "norm", "metallicRoughnessTexture": "map_Pr", "emissiveTexture": "map_Ke"}


def write_obj(scene: ExportScene, path: Path, progress: Progress | None = None) -> None:
    """Write `path` (.zip with everything in it, or .obj with a folder beside it), whole or not at all.

    Raises:
        ExportError: when it cannot be written.
        Cancelled: when asked to stop; what was there stays.
    """
    path = Path(path)
    pictures = _picture_names(scene)
    if path.suffix.lower() == ".zip":
        with whole_file(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.compresslevel = FAST_DEFLATE
            with archive.open(f"{path.stem}.obj", "w", force_zip64=True) as stream:
                _write_geometry(scene, stream, f"{path.stem}.mtl", progress)
            for name, content in _companions(scene, f"{path.stem}.mtl", pictures):
                archive.writestr(name, content)
        return
    folder = companion_folder(path)
    with whole_file(path) as temporary, _created(path.parent / folder):
        with temporary.open("wb") as stream:
            _write_geometry(scene, stream, f"{folder}/{path.stem}.mtl", progress)
        for name, content in _companions(scene, f"{path.stem}.mtl", pictures):
            (path.parent / folder / name).parent.mkdir(exist_ok=True)
            write_whole(path.parent / folder / name, content)


@contextmanager
def _created(folder: Path) -> Iterator[None]:
    """The folder exists inside the block; one that is new and stays empty goes again."""
    known = folder.exists()
    folder.mkdir(exist_ok=True)
    try:
        yield
    finally:
        if not known and not any(folder.iterdir()):
            folder.rmdir()


def _write_geometry(scene: ExportScene, stream: ByteSink, material_file: str, progress: Progress | None) -> None:
    stream.write(f"# Diorama: metres, +Y up\nmtllib {material_file}\n".encode())
    names = material_names(scene)
    written = _Written()
    for mesh in world_meshes(scene, progress, R=Y_UP):
        written.add(stream, mesh, names)


class _Written:
    """How many vertices and texture coordinates the file has so far: OBJ counts through all objects."""

    def __init__(self) -> None:
        self._vertices = 1
        self._uvs = 1

    def add(self, stream: ByteSink, mesh: WorldMesh, names: Mapping[int, str]) -> None:
        stream.write(f"o {one_line(mesh.name)}\n".encode())
        for surface in mesh.surfaces:
            rows = surface.vertices if surface.colours is None else np.hstack([surface.vertices, surface.colours])
            stream.write(number_rows("v", rows, DECIMALS))
            stream.write(number_rows("vn", surface.normals, 4))
            if surface.uv is not None:
                stream.write(number_rows("vt", surface.uv, 6))
            stream.write(f"usemtl {names[id(surface.material)]}\n".encode())
            stream.write(self._faces(surface))
            self._vertices += len(surface.vertices)
            self._uvs += 0 if surface.uv is None else len(surface.uv)

    def _faces(self, surface: Surface) -> bytes:
        corners = surface.faces.astype(np.int64)
        if surface.uv is None:
            return index_rows("f %d//%d %d//%d %d//%d", np.repeat(corners + self._vertices, 2, axis=1))
        v, t = corners + self._vertices, corners + self._uvs
        return index_rows("f %d/%d/%d %d/%d/%d %d/%d/%d", np.stack([v, t, v], axis=2).reshape(-1, 9))


def one_line(text: str) -> str:
    """Text without line breaks."""
    return " ".join(text.split()) or "object"


def material_names(scene: ExportScene) -> dict[int, str]:
    """Names without spaces of the export's materials, by identity."""
    taken: set[str] = set()
    names = {}
    for material in scene.materials:
        stem = name = re.sub(r"\s+", "_", material.name.strip()) or "material"
        number = 2
        while name in taken:
            name, number = f"{stem}_{number}", number + 1
        taken.add(name)
        names[id(material)] = name
    return names


def _picture_names(scene: ExportScene) -> dict[int, str]:
    """File names of the export's pictures, by identity."""
    names: dict[int, str] = {}
    for material in scene.materials:
        for picture in (material.texture, *(material.maps[k] for k in _MAP_KEYWORDS if k in material.maps)):
            if picture is not None and id(picture) not in names:
                names[id(picture)] = f"textures/{len(names):03d}{'.jpg' if _is_large(picture) else '.png'}"
    return names


def _is_large(picture: UInt8[np.ndarray, "h w c"]) -> bool:
    return picture.shape[2] == 3 and picture.shape[0] * picture.shape[1] > _JPEG_FROM_PX


def _companions(scene: ExportScene, material_file: str, pictures: Mapping[int, str]) -> Iterator[tuple[str, bytes]]:
    names = material_names(scene)
    text = "\n".join(material_text(m, names[id(m)], pictures) for m in scene.materials)
    yield material_file, text.encode()
    done: set[str] = set()
    for material in scene.materials:
        for picture in (material.texture, *material.maps.values()):
            name = pictures.get(id(picture))
            if picture is not None and name is not None and name not in done:
                done.add(name)
                yield name, encoded_picture(picture)


def material_text(material: Material, name: str, pictures: Mapping[int, str]) -> str:
    """One `newmtl` block; only pictures that `pictures` names are referred to."""
    colour = " ".join(f"{c:.6f}" for c in material.colour)
    shine = 1000.0 * (1.0 - material.roughness) ** 2
    specular = 0.5 if material.metallic < 0.5 else 1.0
    lines = [f"newmtl {name}", f"Kd {colour}", f"Ks {specular} {specular} {specular}", f"Ns {shine:.1f}"]
    lines += [f"d {material.alpha:.4f}", f"Pr {material.roughness:.4f}", f"Pm {material.metallic:.4f}"]
    lines += [f"illum {4 if material.alpha < 1 else 2}"]
    if any(material.emissive):
        lines.append("Ke " + " ".join(f"{c:.6f}" for c in material.emissive))
    if material.texture is not None and id(material.texture) in pictures:
        lines.append(f"map_Kd {pictures[id(material.texture)]}")
    for slot, keyword in _MAP_KEYWORDS.items():
        if slot in material.maps and id(material.maps[slot]) in pictures:
            lines.append(f"{keyword} {pictures[id(material.maps[slot])]}")
    return "\n".join(lines) + "\n"


def encoded_picture(picture: UInt8[np.ndarray, "h w c"]) -> bytes:
    """JPEG for large opaque pictures, PNG for the others."""
    buffer = io.BytesIO()
    image = Image.fromarray(np.ascontiguousarray(picture))
    if _is_large(picture):
        image.save(buffer, "JPEG", quality=92)
    else:
        image.save(buffer, "PNG")
    return buffer.getvalue()
