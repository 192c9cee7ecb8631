"""What comparing pictures needs to know of a shape: its triangles and its colours, remembered in memory and on disk.

Building a shape from its design takes much longer than reading its triangles back, so every shape is built at most
once per machine.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from jaxtyping import Float, Float32, Int, Int32, UInt8

from diorama_core.geometry.silhouette import ShapeCaster
from diorama_core.io.cache import LruCache
from diorama_core.io.derived import read_arrays, write_arrays
from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear

_FORMAT = "5"
_CACHED_SHAPES = 512
_MIN_AREA_M2 = 1e-12
_READ_ALONG_EDGE = 5
"""Rows of points at which a face's picture is read."""


@dataclass(frozen=True, eq=False)
class ShapeAppearance:
    """One shape at scale 1 in its own frame."""

    vertices: Float32[np.ndarray, "v 3"]
    faces: Int32[np.ndarray, "f 3"]
    colours_srgb: UInt8[np.ndarray, "k 3"]
    """One colour per part whose material has one."""
    areas_m2: Float[np.ndarray, "k"]
    """Surface of those parts."""
    face_rgba: UInt8[np.ndarray, "f 4"]
    """sRGB colour of every face, the mean of its picture, and its opacity; all 0 where no colour is known."""

    @cached_property
    def caster(self) -> ShapeCaster:
        """The triangles, prepared for rays."""
        return ShapeCaster(trimesh.Trimesh(self.vertices, self.faces, process=False))

    def spread_points(self, count: int) -> Float[np.ndarray, "n 3"]:
        """Points spread evenly over the surface, the same ones every time; none where there is no surface."""
        return self._spread(count)[0]

    def spread_coloured_points(self, count: int) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
        """These points with the colours (sRGB, 0 to 1) of the faces they lie on."""
        points, face = self._spread(count)
        return points, self.face_rgba[face, :3] / 255.0

    def _spread(self, count: int) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, " n"]]:
        """Points spread evenly over the surface, and the face of each."""
        triangles = self.vertices[self.faces].astype(np.float64)
        area = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1)
        total = np.cumsum(area)
        if not len(total) or not np.isfinite(total[-1]) or total[-1] <= _MIN_AREA_M2:
            return np.zeros((0, 3)), np.zeros(0, int)
        steps = np.arange(count) + 0.5
        face = np.minimum(np.searchsorted(total, steps / count * total[-1]), len(total) - 1)
        u, v = np.sqrt(np.mod(steps * 0.7548776662466927, 1.0)), np.mod(steps * 0.5698402909980532, 1.0)
        shares = np.stack([1 - u, u * (1 - v), u * v], axis=1)
        return np.asarray((shares[:, :, None] * triangles[face]).sum(axis=1)), face


def appearance_of(parts: trimesh.Scene) -> ShapeAppearance:
    """The triangles and colours of a shape's parts."""
    vertices, faces, colours, areas = [np.zeros((0, 3))], [np.zeros((0, 3), int)], [], []
    of_faces = [np.zeros((0, 4), np.uint8)]
    count = 0
    for node in parts.graph.nodes_geometry:
        T, name = parts.graph[node]
        mesh = parts.geometry[name]
        vertices.append(trimesh.transform_points(mesh.vertices, T))
        faces.append(np.asarray(mesh.faces) + count)
        of_faces.append(face_colours(mesh))
        count += len(mesh.vertices)
        colour = material_rgb(mesh.visual)
        if colour is not None and mesh.area > _MIN_AREA_M2:
            colours.append(colour)
            areas.append(float(mesh.area))
    return ShapeAppearance(
        np.concatenate(vertices).astype(np.float32),
        np.concatenate(faces).astype(np.int32),
        np.array(colours, dtype=np.uint8).reshape(-1, 3),
        np.array(areas),
        np.concatenate(of_faces),
    )


def face_colours(mesh: trimesh.Trimesh) -> UInt8[np.ndarray, "f 4"]:
    """`ShapeAppearance.face_rgba` of one part."""
    visual: Any = mesh.visual
    count = len(mesh.faces)
    if visual is None or not visual.defined:
        return np.zeros((count, 4), np.uint8)
    if visual.kind == "face":
        return np.asarray(visual.face_colors, dtype=np.uint8)
    if visual.kind == "vertex":
        return np.rint(np.asarray(visual.vertex_colors, float)[mesh.faces].mean(axis=1)).astype(np.uint8)
    material: Any = visual.material
    texture = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    whole = material_rgb(visual)
    rgb = np.tile(np.zeros(3) if whole is None else whole, (count, 1))
    if texture is not None and visual.uv is not None and len(visual.uv) == len(mesh.vertices):
        factor = getattr(material, "baseColorFactor", None)
        pixels = _read_picture(texture, np.asarray(visual.uv, float)[mesh.faces])
        light = srgb_to_linear(pixels.mean(axis=1) / 255.0) * (
            np.ones(3) if factor is None else np.asarray(factor, float)[:3] / 255.0
        )
        rgb = np.clip(np.rint(255.0 * linear_to_srgb(light)), 0, 255)
    return np.concatenate([rgb, np.full((count, 1), _opacity(material))], axis=1).astype(np.uint8)


def _opacity(material: Any) -> int:
    """0 to 255; at least 1, since 0 says that nothing is known."""
    factor = getattr(material, "baseColorFactor", None)
    if factor is None or len(factor) < 4 or getattr(material, "alphaMode", None) in (None, "OPAQUE"):
        return 255
    return max(int(factor[3]), 1)


def _read_picture(picture: Any, uv: Float[np.ndarray, "f 3 2"]) -> Float[np.ndarray, "f s 3"]:
    """sRGB, 0 to 255, at evenly spread points of every face; pictures repeat beyond their edges."""
    pixels = np.asarray(picture.convert("RGB"))
    height, width = pixels.shape[:2]
    at = np.nan_to_num(np.einsum("sc,fck->fsk", _even_shares(), uv))
    column = np.floor(np.mod(at[..., 0], 1.0) * width).astype(int) % width
    row = np.floor(np.mod(1.0 - at[..., 1], 1.0) * height).astype(int) % height
    return np.asarray(pixels[row, column], dtype=np.float64)


def _even_shares() -> Float[np.ndarray, "s 3"]:
    """Points inside a triangle as shares of its corners."""
    n = _READ_ALONG_EDGE
    steps = [(i + 1 / 3, j + 1 / 3, n - i - j - 2 / 3) for i in range(n) for j in range(n - i)]
    return np.array(steps) / n


def material_rgb(visual: Any) -> UInt8[np.ndarray, "3"] | None:
    """One sRGB colour for one part: its material's, or the main one of its vertices or faces."""
    if visual is None or not visual.defined:
        return None
    if visual.kind in ("face", "vertex"):
        return np.asarray(visual.main_color, dtype=np.uint8)[:3]
    material: Any = visual.material
    texture = getattr(material, "baseColorTexture", None)
    factor = getattr(material, "baseColorFactor", None)
    if texture is None and factor is None:
        return np.asarray(material.main_color, dtype=np.uint8)[:3]
    picture = np.ones(3) if texture is None else np.asarray(texture.convert("RGB").resize((1, 1)), float)[0, 0] / 255.0
    # glTF: the factor is linear light, the picture is sRGB; a material without a factor shows its picture as it is.
    light = srgb_to_linear(picture) * (np.ones(3) if factor is None else np.asarray(factor, float)[:3] / 255.0)
    return np.asarray(np.clip(np.rint(255.0 * linear_to_srgb(light)), 0, 255), dtype=np.uint8)


class AppearanceStore:
    """Appearances by the content hash of their shapes; safe to share between threads."""

    def __init__(self) -> None:
        self._cached: LruCache[str, ShapeAppearance] = LruCache(_CACHED_SHAPES)

    def get(self, key: str, folder: Path, parts: Callable[[], trimesh.Scene]) -> ShapeAppearance:
        """The appearance under `key`: from memory, from a file in `folder`, or made from `parts()` and written there.

        A folder that cannot be written costs time, nothing else. Without a key nothing is cached.

        Args:
            key: of the shape's geometry; "" caches nothing.
            folder: of the files.
            parts: reads the shape's meshes, with their materials.
        """
        if not key:
            return appearance_of(parts())
        path = folder / f"{key}.{_FORMAT}.npz"
        return self._cached.get(key, lambda: _read(path) or _make(path, parts()))

    def has(self, key: str, folder: Path) -> bool:
        """Whether the appearance of `key` is cached in `folder`."""
        return bool(key) and (folder / f"{key}.{_FORMAT}.npz").is_file()


SHARED_APPEARANCES = AppearanceStore()
"""One memory for all stages: retrieval and pose look at the same shapes."""


_STORED = {
    "vertices": "vertices",
    "faces": "faces",
    "colours": "colours_srgb",
    "areas": "areas_m2",
    "of_faces": "face_rgba",
}
"""Names of the arrays in a file, and the fields that they hold."""


def _read(path: Path) -> ShapeAppearance | None:
    arrays = read_arrays(path, *_STORED)
    return None if arrays is None else ShapeAppearance(**dict(zip(_STORED.values(), arrays, strict=True)))


def _make(path: Path, parts: trimesh.Scene) -> ShapeAppearance:
    appearance = appearance_of(parts)
    write_arrays(path, {name: getattr(appearance, of) for name, of in _STORED.items()})
    return appearance
