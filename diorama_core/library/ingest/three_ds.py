"""3DS (Autodesk 3D Studio): chunks with vertices, faces, texture coordinates and materials' colours; +Z up."""

from __future__ import annotations

import struct
from collections.abc import Iterator

import numpy as np
import trimesh
from trimesh.visual.material import PBRMaterial
from trimesh.visual.texture import TextureVisuals

from diorama_core.errors import LibraryError

MAIN, EDITOR, OBJECT, MESH, MATERIAL = 0x4D4D, 0x3D3D, 0x4000, 0x4100, 0xAFFF
VERTICES, FACES, UV, FACE_MATERIAL, NAME, DIFFUSE = 0x4110, 0x4120, 0x4140, 0x4130, 0xA000, 0xA020
COLOUR_BYTES, COLOUR_FLOATS = (0x0011, 0x0012), (0x0010, 0x0013)
GREY = (0.7, 0.7, 0.7)


def read_3ds(data: bytes) -> tuple[trimesh.Scene, tuple[str, ...]]:
    """The scene of a 3DS file in its own unit, and the names in it.

    Raises:
        LibraryError: it is no such file, or cut off.
    """
    try:
        main = next(body for kind, body in _chunks(data) if kind == MAIN)
        editor = next(body for kind, body in _chunks(main) if kind == EDITOR)
        colours = dict(_material(body) for kind, body in _chunks(editor) if kind == MATERIAL)
        scene, names = trimesh.Scene(), []
        for kind, body in _chunks(editor):
            if kind == OBJECT:
                name, rest = _string(body)
                names.append(name)
                for inner, mesh in _chunks(rest):
                    if inner == MESH and (made := _mesh(mesh, colours)) is not None:
                        scene.add_geometry(made)
        return scene, tuple(names)
    except (StopIteration, struct.error, ValueError, IndexError) as error:
        raise LibraryError("malformed 3DS (a chunk is cut off); export it again") from error


def _chunks(data: bytes) -> Iterator[tuple[int, bytes]]:
    at = 0
    while at + 6 <= len(data):
        kind, length = struct.unpack_from("<HI", data, at)
        if length < 6:
            return
        yield kind, data[at + 6 : at + length]
        at += length


def _string(data: bytes) -> tuple[str, bytes]:
    name, _, rest = data.partition(b"\0")
    return name.decode("latin-1"), rest


def _material(data: bytes) -> tuple[str, tuple[float, ...]]:
    name = ""
    colour: tuple[float, ...] = GREY
    for kind, body in _chunks(data):
        if kind == NAME:
            name = _string(body)[0]
        elif kind == DIFFUSE:
            for inner, value in _chunks(body):
                if inner in COLOUR_BYTES:
                    colour = tuple(v / 255.0 for v in struct.unpack_from("<3B", value))
                elif inner in COLOUR_FLOATS:
                    colour = struct.unpack_from("<3f", value)
    return name, colour


def _mesh(data: bytes, colours: dict[str, tuple[float, ...]]) -> trimesh.Trimesh | None:
    chunks = dict(_chunks(data))
    if VERTICES not in chunks or FACES not in chunks:
        return None
    (count,) = struct.unpack_from("<H", chunks[VERTICES])
    vertices = np.frombuffer(chunks[VERTICES], "<f4", 3 * count, 2).reshape(-1, 3)
    (triangles,) = struct.unpack_from("<H", chunks[FACES])
    faces = np.frombuffer(chunks[FACES], "<u2", 4 * triangles, 2).reshape(-1, 4)[:, :3]
    uv = np.zeros((count, 2))
    if UV in chunks and struct.unpack_from("<H", chunks[UV])[0] == count:
        uv = np.frombuffer(chunks[UV], "<f4", 2 * count, 2).reshape(-1, 2)
    used = [_string(b)[0] for k, b in _chunks(chunks[FACES][2 + 8 * triangles :]) if k == FACE_MATERIAL]
    colour = colours.get(used[0], GREY) if used else GREY
    material = PBRMaterial(name=used[0] if used else "", baseColorFactor=[*colour, 1.0], metallicFactor=0.0)
    visual = TextureVisuals(uv=np.array(uv), material=material)
    return trimesh.Trimesh(np.array(vertices, float), np.array(faces, int), visual=visual, process=False)
