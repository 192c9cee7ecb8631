"""A scene as one binary PLY mesh with normals and vertex colours: metres, +Z up.

PLY has no materials: a vertex takes the colour of its material and of the picture around its place. Surfaces whose
picture shows something are cut into small triangles first, so that a photo on a wall or a painting stays recognisable;
the grain of wood and the weave of cloth are finer than that, and the vertices take their average.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import BinaryIO

import cv2
import numpy as np
import trimesh
from jaxtyping import Float, Float32, UInt8

from diorama_core.export.files import whole_file
from diorama_core.export.gathering import ExportScene
from diorama_core.export.world_meshes import world_meshes
from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear
from diorama_core.progress import SILENT, Progress
from diorama_core.render.appearance import Surface

PICTURE_EDGE_M = 0.05
"""Longest edge of triangles that carry a picture."""
MAX_PIECES = 60_000
"""Triangles that a surface is cut into at most."""
SHOWN_STEPS = 64
"""A picture shows something where places of that size differ by more than this, of 255; less is grain."""
VERTEX = np.dtype([("place", "<f4", 3), ("normal", "<f4", 3), ("colour", "u1", 4)])
FACE = np.dtype([("count", "u1"), ("corners", "<i4", 3)])


def write_ply(scene: ExportScene, path: Path, progress: Progress = SILENT) -> None:
    """Write one mesh, as `Writer` says."""
    with whole_file(Path(path)) as temporary, tempfile.TemporaryFile() as faces, tempfile.TemporaryFile() as vertices:
        vertex_count, face_count = _write_parts(scene, vertices, faces, progress)
        with temporary.open("wb") as stream:
            stream.write(_header(vertex_count, face_count))
            for part in (vertices, faces):
                part.seek(0)
                while block := part.read(1 << 22):
                    stream.write(block)


def _write_parts(scene: ExportScene, vertices: BinaryIO, faces: BinaryIO, progress: Progress) -> tuple[int, int]:
    """Vertices and faces one after the other: the header names both counts before either."""
    vertex_count = face_count = 0
    for mesh in world_meshes(scene, progress):
        for surface in mesh.surfaces:
            fine = finely_cut(surface)
            rows = np.empty(len(fine.vertices), VERTEX)
            rows["place"], rows["normal"], rows["colour"] = fine.vertices, fine.normals, vertex_colours(fine)
            corners = np.empty(len(fine.faces), FACE)
            corners["count"], corners["corners"] = 3, fine.faces + vertex_count
            vertices.write(rows.tobytes())
            faces.write(corners.tobytes())
            vertex_count += len(rows)
            face_count += len(corners)
    return vertex_count, face_count


def _header(vertices: int, faces: int) -> bytes:
    floats = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    colours = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue", "alpha"))
    return (
        "ply\nformat binary_little_endian 1.0\ncomment Diorama: metres, +Z up, sRGB colours\n"
        f"element vertex {vertices}\n{floats}{colours}"
        f"element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()


def finely_cut(surface: Surface) -> Surface:
    """The surface with its large triangles cut where its picture shows something; otherwise it stays as it is."""
    if surface.uv is None or surface.material.texture is None:
        return surface
    seen = _average(surface.material.texture, surface, PICTURE_EDGE_M)
    if np.ptp(seen.reshape(-1, seen.shape[2]), axis=0).max() <= SHOWN_STEPS:
        return surface
    a, b, c = (surface.vertices[surface.faces[:, k]] for k in range(3))
    longest = float(max(np.linalg.norm(x - y, axis=1).max() for x, y in ((a, b), (b, c), (c, a))))
    edge = max(PICTURE_EDGE_M, float(np.sqrt(4.0 * surface.area_m2 / MAX_PIECES)))
    if longest <= edge or len(surface.faces) > MAX_PIECES:
        return surface
    columns = np.hstack([surface.vertices, surface.normals, surface.uv]).astype(np.float64)
    faces = surface.faces
    while longest > edge:
        columns, faces = trimesh.remesh.subdivide(columns, faces)
        longest /= 2.0
        if len(faces) * 4 > 4 * MAX_PIECES:
            break
    rows = columns.astype(np.float32)
    return Surface(rows[:, :3], rows[:, 3:6], faces.astype(np.int32), surface.material, rows[:, 6:8])


def vertex_colours(surface: Surface) -> UInt8[np.ndarray, "n 4"]:
    """sRGB colour and opacity of every vertex: material, vertex colour and picture multiplied."""
    material = surface.material
    linear = np.tile(np.asarray(material.colour, dtype=np.float64), (len(surface.vertices), 1))
    if surface.colours is not None:
        linear *= surface.colours
    if surface.uv is not None and material.texture is not None:
        spacing_m = float(np.sqrt(2.0 * surface.area_m2 / len(surface.faces)))
        around = srgb_to_linear(_average(material.texture, surface, spacing_m)[:, :, :3] / 255.0)
        linear *= _texels(around, surface.uv)
    rgb = np.rint(255 * np.clip(linear_to_srgb(np.clip(linear, 0, 1)), 0, 1)).astype(np.uint8)
    return np.hstack([rgb, np.full((len(rgb), 1), round(255 * material.alpha), np.uint8)])


def _average(picture: UInt8[np.ndarray, "h w c"], surface: Surface, edge_m: float) -> UInt8[np.ndarray, "_ _ c"]:
    """The picture with one texel for each square of an edge on the surface, or as it is where it is coarser."""
    assert surface.uv is not None
    height, width, channels = picture.shape
    a, b, c = (surface.uv[surface.faces[:, k]].astype(np.float64) * (width, height) for k in range(3))
    (x1, y1), (x2, y2) = (b - a).T, (c - a).T
    covered_px = 0.5 * float(np.abs(x1 * y2 - x2 * y1).sum())
    texels = max(1.0, edge_m * float(np.sqrt(covered_px / surface.area_m2)))
    size = (max(1, round(width / texels)), max(1, round(height / texels)))
    return np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA)).reshape(size[1], size[0], channels)


def _texels(picture: Float[np.ndarray, "h w c"], uv: Float32[np.ndarray, "n 2"]) -> Float[np.ndarray, "n c"]:
    """The nearest texel of each coordinate; 1 is the far border, not the near one again."""
    height, width = picture.shape[:2]
    wrapped = np.where((uv < 0) | (uv > 1), uv % 1.0, uv)
    column = np.clip((wrapped[:, 0] * width).astype(int), 0, width - 1)
    row = np.clip(((1 - wrapped[:, 1]) * height).astype(int), 0, height - 1)
    return picture[row, column]
