"""A scene flattened into triangles with materials: what a ray meets, and what that place looks like."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float32, Int, Int32, UInt8

from diorama_core.geometry.ray_scene import RayArray, RayHits, RayScene
from diorama_core.geometry.vectors import dot, face_normals, facing, unit
from diorama_core.io.srgb import srgb_to_linear
from diorama_core.library.opening import OpenedShapes
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.stretch import relative_scale
from diorama_core.render.appearance import Surface, shape_surfaces
from diorama_core.render.lamps import as_lit
from diorama_core.render.slabs import plane_surfaces
from diorama_core.scene.types import Scene

CLEAR = 0.6
"""Surfaces of less opacity cast no shadow."""
MIN_SLANT = 0.1
"""Surfaces seen more edge-on are blurred no further: along them pictures keep some detail."""
MEAN_STEP = 3
"""Every third texel each way tells a picture's mean colour."""


@dataclass(frozen=True, eq=False)
class PlacedSurface:
    """Surfaces put into the world as one instance."""

    surfaces: tuple[Surface, ...]
    matrix: Float[np.ndarray, "4 4"]
    instance: int


@dataclass(frozen=True, eq=False)
class Places:
    """What is seen along each of n rays that met something."""

    points: Float32[np.ndarray, "n 3"]
    normals: Float32[np.ndarray, "n 3"]
    """Smooth shading normals, toward the viewer."""
    flat_normals: Float32[np.ndarray, "n 3"]
    """Normal of the triangle, toward the viewer."""
    albedo: Float32[np.ndarray, "n 3"]
    """Linear base colour."""
    alpha: Float32[np.ndarray, "n"]
    metallic: Float32[np.ndarray, "n"]
    roughness: Float32[np.ndarray, "n"]
    emissive: Float32[np.ndarray, "n 3"]
    instance: Int32[np.ndarray, "n"]
    photographed: Bool[np.ndarray, "n"]
    """Whether the colour already holds the light of the room."""


class World:
    """Everything that is visible, in one structure of triangles."""

    def __init__(self, placed: Iterable[PlacedSurface]) -> None:
        chunks = [_chunk(surface, p.matrix) for p in placed for surface in p.surfaces]
        owners = [p.instance for p in placed for _ in p.surfaces]
        surfaces = [surface for p in placed for surface in p.surfaces]
        starts = np.cumsum([0, *(len(s.vertices) for s in surfaces)])[:-1]
        self.vertices, self._normals, self._uv, colours = (
            np.concatenate([np.zeros((0, columns), np.float32), *(chunk[k] for chunk in chunks)])
            for k, columns in enumerate((3, 3, 2, 3))
        )
        self._colours = colours if any(s.colours is not None for s in surfaces) else None
        self._faces = np.concatenate(
            [np.zeros((0, 3), np.int32), *(s.faces + start for s, start in zip(surfaces, starts, strict=True))]
        ).astype(np.int32)
        counts = [len(s.faces) for s in surfaces]
        self._surface_of_face = np.repeat(np.arange(len(surfaces), dtype=np.int32), counts)
        self._instance_of_face = np.repeat(np.array(owners, dtype=np.int32), counts)
        self._materials = _MaterialTable(surfaces)
        self._face_normals = face_normals(self.vertices, self._faces)
        self.caster = RayScene(self.vertices, self._faces)

    def shadow_caster(self, without: Collection[int] = ()) -> RayScene:
        """Only what holds light off: clear glass lets it through, and so does what is left out.

        Args:
            without: Instances that cast no shadow.
        """
        opaque = self._materials.opacity.take(self._surface_of_face) > CLEAR
        if len(without):
            opaque &= ~np.isin(self._instance_of_face, list(without))
        return self.caster if opaque.all() else RayScene(self.vertices, self._faces[opaque])

    @property
    def bounds(self) -> Float[np.ndarray, "2 3"]:
        """Lowest and highest corner of everything; a unit box when there is nothing."""
        if not len(self.vertices):
            return np.array([[-0.5, -0.5, 0.0], [0.5, 0.5, 1.0]])
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)]).astype(np.float64)

    def places(self, rays: RayArray, hits: RayHits, footprint_m: Float32[np.ndarray, "n"] | None = None) -> Places:
        """What the rays see; every ray must have met something.

        Args:
            rays: Where they come from and go.
            hits: What they meet.
            footprint_m: Width of what each ray stands for where it meets something, seen head-on: pictures are as
                blurred as that; None takes them as sharp as they are.
        """
        triangle, direction = hits.triangle, rays[:, 3:]
        w = np.concatenate([1 - hits.barycentric.sum(axis=1, keepdims=True), hits.barycentric], axis=1)
        corners = self._faces.take(triangle, axis=0)
        flat = facing(self._face_normals.take(triangle, axis=0), direction)
        smooth = -facing(unit(_mix(self._normals, corners, w)), flat)
        surface = self._surface_of_face.take(triangle)
        uv = _mix(self._uv, corners, w)
        spread = None if footprint_m is None else self._spread_uv(triangle, corners, flat, direction, footprint_m)
        albedo, alpha = self._materials.colour(surface, uv, spread)
        if self._colours is not None:
            albedo *= _mix(self._colours, corners, w)
        table = self._materials
        return Places(
            points=rays[:, :3] + direction * hits.distance[:, None],
            normals=smooth.astype(np.float32),
            flat_normals=flat.astype(np.float32),
            albedo=albedo.astype(np.float32),
            alpha=alpha,
            metallic=table.metallic.take(surface),
            roughness=table.roughness.take(surface),
            emissive=table.emissive.take(surface, axis=0),
            instance=self._instance_of_face.take(triangle),
            photographed=table.photographed.take(surface),
        )

    def _spread_uv(
        self,
        triangle: Int[np.ndarray, "n"],
        corners: Int32[np.ndarray, "n 3"],
        flat: Float32[np.ndarray, "n 3"],
        direction: Float32[np.ndarray, "n 3"],
        footprint_m: Float32[np.ndarray, "n"],
    ) -> Float32[np.ndarray, "n"]:
        """Width in texture coordinates of what rays stand for: the side of a square of the same area."""
        a, b, c = (self.vertices.take(corners[:, k], axis=0) for k in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        p, q, r = (self._uv.take(corners[:, k], axis=0) for k in range(3))
        in_uv = np.abs((q - p)[:, 0] * (r - p)[:, 1] - (q - p)[:, 1] * (r - p)[:, 0])
        slant = np.maximum(np.abs(dot(unit(direction), flat)), MIN_SLANT)
        per_metre = np.sqrt(in_uv / np.maximum(area, 1e-12) / slant)
        return (footprint_m * per_metre).astype(np.float32)

    def instances(self, triangle: Int[np.ndarray, "n"]) -> Int32[np.ndarray, "n"]:
        """The instances that triangles are of."""
        return self._instance_of_face.take(triangle)

    def is_photo(self, triangle: Int[np.ndarray, "n"]) -> Bool[np.ndarray, "n"]:
        """Whether the colours of triangles already hold the light of the room."""
        return np.asarray(self._materials.photographed.take(self._surface_of_face.take(triangle)))

    def rough_appearance(self, hits: RayHits) -> tuple[Float32[np.ndarray, "n 3"], Float32[np.ndarray, "n 3"]]:
        """Face normals (as modelled) and mean colours of what was hit: enough for light that bounces."""
        surface = self._surface_of_face.take(hits.triangle)
        return self._face_normals.take(hits.triangle, axis=0), self._materials.mean_colour.take(surface, axis=0)


def scene_world(
    scene: Scene,
    library: ShapeLibrary,
    *,
    textures: Mapping[str, UInt8[np.ndarray, "_ _ _"]] | None = None,
    photographed: bool = True,
    without: frozenset[str] = frozenset(),
) -> World:
    """The scene's visible objects (instance = index in `scene.objects`) and planes (following indices).

    Args:
        scene: What to show; hidden objects are left out.
        library: Where its shapes are.
        textures: Pictures of the planes by `Plane.texture`, and of the objects' materials from the photo.
        photographed: Whether the planes' pictures hold the light of the room, as rectified photos do.
        without: Ids of objects and planes to leave out.
    """
    return World(place_surfaces(scene, library, textures=textures, photographed=photographed, without=without))


def place_surfaces(
    scene: Scene,
    library: ShapeLibrary,
    *,
    textures: Mapping[str, UInt8[np.ndarray, "_ _ _"]] | None = None,
    photographed: bool = True,
    without: frozenset[str] = frozenset(),
) -> list[PlacedSurface]:
    """What `scene_world` is made of; arguments as there.

    Args:
        scene: As it is.
        library: Where shapes come from.
        textures: Pictures by name.
        photographed: Whether objects show the photo's materials.
        without: Ids that are left out.
    """
    placed: list[PlacedSurface] = []
    for index, item in enumerate(scene.objects):
        if not item.hidden and item.id not in without:
            paint = (item.colour, item.finish, item.visible_materials)
            scale = relative_scale(item.pose.scale)
            shapes = library if item.open_share == 0.0 else OpenedShapes(library, item.open_share, scale)
            surfaces = shape_surfaces(shapes, item.shape_id, *paint, textures or {}, scale)
            placed.append(PlacedSurface(as_lit(item, surfaces, scene), item.pose.matrix, index))
    planes = scene.architecture.planes
    pictures = {p.id: (textures or {}).get(p.texture) if p.texture else None for p in planes}
    # Beside photographed walls, a plain one has its colour from the same photo, and so in the same light.
    beside = photographed and any(pictures[p.id] is not None and p.finish is None for p in planes)
    for index, plane in enumerate(planes, start=len(scene.objects)):
        if plane.id not in without:
            faces = plane_surfaces(plane, pictures[plane.id], photographed=photographed, plain_photographed=beside)
            placed.append(PlacedSurface(faces, np.eye(4), index))
    return placed


def _chunk(surface: Surface, matrix: Float[np.ndarray, "4 4"]) -> tuple[np.ndarray, ...]:
    """Places, normals, texture coordinates and colours of a surface's vertices in the world."""
    count = len(surface.vertices)
    linear = matrix[:3, :3]
    return (
        (surface.vertices @ linear.T + matrix[:3, 3]).astype(np.float32),
        unit(surface.normals @ np.linalg.inv(linear)).astype(np.float32),
        np.zeros((count, 2), np.float32) if surface.uv is None else surface.uv,
        np.ones((count, 3), np.float32) if surface.colours is None else surface.colours,
    )


def _mix(values: np.ndarray, corners: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Vertex values interpolated in their triangles."""
    first, second, third = (values.take(corners[:, k], axis=0) * weights[:, k, None] for k in range(3))
    return first + second + third


class _MaterialTable:
    """Materials as arrays, one row per surface."""

    def __init__(self, surfaces: list[Surface]) -> None:
        materials = [s.material for s in surfaces]
        self.metallic = np.array([m.metallic for m in materials], dtype=np.float32)
        self.roughness = np.array([m.roughness for m in materials], dtype=np.float32)
        self.emissive = np.array([m.emissive for m in materials], dtype=np.float32).reshape(-1, 3)
        self._colour = np.array([m.colour for m in materials], dtype=np.float32).reshape(-1, 3)
        self.photographed = np.array([m.photographed for m in materials], dtype=bool)
        self.opacity = np.array([m.alpha for m in materials], dtype=np.float32)
        self._pictures: list[tuple[Pyramid, bool]] = []
        """Linear texels, ever more reduced, and whether they repeat."""
        self._picture_of = np.full(len(surfaces), -1, dtype=np.int32)
        known: dict[tuple[int, bool], int] = {}
        for row, surface in enumerate(surfaces):
            if surface.material.texture is not None:
                key = (id(surface.material.texture), _leaves_unit_square(surface.uv))
                if key not in known:
                    known[key] = len(self._pictures)
                    self._pictures.append((_pyramid(_linear(surface.material.texture)), key[1]))
                self._picture_of[row] = known[key]
        means = [levels[0][::MEAN_STEP, ::MEAN_STEP, :3].mean(axis=(0, 1)) for levels, _ in self._pictures]
        self.mean_colour = self._colour * np.array([*means, np.ones(3)], dtype=np.float32)[self._picture_of]

    def colour(
        self,
        surface: Int32[np.ndarray, "n"],
        uv: Float32[np.ndarray, "n 2"],
        spread_uv: Float32[np.ndarray, "n"] | None = None,
    ) -> tuple[Float32[np.ndarray, "n 3"], Float32[np.ndarray, "n"]]:
        """Linear base colour and opacity at texture coordinates (bilinear), over so wide a place around them.

        Args:
            surface: Index of the surface.
            uv: Texture coordinates.
            spread_uv: Width of the place; None for a point.
        """
        colour, alpha = self._colour.take(surface, axis=0), self.opacity.take(surface)
        picture = self._picture_of.take(surface)
        order = np.argsort(picture, kind="stable")
        bounds = np.searchsorted(picture[order], np.arange(len(self._pictures) + 1))
        for (levels, repeat), start, stop in zip(self._pictures, bounds[:-1], bounds[1:], strict=True):
            if start < stop:
                chosen = order[start:stop]
                spread = None if spread_uv is None else spread_uv.take(chosen)
                texel = _filter(levels, uv.take(chosen, axis=0), spread, repeat=repeat)
                colour[chosen] *= texel[:, :3]
                if texel.shape[1] == 4:
                    clear = alpha[chosen] < 1
                    alpha[chosen[clear]] *= texel[clear, 3]
        return colour, alpha


_LINEAR_OF_BYTE = srgb_to_linear(np.arange(256) / 255.0).astype(np.float32)


def _linear(picture: UInt8[np.ndarray, "h w c"]) -> Float32[np.ndarray, "h w c"]:
    linear = _LINEAR_OF_BYTE.take(picture)
    if picture.shape[2] == 4:
        linear[..., 3] = picture[..., 3] / 255.0
    return linear


def _leaves_unit_square(uv: Float32[np.ndarray, "n 2"] | None) -> bool:
    """Whether a picture is tiled over its surface; otherwise its opposite borders must not bleed into each other."""
    return uv is not None and bool((np.abs(uv - 0.5) > 0.501).any())


Pyramid = tuple[Float32[np.ndarray, "_ _ c"], ...]
"""A picture and its reductions, each half as large (Williams, Pyramidal parametrics, 1983)."""


def _pyramid(picture: Float32[np.ndarray, "h w c"]) -> Pyramid:
    levels = [picture]
    while min(levels[-1].shape[:2]) > 1:
        last = levels[-1]
        height, width = (n // 2 * 2 for n in last.shape[:2])
        a, b, c, d = (last[y:height:2, x:width:2] for y in (0, 1) for x in (0, 1))
        levels.append((a + b + c + d) * np.float32(0.25))  # a tenth of the time of a mean over two axes
    return tuple(levels)


def _filter(
    levels: Pyramid, uv: Float32[np.ndarray, "n 2"], spread_uv: Float32[np.ndarray, "n"] | None, *, repeat: bool
) -> Float32[np.ndarray, "n c"]:
    """Texels, mixed from the two levels whose texels are nearest to so wide (trilinear)."""
    if spread_uv is None or not len(uv):
        return _bilinear(levels[0], uv, repeat=repeat)
    height, width = levels[0].shape[:2]
    level = np.log2(np.maximum(spread_uv * float(np.sqrt(height * width)), 1.0)).clip(0, len(levels) - 1)
    lower = np.floor(level).astype(int)
    out = np.empty((len(uv), levels[0].shape[2]), np.float32)
    for k in np.unique(lower):
        here = np.flatnonzero(lower == k)
        texel = _bilinear(levels[k], uv.take(here, axis=0), repeat=repeat)
        between = (level[here] - k)[:, None].astype(np.float32)
        if between.any():
            texel = texel + between * (_bilinear(levels[k + 1], uv.take(here, axis=0), repeat=repeat) - texel)
        out[here] = texel
    return out


def _bilinear(
    picture: Float32[np.ndarray, "h w c"], uv: Float32[np.ndarray, "n 2"], *, repeat: bool
) -> Float32[np.ndarray, "n c"]:
    height, width = picture.shape[:2]
    x, y = uv[:, 0] * width - 0.5, (1 - uv[:, 1]) * height - 0.5
    x0, y0 = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    fx, fy = (x - x0)[:, None].astype(np.float32), (y - y0)[:, None].astype(np.float32)
    left, right = _texels(x0, width, repeat)
    top, bottom = _texels(y0, height, repeat)
    texels = picture.reshape(height * width, -1)
    top, bottom = top * width, bottom * width
    above = texels.take(top + left, axis=0) * (1 - fx) + texels.take(top + right, axis=0) * fx
    below = texels.take(bottom + left, axis=0) * (1 - fx) + texels.take(bottom + right, axis=0) * fx
    return above * (1 - fy) + below * fy


def _texels(index: Int[np.ndarray, "n"], count: int, repeat: bool) -> tuple[Int[np.ndarray, "n"], Int[np.ndarray, "n"]]:
    """Rows or columns of texels, and those after them."""
    if not repeat:
        return np.minimum(np.maximum(index, 0), count - 1), np.minimum(np.maximum(index + 1, 0), count - 1)
    first = index % count
    after = first + 1
    after[after == count] = 0
    return first, after
