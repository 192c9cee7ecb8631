"""Meshes for the browser: shapes and planes as GLB bytes, cached."""

from __future__ import annotations

import manifold3d
import numpy as np
import trimesh
from jaxtyping import Float, Int32, UInt8
from PIL import Image
from trimesh.visual.material import PBRMaterial

from diorama_core.errors import LibraryError
from diorama_core.geometry.planes import plane_axes, plane_uv
from diorama_core.io.cache import LruCache
from diorama_core.library.opening import can_open, open_parts
from diorama_core.library.paint import main_rgb, repaint
from diorama_core.library.photo_materials import Pictures, with_photo_materials
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.simplify import simplify_glb
from diorama_core.library.stretch import EVEN, Scale, stretch_parts
from diorama_core.scene.types import Finish, PhotoMaterial, Plane, SceneObject

Colour = tuple[float, float, float]
NO_PICTURES: Pictures = {}
_Key = tuple[str, Colour | None, Finish | None, tuple[PhotoMaterial, ...], Scale, float, frozenset[str], int | None]
MAX_PICTURE_PX = 1024
"""Size of one picture from the photo on the page; exports have the whole one."""
GREY = (200, 200, 200)
CACHE_BYTES = 512 * 2**20
"""Bytes of all shapes in memory: what the browser asks for again when somebody joins or an edit is undone."""
LIGHT_SCENE_TRIANGLES = 24_000
"""Triangles of a scene's models, for browsers that draw without a graphics card."""
LIGHT_SHAPE_TRIANGLES = (400, 2000)
"""Fewest and most of one model there."""


class ShapeBytes:
    """GLB bytes of library shapes, in their own colours or others; +Z up, metres. Safe between threads."""

    def __init__(self, library: ShapeLibrary, *, light: bool = False) -> None:
        """Nothing is made yet; `light` models are simplified, the more the more of them there are."""
        self._library = library
        self._max_triangles = LIGHT_SHAPE_TRIANGLES[0] if light else None
        self._cached: LruCache[_Key, bytes]
        self._cached = LruCache(CACHE_BYTES, size_of=len)
        self._main_colours: dict[str, tuple[int, int, int]] = {}

    def expect(self, count: int) -> None:
        """From now on shapes are made for a scene of about `count` objects."""
        if self._max_triangles is not None:
            self._max_triangles = int(np.clip(LIGHT_SCENE_TRIANGLES // max(count, 1), *LIGHT_SHAPE_TRIANGLES))

    def glb(
        self,
        shape_id: str,
        colour: Colour | None = None,
        finish: Finish | None = None,
        materials: tuple[PhotoMaterial, ...] = (),
        scale: Scale = EVEN,
        open_share: float = 0.0,
        pictures: Pictures = NO_PICTURES,
    ) -> bytes:
        """The shape's GLB; with `colour` (sRGB 0 to 1) and `finish` on its main material, and the photo's on others.

        Args:
            shape_id: which shape.
            colour: of its main material.
            finish: of its main material.
            materials: from the photo, over both where they match a slot.
            scale: by which it will be scaled, relative to an even scale: thin parts are made to keep their thickness.
            open_share: how far its doors and drawers stand open, 0 to 1.
            pictures: the textures of materials by name.
        """
        most = self._max_triangles
        shown = {m.texture: pictures[m.texture] for m in materials if m.texture is not None and m.texture in pictures}

        def make() -> bytes:
            unchanged = colour is None and finish is None and not materials and scale == EVEN and not open_share
            if unchanged:
                data = self._library.glb(shape_id)
            else:
                parts = stretch_parts(open_parts(self._library, shape_id, open_share, scale), scale)
                data = _paint_glb(parts, colour, finish, materials, shown)
            return data if most is None else simplify_glb(data, most)

        return self._cached.get((shape_id, colour, finish, materials, scale, open_share, frozenset(shown), most), make)

    def can_open(self, shape_id: str) -> bool:
        """Whether a shape has doors, drawers or lids."""
        try:
            return can_open(self._library, shape_id)
        except LibraryError:
            return False

    def lamp_place(self, item: SceneObject) -> Float[np.ndarray, 3]:
        """Where the light of a lamp comes from, in the world; its middle where its shape is missing."""
        from diorama_core.render.appearance import shape_surfaces  # the ray-caster; opening a project does without it
        from diorama_core.render.lamps import lamp_place

        try:
            surfaces = shape_surfaces(self._library, item.shape_id)
        except LibraryError:
            return item.pose.position
        return lamp_place(item, surfaces)[0]

    def lamp_shade(self, item: SceneObject) -> str | None:
        """Name of the material of a lamp's shade; None where it has none."""
        from diorama_core.render.appearance import shape_surfaces
        from diorama_core.render.lamps import shade_of

        try:
            shade = shade_of(shape_surfaces(self._library, item.shape_id))
        except LibraryError:
            return None
        return None if shade is None else shade.material.name

    def main_colour(self, shape_id: str) -> tuple[int, int, int]:
        """The colour of the shape's main material (sRGB, 0 to 255); grey where the shape is missing."""
        if shape_id not in self._main_colours:
            try:
                rgb = main_rgb(self._library.parts(shape_id))
            except LibraryError:
                rgb = GREY
            self._main_colours[shape_id] = rgb
        return self._main_colours[shape_id]


def _paint_glb(
    parts: trimesh.Scene,
    colour: Colour | None,
    finish: Finish | None,
    materials: tuple[PhotoMaterial, ...],
    pictures: Pictures,
) -> bytes:
    shown = parts if colour is None and finish is None else repaint(parts, colour, finish)
    if materials:
        reduced_pictures = {name: reduce(picture, MAX_PICTURE_PX) for name, picture in pictures.items()}
        shown = with_photo_materials(shown, materials, reduced_pictures)
    return bytes(shown.export(file_type="glb"))


def reduce(picture: UInt8[np.ndarray, "h w 3"], longest: int) -> UInt8[np.ndarray, "h2 w2 3"]:
    """The picture with its longer side at most `longest` pixels."""
    image = Image.fromarray(picture)
    image.thumbnail((longest, longest), Image.Resampling.LANCZOS)
    return np.asarray(image)


def plane_triangles(plane: Plane) -> Int32[np.ndarray, "m 3"]:
    """A plane's polygon (concave ones too) cut into triangles that face the room."""
    axes = np.stack(plane_axes(plane.normal), axis=1)
    return np.asarray(manifold3d.triangulate([plane.polygon @ axes]), dtype=np.int32)


def plane_glb(plane: Plane, texture: UInt8[np.ndarray, "h w 3"]) -> bytes:
    """A plane with its rectified picture, visible from inside the room only."""
    picture = Image.fromarray(texture)
    picture.format = "JPEG"  # of any other trimesh makes a PNG, in ten times the time and size
    material = PBRMaterial(baseColorTexture=picture, metallicFactor=0.0, roughnessFactor=0.9, doubleSided=False)
    mesh = trimesh.Trimesh(
        vertices=plane.polygon,
        faces=plane_triangles(plane),
        vertex_normals=np.tile(plane.normal, (len(plane.polygon), 1)),
        visual=trimesh.visual.TextureVisuals(uv=plane_uv(plane), material=material),
        process=False,
    )
    return bytes(trimesh.Scene(mesh).export(file_type="glb", include_normals=True))
