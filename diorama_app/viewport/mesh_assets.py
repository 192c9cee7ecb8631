"""Meshes for the browser: shapes and planes as GLB bytes, cached."""

from __future__ import annotations

import manifold3d
import numpy as np
import trimesh
from jaxtyping import Int32, UInt8
from PIL import Image
from trimesh.visual.material import PBRMaterial

from diorama_core.errors import LibraryError
from diorama_core.geometry.planes import plane_axes, plane_uv
from diorama_core.io.cache import LruCache
from diorama_core.library.paint import main_rgb, painted
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.simplify import simplified_glb
from diorama_core.scene.types import Finish, Plane

Colour = tuple[float, float, float]
GREY = (200, 200, 200)
CACHE_BYTES = 512 * 2**20
"""Of all shapes in memory: what the browser asks for again when somebody joins or an edit is undone."""
LIGHT_SCENE_TRIANGLES = 24_000
"""Of a scene's models, for browsers that draw without a graphics card."""
LIGHT_SHAPE_TRIANGLES = (400, 2000)
"""Fewest and most of one model there."""


class ShapeBytes:
    """GLB bytes of library shapes, in their own colours or others; +Z up, metres. Safe between threads."""

    def __init__(self, library: ShapeLibrary, *, light: bool = False) -> None:
        """Nothing is made yet; `light` models are simplified, the more the more of them there are."""
        self._library = library
        self._max_triangles = LIGHT_SHAPE_TRIANGLES[0] if light else None
        self._cached: LruCache[tuple[str, Colour | None, Finish | None, int | None], bytes]
        self._cached = LruCache(CACHE_BYTES, size_of=len)
        self._main_colours: dict[str, tuple[int, int, int]] = {}

    def expect(self, count: int) -> None:
        """From now on shapes are made for a scene of about `count` objects."""
        if self._max_triangles is not None:
            self._max_triangles = int(np.clip(LIGHT_SCENE_TRIANGLES // max(count, 1), *LIGHT_SHAPE_TRIANGLES))

    def glb(self, shape_id: str, colour: Colour | None = None, finish: Finish | None = None) -> bytes:
        """The shape's GLB; with `colour` (sRGB 0 to 1) and `finish` on its main material."""
        most = self._max_triangles

        def made() -> bytes:
            own = colour is None and finish is None
            data = self._library.glb(shape_id) if own else _painted_glb(self._library.parts(shape_id), colour, finish)
            return data if most is None else simplified_glb(data, most)

        return self._cached.get((shape_id, colour, finish, most), made)

    def main_colour(self, shape_id: str) -> tuple[int, int, int]:
        """The colour of the shape's main material (sRGB, 0 to 255); grey where the shape is missing."""
        if shape_id not in self._main_colours:
            try:
                found = main_rgb(self._library.parts(shape_id))
            except LibraryError:
                found = GREY
            self._main_colours[shape_id] = found
        return self._main_colours[shape_id]


def _painted_glb(parts: trimesh.Scene, colour: Colour | None, finish: Finish | None) -> bytes:
    return bytes(painted(parts, colour, finish).export(file_type="glb"))


def plane_triangles(plane: Plane) -> Int32[np.ndarray, "m 3"]:
    """A plane's polygon (concave ones too) cut into triangles that face the room."""
    axes = np.stack(plane_axes(plane.normal), axis=1)
    return np.asarray(manifold3d.triangulate([plane.polygon @ axes]), dtype=np.int32)


def plane_glb(plane: Plane, texture: UInt8[np.ndarray, "h w 3"]) -> bytes:
    """A plane with its rectified picture, visible from inside the room only."""
    material = PBRMaterial(
        baseColorTexture=Image.fromarray(texture), metallicFactor=0.0, roughnessFactor=0.9, doubleSided=False
    )
    mesh = trimesh.Trimesh(
        vertices=plane.polygon,
        faces=plane_triangles(plane),
        vertex_normals=np.tile(plane.normal, (len(plane.polygon), 1)),
        visual=trimesh.visual.TextureVisuals(uv=plane_uv(plane), material=material),
        process=False,
    )
    return bytes(trimesh.Scene(mesh).export(file_type="glb", include_normals=True))
